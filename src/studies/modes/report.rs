//! What a study of modes says, as it is found: lists, shapes, findings.

use super::damped::Damped;
use crate::geometry::Space;
use crate::kinematics::coordinates::Coordinate;
use crate::mechanism::Mechanism;
use crate::model::Study;
use crate::results::{Certificate, Finding, List, Scene, six_digits};
use crate::studies::common::case::Case;
use crate::studies::common::numbers::Sources;
use crate::studies::common::outcome::Outcome;
use nalgebra::{Complex, DVector};

/// Unbalanced forces below this part of what they are made of are round-off.
pub(super) const BALANCED: f64 = 1e-8;
/// Modes that are drawn.
pub(super) const DRAWN: usize = 12;
/// Parts of a shape that count in words, of the largest one.
const PART: f64 = 0.3;
/// Imaginary part of a part of a shape, of its real one, that is round-off.
const AGAINST: f64 = 1e-9;
/// Most coordinates that a finding names.
const NAMED: usize = 12;

/// What a study says.
pub(super) struct Report<'a> {
    pub(super) study: &'a Study,
    /// Independent coordinates.
    pub(super) own: &'a [Coordinate],
    pub(super) lists: Vec<List>,
    pub(super) shapes: Vec<Vec<(String, f64)>>,
    pub(super) findings: Vec<Finding>,
}

/// An undamped mode.
pub(super) struct Undamped {
    /// λ, 1/s².
    pub(super) value: f64,
    /// x (n), on the independent coordinates.
    pub(super) shape: DVector<f64>,
    /// Size of λ that is round-off.
    pub(super) noise: f64,
}

impl Undamped {
    /// Whether nothing drives it back.
    pub(super) fn is_free(&self) -> bool {
        self.value.abs() <= self.noise
    }
}

