use super::super::manifest::NAME;
use super::*;

/// A fresh directory below the system's temporary one, removed at the end.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("grashof-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// All names but that of the record, in order.
    fn names(&self) -> Vec<String> {
        let names = fs::read_dir(&self.0).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<_> = names.filter(|name| name != NAME).collect();
        names.sort();
        names
    }

    fn put(&self, name: &str, text: &str) {
        fs::write(self.0.join(name), text).unwrap();
    }

    fn text(&self, name: &str) -> String {
        fs::read_to_string(self.0.join(name)).unwrap()
    }

    /// A run of study `a` that dies when it has renamed this many of its files.
    fn killed(&self, files: &[(&str, &str)], renamed: usize) {
        let mut manifest = Manifest::read(&self.0);
        let marks: BTreeMap<String, Mark> = files.iter().map(|(name, text)| ((*name).into(), Mark::of(&bytes(text)).unwrap())).collect();
        let writing = Writing { study: "a".into(), set: set_of(&marks), suffix: ".new-0.0".into(), files: marks };
        manifest.writing = Some(writing.clone());
        manifest.store(&self.0).unwrap();
        files.iter().for_each(|(name, text)| put(&writing.temporary(&self.0, name), &bytes(text), &|| false).unwrap());
        for (name, _) in &files[..renamed] {
            fs::rename(writing.temporary(&self.0, name), self.0.join(name)).unwrap();
        }
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn bytes(text: &str) -> Content {
    Content::Bytes(text.into())
}

fn staged(files: &[(&str, &str)]) -> Staging {
    let mut staging = Staging::new();
    files.iter().for_each(|(name, text)| staging.add(*name, *text));
    staging
}

#[test]
fn a_failed_write_leaves_everything_as_it_was() {
    let scratch = Scratch::new("atomic");
    staged(&[("a.csv", "old")]).commit(&scratch.0, "a", false).unwrap();
    let record = scratch.text(NAME);
    fs::create_dir(scratch.0.join("a.json")).unwrap();
    let error = staged(&[("a.csv", "new"), ("a-x.svg", "new"), ("a.json", "new")]).commit(&scratch.0, "a", true).unwrap_err();
    assert_eq!(error.path, scratch.0.join("a.json"));
    assert!(error.to_string().contains("in the way"));
    assert_eq!(scratch.names(), ["a.csv", "a.json"]);
    assert_eq!((scratch.text("a.csv"), scratch.text(NAME)), ("old".into(), record));
}

#[test]
fn a_path_through_a_file_is_an_error_and_makes_nothing() {
    let scratch = Scratch::new("through");
    scratch.put("file", "");
    assert!(staged(&[("a.csv", "")]).commit(&scratch.0.join("file/below"), "a", false).is_err());
    assert!(staged(&[("../a.csv", "")]).commit(&scratch.0.join("out"), "a", false).is_err());
    // a name that is too long for the file system, after others were written
    let long = "a".repeat(300);
    assert!(staged(&[("a.csv", ""), (&long, "")]).commit(&scratch.0.join("out"), "a", false).is_err());
    assert_eq!(scratch.names(), ["file"]);
}

#[test]
fn only_recorded_files_are_replaced_and_removed() {
    let scratch = Scratch::new("recorded");
    let own = ["a-photo.png", "a-001.csv", "a-A.csv", "a.mat", ".a.csv.new-0.0"];
    own.iter().for_each(|name| scratch.put(name, "own"));
    staged(&[("a.csv", "1"), ("a-x.svg", "1"), ("a-y.svg", "1")]).commit(&scratch.0, "a", false).unwrap();
    staged(&[("a-x.csv", "other study")]).commit(&scratch.0, "a-x", false).unwrap();
    // somebody edits one of the figures that the next run does not make
    scratch.put("a-y.svg", "edited");
    staged(&[("a.csv", "2")]).commit(&scratch.0, "a", false).unwrap();
    own.iter().for_each(|name| assert_eq!(scratch.text(name), "own"));
    assert_eq!((scratch.text("a.csv"), scratch.text("a-y.svg")), ("2".into(), "edited".into()));
    assert!(!scratch.names().contains(&"a-x.svg".into()) && scratch.text("a-x.csv") == "other study");
    // nor is it written over, unless that is said
    let again = staged(&[("a.csv", "3"), ("a-photo.png", "3")]);
    let error = again.commit(&scratch.0, "a", false).unwrap_err();
    assert_eq!((error.path.as_path(), error.cause.kind()), (scratch.0.join("a-photo.png").as_path(), ErrorKind::AlreadyExists));
    assert_eq!((scratch.text("a.csv"), scratch.text("a-photo.png")), ("2".into(), "own".into()));
    assert!(prepare(&scratch.0, &["a-photo.png".into()], false).is_err() && prepare(&scratch.0, &["a.csv".into()], false).is_ok());
    again.commit(&scratch.0, "a", true).unwrap();
    assert_eq!(scratch.text("a-photo.png"), "3");
}

#[cfg(unix)]
#[test]
fn nothing_is_written_through_a_link() {
    let scratch = Scratch::new("link");
    let out = scratch.0.join("out");
    fs::create_dir(&out).unwrap();
    scratch.put("mine", "own");
    for name in ["a.csv", NAME, ".grashof.json.new"] {
        std::os::unix::fs::symlink(scratch.0.join("mine"), out.join(name)).unwrap();
    }
    assert!(staged(&[("a.csv", "1")]).commit(&out, "a", false).is_err());
    staged(&[("a.csv", "1")]).commit(&out, "a", true).unwrap();
    assert_eq!(scratch.text("mine"), "own");
    assert!(fs::symlink_metadata(out.join("a.csv")).unwrap().is_file() && fs::symlink_metadata(out.join(NAME)).unwrap().is_file());
}

#[test]
fn what_a_killed_run_left_is_finished_or_cleared() {
    let new = [("a.csv", "new"), ("a.json", "new"), ("a-x.svg", "new")];
    for renamed in 0..=3 {
        let scratch = Scratch::new("killed");
        staged(&[("a.csv", "old"), ("a.json", "old"), ("a-old.svg", "old")]).commit(&scratch.0, "a", false).unwrap();
        scratch.killed(&new, renamed);
        // a run of another study mends it
        let written = staged(&[("b.csv", "b")]).commit(&scratch.0, "b", false).unwrap();
        assert!(written.notes[0].contains("are complete now"), "{:?}", written.notes);
        assert_eq!(scratch.names(), ["a-x.svg", "a.csv", "a.json", "b.csv"]);
        new.iter().for_each(|(name, text)| assert_eq!(scratch.text(name), *text));
        assert!(!Manifest::read(&scratch.0).is_mixed("a"));
    }
    // killed before all was written: the old set stays
    let scratch = Scratch::new("killed-early");
    staged(&[("a.csv", "old"), ("a.json", "old")]).commit(&scratch.0, "a", false).unwrap();
    scratch.killed(&new, 0);
    scratch.put(".a.json.new-0.0", "ne");
    let notes = prepare(&scratch.0, &[], false).unwrap();
    assert!(notes[0].contains("those of the run before"), "{notes:?}");
    assert_eq!((scratch.names(), scratch.text("a.json")), (vec!["a.csv".into(), "a.json".into()], "old".into()));
    // a set like the one before, of which a file was half written
    scratch.killed(&[("a.csv", "old"), ("a.json", "old")], 0);
    scratch.put(".a.json.new-0.0", "ol");
    prepare(&scratch.0, &[], false).unwrap();
    assert_eq!((scratch.names(), scratch.text("a.json")), (vec!["a.csv".into(), "a.json".into()], "old".into()));
    // somebody has taken away what would make it whole: the record tells, and the next run mends it
    scratch.killed(&new, 1);
    fs::remove_file(scratch.0.join(".a.json.new-0.0")).unwrap();
    let notes = prepare(&scratch.0, &[], false).unwrap();
    assert!(notes[0].contains("of two runs") && Manifest::read(&scratch.0).is_mixed("a"), "{notes:?}");
    assert!(staged(&new).commit(&scratch.0, "a", false).unwrap().notes.is_empty());
    assert!(!Manifest::read(&scratch.0).is_mixed("a") && scratch.names() == ["a-x.svg", "a.csv", "a.json"]);
}

#[test]
fn a_record_that_lies_reaches_nothing_outside_and_nobody_s_own() {
    let scratch = Scratch::new("lies");
    let out = scratch.0.join("out");
    let outside = scratch.0.join("mine").display().to_string();
    scratch.put("mine", "own");
    staged(&[("a.csv", "1")]).commit(&out, "a", false).unwrap();
    fs::write(out.join("a-mine.csv"), "own").unwrap();
    let good = fs::read_to_string(out.join(NAME)).unwrap();
    let mark = serde_json::to_value(Mark::of(&bytes("own")).unwrap()).unwrap();
    let entry = format!("{{\"study\": \"a\", \"set\": \"\", \"size\": 3, \"sum\": {}}}", mark["sum"]);
    let marks = mark.to_string();
    for text in [
        // names that lead out
        format!("{{\"grashof\": 1, \"files\": {{\"../mine\": {entry}, \"{outside}\": {entry}}}}}"),
        format!(
            "{{\"grashof\": 1, \"files\": {{}}, \"writing\": {{\"study\": \"a\", \"set\": \"\", \"suffix\": \".new-/../../mine\", \"files\": {{\"a.csv\": {marks}}}}}}}"
        ),
        format!(
            "{{\"grashof\": 1, \"files\": {{}}, \"writing\": {{\"study\": \"a\", \"set\": \"\", \"suffix\": \".new-1\", \"files\": {{\"../mine\": {marks}}}}}}}"
        ),
        // a name of the user's with another content, and texts that are none
        good.replace("a.csv", "a-mine.csv"),
        good[..good.len() / 2].into(),
        "[1, 2]".into(),
        good.replace("\"grashof\": 1", "\"grashof\": 9"),
    ] {
        fs::write(out.join(NAME), &text).unwrap();
        let again = staged(&[("b.csv", "1")]).commit(&out, "a", false);
        assert!(again.is_ok(), "{text}");
        let own = [scratch.text("mine"), fs::read_to_string(out.join("a-mine.csv")).unwrap()];
        assert_eq!(own, ["own", "own"], "{text}");
    }
}

/// A writing that is to stop leaves what stood there, and no temporary files.
#[test]
fn a_stopped_writing_leaves_the_files_before() {
    let scratch = Scratch::new("stopped");
    staged(&[("a.csv", "old"), ("a.json", "old")]).commit(&scratch.0, "a", false).unwrap();
    let before = scratch.names();
    let long = "x".repeat(5 << 20);
    for after in 0..7 {
        let asked = std::sync::atomic::AtomicUsize::new(0);
        let stop = || asked.fetch_add(1, std::sync::atomic::Ordering::Relaxed) >= after;
        let error = staged(&[("a.csv", &long), ("a-new.svg", "new")]).commit_unless(&scratch.0, "a", false, &stop).err();
        if after < 6 {
            assert_eq!(error.map(|e| e.cause.kind()), Some(std::io::ErrorKind::Interrupted), "{after}");
            assert_eq!((scratch.names(), scratch.text("a.csv")), (before.clone(), "old".to_owned()));
        } else {
            assert!(error.is_none());
            assert_eq!(scratch.text("a.csv").len(), long.len());
        }
    }
}
