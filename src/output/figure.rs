//! Figures: curves over a common axis, laid out as one panel for each unit.

use super::legend::{self, Entry, Legend};
use super::panel::{Line, Panel, Ruler};
use super::picture::Picture;
use super::plot::{Curve, Figure, Scale};
use super::raster::RenderError;
use super::scene::{Rect, Scene};
use super::{font, poles, thin};

const WIDTH: f64 = 1000.0;
const HEIGHT: f64 = 640.0;
/// What a further panel adds.
const PANEL: f64 = 260.0;
/// Letters of the names of curves for which an axis has room, alone and as one of several.
const LETTERS_OF_AXIS: usize = 36;
const LETTERS_OF_PANEL: usize = 22;

/// Draws `figure` as SVG and PNG, 1000 by 640 pixels and 260 more for each further panel.
///
/// # Errors
/// None that data could cause: curves without values give a picture that says so.
pub fn render_figure(figure: &Figure) -> Result<Picture, RenderError> {
    Picture::of(&layout(figure))
}

/// The indices of the curves of each panel, and the panel's unit.
fn panels(figure: &Figure) -> Vec<(String, Vec<usize>)> {
    let mut groups: Vec<(String, Vec<usize>)> = Vec::new();
    for (index, curve) in figure.curves.iter().enumerate().filter(|(_, curve)| !curve.right) {
        let unit = curve.unit.as_ref().unwrap_or(&figure.y.unit);
        match groups.iter_mut().find(|(known, _)| known == unit) {
            Some((_, indices)) => indices.push(index),
            None => groups.push((unit.clone(), vec![index])),
        }
    }
    // those over the axis on the right stand in the first panel
    let right = figure.curves.iter().enumerate().filter(|(_, curve)| curve.right).map(|(index, _)| index);
    if let Some((_, first)) = groups.first_mut() {
        first.extend(right);
    }
    if groups.is_empty() {
        groups.push((figure.y.unit.clone(), Vec::new()));
    }
    groups
}

fn layout(figure: &Figure) -> Scene {
    let groups = panels(figure);
    let height = HEIGHT + PANEL * (groups.len() - 1) as f64;
    let mut scene = Scene { width: WIDTH, height, title: figure.title.clone(), items: Vec::new() };
    let top = if figure.title.is_empty() { 22.0 } else { 58.0 };
    if !figure.title.is_empty() {
        scene.headline(&figure.title);
    }

    let all = |axis: fn(&(f64, f64)) -> f64| figure.curves.iter().flat_map(move |curve| curve.points.iter().map(axis));
    let ordered = figure.curves.iter().all(|curve| thin::is_ordered(&curve.points));
    let mut x = Ruler::over(all(|point| point.0), &figure.x, &figure.x.unit, figure.equal);
    // on a logarithmic axis the ends are results like all others, and their dots must not be cut
    x.pad(if ordered && figure.x.scale == Scale::Linear { 0.0 } else { 0.05 });
    x.limit(figure.x.range);

    let mut drawn: Vec<Panel> = groups.iter().map(|(unit, indices)| panel(figure, unit, indices)).collect();
    if let (true, [only]) = (figure.equal, drawn.as_mut_slice()) {
        Ruler::share(&mut x, &mut only.y);
    }

    // First with every legend inside; one that would hide a curve goes outside, and the panels are laid out anew.
    for pass in 0..2 {
        place(&mut drawn, &mut x, top, height, figure.equal);
        if pass == 0 {
            for panel in &mut drawn {
                let pixels = panel.pixels(&x, &figure.breaks);
                panel.legend = legend::choose(std::mem::take(&mut panel.entries), panel.rect, &pixels);
            }
            if drawn.iter().all(|panel| panel.legend.is_inside()) {
                break;
            }
        }
    }
    let last = drawn.len() - 1;
    for (index, panel) in drawn.iter().enumerate() {
        panel.draw(&mut scene, &x, &figure.breaks, index == last);
    }
    scene
}

