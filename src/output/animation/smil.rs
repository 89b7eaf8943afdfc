//! A film as one SVG that moves by itself (SMIL): bodies by their transforms, springs by their points, paths as they grow.
//!
//! Where the display lists of the pictures differ by more than places, as those of solids whose faces come and go, pictures follow each
//! other as in a flip-book.

use super::film::{Film, Trail};
use super::tracks::{Track, tracks, with};
use crate::output::scene::{Item, Stroke};
use crate::output::svg::{head, pairs, short, write_item};
use crate::output::thin::Point;
use std::fmt::Write;

/// Steps a second: between them everything moves evenly.
const RATE: f64 = 25.0;
/// Pictures a second of a flip-book.
const FLIPS: f64 = 12.5;
/// Times a second.
const READ: f64 = 10.0;
/// Width of a path.
const PATH: f64 = 2.4;

/// The text of an SVG that shows a film.
#[must_use]
pub fn moving_svg(film: &Film<'_>, width: usize) -> String {
    let (shot, sheet) = (film.shot(), &film.sheet);
    let steps = (shot.seconds * RATE.min(shot.rate)).round().max(1.0) as usize;
    let height = (sheet.height * width as f64 / sheet.width).ceil();
    let mut out = head([width as f64, height], sheet);
    sheet.items.iter().for_each(|item| write_item(&mut out, item, ""));
    let timing = timing(shot.seconds, shot.repeats);
    // one place more than steps: the end, which in a motion that returns is the beginning
    let places = shot.places(steps);
    let pictures: Vec<Vec<Item>> = places.iter().map(|x| film.mechanism(*x)).collect();
    match tracks(&pictures) {
        Some(tracks) => tracks.iter().for_each(|track| write_track(&mut out, track, &timing)),
        None => flip_book(&mut out, film, &timing),
    }
    film.trails.iter().for_each(|trail| grow(&mut out, trail, &timing));
    readings(&mut out, film, &timing);
    out.push_str("</svg>\n");
    out
}

/// Duration and repetition as attributes.
fn timing(seconds: f64, repeats: bool) -> String {
    let end = if repeats { "repeatCount=\"indefinite\"" } else { "fill=\"freeze\"" };
    format!("dur=\"{seconds:.3}s\" {end}")
}

fn write_track(out: &mut String, track: &Track, timing: &str) {
    match track {
        Track::Rest(items) => items.iter().for_each(|item| write_item(out, item, "")),
        Track::Rigid { items, places, turns } => {
            let _ = write!(
                out,
                "<g transform=\"translate({})\"><animateTransform attributeName=\"transform\" type=\"translate\" {timing} values=\"{}\"/>",
                pairs(&places[..1]),
                list(places, |p| pairs(&[*p]))
            );
            if turns.iter().any(|turn| *turn != 0.0) {
                let values = list(turns, |turn| short(*turn));
                let _ = write!(
                    out,
                    "<animateTransform attributeName=\"transform\" type=\"rotate\" additive=\"sum\" {timing} values=\"{values}\"/>"
                );
            }
            out.push('\n');
            items.iter().for_each(|item| write_item(out, item, ""));
            out.push_str("</g>\n");
        }
        Track::Form { item, points } => {
            let values = list(points, |points| pairs(points));
            write_item(out, item, &format!("<animate attributeName=\"points\" {timing} values=\"{values}\"/>"));
        }
    }
}

fn list<T>(values: &[T], text: impl Fn(&T) -> String) -> String {
    values.iter().map(text).collect::<Vec<_>>().join(";")
}

/// Pictures one after the other, each shown for its time.
fn flip_book(out: &mut String, film: &Film<'_>, timing: &str) {
    let steps = (film.shot().seconds * FLIPS.min(film.shot().rate)).round().max(1.0) as usize;
    let places = film.shot().places(steps);
    // what returns and repeats shows its first picture once
    let count = if film.count() == film.shot().steps { steps } else { steps + 1 };
    for (k, x) in places.iter().take(count).enumerate() {
        flip(out, &film.mechanism(*x), [k, count], timing);
    }
}

