//! Names beside what they name, where they cover least and are read as belonging to it.
//!
//! A name has a place in each direction and at growing distances around what it names, and takes the cheapest. One that stands nearer to
//! another pin or part than to its own, or far from it, has a leader line, which costs as well. When all are placed, each is placed anew
//! beside all others until none moves (discrete descent: Christensen, Marks and Shieber 1995).

use super::font;
use super::measure::{crosses, encloses, gap, meets};
use super::scene::{Anchor, Color, Item, Rect, Scene, Stroke, Text};
use super::symbols::direction;
use super::thin::Point;

/// Directions around a place.
const AROUND: u32 = 16;
/// Distances of names beyond the least one, pixels.
const RINGS: [f64; 11] = [0.0, 6.0, 14.0, 24.0, 36.0, 50.0, 66.0, 84.0, 104.0, 128.0, 160.0];
/// Farther from what they name than this, names have a leader line, pixels.
const FAR: f64 = 36.0;
/// The shortest leader line that is seen as one, pixels.
const SHORTEST: f64 = 12.0;
/// What a leader line costs.
const LEADER: f64 = 24.0;
/// What it costs to be in the way of a name, a pin or a leader line.
const CROSSED: f64 = 90.0;
/// Rounds in which names are placed anew, at most.
const ROUNDS: usize = 5;

/// What a name may have to keep clear of, and how much that matters.
#[derive(Clone, Copy, Debug)]
pub(super) enum Obstacle {
    /// A part in its strong position.
    Body,
    /// A part in a pale position.
    Shade,
    /// A path.
    Path,
    /// A line of a sign.
    Sign,
}

impl Obstacle {
    fn weight(self) -> f64 {
        match self {
            Self::Body | Self::Sign => 14.0,
            Self::Shade => 3.0,
            Self::Path => 6.0,
        }
    }

    /// How far a name keeps from the middle of the line.
    fn reach(self) -> f64 {
        match self {
            Self::Path | Self::Sign => 4.0,
            _ => super::symbols::BAR / 2.0 + 2.0,
        }
    }
}

/// What is named.
#[derive(Clone, Debug)]
pub(super) enum Named {
    /// A pin, at the place of its name.
    Pin,
    /// A body or link, by its lines; one that returns to its first point is the edge of an area.
    Part(Vec<Vec<Point>>),
    /// A path.
    Path(Vec<Point>),
}

/// A name, the place that it belongs to, and how far from there it keeps.
#[derive(Clone, Debug)]
pub(super) struct Name {
    pub(super) text: String,
    pub(super) at: Point,
    /// Places of the same thing that will do as well.
    pub(super) also: Vec<Point>,
    /// The edges of what hides it: where its name stands in one of them it would be taken for that of the other.
    pub(super) above: Vec<Vec<Point>>,
    /// With no reach it may stand right on its place.
    pub(super) reach: f64,
    pub(super) color: Color,
    pub(super) of: Named,
}

/// Where a name of a drawing stands in its picture, pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// The name.
    pub text: String,
    /// Left, top, right, bottom.
    pub area: [f64; 4],
    /// The place that it belongs to.
    pub at: [f64; 2],
    /// Whether that is the pin of a joint.
    pub pin: bool,
    /// Whether a line leads there.
    pub leader: bool,
}

/// A name where it may stand.
#[derive(Clone, Copy, Debug)]
struct Spot {
    area: Rect,
    at: Point,
    leader: Option<[Point; 2]>,
}

/// The names of a drawing, and all they keep clear of.
#[derive(Clone, Debug)]
pub(super) struct Lettering {
    sheet: Rect,
    samples: Vec<(Point, Obstacle)>,
    signs: Vec<Rect>,
    pins: Vec<Point>,
    pale_pins: Vec<Point>,
    names: Vec<(Name, Spot)>,
    size: f64,
}

impl Lettering {
    /// No names yet, to be placed within `sheet`, with letters of a size.
    pub(super) fn new(sheet: Rect, size: f64) -> Self {
        Self { sheet, samples: Vec::new(), signs: Vec::new(), pins: Vec::new(), pale_pins: Vec::new(), names: Vec::new(), size }
    }