impl Report<'_> {
    pub(super) fn list(&mut self, name: impl Into<String>, unit: &str, values: Vec<f64>) {
        self.lists.push(List { name: name.into(), unit: unit.into(), values, ..List::default() });
    }

    pub(super) fn finding(&mut self, code: &'static str, message: String) {
        self.findings.push(Finding { code: code.into(), message, path: self.study.place.clone() });
    }

    /// Which coordinates are held by a force above its noise, and that there is nothing to move.
    pub(super) fn balance<'f>(&mut self, forces: impl Iterator<Item = (&'f f64, f64)>) {
        if self.own.is_empty() {
            self.finding("no-freedom", "joints and drivers leave no motion, so there are no modes".into());
        }
        let unit = |c: &Coordinate| if c.turns { "N m" } else { "N" };
        let held: Vec<(&Coordinate, &f64)> =
            self.own.iter().zip(forces).filter(|(_, (f, noise))| f.abs() > *noise).map(|(c, (f, _))| (c, f)).collect();
        let mut by: Vec<String> = held.iter().take(NAMED).map(|(c, f)| format!("`{}` {} {}", c.name, six_digits(**f), unit(c))).collect();
        if held.len() > NAMED {
            by.push(format!("{} others", held.len() - NAMED));
        }
        if !by.is_empty() {
            let message = format!(
                "the pose is no equilibrium: it is held against {}; negative eigenvalues are rates at which motions leave it, not vibrations, and all of them depend on which coordinates are held",
                by.join(", ")
            );
            self.finding("unbalanced", message);
        }
    }

    /// Frequencies and shapes of undamped modes, with what their signs mean: √λ, NaN for λ < 0, 0 for a free motion.
    pub(super) fn frequencies(&mut self, found: &[Undamped]) -> Vec<f64> {
        let mut frequencies = Vec::new();
        for (i, mode) in found.iter().enumerate() {
            let (Undamped { value: lambda, shape, .. }, free) = (mode, mode.is_free());
            self.shapes.push(self.own.iter().map(|c| c.name.clone()).zip(shape.iter().copied()).collect());
            if free {
                self.finding(
                    "free-motion",
                    format!("mode {} is a free motion of {}: nothing drives it back", i + 1, self.parts(&shape.abs())),
                );
            } else if *lambda < 0.0 {
                let rate = (-lambda).sqrt();
                let message = format!(
                    "mode {} is unstable, {}: it grows like exp({} t/s), by e in {} s",
                    i + 1,
                    self.parts(&shape.abs()),
                    six_digits(rate),
                    six_digits(rate.recip())
                );
                self.finding("unstable", message);
            }
            frequencies.push(if free { 0.0 } else { lambda.sqrt() });
        }
        self.list("frequencies", "rad/s", frequencies.clone());
        frequencies
    }

    /// That forces have no potential: K is unsymmetric by this part of its size.
    pub(super) fn circulates(&mut self, part: f64) {
        let message = format!(
            "forces in the pose have no potential (K is unsymmetric by {part:.1e} of its size, as by a load that follows its body): the modes are those of the state matrix, and methods for symmetric matrices are left out"
        );
        self.finding("circulatory-forces", message);
    }

    /// Lists and shapes of the first `wanted` damped modes, with what grows, also among those that are not listed; their frequencies
    /// |Im μ|. One with μ = 0 is a free motion.
    pub(super) fn damped(&mut self, all: &[Damped], wanted: usize) -> Vec<f64> {
        let (found, beyond) = all.split_at(wanted.min(all.len()));
        let each = |f: &dyn Fn(&Damped) -> f64| -> Vec<f64> { found.iter().map(f).collect() };
        let frequencies = each(&|d| d.value.im);
        self.list("eigenvalues_real", "1/s", each(&|d| d.value.re));
        self.list("eigenvalues_imaginary", "1/s", each(&|d| d.value.im));
        self.list("damping_ratios", "", each(&Damped::ratio));
        self.list("frequencies", "rad/s", frequencies.clone());
        for (i, mode) in found.iter().enumerate() {
            let amplitudes = mode.shape.map(|x| x.norm());
            let named = |c: &Coordinate, x: &Complex<f64>| [(c.name.clone(), x.norm()), (format!("{}.phase", c.name), phase(*x))];
            self.shapes.push(self.own.iter().zip(mode.shape.iter()).flat_map(|(n, x)| named(n, x)).collect());
            if mode.value.norm() == 0.0 {
                let message = format!("mode {} is a free motion of {}: nothing drives it back", i + 1, self.parts(&amplitudes));
                self.finding("free-motion", message);
            } else if mode.grows() {
                let message = format!(
                    "mode {} is unstable, {}: it grows like exp({} t/s)",
                    i + 1,
                    self.parts(&amplitudes),
                    six_digits(mode.value.re)
                );
                self.finding("unstable", message);
            }
        }
        if let Some(fastest) = beyond.iter().filter(|mode| mode.grows()).map(|mode| mode.value.re).max_by(f64::total_cmp) {
            let count = beyond.iter().filter(|mode| mode.grows()).count();
            let message = format!(
                "{count} more of the modes that are not listed are unstable: the fastest grows like exp({} t/s); `lowest` asks for more",
                six_digits(fastest)
            );
            self.finding("unstable", message);
        }
        frequencies
    }

    /// That these are not all modes.
    pub(super) fn lowest(&mut self, listed: usize, all: usize) {
        if listed < all {
            self.finding("lowest-modes", format!("these are the {listed} lowest of {all} modes; `lowest` asks for more"));
        }
    }

    /// That these damped modes are not all of `n` coordinates, of which not all are known: there are as many as 2n eigenvalues make.
    pub(super) fn lowest_of(&mut self, listed: &[Damped], n: usize) {
        let found: usize = listed.iter().map(|mode| if mode.value.im == 0.0 { 1 } else { 2 }).sum();
        if found < 2 * n {
            let message =
                format!("these are the {} lowest modes, with {found} of {} eigenvalues; `lowest` asks for more", listed.len(), 2 * n);
            self.finding("lowest-modes", message);
        }
    }

    /// The coordinates that move most in a shape, the largest first.
    fn parts(&self, sizes: &DVector<f64>) -> String {
        let largest = sizes.amax();
        let mut order: Vec<usize> = (0..sizes.len()).filter(|&i| sizes[i] >= PART * largest).collect();
        order.sort_by(|a, b| sizes[*b].total_cmp(&sizes[*a]));
        let shown: Vec<String> = order.iter().take(3).map(|&i| format!("`{}`", self.own[i].name)).collect();
        let more = if order.len() > 3 { " and others" } else { "" };
        format!("{}{more}", shown.join(", "))
    }

    /// The whole: numbers of the study from its frequencies, with the pictures of its modes; `residual` is the largest |Φ|, m or rad.
    pub(super) fn outcome<G: Space>(
        mut self,
        case: Case<'_>,
        mechanism: &Mechanism<G>,
        frequencies: &[f64],
        residual: f64,
        scenes: Vec<Scene>,
    ) -> Outcome {
        let ratios = self.lists.iter().find(|list| list.name == "damping_ratios").map_or(&[][..], |list| &list.values);
        let shown = scenes.into_iter().enumerate().map(|(i, scene)| {
            let caption = caption(frequencies.get(i).copied(), ratios.get(i).copied());
            (format!("mode-{}", i + 1), Scene { caption, ..scene })
        });
        let scenes: Vec<(String, Scene)> = shown.collect();
        let results: Vec<f64> = (0..case.study.results.len()).map(|i| frequencies.get(i).copied().unwrap_or(f64::NAN)).collect();
        let numbers = Sources { case, tables: &mechanism.tables, functionals: &[], results: &results, works: &[] }.numbers(true);
        self.findings.extend(numbers.findings);
        Outcome {
            stopped: numbers.undefined.as_ref().map(|u| u.message.clone()),
            undefined: numbers.undefined,
            parameters: case.named(),
            scalars: numbers.scalars,
            expectations: numbers.expectations,
            results,
            lists: self.lists,
            shapes: self.shapes,
            findings: self.findings,
            certificate: Certificate { evaluations: 1, constraint: residual, ..Certificate::default() },
            scenes,
            ..Outcome::default()
        }
    }
}

/// The phase of a part of a shape, from −π to π; against the largest part it is π, whatever the sign of its round-off.
fn phase(x: Complex<f64>) -> f64 {
    if x.re < 0.0 && x.im.abs() <= AGAINST * x.re.abs() { std::f64::consts::PI } else { x.arg() }
}

/// What the title of a drawing says of a mode: its frequency (of rad/s) and damping ratio.
fn caption(frequency: Option<f64>, ratio: Option<f64>) -> String {
    let frequency = match frequency {
        Some(frequency) if frequency > 0.0 => frequency,
        Some(frequency) => return if frequency.is_nan() { "unstable" } else { "does not oscillate" }.into(),
        None => return String::new(),
    };
    let digits = |x: f64| format!("{x:.3e}").parse().unwrap_or(x).to_string();
    let damping = ratio.map_or_else(String::new, |ratio| format!(", damping ratio {}", digits(ratio)));
    format!("{} Hz{damping}", digits(frequency / std::f64::consts::TAU))
}