/// The time or what stands for it, in steps that can be read.
fn readings(out: &mut String, film: &Film<'_>, timing: &str) {
    let steps = (film.shot().seconds * READ.min(film.shot().rate)).round().max(1.0) as usize;
    let count = if film.count() == film.shot().steps { steps } else { steps + 1 };
    for (k, text) in film.shot().readings(steps).iter().take(count).enumerate() {
        flip(out, &[film.reading(text)], [k, count], timing);
    }
}

/// Items that are shown in the k-th of `count` even parts of the whole.
fn flip(out: &mut String, items: &[Item], [k, count]: [usize; 2], timing: &str) {
    let [from, to] = [k, k + 1].map(|k| short_time(k as f64 / count as f64));
    let (times, values) = match k {
        _ if count == 1 => ("0".into(), "inline"),
        0 => (format!("0;{to}"), "inline;none"),
        k if k + 1 == count => (format!("0;{from}"), "none;inline"),
        _ => (format!("0;{from};{to}"), "none;inline;none"),
    };
    let first = if k == 0 { "" } else { " display=\"none\"" };
    let _ = writeln!(
        out,
        "<g{first}><animate attributeName=\"display\" calcMode=\"discrete\" {timing} keyTimes=\"{times}\" values=\"{values}\"/>"
    );
    items.iter().for_each(|item| write_item(out, item, ""));
    out.push_str("</g>\n");
}

fn short_time(x: f64) -> String {
    format!("{x:.5}").trim_end_matches('0').trim_end_matches('.').to_string()
}

/// A path that is uncovered as it is drawn, and the point that draws it.
fn grow(out: &mut String, trail: &Trail, timing: &str) {
    let mut points: Vec<Point> = trail.points.iter().filter(|p| p.iter().all(|x| x.is_finite())).copied().collect();
    points.dedup();
    let Some(last) = points.last().copied() else { return };
    // pieces of the path that are passed in even times
    let pieces = (trail.points.len() - 1).clamp(1, 200);
    let at = |k: usize| trail.points[k * (trail.points.len() - 1) / pieces];
    let mut lengths = vec![0.0];
    let mut index = 0;
    for k in 1..=pieces {
        let end = k * (trail.points.len() - 1) / pieces;
        let way: f64 = trail.points[index..=end].windows(2).map(|p| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1])).sum();
        lengths.push(lengths[k - 1] + if way.is_finite() { way } else { 0.0 });
        index = end;
    }
    let whole = lengths[pieces];
    if whole > 1.0 {
        // the way that is still to be covered; the gap is longer than the path
        let values = list(&lengths, |length| short(whole - length));
        let path = Item::Path { points, closed: false, fill: None, stroke: Some(Stroke::solid(trail.color, PATH)) };
        let within = format!("<animate attributeName=\"stroke-dashoffset\" {timing} values=\"{values}\"/>");
        let mut element = String::new();
        write_item(&mut element, &path, &within);
        let dash = format!("<polyline stroke-dasharray=\"{0} {1}\" stroke-linecap=\"butt\"", short(whole), short(whole + 9.0));
        out.push_str(&element.replacen("<polyline", &dash, 1));
    }
    let tip = Item::Circle { at: last, radius: 4.5, fill: Some(trail.color), stroke: None };
    let places: Vec<Point> = (0..=pieces).map(at).filter(|p| p.iter().all(|x| x.is_finite())).collect();
    if let Some(first) = places.first() {
        let track = Track::Rigid { items: vec![with(&tip, vec![[0.0; 2]])], turns: vec![0.0], places: places.clone() };
        if places.iter().all(|p| (p[0] - first[0]).hypot(p[1] - first[1]) < 0.02) {
            write_item(out, &with(&tip, vec![*first]), "");
        } else {
            write_track(out, &track, timing);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_short() {
        assert_eq!((short_time(0.5), short_time(1.0), short_time(1.0 / 3.0)), ("0.5".into(), "1".into(), "0.33333".into()));
    }
}
