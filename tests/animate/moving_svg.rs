//! SVG that moves: where its parts are at a time, as a browser has them.

use super::{PENDULUM, Place, SLIDER_CRANK, shot};
use grashof::output::Pace;
use grashof::results::Scene;
use grashof::results::scene::Place as On;
use roxmltree::{Document, Node};

/// The value of an animation at a part of its duration: lists of numbers with `;` between them, even in time.
fn value(animation: Node<'_, '_>, part: f64) -> Vec<f64> {
    let values: Vec<Vec<f64>> = animation
        .attribute("values")
        .unwrap()
        .split(';')
        .map(|list| list.split([' ', ',']).map(|x| x.parse().unwrap()).collect())
        .collect();
    let at = part * (values.len() - 1) as f64;
    let k = (at as usize).min(values.len() - 2);
    values[k].iter().zip(&values[k + 1]).map(|(a, b)| a + (at - k as f64) * (b - a)).collect()
}

/// Middles of all circles at a part of the duration, pixels.
fn circles(document: &Document<'_>, part: f64) -> Vec<[f64; 2]> {
    let number = |node: &Node<'_, '_>, name: &str| node.attribute(name).unwrap().parse::<f64>().unwrap();
    let circles = document.descendants().filter(|node| node.has_tag_name("circle"));
    circles
        .map(|circle| {
            let (x, y) = (number(&circle, "cx"), number(&circle, "cy"));
            let group = circle.parent().filter(|parent| parent.has_tag_name("g"));
            let Some(group) = group else { return [x, y] };
            let of = |kind: &str| group.children().find(|node| node.attribute("type") == Some(kind)).map(|node| value(node, part));
            let (place, turn) = (of("translate").unwrap(), of("rotate").map_or(0.0, |turn| turn[0]));
            let (s, c) = turn.to_radians().sin_cos();
            [place[0] + c * x - s * y, place[1] + s * x + c * y]
        })
        .collect()
}

fn world(scene: &Scene, poses: &[f64], place: &On) -> [f64; 2] {
    let [x, y, _] = scene.world(poses, place);
    [x, y]
}

/// How far circles are from where the joints are at most, pixels; the scale is that of two joints in the first picture.
#[test]
fn joints_are_where_they_are_at_any_time() {
    let place = Place::new("svg", SLIDER_CRANK);
    let text = String::from_utf8(place.made("animate --study turn --rate 20 --duration 4 -o out.svg", "out.svg")).unwrap();
    let document = Document::parse(&text).unwrap();
    let (scene, shot) = shot(SLIDER_CRANK, "turn", Pace::Duration(4.0), 20.0, true);
    let poses = |k: usize| scene.frames.at(shot.at[k], 2);
    let pins: Vec<&On> = scene.joints.iter().filter(|joint| joint.kind == "revolute").map(|joint| &joint.a).collect();
    // scale and origin by the hinge that rests, and the crank's length as it is drawn
    let rests = circles(&document, 0.0).into_iter().find(|at| circles(&document, 0.3).contains(at)).unwrap();
    let ground = world(&scene, &poses(0), pins[0]);
    let scales = circles(&document, 0.0).into_iter().map(|at| (at[0] - rests[0]).hypot(at[1] - rests[1]) / 0.3).filter(|s| *s > 1.0);
    let fits = |scale: f64, k: usize| {
        let drawn = circles(&document, k as f64 / 80.0);
        let far = |pin: &&On| {
            let [x, y] = world(&scene, &poses(k), pin);
            let at = [rests[0] + scale * (x - ground[0]), rests[1] - scale * (y - ground[1])];
            drawn.iter().map(|c| (c[0] - at[0]).hypot(c[1] - at[1])).fold(f64::INFINITY, f64::min)
        };
        pins.iter().map(far).fold(0.0, f64::max)
    };
    let scale = scales.min_by(|a, b| fits(*a, 0).total_cmp(&fits(*b, 0))).unwrap();
    for k in [0, 1, 7, 20, 33, 61, 79] {
        assert!(fits(scale, k) < 0.2, "{} px off in picture {k}", fits(scale, k));
    }
    assert!(text.len() < 100_000, "{} bytes", text.len());
}

