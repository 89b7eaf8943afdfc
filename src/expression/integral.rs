//! The integral of an output of a program over one of its inputs, ∫₀ˢ F ds, over the pieces between the places where its formula changes:
//! what the law of a spring stores.
//!
//! The way from 0 to s is gone along in pieces. In each the output is known at the Chebyshev-Lobatto places sin²(jπ/32), j = 0 … 16, of
//! which every other one and every fourth one are those of half and of a quarter of the degree, so that Clenshaw and Curtis' rules (1960)
//! over them estimate each other's errors (Trefethen, *SIAM Review* 50 (2008) 67). Where a switch has another mode at one place than at
//! the one before, the place where it changes is found to round-off and ends the piece: the output may have a kink or jump there. Where a
//! switch comes near to its edge between places, or the rules disagree, the piece is halved, so that a kink that no switch tells, as of a
//! function from outside, is closed in.
//!
//! Where F depends on time, ∂U/∂t = ∫₀ˢ ∂F/∂t ds + Σ (F⁻ − F⁺) ∂σ/∂t over the places σ at which it jumps.

use super::program::Program;
use crate::scalar::{Dual, Interval};
use std::f64::consts::PI;

/// Degree of the polynomial through all places of a piece.
const N: usize = 16;

/// Pieces of the way that are tried first.
const FIRST: f64 = 4.0;

/// Pieces that are tried; what is left then is taken as it is seen, in so many parts.
const MOST: usize = 4000;
const SEEN: usize = 64;

/// Part of the integral of |F| that a piece may be off; or what the rounding of s is worth where F varies.
const EXACT: f64 = 1e-15;

/// Halvings behind which a piece may be off by this part of its own: what no halving makes smaller is round-off of F.
const HALVED: usize = 3;
const NOISE: f64 = 1e-12;

/// Parts of the way: what is narrower has no places of its own, and where a switch only touches its edge nothing is looked for.
const NARROWEST: f64 = 4.0 * f64::EPSILON;
const TOUCHED: f64 = 1e-7;

/// Nodes and weights, and the scratch of an integral.
#[derive(Clone, Debug)]
pub struct Integral {
    /// Places in a piece, from 0 to 1.
    places: [f64; N + 1],
    /// Weights of the rules of degree 4, 8 and 16; their sum is 1.
    weights: [[f64; N + 1]; 3],
    /// F at the places.
    values: [f64; N + 1],
    /// Distances of all switches from their edges at the places (N + 1 × switches).
    edges: Vec<f64>,
    /// Modes inside of the piece, and at a place.
    inside: Vec<i32>,
    there: Vec<i32>,
    /// Inputs and registers with their derivatives by s and by time.
    slopes: Vec<Dual<2>>,
    moving: Vec<Dual<2>>,
    /// Inputs and registers with their round-off.
    around: [Vec<Interval>; 2],
}

/// What is seen of a piece.
enum Piece {
    /// Means of F and of its magnitude, the estimated error of the first, and how far F is from it.
    Smooth([f64; 4]),
    /// A switch changes between two places.
    Changes(f64, f64),
    /// Too coarse to tell.
    Open,
}

/// Where a piece ends because a switch changes: the near and the far side, the number of the switch, and the end that was tried.
#[derive(Clone, Copy)]
struct Cut {
    near: f64,
    far: f64,
    switch: usize,
    tried: f64,
}

/// What is integrated: an output of a program over one of its inputs, the other inputs as they stand.
#[derive(Debug)]
pub struct Integrand<'a> {
    /// The program.
    pub program: &'a Program,
    /// Values of all inputs; that of `over` is written.
    pub inputs: &'a mut [f64],
    /// Scratch.
    pub registers: &'a mut [f64],
    /// Outputs; written.
    pub outputs: &'a mut [f64],
    /// Modes of all switches, of which those count that are [given](Program::decided_by); shape of the pool.
    pub modes: &'a [i32],
    /// The input that is integrated over; none if the program does not read it.
    pub over: Option<usize>,
    /// The output that is integrated.
    pub output: usize,
    /// Where `output` is the derivative by time of another output that may jump: that one, and the input that is time.
    pub jumping: Option<[usize; 2]>,
}

impl Integrand<'_> {
    fn go_to(&mut self, x: f64) {
        if let Some(over) = self.over {
            self.inputs[over] = x;
        }
    }
}

