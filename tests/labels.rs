//! Names in the drawings of the models: none over another one, and each is read as belonging to its own pin.

use grashof::Model;
use grashof::output::{Label, drawing, labels};

/// Models and studies whose drawings are looked at: the first study of each, and drawings that are crowded.
fn drawings() -> Vec<(String, Vec<Label>)> {
    let files = std::fs::read_dir("models").expect("the models").map(|entry| entry.expect("a file").path());
    let mut files: Vec<_> = files.filter(|path| path.extension().is_some_and(|e| e == "yaml")).collect();
    files.sort();
    let mut found = Vec::new();
    for file in files {
        let model = Model::load(&file).unwrap_or_else(|e| panic!("{e}"));
        let studies = model.studies();
        for name in
            studies.iter().take(1).chain(studies.iter().skip(1).filter(|name| ["hold", "tilted", "firing"].contains(&name.as_str())))
        {
            let results = model.study(name).and_then(|study| study.run()).unwrap_or_else(|e| panic!("{name}: {e}"));
            let of = format!("{}, {name}", file.display());
            found.extend(results.scenes.iter().map(|(run, scene)| (of.clone(), labels(&drawing("", name, run, scene)))));
        }
    }
    assert!(found.len() >= 25, "{}", found.len());
    found
}

fn gap([left, top, right, bottom]: [f64; 4], [x, y]: [f64; 2]) -> f64 {
    (x - x.clamp(left, right)).hypot(y - y.clamp(top, bottom))
}

#[test]
fn each_name_is_read_as_that_of_its_own_pin_and_none_covers_another() {
    let mut leaders = 0;
    for (of, labels) in drawings() {
        for (index, a) in labels.iter().enumerate() {
            for b in &labels[..index] {
                let apart = a.area[0] >= b.area[2] || b.area[0] >= a.area[2] || a.area[1] >= b.area[3] || b.area[1] >= a.area[3];
                assert!(apart, "{of}: {} lies on {}", a.text, b.text);
            }
            leaders += usize::from(a.leader);
            for other in labels.iter().filter(|other| a.pin && other.pin && !a.leader && other.at != a.at) {
                assert!(gap(a.area, a.at) < gap(a.area, other.at), "{of}: {} stands at {}", a.text, other.text);
            }
        }
    }
    assert!(leaders > 10, "{leaders}");
}