    /// Keeps clear of a line, sampled every few pixels.
    pub(super) fn avoid_line(&mut self, line: &[Point], obstacle: Obstacle) {
        self.samples.extend(line.first().map(|point| (*point, obstacle)));
        for ends in line.windows(2) {
            let [a, b] = [ends[0], ends[1]];
            let count = ((b[0] - a[0]).hypot(b[1] - a[1]) / 6.0).ceil().clamp(1.0, 1000.0) as u32;
            self.samples.extend((1..=count).map(|step| {
                let s = f64::from(step) / f64::from(count);
                ([a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])], obstacle)
            }));
        }
    }

    /// Keeps clear of a sign of the given half sizes, its middle shifted from `at`.
    pub(super) fn avoid(&mut self, at: Point, half: [f64; 2], shift: [f64; 2]) {
        let (x, y) = (at[0] + shift[0], at[1] + shift[1]);
        self.signs.push(Rect { left: x - half[0], top: y - half[1], right: x + half[0], bottom: y + half[1] });
    }

    /// Tells of a pin, beside which the name of another one would be taken for its own.
    pub(super) fn pin(&mut self, at: Point, strong: bool) {
        if strong { &mut self.pins } else { &mut self.pale_pins }.push(at);
    }

    /// Places names, those that are first before the others.
    pub(super) fn place(&mut self, names: Vec<Name>) {
        let parts: Vec<Named> = names.iter().map(|name| name.of.clone()).collect();
        let mut tasks: Vec<Task> = Vec::new();
        for (index, mut name) in names.into_iter().enumerate() {
            name.text = font::fitted(&name.text, self.size, 0.4 * self.sheet.width());
            if !name.text.is_empty() {
                let others = parts.iter().enumerate().filter(|(other, _)| *other != index);
                let rivals = match name.of {
                    Named::Pin => self.pins.iter().filter(|pin| !super::sheet::near(**pin, name.at)).map(|pin| vec![*pin]).collect(),
                    Named::Part(_) => {
                        others.filter_map(|(_, of)| if let Named::Part(l) = of { Some(l.clone()) } else { None }).flatten().collect()
                    }
                    Named::Path(_) => Vec::new(),
                };
                tasks.push(self.task(name, rivals));
            }
        }
        let mut spots: Vec<Option<Spot>> = vec![None; tasks.len()];
        for _ in 0..ROUNDS {
            let mut moved = false;
            for (index, task) in tasks.iter().enumerate() {
                let before = spots[index].take();
                let others: Vec<&Spot> = spots.iter().flatten().collect();
                let found = self.best(task, &others);
                moved |= before.zip(found).is_none_or(|(before, found)| before.area != found.area);
                spots[index] = found;
            }
            if !moved {
                break;
            }
        }
        self.names = tasks.into_iter().zip(spots).filter_map(|(task, spot)| Some((task.name, spot?))).collect();
    }

    /// A name with what is around it.
    fn task(&self, name: Name, rivals: Vec<Vec<Point>>) -> Task {
        let (width, height) = (font::width(&name.text, self.size), self.size * font::CAPITAL);
        let far = RINGS[RINGS.len() - 1] + name.reach + width + 20.0;
        let places: Vec<Point> = std::iter::once(name.at).chain(name.also.iter().copied()).collect();
        let close = |p: &Point| places.iter().any(|at| (p[0] - at[0]).abs() < far && (p[1] - at[1]).abs() < far);
        let samples = self.samples.iter().filter(|(point, _)| close(point)).copied().collect();
        let mut spots = Vec::new();
        for (other, at) in places.iter().enumerate() {
            for (ring, more) in RINGS.into_iter().enumerate() {
                let radius = name.reach + more;
                for step in 0..if radius == 0.0 { 1 } else { AROUND } {
                    // From the right and upwards, where a name is looked for first.
                    let (sin, cos) = (f64::from(step) * std::f64::consts::TAU / f64::from(AROUND)).sin_cos();
                    let around = [cos * (radius + width / 2.0), -sin * (radius + height / 2.0)];
                    let [x, y] = if radius == 0.0 { *at } else { [at[0] + around[0], at[1] + around[1]] };
                    let area = Rect { left: x - width / 2.0, top: y - height / 2.0, right: x + width / 2.0, bottom: y + height / 2.0 };
                    // A diagonal place is as good as a level one; a distant one is a little worse.
                    spots.push((5.0 * ring as f64 + 0.1 * f64::from(step) + 4.0 * other as f64, *at, area));
                }
            }
        }
        spots.sort_by(|a, b| a.0.total_cmp(&b.0));
        Task { name, rivals, samples, spots }
    }

    /// The cheapest place of a name beside others.
    fn best(&self, task: &Task, others: &[&Spot]) -> Option<Spot> {
        let mut best: Option<(f64, Spot)> = None;
        for (least, at, area) in &task.spots {
            if best.as_ref().is_some_and(|(cost, _)| cost <= least) {
                break;
            }
            let (leader, price) = self.leader(task, *at, area, others);
            let cost = least + price + self.cost(area, &task.samples, others);
            if best.as_ref().is_none_or(|(lowest, _)| cost < *lowest) {
                best = Some((cost, Spot { area: *area, at: *at, leader }));
            }
        }
        best.map(|(_, spot)| spot)
    }

    /// The leader line that a name needs in a place, and what that or being mistaken costs.
    fn leader(&self, task: &Task, at: Point, area: &Rect, others: &[&Spot]) -> (Option<[Point; 2]>, f64) {
        let least = |lines: &[Vec<Point>]| lines.iter().map(|line| gap(area, line)).fold(f64::INFINITY, f64::min);
        let (own, mistaken) = match &task.name.of {
            Named::Pin => {
                let own = gap(area, &[at]);
                (own, least(&task.rivals) < 1.25 * own + 3.0)
            }
            Named::Part(lines) => {
                let own = least(lines);
                (own, own > 0.0 && least(&task.rivals) <= own || task.name.above.iter().any(|edge| encloses(edge, area.center())))
            }
            Named::Path(line) => (gap(area, line), false),
        };
        if !mistaken && own <= FAR {
            let pale = matches!(task.name.of, Named::Pin) && self.pale_pins.iter().any(|pin| gap(area, &[*pin]) < own);
            return (None, if pale { 10.0 } else { 0.0 });
        }
        let from = area.grown(3.0).nearest(at);
        let (along, length) = direction(at, from);
        // to the rim of a pin, or into a part
        let inner = if matches!(task.name.of, Named::Pin) { 0.62 * task.name.reach } else { 0.0 };
        if length - inner < SHORTEST {
            return (None, if mistaken { CROSSED } else { 0.0 });
        }
        let line = [from, [at[0] + inner * along[0], at[1] + inner * along[1]]];
        let names = others.iter().filter(|other| meets(&other.area.grown(3.0), line)).count();
        // one that begins beside another goes along it
        let beside = |from: Point, other: [Point; 2]| super::thin::distance(from, other[0], other[1]) < 8.0;
        let meets_line = |other: &[Point; 2]| crosses(*other, line) || beside(other[0], line) || beside(from, *other);
        let lines = others.iter().filter_map(|other| other.leader).filter(meets_line).count();
        let pins = self.pins.iter().filter(|pin| super::thin::distance(**pin, line[0], line[1]) < 10.0 && !super::sheet::near(**pin, at));
        let covered = task.samples.iter().filter(|(p, _)| super::thin::distance(*p, line[0], line[1]) < 3.0);
        let covered: f64 = covered.map(|(_, obstacle)| 0.1 * obstacle.weight()).sum();
        (Some(line), LEADER + 0.1 * length + covered + CROSSED * (names + lines + pins.count()) as f64)
    }

    fn cost(&self, area: &Rect, samples: &[(Point, Obstacle)], others: &[&Spot]) -> f64 {
        let outside = area.width() * area.height() - area.overlap(&self.sheet);
        let taken: f64 = others.iter().map(|other| area.grown(5.0).overlap(&other.area)).sum();
        let signs: f64 = self.signs.iter().map(|sign| area.grown(2.0).overlap(sign)).sum();
        let leaders = others.iter().filter_map(|other| other.leader).filter(|line| meets(&area.grown(3.0), *line)).count();
        let lines = samples.iter().filter(|(point, obstacle)| area.grown(obstacle.reach()).contains(*point));
        outside + 10.0 * taken + signs + CROSSED * leaders as f64 + lines.map(|(_, obstacle)| obstacle.weight()).sum::<f64>()
    }

    /// Where the names stand.
    pub(super) fn labels(&self) -> Vec<Label> {
        let label = |(name, spot): &(Name, Spot)| Label {
            text: name.text.clone(),
            area: [spot.area.left, spot.area.top, spot.area.right, spot.area.bottom],
            at: spot.at,
            pin: matches!(name.of, Named::Pin),
            leader: spot.leader.is_some(),
        };
        self.names.iter().map(label).collect()
    }

    /// Writes all names. A leader line ends at the rim of a pin, and with a dot on a part (ISO 128-22).
    pub(super) fn draw(self, scene: &mut Scene) {
        for (name, spot) in &self.names {
            let Some([from, to]) = spot.leader else { continue };
            scene.line(vec![from, to], Stroke::solid([255; 3], 4.0));
            scene.line(vec![from, to], Stroke::solid(name.color, 1.3));
            if !matches!(name.of, Named::Pin) {
                scene.circle(to, 3.0, Some(name.color), None);
            }
        }
        let size = self.size;
        scene.items.extend(self.names.into_iter().map(|(Name { text, color, .. }, Spot { area, .. })| {
            Item::Text(Text { at: [area.left, area.bottom], text, size, color, anchor: Anchor::Start, upright: false, halo: true })
        }));
    }
}