impl Integral {
    /// Scratch for some programs of so many inputs, of a pool with so many switches.
    #[must_use]
    pub fn new<'p>(programs: impl IntoIterator<Item = &'p Program>, inputs: usize, switches: usize) -> Self {
        let rule = |degree: usize| {
            let step = N / degree;
            std::array::from_fn(|j| if j.is_multiple_of(step) { weight(j / step, degree) } else { 0.0 })
        };
        let mut none = true;
        let (mut most_switches, mut most_registers) = (0, 0);
        for program in programs {
            none = false;
            most_switches = most_switches.max(program.switches().len());
            most_registers = most_registers.max(program.registers());
        }
        let modes = vec![0; if none { 0 } else { switches }];
        Self {
            places: std::array::from_fn(|j| (0.5 * PI * j as f64 / N as f64).sin().powi(2)),
            weights: [rule(N / 4), rule(N / 2), rule(N)],
            values: [0.0; N + 1],
            edges: vec![0.0; (N + 1) * most_switches],
            inside: modes.clone(),
            there: modes,
            slopes: vec![Dual::default(); if none { 0 } else { inputs }],
            moving: vec![Dual::default(); most_registers],
            around: [if none { 0 } else { inputs }, most_registers].map(|n| vec![Interval::default(); n]),
        }
    }

    /// The mean of the output by the rule number `rule`, that of its magnitude; how far the next coarser rule is from the first, in view of
    /// how fast rules of rising degree close in on a smooth function (as in Piessens et al., *QUADPACK*, 1983); and how far the output is
    /// from its mean.
    fn means(&self, rule: usize) -> [f64; 4] {
        let mean = |rule: usize, of: &dyn Fn(f64) -> f64| -> f64 {
            self.weights[rule].iter().zip(&self.values).filter(|(w, _)| **w != 0.0).map(|(w, f)| w * of(*f)).sum()
        };
        let value = mean(rule, &|f| f);
        let apart = (value - mean(rule - 1, &|f| f)).abs();
        let varies = mean(rule, &|f| (f - value).abs());
        let off = if varies > 0.0 { apart.min(varies * (200.0 * apart / varies).powf(1.5)) } else { apart };
        [value, mean(rule, &f64::abs), off, varies]
    }

    /// Whether a switch may come to its edge between every `step`-th of the places, at which it is inside: by parabolas through three.
    fn dips(&self, switches: usize, step: usize) -> bool {
        (0..switches).any(|k| {
            let edge = |j: usize| self.edges[j * switches + k];
            (step..N).step_by(step).any(|j| {
                let ([x0, x1, x2], g) = ([j - step, j, j + step].map(|j| self.places[j]), [j - step, j, j + step].map(edge));
                let (left, right) = ((g[1] - g[0]) / (x1 - x0), (g[2] - g[1]) / (x2 - x1));
                let bend = (right - left) / (x2 - x0);
                // slopes at the three places; the lowest place may lie between the first two or the last two
                let [s0, s1, s2] = [left - bend * (x1 - x0), left + bend * (x1 - x0), right + bend * (x2 - x1)];
                s0 < 0.0 && s2 > 0.0 && g[1] - 0.25 * s1 * s1 / bend < 0.5 * g[0].min(g[1]).min(g[2])
            })
        })
    }
}

/// Weight of the place number `k` of Clenshaw and Curtis' rule of an even degree on [0, 1].
fn weight(k: usize, degree: usize) -> f64 {
    let angle = PI * k as f64 / degree as f64;
    let term = |j: usize| {
        let b = if 2 * j == degree { 1.0 } else { 2.0 };
        b * (2.0 * j as f64 * angle).cos() / (4 * j * j - 1) as f64
    };
    let end = if k == 0 || k == degree { 0.5 } else { 1.0 };
    end / degree as f64 * (1.0 - (1..=degree / 2).map(term).sum::<f64>())
}