/// The panel of the curves `indices`, not yet placed.
fn panel(figure: &Figure, unit: &str, indices: &[usize]) -> Panel {
    let curves = || indices.iter().map(|index| &figure.curves[*index]);
    let within =
        |point: &&(f64, f64)| figure.x.range[0].is_none_or(|low| point.0 >= low) && figure.x.range[1].is_none_or(|high| point.0 <= high);
    let bounds = [false, true].map(|right| poles::bounded(curves().filter(|curve| curve.right == right)));
    let values_of = |right: bool| {
        let [low, high] = bounds[usize::from(right)].unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        let points = curves().filter(move |curve| curve.right == right).flat_map(move |curve| curve.points.iter().filter(within));
        // the axis ends within what grows without bound
        points.map(move |point| point.1.max(low).min(high))
    };
    let mut axis = figure.y.clone();
    let names: Vec<_> = curves().filter(|curve| !curve.right).map(|curve| curve.label.as_str()).filter(|label| !label.is_empty()).collect();
    if axis.label.is_empty() || indices.len() < figure.curves.len() {
        // The names are in the legend anyway: on the axis they stand only if they are few.
        let joined = names.join(", ");
        let mut quantities = curves().filter(|curve| !curve.right).map(|curve| &curve.quantity);
        let quantity = quantities.next().filter(|first| quantities.all(|other| other == *first)).cloned();
        let most = if indices.len() < figure.curves.len() { LETTERS_OF_PANEL } else { LETTERS_OF_AXIS };
        axis.label = if names.len() <= 3 && joined.chars().count() <= most { joined } else { quantity.unwrap_or_default() };
    }
    if let Some((_, quantity)) = figure.quantities.iter().find(|(known, _)| known == unit) {
        axis.label.clone_from(quantity);
    }
    let mut y = Ruler::over(values_of(false), &axis, unit, figure.equal);
    y.pad(0.06);
    let range = figure.ranges.iter().find(|(of, _)| of == unit).map(|(_, range)| *range);
    if let Some(range) = range {
        y.limit(range);
    }
    let mut right = figure.right.as_ref().filter(|_| curves().any(|curve| curve.right)).map(|axis| {
        let mut axis = axis.clone();
        if axis.label.is_empty() {
            axis.label = curves().filter(|curve| curve.right).map(|curve| curve.label.as_str()).collect::<Vec<_>>().join(", ");
        }
        let mut ruler = Ruler::over(values_of(true), &axis, &axis.unit, false);
        ruler.pad(0.06);
        ruler.limit(axis.range);
        ruler
    });
    if let (Some(right), None, Some([None, None])) = (&mut right, range, figure.right.as_ref().map(|axis| axis.range)) {
        Ruler::level(&mut y, right);
    }
    let styles = figure.styles();
    let line = |&index: &usize| {
        let (color, dash) = styles[index];
        let Curve { points, right, dots, .. } = figure.curves[index].clone();
        Line { ordered: thin::is_ordered(&points), points, color, dash, right, dots }
    };
    let lines: Vec<_> = indices.iter().map(line).collect();
    let entries = lines.iter().zip(curves()).map(|(line, curve)| {
        let side = if line.right { " (right)" } else { "" };
        Entry { label: curve.label.clone() + side, color: line.color, dash: line.dash, dots: line.dots }
    });
    // One curve whose name the axis has needs no legend.
    let alone = names.len() == 1 && right.is_none() && lines.len() == 1 && (axis.label == names[0] || figure.curves.len() == 1);
    let entries = if alone || names.is_empty() { Vec::new() } else { entries.collect() };
    let marks = figure.marks.iter().filter(|mark| indices.contains(&mark.curve)).cloned().collect();
    Panel {
        rect: Rect { left: 0.0, top: 0.0, right: WIDTH, bottom: HEIGHT },
        y,
        right,
        lines,
        entries,
        legend: Legend::Inside(Vec::new(), [0.0; 2]),
        marks,
        clipped: bounds.map(|bounds| bounds.is_some()),
        dead: curves().any(|curve| curve.poles.contains(&true)),
        label: 0.0,
        side: 0.0,
    }
}

