//! Drawings as they are laid out.

use super::*;
use crate::output::pose::{Link, Outline, Trace};

fn plate(points: Vec<[f64; 2]>) -> Vec<Form> {
    vec![Form::flat(FormKind::Plate { points }, 0.0)]
}

fn named(name: &str, poses: Vec<Vec<Form>>) -> Outline {
    Outline { name: name.into(), poses }
}

#[test]
fn odd_mechanisms_make_a_picture_all_the_same() {
    let nan = f64::NAN;
    let symbol =
        |at| Symbol { kind: SymbolKind::Slide, driven: true, poses: vec![Placement { at, ..Placement::default() }], ..Symbol::default() };
    for at in [[0.0, 0.0], [nan, 1.0], [1e300, 0.0]] {
        let round = Form::flat(FormKind::Disc { center: at, radius: nan, spoke: Some(at) }, nan);
        let body = named("b", vec![plate(vec![at]), vec![round], plate(vec![at, at, at])]);
        let trace = Trace { name: "p".into(), points: vec![at, [0.5, 0.5], [nan, nan]] };
        let link = Link { poses: vec![[at, [1.0, 0.0]]], turned: vec![[nan; 2]], kind: LinkKind::Torsion, ..Link::default() };
        let gear = crate::output::pose::Gear {
            circles: vec![vec![at; 3]],
            rims: Vec::new(),
            line: Some([at; 2]),
            mesh: Some(at),
            belt: vec![at; 3],
            rope: Some([at; 2]),
        };
        let (joints, gears) = (vec![symbol(at)], vec![gear]);
        let drawing = Drawing { bodies: vec![body], joints, traces: vec![trace], links: vec![link], gears, ..Drawing::default() };
        let svg = crate::output::svg::write_svg(&layout(&drawing));
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    }
    assert!(layout(&Drawing::default()).height > 0.0);
}

fn texts(drawing: &Drawing) -> Vec<String> {
    let items = layout(drawing).items.into_iter();
    items.filter_map(|item| if let crate::output::scene::Item::Text(text) = item { Some(text.text) } else { None }).collect()
}