impl Integral {
    /// ∫ from 0 to `way`, piece by piece; no request to the heap.
    ///
    /// # Errors
    /// What is seen of it, if it takes too many pieces.
    pub fn to(&mut self, way: f64, f: &mut Integrand<'_>) -> Result<f64, f64> {
        let narrowest = NARROWEST * way.abs();
        let switches = self.there.len();
        self.there.copy_from_slice(&f.modes[..switches]);
        self.inside.copy_from_slice(&self.there);
        let (mut from, mut width) = (0.0, way / FIRST);
        let (mut sum, mut size, mut halvings) = (0.0, 0.0, 0);
        let mut cut: Option<Cut> = None;
        for _ in 0..MOST {
            let left = way - from;
            if left == 0.0 {
                return Ok(sum);
            }
            let whole = width.abs() + narrowest >= left.abs();
            let to = cut.map_or(if whole { way } else { from + width }, |cut| cut.near);
            let reach = cut.map_or(to, |cut| cut.far) - from;
            let narrow = (to - from).abs() <= narrowest;
            let [mean, magnitude] = match self.piece(f, [from, to]) {
                Piece::Smooth([_, magnitude, ..]) if !magnitude.is_finite() => return Ok(f64::NAN),
                Piece::Smooth([mean, magnitude, off, varies])
                    if narrow
                        || off * reach.abs() <= (EXACT * (size + magnitude * reach.abs())).max(varies * narrowest)
                        || halvings >= HALVED && off <= NOISE * magnitude
                        || off <= self.round_off(f, 0.5 * (from + to)) =>
                {
                    [mean, magnitude]
                }
                // there are no places between the two
                Piece::Changes(..) if narrow => [self.values[0]; 2],
                Piece::Changes(before, after) => {
                    cut = Some(self.change(f, way, [before, after], to));
                    continue;
                }
                Piece::Open if (to - from).abs() <= TOUCHED * way.abs() => {
                    let [mean, magnitude, ..] = self.means(2);
                    [mean, magnitude]
                }
                Piece::Smooth(_) | Piece::Open => {
                    (width, cut) = (0.5 * (to - from), None);
                    halvings += 1;
                    continue;
                }
            };
            sum += mean * reach;
            size += (magnitude * reach).abs();
            if let (Some(cut), Some(jumping)) = (cut, f.jumping) {
                sum += self.jump(f, cut, jumping);
            }
            from += reach;
            width = cut.map_or(0.0, |cut| 0.5 * (cut.tried - cut.far).abs()).max(2.0 * reach.abs()).copysign(way);
            (halvings, cut) = (0, None);
        }
        for part in 0..SEEN {
            let h = (way - from) / SEEN as f64;
            (0..=N).for_each(|j| {
                self.at(f, from + (part as f64 + self.places[j]) * h, j);
            });
            sum += h * self.means(2)[0];
        }
        Err(sum)
    }

    /// Looks at a piece.
    fn piece(&mut self, f: &mut Integrand<'_>, [from, to]: [f64; 2]) -> Piece {
        let place = |places: &[f64; N + 1], j: usize| if j == N { to } else { from + places[j] * (to - from) };
        for (rule, first, step) in [(1, 0, 2), (2, 1, 2)] {
            for j in (first..=N).step_by(step) {
                let x = place(&self.places, j);
                if !self.at(f, x, j) {
                    return Piece::Changes(place(&self.places, if first == 0 { j - 2 } else { j - 1 }), x);
                }
            }
            let means = self.means(rule);
            if self.dips(f.program.switches().len(), if rule == 1 { 2 } else { 1 }) {
                if rule == 1 {
                    continue;
                }
                return Piece::Open;
            }
            if rule == 2 || means[2] <= EXACT * means[1] || !means[1].is_finite() {
                return Piece::Smooth(means);
            }
        }
        Piece::Open
    }

    /// How far apart the bounds of F are that hold its value at `x` and its rounding, in the modes inside of the piece; 0 where there are none.
    fn round_off(&mut self, f: &mut Integrand<'_>, x: f64) -> f64 {
        f.go_to(x);
        let [inputs, registers] = &mut self.around;
        inputs.iter_mut().zip(f.inputs.iter()).for_each(|(around, input)| *around = Interval::between(*input, *input));
        let mut outputs = [Interval::default(); 2];
        f.program.eval(inputs, &self.inside, registers, &mut outputs[..f.outputs.len()]);
        let Interval { low, high } = outputs[f.output];
        Some(high - low).filter(|width| width.is_finite()).unwrap_or(0.0)
    }

