//! Mechanisms made by chance: coordinates, space, and families of schemes must not matter, and energy must be kept.
//!
//! All bodies lie on the ground's frame as drawn, so that every joint is closed at coordinate 0, loops included.

use super::dice::Dice;
use super::motion::{apart, moved};
use super::{between, cases, seeded, tell};
use crate::common::columns;
use std::fmt::Write;

/// A body on its joint, in space; a plane mechanism leaves out z.
struct Link {
    parent: usize,
    kind: &'static str,
    place: [f64; 3],
    axis: [f64; 3],
    com: [f64; 3],
    mass: f64,
    inertia: f64,
    rate: f64,
}

/// A joint between the ground and the last body that closes a loop.
struct Closure {
    kind: &'static str,
    places: [[f64; 3]; 2],
}

/// A mechanism, of which texts for the plane and for space are made.
struct Chance {
    planar: bool,
    links: Vec<Link>,
    closure: Option<Closure>,
    stiffness: f64,
    damping: f64,
    gravity: [f64; 3],
}

fn vector(dice: &mut Dice, planar: bool) -> [f64; 3] {
    let mut part = || between(dice, -1.0, 1.0);
    [part(), part(), if planar { 0.0 } else { part() }]
}

impl Chance {
    fn new(dice: &mut Dice, planar: bool) -> Self {
        let count = 2 + dice.next(3);
        let kinds: &[&'static str] = if planar {
            &["revolute", "revolute", "slider"]
        } else {
            &["revolute", "spherical", "universal", "cylindrical", "slider", "screw"]
        };
        let mut link = |parent: usize| {
            let kind = kinds[dice.next(kinds.len())];
            let place = vector(dice, planar);
            let off = vector(dice, planar);
            // of a slider in the plane; turning is about z there
            let axis = if planar && kind == "revolute" { [0.0, 0.0, 1.0] } else { vector(dice, planar).map(|x| x + 1.2) };
            Link {
                parent,
                kind,
                place,
                axis: if planar && kind == "slider" { [axis[0], axis[1], 0.0] } else { axis },
                com: [place[0] + off[0] + 0.3, place[1] + off[1], place[2] + off[2]],
                mass: between(dice, 0.5, 3.0),
                inertia: between(dice, 0.1, 0.6),
                rate: between(dice, -1.0, 1.0),
            }
        };
        let mut links = vec![link(0)];
        for _ in 1..count {
            // a chain or a tree
            let parent = links.len();
            links.push(link(parent));
        }
        for (i, link) in links.iter_mut().enumerate().skip(1) {
            if dice.next(3) == 0 {
                link.parent = dice.next(i + 1);
            }
        }
        // a loop over three joints or more, which keeps a freedom
        let closure = (count > 2 && dice.next(2) == 0).then(|| {
            let pinned = count > 3 && planar && dice.next(2) == 0;
            let place = vector(dice, planar);
            let off = vector(dice, planar);
            let far = [place[0] + 0.5 * off[0] + 0.7, place[1] + 0.5 * off[1], place[2] + 0.5 * off[2]];
            if pinned { Closure { kind: "revolute", places: [place; 2] } } else { Closure { kind: "distance", places: [place, far] } }
        });
        let damping = if dice.next(2) == 0 { 0.0 } else { between(dice, 0.1, 2.0) };
        let mut gravity = vector(dice, planar);
        gravity[1] -= 9.0;
        Self { planar, links, closure, stiffness: between(dice, 5.0, 60.0), damping, gravity }
    }

    /// The model's text in the plane or in space, with the options of its motion.
    fn text(&self, planar: bool, options: &str) -> String {
        let list = |v: [f64; 3]| if planar { format!("[{}, {}]", v[0], v[1]) } else { format!("[{}, {}, {}]", v[0], v[1], v[2]) };
        let name = |body: usize| if body == 0 { "ground".to_owned() } else { format!("b{body}") };
        let mut points = vec![String::new(); self.links.len() + 1];
        let (mut joints, mut bodies, mut start, mut shown) = (String::new(), String::new(), Vec::new(), Vec::new());
        for (link, i) in self.links.iter().zip(1..) {
            for body in [link.parent, i] {
                write!(points[body], "j{i}: {}, ", list(link.place)).unwrap();
            }
            writeln!(joints, "  j{i}: {{ {}: [{}.j{i}, b{i}.j{i}]{} }}", link.kind, name(link.parent), link.axis(planar)).unwrap();
            // a loop may not allow the rates of its joints, and those of other kinds of joints would be left open: all rest
            let moving = self.planar && self.closure.is_none();
            match link.kind {
                "revolute" if moving => start.push(format!("j{i}.angle: 0, j{i}.omega: {}", link.rate)),
                "slider" if moving => start.push(format!("j{i}.position: 0, j{i}.velocity: {}", link.rate)),
                _ => {}
            }
            shown.extend([format!("b{i}.com.x"), format!("b{i}.com.y")]);
        }
        let last = self.links.len();
        if let Some(Closure { kind, places }) = &self.closure {
            for (body, place) in [0, last].into_iter().zip(places) {
                write!(points[body], "close: {}, ", list(*place)).unwrap();
            }
            let axis = if planar || *kind == "distance" { "" } else { ", axis: [0, 0, 1]" };
            writeln!(joints, "  c: {{ {kind}: [ground.close, b{last}.close]{axis} }}").unwrap();
        }
        for (link, i) in self.links.iter().zip(1..) {
            let inertia = if planar { format!("{}", link.inertia) } else { format!("[0.5, 0.4, {}]", link.inertia) };
            let points = points[i].trim_end_matches(", ");
            let com = list(link.com);
            writeln!(bodies, "  b{i}: {{ mass: {}, inertia: {inertia}, com: {com}, points: {{ {points} }} }}", link.mass).unwrap();
        }
        format!(
            "grashof: 1\nname: chance\nspace: {}\ngravity: {}\nground: {{ post: {}, {} }}\nbodies:\n{bodies}joints:\n{joints}\
             springs:\n  s: {{ between: [ground.post, b{last}.com], stiffness: {}, length: 1, damping: {} }}\nstart: {{ {} }}\n\
             studies:\n  move:\n    dynamics: {{ until: 0.4 s, every: 0.1 s{options} }}\n    columns: [time, energy.total, {}]\n",
            if planar { "planar" } else { "spatial" },
            list(self.gravity),
            list([-1.5, 1.7, if self.planar { 0.0 } else { 0.4 }]),
            points[0].trim_end_matches(", "),
            self.stiffness,
            self.damping,
            start.join(", "),
            shown.join(", ")
        )
    }
}

