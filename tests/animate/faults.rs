//! What cannot be shown is refused, with a remedy, before anything is written.

use super::{Place, SLIDER_CRANK};
use std::fs;

#[test]
fn what_cannot_be_shown_is_refused() {
    let place = Place::new("refused", SLIDER_CRANK);
    for (words, said) in [
        ("animate --study nowhere -o out.gif", "nowhere"),
        ("animate -o out.gif", "the model has 4 studies"),
        ("animate --study rest -o out.gif", "has no motion"),
        ("animate --study turn -o out.avi", "the ending of `out.avi` is not known"),
        ("animate --study turn", "where the animation goes"),
        ("animate --study turn --mode 2 -o out.gif", "has no modes"),
        ("animate --study turn --run 2 -o out.gif", "is no sweep"),
        ("animate --study turn --view top -o out.gif", "is planar"),
        ("animate --study turn --rate 60 -o out.gif", "at most 50 pictures"),
        ("animate --study turn --speed 1e-9 -o out.gif", "pictures and more than"),
        ("animate --study turn -o no/such/place/out.gif", "there is no such file"),
        ("export --study turn", "what to write"),
        ("export --study turn --dxf out.dxf --view top", "is planar"),
        ("export --study turn --gltf out.glb --view top", "is for a drawing"),
        ("export --study turn --gltf out.obj", "the ending of `out.obj` is not known"),
        ("export --study rest --dxf out.dxf", "has no motion"),
    ] {
        let message = place.refused(words);
        assert!(message.contains(said), "{words}: {message}");
    }
}

#[test]
fn options_that_make_no_sense_are_refused() {
    let place = Place::new("usage", SLIDER_CRANK);
    for words in ["--speed 0", "--speed 2 --duration 3", "--rate nan", "--size 5", "--loop --once", "--view above", "--run 0"] {
        let output = place.run(&format!("animate --study turn -o out.gif {words}"));
        assert_eq!(output.status.code(), Some(2), "{words}");
    }
}

#[test]
fn without_ffmpeg_there_are_no_films() {
    let place = Place::new("ffmpeg", SLIDER_CRANK);
    for file in ["out.mp4", "out.webm"] {
        let mut command = place.command(&format!("animate --study turn -o {file}"));
        let said = place.refused_by({
            command.env("PATH", &place.0);
            command
        });
        assert!(said.contains("`ffmpeg`, which is not found") && said.contains("install it"), "{said}");
    }
}

/// A program in place of ffmpeg that keeps what it is told, and what comes through the pipe.
#[cfg(unix)]
#[test]
fn a_film_is_given_all_pictures() {
    use std::os::unix::fs::PermissionsExt;
    let place = Place::new("film", SLIDER_CRANK);
    let program = place.0.join("bin/ffmpeg");
    fs::create_dir(place.0.join("bin")).unwrap();
    let script = "#!/bin/sh\n[ \"$1\" = -version ] && exit 0\nprintf '%s ' \"$@\" > words\nfor last; do :; done\n/bin/cat > \"$last\"\n[ ! -e broken ] || { echo broken pipe dream >&2; exit 1; }\n";
    fs::write(&program, script).unwrap();
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
    let film = |file: &str| {
        let mut command = place.command(&format!("animate --study turn --duration 1 --rate 10 --size 101 -o {file}"));
        command.env("PATH", place.0.join("bin"));
        command
    };
    let output = film("out.mp4").output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let words = fs::read_to_string(place.0.join("words")).unwrap();
    assert!(words.contains("-pix_fmt rgb24") && words.contains("-r 10 ") && words.contains("libx264"), "{words}");
    let size = words.split_once("-s ").unwrap().1.split_once(' ').unwrap().0;
    let (width, height) = size.split_once('x').unwrap();
    let pixels = width.parse::<usize>().unwrap() * height.parse::<usize>().unwrap();
    // shown once, a turn has its last picture, too
    assert_eq!(fs::read(place.0.join("out.mp4")).unwrap().len(), 11 * 3 * pixels);
    // what fails leaves nothing
    fs::write(place.0.join("broken"), "").unwrap();
    assert!(place.refused_by(film("other.webm")).contains("broken pipe dream"));
}

#[test]
fn a_file_that_is_there_is_kept() {
    let place = Place::new("kept", SLIDER_CRANK);
    fs::write(place.0.join("out.gif"), "mine").unwrap();
    fs::write(place.0.join("out.dxf"), "mine").unwrap();
    assert!(place.refused("animate --study turn -o out.gif").contains("--force"));
    assert!(place.refused("export --study turn --gltf new.glb --dxf out.dxf").contains("--force"));
    assert_eq!(fs::read(place.0.join("out.gif")).unwrap(), b"mine");
    let forced = place.made("animate --study part --size 80 --duration 1 --rate 3 --force -o out.gif", "out.gif");
    assert!(forced.starts_with(b"GIF89a"));
}