#[test]
fn a_turn_that_repeats_comes_back() {
    let place = Place::new("closed", SLIDER_CRANK);
    let text = String::from_utf8(place.made("animate --study turn --duration 3 -o out.svg", "out.svg")).unwrap();
    let document = Document::parse(&text).unwrap();
    let moved = document.descendants().filter(|node| node.has_tag_name("animateTransform"));
    let mut turned: f64 = 0.0;
    for animation in moved {
        assert_eq!((animation.attribute("dur"), animation.attribute("repeatCount")), (Some("3.000s"), Some("indefinite")));
        let [first, last] = [value(animation, 0.0), value(animation, 1.0)];
        let whole = if animation.attribute("type") == Some("rotate") { 360.0 } else { f64::INFINITY };
        turned = turned.max(if whole.is_finite() { (last[0] - first[0]).abs() } else { 0.0 });
        let gap = first.iter().zip(&last).map(|(a, b)| (b - a).abs() % whole).fold(0.0, f64::max);
        assert!(gap < 0.05 || whole - gap < 0.05, "{first:?} {last:?}");
    }
    assert!((turned - 360.0).abs() < 0.05, "the crank turns by {turned}");
}

#[test]
fn what_is_shown_once_stays_at_its_end() {
    let place = Place::new("freeze", PENDULUM);
    let text = String::from_utf8(place.made("animate --study swing --once -o out.svg", "out.svg")).unwrap();
    assert!(text.contains("fill=\"freeze\"") && !text.contains("indefinite"));
}

#[test]
fn solids_are_a_flip_book() {
    let text = fs_model("four_bar_spatial.yaml");
    let place = Place::new("flips", &text);
    let svg = String::from_utf8(place.made("animate --duration 2 --view 30,20 -o out.svg", "out.svg")).unwrap();
    let document = Document::parse(&svg).unwrap();
    let moving = document.descendants().filter(|node| node.attribute("attributeName").is_some()).count();
    assert!(moving > 3, "{moving} animations");
}

fn fs_model(name: &str) -> String {
    std::fs::read_to_string(std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("models").join(name)).unwrap()
}

/// The arrow of a load is there at all times, as long as its force, and turns over with it.
#[test]
fn forces_move_with_the_mechanism() {
    let text = SLIDER_CRANK.replace("drivers:", "loads: { push: { at: rod.P, force: [0, 5 N*cos(O.angle)] } }\ndrivers:").replace(
        "kinematics: { over: 1 turn, samples: 97 }, columns: [time, rod.P]",
        "inverse: { over: 1 turn, samples: 97 }, columns: [time], show: { loads: 10 N/m }",
    );
    let place = Place::new("forces", &text);
    let svg = String::from_utf8(place.made("animate --study turn --rate 20 --duration 4 -o out.svg", "out.svg")).unwrap();
    let document = Document::parse(&svg).unwrap();
    let moving =
        |node: &Node<'_, '_>| node.attribute("fill") == Some("#d55e00") && node.children().any(|child| child.has_tag_name("animate"));
    let arrow = document.descendants().find(|node| node.has_tag_name("polygon") && moving(node)).unwrap();
    let animation = arrow.children().find(|child| child.has_tag_name("animate")).unwrap();
    let way = |part: f64| {
        let points = value(animation, part);
        assert_eq!(points.len(), 14);
        [points[6] - 0.5 * (points[0] + points[12]), points[7] - 0.5 * (points[1] + points[13])]
    };
    let first = way(0.0);
    assert!(first[0].abs() < 0.1 && first[1] < -20.0, "{first:?}");
    for part in [0.25_f64, 0.5, 0.75, 1.0] {
        let force = (20f64.to_radians() - std::f64::consts::TAU * part).cos() / 20f64.to_radians().cos();
        let [x, y] = way(part);
        assert!(x.abs() < 0.1 && (y - force * first[1]).abs() < 0.02 * first[1].abs(), "{part}: {x} {y}, {force}");
    }
}