    /// Evaluates at `x`, the place number `j` of a piece, in the modes that belong to it; whether they are those of the place 0.
    fn at(&mut self, f: &mut Integrand<'_>, x: f64, j: usize) -> bool {
        f.go_to(x);
        let switches = f.program.switches();
        if !switches.is_empty() {
            f.program.set_modes(f.inputs, f.registers, &mut self.there);
            if j == 0 {
                self.inside.copy_from_slice(&self.there);
            }
            let edges = &mut self.edges[j * switches.len()..(j + 1) * switches.len()];
            f.program.roots(f.inputs, &self.there, f.registers, edges);
        }
        f.program.eval(f.inputs, &self.there, f.registers, f.outputs);
        self.values[j] = f.outputs[f.output];
        switches.iter().all(|&switch| self.there[switch as usize] == self.inside[switch as usize])
    }

    /// Where the first switch that is another one behind `b` than before `a` changes: by false position on its root function (Dowell &
    /// Jarratt 1971), halved where that is slow.
    fn change(&mut self, f: &mut Integrand<'_>, way: f64, [mut a, mut b]: [f64; 2], tried: f64) -> Cut {
        let narrowest = NARROWEST * way.abs();
        let switches = f.program.switches();
        let differs = |switch: &u32| self.there[*switch as usize] != self.inside[*switch as usize];
        let switch = switches.iter().position(differs).unwrap_or(0);
        let ([_, mut fa], [_, mut fb]) = (self.beside(f, a, switch), self.beside(f, b, switch));
        let mut side = 0.0;
        for iteration in 0.. {
            let width = (b - a).abs();
            if width <= narrowest {
                break;
            }
            let least = 0.25 * narrowest / width;
            let part = fa / (fa - fb);
            let sound = fa > 0.0 && fb < 0.0 && iteration % 4 != 3;
            let x = a + (b - a) * if sound { part.clamp(least, 1.0 - least) } else { 0.5 };
            let [changed, root] = self.beside(f, x, switch);
            if changed > 0.0 {
                (b, fb) = (x, root);
                fa *= if side > 0.0 { 0.5 } else { 1.0 };
            } else {
                (a, fa) = (x, root);
                fb *= if side < 0.0 { 0.5 } else { 1.0 };
            }
            side = changed;
        }
        Cut { near: a, far: b, switch, tried }
    }

    /// Whether a switch is another one at `x` than inside of the piece (1, else −1), and its root function in those modes.
    fn beside(&mut self, f: &mut Integrand<'_>, x: f64, switch: usize) -> [f64; 2] {
        f.go_to(x);
        let switches = f.program.switches();
        f.program.set_modes(f.inputs, f.registers, &mut self.there);
        f.program.roots(f.inputs, &self.inside, f.registers, &mut self.edges[..switches.len()]);
        let mode = switches[switch] as usize;
        [if self.there[mode] == self.inside[mode] { -1.0 } else { 1.0 }, self.edges[switch]]
    }

    /// What a jump of `jumping` adds to ∂U/∂t where its place moves with `time`.
    fn jump(&mut self, f: &mut Integrand<'_>, cut: Cut, [jumping, time]: [usize; 2]) -> f64 {
        f.go_to(cut.near);
        f.program.eval(f.inputs, &self.inside, f.registers, f.outputs);
        let before = f.outputs[jumping];
        f.go_to(cut.far);
        f.program.set_modes(f.inputs, f.registers, &mut self.there);
        f.program.eval(f.inputs, &self.there, f.registers, f.outputs);
        let after = f.outputs[jumping];
        for (slope, input) in self.slopes.iter_mut().zip(f.inputs.iter()) {
            *slope = Dual { x: *input, d: [0.0; 2] };
        }
        f.over.into_iter().for_each(|over| self.slopes[over].d[0] = 1.0);
        self.slopes[time].d[1] = 1.0;
        let [by_way, by_time] = f.program.operand(cut.switch, &self.slopes, &self.inside, &mut self.moving).d;
        // an edge that does not move is none of time
        if by_time == 0.0 || by_way == 0.0 { 0.0 } else { -(before - after) * by_time / by_way }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_are_exact_to_their_degree() {
        let integral = Integral::new([], 0, 0);
        for (rule, degree) in [(0, 4), (1, 8), (2, 16)] {
            for power in 0..=degree {
                let of = |j: usize| integral.weights[rule][j] * integral.places[j].powi(power);
                let off = (0..=N).map(of).sum::<f64>() * f64::from(power + 1) - 1.0;
                assert!(off.abs() < 1e-14, "x^{power} by degree {degree}: {off:e}");
            }
        }
    }
}
