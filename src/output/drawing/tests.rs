//! Drawings as they are laid out.

use super::*;
use crate::output::pose::{Form, Link, Outline, Trace};

fn plate(points: Vec<[f64; 2]>) -> Vec<Form> {
    vec![Form { kind: FormKind::Plate { points }, depth: 0.0 }]
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
        let round = Form { kind: FormKind::Disc { center: at, radius: nan, spoke: Some(at) }, depth: nan };
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
    let disc = |radius| Form { kind: FormKind::Disc { center: [0.0; 2], radius, spoke: None }, depth: -0.1 };
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
        Form { kind, depth: 0.0 }
    };
    assert!(gear(0.0).as_ghost(Some(&gear(0.0))).is_none());
    // one that travels is seen as a disc, without the teeth that would fill the gaps of others
    let ghost = gear(0.5).as_ghost(Some(&gear(0.0))).expect("a wheel elsewhere");
    assert!(matches!(ghost.kind, FormKind::Disc { center: [0.5, 0.0], .. }), "{ghost:?}");
}