#[test]
fn a_plate_that_is_hidden_in_its_middle_is_named_where_it_is_seen() {
    let corners = vec![[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let disc = |radius| Form::flat(FormKind::Disc { center: [0.0; 2], radius, spoke: None }, -0.1);
    let off = |radius: f64| {
        let plate = Form { depth: -1.0, ..plate(corners.clone()).remove(0) };
        let bodies = vec![Outline::default(), named("plate", vec![vec![plate]]), named("wheel", vec![vec![disc(radius)]])];
        let drawing = Drawing { bodies, ..Drawing::default() };
        let found = labels(&drawing);
        let at = |name: &str| found.iter().find(|label| label.text == name).expect("a name").at;
        let [plate, wheel] = ["plate", "wheel"].map(at);
        (plate[0] - wheel[0]).hypot(plate[1] - wheel[1]) / plan(&drawing).sheet.scale
    };
    let beside = off(0.45);
    assert!(beside > 0.45 && beside < 1.0, "{beside}");
    assert!(off(0.7) > 0.7, "{}", off(0.7));
}

#[test]
fn more_names_than_can_be_read_are_left_out() {
    let names = |count: u32| {
        let body = |k| named(&format!("rod {k}"), vec![plate(vec![[f64::from(k), 0.0], [f64::from(k), 1.0]])]);
        let drawing = Drawing { bodies: (0..=count).map(body).collect(), ..Drawing::default() };
        texts(&drawing).iter().filter(|text| text.starts_with("rod")).count()
    };
    assert_eq!((names(5), names(5000)), (5, 0));
}

#[test]
fn joints_at_one_place_have_one_label() {
    let symbol = |name: &str, at| Symbol { name: name.into(), poses: vec![Placement { at, ..Placement::default() }], ..Symbol::default() };
    let drawing = Drawing { joints: vec![symbol("A", [0.0; 2]), symbol("B", [1.0, 0.0]), symbol("C", [0.0; 2])], ..Drawing::default() };
    let texts = texts(&drawing);
    assert!(texts.contains(&"A, C".into()) && texts.contains(&"B".into()) && !texts.contains(&"C".into()), "{texts:?}");
}

#[test]
fn each_of_several_paths_has_its_name() {
    let trace = |name: &str, y: f64| Trace { name: name.into(), points: vec![[0.0, y], [1.0, y]] };
    let body = named("rod", vec![plate(vec![[0.0, 0.0], [1.0, 0.0]])]);
    let of = |traces| texts(&Drawing { bodies: vec![Outline::default(), body.clone()], traces, ..Drawing::default() });
    let one = of(vec![trace("rod", 1.0)]);
    assert_eq!(one.iter().filter(|text| text.contains("rod")).count(), 1, "{one:?}");
    let two = of(vec![trace("rod", 1.0), trace("rod.end", 2.0)]);
    assert!(["rod", "path of rod", "rod.end"].iter().all(|name| two.contains(&(*name).into())), "{two:?}");
}

#[test]
fn a_guide_has_the_colour_of_its_body() {
    let way = Placement { way: Some([[0.0, 0.0], [1.0, 0.0]]), along: [1.0, 0.0], ..Placement::default() };
    let edge = |way_body| Pen::looks(body_color(way_body), 1.0).edge;
    let drawn = |way_grounded| {
        let slide = Symbol { kind: SymbolKind::Slide, way_grounded, way_body: 2, poses: vec![way], ..Symbol::default() };
        let items = layout(&Drawing { joints: vec![slide], ..Drawing::default() }).items;
        items.iter().any(|item| matches!(item, Item::Path { stroke: Some(stroke), .. } if stroke.color == edge(2)))
    };
    assert!(drawn(false) && !drawn(true));
}

#[test]
fn paths_are_told_apart() {
    let all: Vec<_> = (0..30).map(path_stroke).collect();
    assert!((0..30).all(|i| !all[..i].contains(&all[i])));
    let arrows = [crate::output::pose::ForceKind::Load, crate::output::pose::ForceKind::Reaction].map(forces::color);
    assert!(all.iter().all(|(color, _)| !arrows.contains(color)));
}

#[test]
fn both_axes_have_one_scale() {
    let square = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let drawing = Drawing { bodies: vec![named("", vec![plate(square)])], ..Drawing::default() };
    let scene = layout(&drawing);
    let crate::output::scene::Item::Path { points, .. } = &scene.items[0] else { panic!("a body first") };
    let (width, height) = (points[1][0] - points[0][0], points[2][1] - points[1][1]);
    assert!((width.abs() - height.abs()).abs() < 1e-9, "{points:?}");
}

#[test]
fn gears_that_stay_in_their_place_are_not_seen_in_pale_positions() {
    let gear = |x: f64| {
        let kind =
            FormKind::Gear { center: [x, 0.0], radius: 0.1, teeth: 20, outline: vec![[x, 0.1]; 3], spoke: Some([x, 0.0]), rim: None };
        Form::flat(kind, 0.0)
    };
    assert!(gear(0.0).as_ghost(Some(&gear(0.0))).is_none());
    // one that travels is seen as a disc, without the teeth that would fill the gaps of others
    let ghost = gear(0.5).as_ghost(Some(&gear(0.0))).expect("a wheel elsewhere");
    assert!(matches!(ghost.kind, FormKind::Disc { center: [0.5, 0.0], .. }), "{ghost:?}");
}

/// Where the bearing of a hinge lies among the items, and where the body at that place.
fn bearing_and_body(at: [f64; 2], axes: Option<[[f64; 2]; 3]>) -> [usize; 2] {
    let square = vec![[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let body = named("", vec![vec![Form::flat(FormKind::Area { points: square, shade: 1.0 }, -1.0)]]);
    let hinge = Symbol { grounded: true, bodies: [0, 1], poses: vec![Placement { at, ..Placement::default() }], ..Symbol::default() };
    let drawing = Drawing { bodies: vec![Outline::default(), body], joints: vec![hinge], axes, ..Drawing::default() };
    let items = layout(&drawing).items;
    let filled = |corners: usize| {
        let found =
            items.iter().position(|item| matches!(item, Item::Path { points, fill: Some(_), closed: true, .. } if points.len() == corners));
        found.expect("a shape")
    };
    [filled(3), filled(4)]
}

#[test]
fn a_bearing_that_its_body_would_hide_stands_before_it() {
    let axes = Some([[1.0, 0.0], [0.0, 1.0], [0.3, 0.3]]);
    for (at, axes, before) in [([0.2, 0.1], axes, true), ([1.5, 0.0], axes, false), ([0.2, 0.1], None, true)] {
        let [bearing, body] = bearing_and_body(at, axes);
        assert_eq!(bearing > body, before, "{at:?} {axes:?}: {bearing} {body}");
    }
}

#[test]
fn of_two_equal_plates_the_lower_is_named_beside_the_upper() {
    let square = |x: f64| plate(vec![[x - 1.0, -1.0], [x + 1.0, -1.0], [x + 1.0, 1.0], [x - 1.0, 1.0]]);
    let bodies = vec![Outline::default(), named("left", vec![square(0.0)]), named("right", vec![square(0.7)])];
    let drawing = Drawing { bodies, ..Drawing::default() };
    let found = labels(&drawing);
    let left = found.iter().find(|label| label.text == "left").expect("a name").at;
    let edge = plan(&drawing).sheet.point([-0.3, 0.0]);
    assert!(left[0] < edge[0], "{found:?}, {edge:?}");
}

#[test]
fn a_path_called_like_one_of_several_joints_at_a_place_is_said_to_be_a_path() {
    let symbol = |name: &str| Symbol { name: name.into(), poses: vec![Placement::default()], ..Symbol::default() };
    let traces = vec![Trace { name: "Z".into(), points: vec![[0.0, 1.0], [1.0, 1.0]] }, Trace { name: "p".into(), points: vec![[0.0; 2]] }];
    let drawing = Drawing { joints: vec![symbol("X"), symbol("Z")], traces, ..Drawing::default() };
    let texts = texts(&drawing);
    assert!(texts.contains(&"X, Z".into()) && texts.contains(&"path of Z".into()), "{texts:?}");
}

#[test]
fn a_box_is_drawn_where_no_shape_of_the_body_shows_that_it_slides() {
    let boxes = |boxed: bool, clear: f64| {
        let way = Placement { way: Some([[0.0, 0.0], [1.0, 0.0]]), along: [1.0, 0.0], clear, ..Placement::default() };
        let slide = Symbol { kind: SymbolKind::Slide, boxed, poses: vec![way], ..Symbol::default() };
        layout(&Drawing { joints: vec![slide], ..Drawing::default() }).items.len()
    };
    assert!(boxes(false, 0.0) > boxes(false, 0.1) && boxes(true, 0.1) > boxes(false, 0.1));
}

/// The lines of a joint alone, each by its points and whether it is filled.
fn lines_of(symbol: Symbol) -> Vec<(Vec<Point>, bool)> {
    let items = layout(&Drawing { joints: vec![symbol], ..Drawing::default() }).items;
    let of = |item: Item| if let Item::Path { points, fill, .. } = item { Some((points, fill.is_some())) } else { None };
    items.into_iter().filter_map(of).collect()
}

#[test]
fn a_plane_is_drawn_across_its_normal_and_a_ring_about_the_axis_that_a_slide_turns_about() {
    let placement = Placement { along: [0.0, 1.0], across: [[1.0, 0.0], [0.0, 0.4]], ..Placement::default() };
    let plane =
        lines_of(Symbol { kind: SymbolKind::Plane, way_grounded: true, grounded: true, poses: vec![placement], ..Symbol::default() });
    // one piece, as wide as the direction across is long, and neither a way along its normal nor a bearing
    let [(corners, true)] = &plane[..1] else { panic!("{plane:?}") };
    let reach = |axis: usize| {
        corners.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max) - corners.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min)
    };
    assert!(corners.len() == 4 && (reach(1) / reach(0) - 0.4).abs() < 1e-9, "{corners:?}");
    let slide = |rings| lines_of(Symbol { kind: SymbolKind::Slide, rings, boxed: true, poses: vec![placement], ..Symbol::default() }).len();
    assert_eq!(slide(true), slide(false) + 1);
}

#[test]
fn a_slide_that_areas_hide_is_shown_by_the_outline_of_its_box() {
    let placement = Placement { along: [1.0, 0.0], clear: 0.1, ..Placement::default() };
    let of = |hidden| lines_of(Symbol { kind: SymbolKind::Slide, hidden, way_body: 1, poses: vec![placement], ..Symbol::default() });
    let (with, without) = (of(true), of(false));
    assert_eq!(with.len(), without.len() + 2);
    let outline = with.iter().find(|(points, filled)| points.len() == 4 && !filled).expect("an outline");
    assert!(!without.contains(outline));
}

#[test]
fn a_guide_on_the_ground_stands_before_wheels_and_behind_bars() {
    let way = Placement { way: Some([[0.0, -0.5], [0.0, 0.5]]), along: [0.0, 1.0], ..Placement::default() };
    let slide = Symbol { kind: SymbolKind::Slide, way_grounded: true, boxed: true, poses: vec![way], ..Symbol::default() };
    let disc = Form::flat(FormKind::Disc { center: [0.0; 2], radius: 1.0, spoke: None }, -3.0);
    let bar = Form::flat(FormKind::Bar { from: [-1.0, 0.0], to: [1.0, 0.0], width: Width::Given(0.1) }, 0.0);
    let bodies = vec![Outline::default(), named("wheel", vec![vec![disc]]), named("rod", vec![vec![bar]])];
    let items = layout(&Drawing { bodies, joints: vec![slide], ..Drawing::default() }).items;
    let wheel = items.iter().position(|item| matches!(item, Item::Circle { radius, .. } if *radius > 100.0)).expect("the wheel");
    let wide = |points: &[Point]| points.iter().any(|p| points.iter().any(|q| (p[0] - q[0]).abs() > 300.0));
    let rod = items.iter().rposition(|item| matches!(item, Item::Path { points, fill: Some(_), .. } if wide(points))).expect("the rod");
    assert!(wheel < rod, "{wheel} {rod}");
    // the wall with its hatching, and the box
    let guide = items[wheel..rod].iter().filter(|item| matches!(item, Item::Path { .. })).count();
    assert!(guide > 5, "{guide}");
}