/// Gives each panel its rectangle and the axes their marks.
fn place(panels: &mut [Panel], x: &mut Ruler, top: f64, height: f64, equal: bool) {
    let count = panels.len() as f64;
    let (gap, bottom) = (28.0, height - 84.0);
    let each = (bottom - top - gap * (count - 1.0)) / count;
    for (index, panel) in panels.iter_mut().enumerate() {
        let above = top + index as f64 * (each + gap);
        let legend = panel.legend.height(WIDTH - 160.0);
        panel.rect.top = above + legend;
        panel.rect.bottom = above + each;
        panel.y.mark(panel.rect.height(), 62.0, |_| 30.0);
        if let Some(right) = &mut panel.right {
            right.mark(panel.rect.height(), 62.0, |_| 30.0);
        }
    }
    let widest = panels.iter().map(|panel| panel.y.widest()).fold(20.0, f64::max);
    let beside = panels.iter().map(|panel| panel.legend.width()).fold(0.0, f64::max);
    // the numbers and the name of an axis on the right
    let side = panels.iter().filter_map(|panel| panel.right.as_ref()).map(|right| right.widest() + 52.0).fold(0.0, f64::max);
    let beside = beside + side;
    let left = 62.0 + widest;
    let mark = |x: &mut Ruler, right: f64| x.mark(right - left, 96.0, |label| font::width(label, super::panel::TICK) + 26.0);
    // Half of the last label of x may stand out on the right.
    mark(x, WIDTH - 34.0 - beside);
    let right = WIDTH - (x.widest() / 2.0 + 10.0).max(if beside > 0.0 { 8.0 + beside } else { 34.0 });
    for panel in panels.iter_mut() {
        (panel.rect.left, panel.rect.right, panel.label) = (left, right, left - widest - 26.0);
        panel.side = side;
    }
    if let (true, [only]) = (equal, &mut *panels) {
        Ruler::equalize(x, &mut only.y, only.rect);
        only.y.mark(only.rect.height(), 62.0, |_| 30.0);
        // equal scales may ask for longer numbers than before: the label gives way to the left
        only.label = (left - only.y.widest() - 26.0).max(18.0);
    }
    mark(x, right);
}

#[cfg(test)]
mod tests {
    use super::super::plot::Axis;
    use super::*;

    fn curve(label: &str, unit: Option<&str>, points: Vec<(f64, f64)>) -> Curve {
        Curve { label: label.into(), unit: unit.map(Into::into), points, ..Curve::default() }
    }

    fn svg(figure: &Figure) -> String {
        super::super::svg::write_svg(&layout(figure))
    }

    fn axis(label: &str, unit: &str) -> Axis {
        Axis { label: label.into(), unit: unit.into(), ..Axis::default() }
    }

    /// The polylines of curves, not of the grid: those of the curves' stroke width.
    fn lines(svg: &str) -> Vec<&str> {
        svg.lines().filter(|line| line.starts_with("<polyline") && line.contains("stroke-width=\"3\"")).collect()
    }

    #[test]
    fn a_jump_is_not_joined() {
        let points = vec![(0.0, 1.0), (1.0, 2.0), (1.0, -2.0), (2.0, -1.0)];
        let figure = Figure {
            x: axis("theta", "deg"),
            y: axis("torque", "N m"),
            curves: vec![curve("torque", None, points)],
            breaks: vec![1.0],
            ..Figure::default()
        };
        let svg = svg(&figure);
        assert_eq!(lines(&svg).len(), 2);
        assert!(svg.contains(">theta in deg<") && svg.contains(">torque in N m<") && svg.contains(">dashed: switches<"));
    }

    #[test]
    fn a_curve_alone_in_its_panel_is_named() {
        let points = || (0..50).map(|k| (f64::from(k), f64::from(k).sin())).collect::<Vec<_>>();
        let of = |label: &str| {
            let speed = Curve { quantity: "angular speed".into(), ..curve(label, Some("rad/s"), points()) };
            let figure = Figure { curves: vec![curve("a.angle", Some("rad"), points()), speed], ..Figure::default() };
            svg(&figure).matches(&format!(">{label}")).count()
        };
        assert_eq!([of("a.omega"), of("output_rocker_with_a_long_name.omega")], [1, 1]);
    }