/// A name to be placed.
struct Task {
    name: Name,
    /// Lines of what else it could be taken to belong to.
    rivals: Vec<Vec<Point>>,
    samples: Vec<(Point, Obstacle)>,
    /// Where it may stand, with the least cost there and the place beside which that is, the cheapest first.
    spots: Vec<(f64, Point, Rect)>,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lettering() -> Lettering {
        Lettering::new(Rect { left: 0.0, top: 0.0, right: 400.0, bottom: 400.0 }, 20.0)
    }

    fn pin(text: &str, at: Point) -> Name {
        Name { text: text.into(), at, also: Vec::new(), above: Vec::new(), reach: 14.0, color: [0; 3], of: Named::Pin }
    }

    #[test]
    fn two_names_at_one_point_do_not_overlap() {
        let mut letters = lettering();
        letters.avoid_line(&[[0.0, 200.0], [400.0, 200.0]], Obstacle::Body);
        letters.place(vec![pin("first", [200.0, 200.0]), pin("second", [200.0, 200.0])]);
        let [(_, Spot { area: a, .. }), (_, Spot { area: b, .. })] = &letters.names[..] else { panic!("two names") };
        assert_eq!(a.overlap(b), 0.0);
        assert!(a.bottom < 200.0 || a.top > 200.0, "not on the line");
    }

