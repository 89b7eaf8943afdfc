//! What is said of files that cannot be read, or not as they stand.

use super::{bytes, directory, document, imported};
use grashof::model::{Document, Import, Selection, import};
use std::fs;
use std::path::PathBuf;

#[test]
fn every_refusal_is_told_at_its_line() {
    let bless = std::env::var_os("GRASHOF_BLESS").is_some();
    let mut files: Vec<PathBuf> = fs::read_dir(directory().join("refused")).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|e| e == "urdf"));
    files.sort();
    assert!(files.len() >= 40, "{}", files.len());
    let mut wrong = Vec::new();
    for path in files {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let found = match import(&fs::read(&path).unwrap(), &name, &Import::default()) {
            Ok(_) => "accepted\n".to_owned(),
            Err(report) => report.render(false),
        };
        let expected = path.with_extension("txt");
        if bless {
            fs::write(&expected, &found).unwrap();
        } else if fs::read_to_string(&expected).unwrap_or_default() != found {
            wrong.push(format!("{name}:\n{found}"));
        }
        assert!(found.contains("error["), "{name}: {found}");
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn imports_are_commented_models_that_check() {
    let bless = std::env::var_os("GRASHOF_BLESS").is_some();
    for name in ["odd", "kinds", "mimic"] {
        let found = imported(&format!("{name}.urdf"), &Import::default());
        let file = directory().join(format!("{name}.yaml"));
        if bless {
            fs::write(&file, &found.text).unwrap();
        }
        assert_eq!(found.text, fs::read_to_string(&file).unwrap(), "{name}");
        let report = Document::read(&found.text, name).unwrap().check_all(&Selection::default());
        assert!(report.diagnostics.is_empty(), "{name}: {report}");
        // what is told on the way stands in the file, too
        for (line, note) in &found.notes {
            assert!(found.text.contains(&format!("#   line {line}: {note}\n")), "{note}");
        }
    }
}

#[test]
fn hostile_files_are_refused_at_once() {
    let refused = |text: &str| import(text.as_bytes(), "x.urdf", &Import::default()).unwrap_err().diagnostics[0].code;
    let deep = format!("<robot name='r'>{}{}</robot>", "<a>".repeat(50_000), "</a>".repeat(50_000));
    assert_eq!(refused(&deep), "too-deep");
    assert_eq!(refused(&format!("<robot name='r'>{}</robot>", " ".repeat(17 << 20))), "file-too-large");
    assert_eq!(import(b"<robot name='\xff'/>", "x.urdf", &Import::default()).unwrap_err().diagnostics[0].code, "not-utf8");
    // a file that ends anywhere
    let whole = String::from_utf8(bytes("kinds.urdf")).unwrap();
    for end in (0..whole.trim_end().len()).step_by(7).filter(|end| whole.is_char_boundary(*end)) {
        assert!(import(&whole.as_bytes()[..end], "x.urdf", &Import::default()).is_err(), "{end}");
    }
    // a file in which any word is something else
    for (i, _) in whole.match_indices('"').step_by(2) {
        for word in ["", "x", "nan", "1e999", "-1", "0 0 0 0", "&lt;", "\u{e4}"] {
            let end = i + 1 + whole[i + 1..].find('"').unwrap();
            let _ = import(format!("{}{word}{}", &whole[..=i], &whole[end..]).as_bytes(), "x.urdf", &Import::default());
        }
    }
}

/// What is large, equal or without mass is taken as it is meant.
#[test]
fn odd_numbers_are_read_as_they_are_meant() {
    let robot = |axis: &str, limit: &str| {
        format!(
            "<robot name='r'><link name='base'/><link name='arm'/><joint name='j' type='revolute'><parent link='base'/>\
             <child link='arm'/><axis xyz='{axis}'/><limit {limit}/></joint></robot>"
        )
    };
    let stops = Import { stops: true, ..Import::default() };
    let read = |axis: &str, limit: &str| import(robot(axis, limit).as_bytes(), "r.urdf", &stops);
    let large = read("1e300 1e300 0", "lower='-1' upper='1' effort='1' velocity='1'").unwrap();
    assert!(large.text.contains("axis: [0.7071067811865475, 0.7071067811865475, 0]") && large.text.contains("limits: {"), "{}", large.text);
    let equal = read("0 0 1", "lower='0' upper='0' effort='1' velocity='1'").unwrap();
    assert!(!equal.text.contains("limits: {"), "{}", equal.text);
    for limit in ["effort='-1' velocity='1'", "effort='1' velocity='-1'"] {
        assert_eq!(read("0 0 1", limit).unwrap_err().diagnostics[0].code, "negative");
    }
    assert_eq!(large.bare, ["arm"]);
    // what the model gives mass needs no remark
    let files = |_: &str| Ok(("r.urdf".to_owned(), robot("0 0 1", "effort='1' velocity='1'").into_bytes()));
    let notes = |bodies: &str| {
        let text = format!("grashof: 1\nname: n\nspace: spatial\ngravity: none\ninclude: {{ urdf: r.urdf }}\n{bodies}");
        Document::with_files(text.as_bytes(), "model.yaml", &files).unwrap().notes()
    };
    let bare = |notes: Vec<String>| notes.iter().any(|note| note.contains("carry no mass"));
    assert!(bare(notes("")) && !bare(notes("bodies: { arm: { mass: 1 kg, inertia: 0.1 kg m^2 } }\n")));
}

/// Faults of what comes from a file are shown in that file, faults of what the model says of it in the model.
#[test]
fn findings_stand_where_they_are_made() {
    let head = "grashof: 1\nname: n\nspace: spatial\ngravity: none\n";
    let first = |text: &str| {
        let report = document(&format!("{head}{text}")).check_all(&Selection::default());
        let found = report.diagnostics.first().unwrap_or_else(|| panic!("no finding: {text}")).clone();
        (found.code, found.file.clone(), found.line())
    };
    // a patch of an included joint
    assert_eq!(first("include: { urdf: skew.urdf }\njoints: { hinge: { damping: 3 kg } }\n"), ("wrong-dimension", "model.yaml".into(), 6));
    // a second kind beside that of the file
    assert_eq!(first("include: { urdf: skew.urdf }\njoints: { hinge: { fixed: [ground, bob] } }\n").0, "two-kinds");
    // the value of `at` is the model's
    assert_eq!(first("include: { urdf: skew.urdf, at: [0, 0, 1 kg] }\n"), ("wrong-dimension", "model.yaml".into(), 5));
    assert_eq!(first("include: [{ urdf: skew.urdf, rpy: [0, tilt, 0] }]\n"), ("unknown-name", "model.yaml".into(), 5));
    // a name that the robot has
    assert_eq!(first("include: { urdf: skew.urdf }\nparameters: { hinge: 1 }\n").0, "duplicate-name");
    // a body of the file that the model removes is missing to a joint of the file
    let (code, file, line) = first("include: { urdf: skew.urdf }\nbodies: { bob: null }\n");
    assert_eq!((code, file.as_str(), line), ("unknown-body", "skew.urdf", 11));
    // sections that a file gives are not missing, all others are
    let report = document("grashof: 1\nname: n\nspace: spatial\ninclude: { urdf: skew.urdf }\n").check_all(&Selection::default());
    assert_eq!(report.diagnostics.iter().map(|d| d.code).collect::<Vec<_>>(), ["missing-key"], "{report}");
}

#[test]
fn a_wrong_include_is_told_before_anything_else() {
    let files =
        |name: &str| fs::read(directory().join(name)).map(|bytes| (name.to_owned(), bytes)).map_err(|_| "there is no such file".to_owned());
    let first = |include: &str, space: &str| {
        let text = format!("grashof: 1\nname: n\nspace: {space}\ngravity: none\ninclude: {include}\n");
        let report = Document::with_files(text.as_bytes(), "model.yaml", &files).unwrap_err();
        (report.diagnostics[0].code, report.diagnostics[0].file.clone(), report.diagnostics[0].line())
    };
    let here = |code| (code, "model.yaml".to_owned(), 5);
    assert_eq!(first("{ urdf: nowhere.urdf }", "spatial"), here("no-file"));
    assert_eq!(first("{ urdf: skew.urdf, prefx: a_ }", "spatial"), here("unknown-key"));
    assert_eq!(first("{ urdf: skew.urdf, prefix: a- }", "spatial"), here("bad-name"));
    assert_eq!(first("skew.urdf", "spatial"), here("wrong-type"));
    assert_eq!(first("{ urdf: skew.urdf, base: loose }", "spatial"), here("unknown-word"));
    assert_eq!(first("{ urdf: skew.urdf }", "planar"), here("spatial-only"));
    assert_eq!(first("{ urdf: refused/bad-token.urdf }", "spatial"), ("wrong-count", "refused/bad-token.urdf".into(), 4));
    assert_eq!(first("{ urdf: skew.urdf, base: free }", "spatial"), ("fixed-base", "skew.urdf".into(), 3));
    assert_eq!(first("{ urdf: two_bars.urdf, base: free, at: [d, 0, 0] }", "spatial"), ("not-constant", "two_bars.urdf".into(), 3));
    // a text of its own reads no files
    let text = "grashof: 1\nname: n\nspace: spatial\ngravity: none\ninclude: { urdf: skew.urdf }\n";
    assert_eq!(Document::read(text, "model.yaml").unwrap_err().diagnostics[0].code, "no-file");
}

/// What the translation needs of the language, refused where it does not belong.
#[test]
fn orientations_and_fictitious_inertias_are_checked() {
    let codes = |space: &str, axis: &str, inertia: &str, joint: &str| -> Vec<&'static str> {
        let text = format!(
            "grashof: 1\nname: n\nspace: {space}\ngravity: none\nbodies:\n  b: {{ mass: 1 kg, {inertia} }}\n\
             joints:\n  j: {{ revolute: [ground, b], {axis}{joint} }}\n"
        );
        let report = Document::read(&text, "model.yaml").unwrap().check_all(&Selection::default());
        report.diagnostics.iter().map(|finding| finding.code).collect()
    };
    let spatial = |inertia, joint| codes("spatial", "axis: [0, 0, 1], ", inertia, joint);
    assert!(spatial("inertia: [1, 1, 1]", "rpy: [0, 30 deg, 0]").is_empty());
    assert_eq!(spatial("inertia: [1, 1, 1]", "rpy: [0, 30 deg, 0], to: [0, 1, 0]"), ["two-kinds"]);
    assert_eq!(spatial("inertia: [1, 1, 1]", "rpy: [0, 1 m, 0]"), ["wrong-dimension"]);
    assert_eq!(spatial("inertia: [1, 1, 1]", "rpy: [0, 0]"), ["wrong-size"]);
    assert_eq!(codes("planar", "", "inertia: 1", "rpy: [0, 0, 0]"), ["unknown-key"]);
    assert_eq!(spatial("inertia: [1, 1, 3]", "damping: 0"), ["impossible-inertia"]);
    assert!(spatial("inertia: [1, 1, 3], fictitious: true", "damping: 0").is_empty());
    assert_eq!(spatial("inertia: [1, -1, 3], fictitious: true", "damping: 0"), ["impossible-inertia"]);
}