    #[test]
    fn zeros_of_two_axes_are_level() {
        let wave = |size: f64, shift: f64| (0..50).map(|k| (f64::from(k), size * (f64::from(k).sin() + shift))).collect::<Vec<_>>();
        let right = Curve { right: true, ..curve("power", Some("W"), wave(80.0, -0.5)) };
        let curves = vec![curve("torque", Some("N m"), wave(3.0, 0.4)), right];
        let figure = |low: Option<f64>| Figure {
            curves: curves.clone(),
            right: Some(Axis { range: [low, None], ..axis("power", "W") }),
            ..Figure::default()
        };
        let part = |ruler: &Ruler| ruler.place(0.0);
        let parts = |figure: &Figure| {
            let panel = panel(figure, "N m", &[0, 1]);
            [part(&panel.y), part(&panel.right.expect("an axis on the right"))]
        };
        let [left, right] = parts(&figure(None));
        assert!((left - right).abs() < 1e-12 && left > 0.2 && left < 0.8, "{left} {right}");
        // ends that are given stay
        let [left, right] = parts(&figure(Some(-120.0)));
        assert!((left - right).abs() > 0.1, "{left} {right}");
    }

    #[test]
    fn a_curve_of_few_values_leaves_the_axis_towards_a_dead_point_by_an_arrow() {
        let at = |k: i32| if k == 0 { (0.0, f64::NAN) } else { (0.4 + f64::from(k - 1), -1.0 / (0.4 + f64::from(k - 1)).powi(4)) };
        let dead = Curve { poles: [true, false], ..curve("torque", Some("N m"), (0..17).map(at).collect()) };
        let figure = Figure { x: axis("O.angle", "deg"), curves: vec![dead], ..Figure::default() };
        let svg = svg(&figure);
        let arrows = svg.lines().filter(|line| line.starts_with("<polygon") && line.contains("fill=\"#0072b2\""));
        assert_eq!(arrows.count(), 1, "{svg}");
        // of 16 values the two beyond the edge have no dots, but the line goes to there
        assert_eq!(svg.lines().filter(|line| line.starts_with("<circle")).count(), 14, "{svg}");
        assert_eq!(lines(&svg)[0].matches(',').count(), 15, "{svg}");
        assert!(svg.contains(">arrows: without bound<") && svg.contains(">towards a dead point<"), "{svg}");
    }

    #[test]
    fn numbers_of_runs_without_bound_leave_the_axis_where_they_begin() {
        let at = |k: i32| {
            (
                f64::from(k),
                if k < 8 {
                    -1e30
                } else if k > 32 {
                    1e30
                } else {
                    f64::from(k).sin()
                },
            )
        };
        let curves = vec![Curve { runs: true, ..curve("torque", Some("N m"), (0..=40).map(at).collect()) }];
        let svg = svg(&Figure { x: axis("a", ""), curves, ..Figure::default() });
        let arrows: Vec<[f64; 2]> =
            svg.lines().filter(|line| line.starts_with("<polygon") && line.contains("fill=\"#0072b2\"")).map(tip).collect();
        let [[x, y], [u, v]] = arrows[..] else { panic!("{arrows:?}: {svg}") };
        assert!(x < 300.0 && u > 700.0 && y > 500.0 && v < 50.0, "{arrows:?}");
        assert!(svg.contains(">arrows: without bound<") && !svg.contains("dead point"), "{svg}");
    }

    /// The first corner of a polygon.
    fn tip(line: &str) -> [f64; 2] {
        let corners = line.split("points=\"").nth(1).and_then(|of| of.split('"').next()).expect("corners");
        let mut numbers = corners.split([' ', ',']).map(|x| x.parse().expect("a number"));
        [(); 2].map(|()| numbers.next().expect("a corner"))
    }

    #[test]
    fn a_curve_that_runs_back_shows_its_direction() {
        let path = |turns: bool| {
            let at = |k: i32| (f64::from(k) * 0.05).sin_cos();
            (0..126).map(|k| if turns { at(k) } else { (f64::from(k), at(k).0) }).collect()
        };
        let heads = |points, dots| {
            let curves = vec![Curve { dots, ..curve("a", Some("m"), points) }];
            let figure = Figure { x: axis("x", "m"), curves, ..Figure::default() };
            svg(&figure).lines().filter(|line| line.starts_with("<polygon") && line.contains("fill=\"#0072b2\"")).count()
        };
        assert!(heads(path(true), false) >= 4);
        assert_eq!((heads(path(false), false), heads(path(true), true)), (0, 0));
    }

