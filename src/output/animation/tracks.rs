//! The items of a display list over a motion: what rests, what moves as a rigid whole, what changes its form.

use crate::output::scene::Item;
use crate::output::thin::Point;

/// Differences that are not seen, pixels.
const RESTS: f64 = 0.02;
const RIGID: f64 = 0.06;

/// A part of the display list over all pictures.
#[derive(Clone, Debug)]
pub(super) enum Track {
    /// It is always the same.
    Rest(Vec<Item>),
    /// It moves as a whole: items about their origin, whose place, pixels, and turn, degrees, are given for each picture.
    Rigid { items: Vec<Item>, places: Vec<Point>, turns: Vec<f64> },
    /// Its points move apart: an item as in the first picture, and its points in each.
    Form { item: Item, points: Vec<Vec<Point>> },
}

/// The tracks of display lists, in the order of their items; none if the lists differ by more than places.
pub(super) fn tracks(pictures: &[Vec<Item>]) -> Option<Vec<Track>> {
    let first = pictures.first()?;
    if !pictures.iter().all(|picture| picture.len() == first.len() && picture.iter().zip(first).all(|(a, b)| alike(a, b))) {
        return None;
    }
    let mut tracks: Vec<Track> = Vec::new();
    for index in 0..first.len() {
        let item = &first[index];
        let points: Vec<Vec<Point>> = pictures.iter().map(|picture| places(&picture[index])).collect();
        if points.iter().all(|now| apart(now, &points[0]) < RESTS) {
            match tracks.last_mut() {
                Some(Track::Rest(items)) => items.push(item.clone()),
                _ => tracks.push(Track::Rest(vec![item.clone()])),
            }
        } else if !joins(tracks.last_mut(), item, &points) {
            tracks.push(match motion(&points) {
                Some((places, turns)) => {
                    let own = points[0].iter().map(|p| [p[0] - places[0][0], p[1] - places[0][1]]).collect();
                    Track::Rigid { items: vec![with(item, own)], places, turns }
                }
                None => Track::Form { item: item.clone(), points },
            });
        }
    }
    Some(tracks)
}

/// Whether two items differ by their places alone.
fn alike(a: &Item, b: &Item) -> bool {
    let (p, q) = (places(a), places(b));
    p.len() == q.len() && with(a, q) == *b
}

fn places(item: &Item) -> Vec<Point> {
    match item {
        Item::Path { points, .. } | Item::Veil { points, .. } => points.clone(),
        Item::Circle { at, .. } => vec![*at],
        Item::Text(text) => vec![text.at],
    }
}

/// The item at other places.
pub(super) fn with(item: &Item, places: Vec<Point>) -> Item {
    let mut item = item.clone();
    match (&mut item, places.first()) {
        (Item::Path { points, .. } | Item::Veil { points, .. }, _) => *points = places,
        (Item::Circle { at, .. }, Some(place)) => *at = *place,
        (Item::Text(text), Some(place)) => text.at = *place,
        _ => {}
    }
    item
}

fn apart(a: &[Point], b: &[Point]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).fold(0.0, f64::max)
}

/// Puts an item to what moves as a whole, if it goes with it.
fn joins(track: Option<&mut Track>, item: &Item, points: &[Vec<Point>]) -> bool {
    let Some(Track::Rigid { items, places, turns }) = track else { return false };
    let own: Vec<Point> = points[0].iter().map(|p| [p[0] - places[0][0], p[1] - places[0][1]]).collect();
    let goes =
        points.iter().zip(places.iter().zip(turns.iter())).all(|(now, (place, turn))| apart(now, &moved(&own, *place, *turn)) < RIGID);
    if goes {
        items.push(with(item, own));
    }
    goes
}

/// Points about their origin at a place and a turn, degrees.
fn moved(own: &[Point], place: Point, turn: f64) -> Vec<Point> {
    let (s, c) = turn.to_radians().sin_cos();
    own.iter().map(|[x, y]| [place[0] + c * x - s * y, place[1] + s * x + c * y]).collect()
}

/// Place of the middle of points and their turn since the first picture, in each; none if they do not move as a whole.
fn motion(points: &[Vec<Point>]) -> Option<(Vec<Point>, Vec<f64>)> {
    let first = &points[0];
    let middle = |now: &[Point]| {
        let count = now.len() as f64;
        now.iter().fold([0.0; 2], |sum, p| [sum[0] + p[0] / count, sum[1] + p[1] / count])
    };
    let center = middle(first);
    let far = |k: &usize| (first[*k][0] - center[0]).hypot(first[*k][1] - center[1]);
    let hand = (0..first.len()).max_by(|a, b| far(a).total_cmp(&far(b)))?;
    let turned = |now: &[Point], at: Point| (now[hand][1] - at[1]).atan2(now[hand][0] - at[0]).to_degrees();
    let places: Vec<Point> = points.iter().map(|now| middle(now)).collect();
    let mut turns = vec![0.0; points.len()];
    if far(&hand) > RIGID {
        let begun = turned(first, center);
        for k in 1..points.len() {
            let turn = turned(&points[k], places[k]) - begun;
            turns[k] = turn - 360.0 * ((turn - turns[k - 1]) / 360.0).round();
        }
    }
    let own: Vec<Point> = first.iter().map(|p| [p[0] - center[0], p[1] - center[1]]).collect();
    let rigid = points.iter().zip(places.iter().zip(&turns)).all(|(now, (place, turn))| apart(now, &moved(&own, *place, *turn)) < RIGID);
    rigid.then_some((places, turns))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::scene::Stroke;

    fn bar(points: Vec<Point>) -> Item {
        Item::Path { points, closed: false, fill: None, stroke: Some(Stroke::solid([0; 3], 2.0)) }
    }

    fn pin(at: Point) -> Item {
        Item::Circle { at, radius: 3.0, fill: Some([9; 3]), stroke: None }
    }

    /// A crank that makes a turn, with its pin, ground, and a spring from there.
    fn picture(turn: f64) -> Vec<Item> {
        let (s, c) = turn.to_radians().sin_cos();
        let end = [50.0 + 30.0 * c, 50.0 + 30.0 * s];
        vec![pin([50.0; 2]), bar(vec![[50.0; 2], end]), pin(end), bar(vec![[10.0, 10.0], end])]
    }

    #[test]
    fn what_moves_together_is_one_track() {
        let pictures: Vec<_> = (0..=8).map(|k| picture(f64::from(k) * 45.0)).collect();
        let tracks = tracks(&pictures).unwrap();
        let [Track::Rest(still), Track::Rigid { items, turns, .. }, Track::Form { points, .. }] = &tracks[..] else { panic!("{tracks:?}") };
        assert_eq!((still.len(), items.len(), points.len()), (1, 2, 9));
        assert!((turns[8] - 360.0).abs() < 1e-9, "{turns:?}");
    }

    #[test]
    fn other_items_are_no_track() {
        let mut other = picture(10.0);
        other.pop();
        assert!(tracks(&[picture(0.0), other]).is_none());
    }
}
