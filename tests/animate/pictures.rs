//! GIF, and single pictures.

use super::{PENDULUM, Place, SLIDER_CRANK, names};
use gif::{DecodeOptions, Repeat};
use std::fs;

/// A GIF as a viewer has it.
struct Seen {
    size: [usize; 2],
    repeats: bool,
    delays: Vec<u16>,
    /// Red, green, blue of each pixel of each picture.
    pictures: Vec<Vec<[u8; 3]>>,
}

fn seen(bytes: &[u8]) -> Seen {
    let mut options = DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::Indexed);
    let mut decoder = options.read_info(bytes).unwrap();
    let size = [usize::from(decoder.width()), usize::from(decoder.height())];
    let palette: Vec<[u8; 3]> = decoder.global_palette().unwrap().chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
    let mut screen = vec![[0; 3]; size[0] * size[1]];
    let (mut delays, mut pictures) = (Vec::new(), Vec::new());
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        assert!(frame.palette.is_none(), "a palette of its own");
        delays.push(frame.delay);
        for (k, index) in frame.buffer.iter().enumerate() {
            let (x, y) = (k % usize::from(frame.width), k / usize::from(frame.width));
            if frame.transparent != Some(*index) {
                screen[(usize::from(frame.top) + y) * size[0] + usize::from(frame.left) + x] = palette[usize::from(*index)];
            }
        }
        pictures.push(screen.clone());
    }
    Seen { size, repeats: decoder.repeat() == Repeat::Infinite, delays, pictures }
}

/// The pixels that differ clearly.
fn differing(a: &[[u8; 3]], b: &[[u8; 3]]) -> usize {
    let far = |(a, b): &(&[u8; 3], &[u8; 3])| a.iter().zip(b.iter()).any(|(x, y)| x.abs_diff(*y) > 60);
    a.iter().zip(b).filter(far).count()
}

#[test]
fn a_turn_has_its_pictures_and_its_time() {
    let place = Place::new("gif", SLIDER_CRANK);
    let all = seen(&place.made("animate --study turn --rate 30 --size 300 -o out.gif", "out.gif"));
    // one turn at 2 rad/s takes 3.1416 s: 94 steps of 1/30 s
    assert_eq!((all.size[0], all.pictures.len(), all.repeats), (300, 94, true));
    assert_eq!(all.delays.iter().map(|d| u32::from(*d)).sum::<u32>(), 313);
    // the step from the last picture to the first is like any other, and half a turn is far
    let step = differing(&all.pictures[0], &all.pictures[1]).max(differing(&all.pictures[46], &all.pictures[47]));
    assert!(differing(&all.pictures[93], &all.pictures[0]) < 3 * step + 40);
    assert!(differing(&all.pictures[47], &all.pictures[0]) > 6 * step.max(20));
    let once = seen(&place.made("animate --study turn --speed 2 --once --rate 10 --size 100 -o once.gif", "once.gif"));
    assert_eq!((once.pictures.len(), once.repeats), (17, false));
    assert!(once.delays.iter().all(|delay| *delay == 10));
}

#[test]
fn the_same_command_gives_the_same_bytes_with_any_number_of_threads() {
    let place = Place::new("threads", SLIDER_CRANK);
    let [one, four] =
        ["1", "4"].map(|n| place.made(&format!("animate --study turn --duration 1 --size 200 -j {n} -o {n}.gif"), &format!("{n}.gif")));
    assert!(one == four);
}

#[test]
fn a_motion_in_time_ends_where_it_ends() {
    let place = Place::new("time", PENDULUM);
    let swing = seen(&place.made("animate --study swing --rate 20 --size 200 -o s.gif", "s.gif"));
    assert_eq!(swing.pictures.len(), 21);
    assert!(differing(&swing.pictures[0], &swing.pictures[20]) > 50);
    // a swing of a mode of vibration comes back
    let mode = seen(&place.made("animate --study small --rate 10 --size 200 -o m.gif", "m.gif"));
    assert_eq!((mode.pictures.len(), mode.repeats), (40, true));
}

#[test]
fn single_pictures_are_numbered() {
    let place = Place::new("frames", SLIDER_CRANK);
    let make = |rate: u32| {
        let output = place.run(&format!("animate --study turn --duration 1 --rate {rate} --size 120 -o frames/"));
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        names(&place.0.join("frames")).into_iter().filter(|name| name.ends_with(".png")).collect::<Vec<_>>()
    };
    let pictures = make(6);
    assert_eq!((pictures.len(), pictures[0].as_str(), pictures[5].as_str()), (6, "0001.png", "0006.png"));
    let mut reader =
        png::Decoder::new(std::io::BufReader::new(fs::File::open(place.0.join("frames/0003.png")).unwrap())).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!(info.width, 120);
    assert!(pixels.chunks_exact(3).filter(|p| p[0] < 215).count() > 50, "an empty picture");
    // fewer pictures leave none of the older ones
    assert_eq!(make(3).len(), 3);
}

#[test]
fn a_run_of_a_sweep_may_be_chosen() {
    let place = Place::new("sweep", SLIDER_CRANK);
    let [first, second] =
        [1, 2].map(|n| place.made(&format!("animate --study cranks --run {n} --rate 5 --size 200 -o {n}.gif"), &format!("{n}.gif")));
    assert!(first != second);
    assert!(place.refused("animate --study cranks --run 3 -o 3.gif").contains("has 2 runs"));
}