    #[test]
    fn odd_data_make_a_picture_all_the_same() {
        let nan = f64::NAN;
        let samples = [
            vec![],
            vec![(0.0, 5.0)],
            vec![(0.0, nan), (1.0, nan)],
            vec![(0.0, 5.0), (1.0, 5.0)],
            vec![(0.0, 1e300), (1.0, -1e300)],
            vec![(0.0, f64::MAX), (1.0, f64::INFINITY), (2.0, 1.0)],
            vec![(1e-320, 1e-320), (2e-320, 3e-320)],
            vec![(0.0, 1e9), (1.0, 1e9 + 1e-6)],
            vec![(0.0, -1.0), (0.0, 1.0)],
        ];
        for points in samples {
            for (scale, equal) in [(Scale::Linear, false), (Scale::Log, false), (Scale::Linear, true), (Scale::Log, true)] {
                let axis = Axis { label: "q".into(), unit: "m".into(), scale, ..Axis::default() };
                let curves = vec![curve("a", None, points.clone()), curve("b", None, points.clone())];
                let figure = Figure { x: axis.clone(), y: axis, curves, equal, ..Figure::default() };
                let svg = svg(&figure);
                assert!(!svg.contains("NaN") && !svg.contains("inf"), "{points:?} {scale:?} {equal}: {svg}");
            }
        }
        assert!(svg(&Figure::default()).contains("no values"));
    }

    #[test]
    fn an_axis_of_many_names_says_what_they_are_of() {
        let curves = |count: usize, quantity: &str| -> Vec<Curve> {
            let of =
                |k: usize| Curve { quantity: quantity.into(), ..curve(&format!("joint{k}.f"), Some("N"), vec![(0.0, 1.0), (1.0, 2.0)]) };
            (0..count).map(of).collect()
        };
        let text = |curves| svg(&Figure { x: axis("time", "s"), curves, ..Figure::default() });
        assert!(text(curves(4, "force")).contains("force in N"), "{}", text(curves(4, "force")));
        assert!(text(curves(2, "force")).contains("joint0.f, joint1.f in N"));
        let mixed = [curves(2, "force"), curves(2, "tension")].concat();
        assert!(!text(mixed).contains("force in N"));
    }

    #[test]
    fn panels_can_be_named_after_their_quantity() {
        let points = vec![(1e-6, 1.0), (1e-3, 10.0)];
        let curves = vec![curve("rk4", Some("s"), points.clone()), curve("rk4", Some(""), points)];
        let axis = Axis { label: "error".into(), scale: Scale::Log, ..Axis::default() };
        let quantities = vec![("s".into(), "time".into()), (String::new(), "evaluations".into())];
        let figure = Figure { x: axis.clone(), y: Axis { label: String::new(), ..axis }, curves, quantities, ..Figure::default() };
        let svg = svg(&figure);
        assert!(svg.contains(">time in s<") && svg.contains(">evaluations<") && svg.contains(">error<"), "{svg}");
    }

    #[test]
    fn curves_of_different_units_have_panels_of_their_own() {
        let points = vec![(0.0, 0.0), (1.0, 1.0)];
        let curves = vec![curve("delta", Some("deg"), points.clone()), curve("omega", Some("rad/s"), points)];
        let figure = Figure { x: axis("t", "s"), curves, ..Figure::default() };
        let svg = svg(&figure);
        assert!(svg.contains("height=\"900\"") && svg.contains(">delta in deg<") && svg.contains(">omega in rad/s<"));
        // where there is little room for names, so that the quantity stands for them
        let long = ["rope_cabin.force", "rope_weight.force"]
            .map(|name| Curve { quantity: "force".into(), ..curve(name, Some("N"), vec![(0.0, 1.0)]) });
        let other = curve("x", Some("m"), vec![(0.0, 1.0)]);
        let svg = self::svg(&Figure { x: axis("t", "s"), curves: [&long[..], &[other]].concat(), ..Figure::default() });
        assert!(svg.contains(">force in N<"), "{svg}");
        // and however many they are
        let units = ["m", "m/s", "N", "N m", "W"];
        let curves = units.map(|unit| curve("x", Some(unit), vec![(0.0, 0.0), (1.0, 1.0)])).to_vec();
        let svg = self::svg(&Figure { x: axis("t", "s"), curves, ..Figure::default() });
        assert!(svg.contains("height=\"1680\"") && units.iter().all(|unit| svg.contains(&format!(">x in {unit}<"))), "{svg}");
    }
}