impl Link {
    /// The options of its joint.
    fn axis(&self, planar: bool) -> String {
        let [x, y, z] = self.axis;
        match self.kind {
            "spherical" => String::new(),
            "revolute" if planar => String::new(),
            "universal" => format!(", axes: [[{x}, {y}, {z}], [{}, {x}, 0]]", -y),
            "screw" => format!(", axis: [{x}, {y}, {z}], pitch: 0.3"),
            _ if planar => format!(", axis: [{x}, {y}]"),
            _ => format!(", axis: [{x}, {y}, {z}]"),
        }
    }
}

const TIGHT: &str = ", integrator: dop853, tolerance: 1e-11";

/// What may be changed without changing the motion.
const OTHERS: [(&str, &str); 3] = [
    ("cartesian", ", integrator: dop853, tolerance: 1e-11, coordinates: cartesian"),
    ("minimal", ", integrator: dop853, tolerance: 1e-11, coordinates: minimal"),
    ("implicit", ", integrator: radau5, tolerance: 1e-10"),
];

#[test]
fn coordinates_space_and_schemes_do_not_matter() {
    let wanted = cases(60);
    let mut dice = seeded(0x4EC4_A215);
    let (mut ran, mut refused, mut findings, mut worst) = (0, 0, Vec::new(), 0.0_f64);
    for case in 0..wanted {
        let chance = Chance::new(&mut dice, case % 2 == 0);
        let text = chance.text(chance.planar, TIGHT);
        let first = moved(&text);
        let mut twins: Vec<(&str, String)> = OTHERS.iter().map(|(name, options)| (*name, chance.text(chance.planar, options))).collect();
        if chance.planar {
            twins.push(("spatial", chance.text(false, TIGHT)));
        }
        let mut find = |what: String, text: &str| {
            let path = std::env::temp_dir().join(format!("grashof-mechanism-{case}.yaml"));
            std::fs::write(&path, text).unwrap();
            findings.push(format!("case {case}: {what}: {}", path.display()));
        };
        match &first {
            Err(_) => refused += 1,
            Ok(outcome) => {
                ran += 1;
                let at = columns(&text, "move").iter().position(|n| n == "energy.total").unwrap();
                let energies = || outcome.rows.iter().map(|r| r[at]);
                let drift = energies().fold(f64::MIN, f64::max) - energies().fold(f64::MAX, f64::min);
                let size = energies().fold(1.0_f64, |m, e| m.max(e.abs()));
                if chance.damping == 0.0 && drift > 1e-8 * size {
                    find(format!("energy drifts by {drift:e} of {size:e}"), &text);
                }
            }
        }
        for (name, twin) in &twins {
            match (&first, moved(twin)) {
                (Ok(a), Ok(b)) => {
                    let off = apart(a, &b, 0.1);
                    worst = worst.max(off);
                    if off > 1e-6 {
                        find(format!("{name} is off by {off:e}"), twin);
                    }
                }
                (Err(_), Err(_)) => {}
                (Ok(_), Err(reason)) => find(format!("{name} alone does not run: {reason}"), twin),
                (Err(reason), Ok(_)) => find(format!("only {name} runs: {reason}"), &text),
            }
        }
    }
    let figures = format!("{wanted} cases: {ran} ran, {refused} refused in all forms; largest difference {worst:.1e}");
    tell(&format!("mechanisms: {figures}; {} findings", findings.len()));
    assert!(findings.is_empty(), "{} findings\n{}", findings.len(), findings.join("\n"));
    assert!(ran * 10 > wanted * 9, "{ran} of {wanted} ran");
}