    #[test]
    fn a_name_among_pins_has_a_leader_line() {
        let mut letters = lettering();
        let around = (0..12).map(|k| f64::from(k) * std::f64::consts::TAU / 12.0).map(|a| [200.0 + 26.0 * a.cos(), 200.0 + 26.0 * a.sin()]);
        for at in around.chain([[200.0, 200.0]]) {
            letters.pin(at, true);
            letters.avoid(at, [8.0; 2], [0.0; 2]);
        }
        letters.place(vec![pin("among", [200.0, 200.0])]);
        let label = &letters.labels()[0];
        assert!(label.leader && gap(&letters.names[0].1.area, &[[200.0, 200.0]]) > 30.0, "{label:?}");
        let mut scene = Scene::default();
        letters.draw(&mut scene);
        assert!(matches!(&scene.items[..], [Item::Path { .. }, Item::Path { points, .. }, Item::Text(_)] if points.len() == 2));
        // alone it stands beside its pin
        let mut letters = lettering();
        letters.pin([200.0, 200.0], true);
        letters.place(vec![pin("alone", [200.0, 200.0])]);
        assert!(!letters.labels()[0].leader);
    }

    #[test]
    fn the_name_of_a_bar_moves_along_it() {
        let bar = |y: f64| vec![vec![[50.0, y], [350.0, y]]];
        let part = |text: &str, y: f64| Name {
            at: [200.0, y],
            also: vec![[120.0, y], [280.0, y]],
            of: Named::Part(bar(y)),
            ..pin(text, [200.0, y])
        };
        let mut letters = lettering();
        // what is around the middle of the first bar
        letters.avoid([200.0, 200.0], [40.0, 60.0], [0.0; 2]);
        letters.place(vec![part("bar", 200.0), part("other", 320.0)]);
        assert!(letters.names[0].1.at != [200.0, 200.0] && letters.labels().iter().all(|label| !label.leader), "{:?}", letters.labels());
    }
}