/// A URDF asks `<limit>` of joints that turn or slide between ends. Without it nothing is missing to move the joint: a remark.
#[test]
fn joints_without_a_limit_are_read_as_free_of_limits() {
    let limit = "<limit lower=\"-1\" upper=\"1\" effort=\"5\" velocity=\"2\"/>";
    let text = |kind: &str, limit: &str| {
        format!(
            "<robot name=\"r\">\n  <link name=\"a\"/>\n  <link name=\"b\"><inertial><mass value=\"1\"/>\
             <inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial></link>\n  \
             <joint name=\"j\" type=\"{kind}\"><parent link=\"a\"/><child link=\"b\"/><axis xyz=\"0 0 1\"/>{limit}</joint>\n</robot>\n"
        )
    };
    for kind in ["revolute", "prismatic"] {
        for stops in [false, true] {
            let asked = Import { stops, ..Import::default() };
            let read = |limit: &str| import(text(kind, limit).as_bytes(), "x.urdf", &asked).unwrap_or_else(|report| panic!("{report}"));
            let (without, with) = (read(""), read(limit));
            let remark = format!("joints without the `<limit>` that a URDF gives them, read as free of limits: j ({kind})");
            assert!(without.notes.iter().any(|(line, note)| *line == 4 && note.contains(&remark)), "{:?}", without.notes);
            assert!(!with.notes.iter().any(|(_, note)| note.contains("read as free")), "{:?}", with.notes);
            assert!(!without.text.contains("limits: {"), "{}", without.text);
            assert_eq!(with.text.contains("limits: {"), stops, "{}", with.text);
            // the same joint, and it moves
            let report = Document::read(&without.text, "x").unwrap().check_all(&Selection::default());
            assert!(report.diagnostics.is_empty(), "{report}");
            let continuous = import(text("continuous", "").as_bytes(), "x.urdf", &asked).unwrap();
            if kind == "revolute" {
                let joint = |text: &str| text.lines().find(|line| line.contains("revolute:")).map(str::to_owned);
                assert_eq!(joint(&without.text), joint(&continuous.text));
            }
        }
    }
}
