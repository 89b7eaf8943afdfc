//! A mechanism whose drivers leave no freedom: position, velocity, acceleration and multipliers at any time by Newton's method.

use super::assemble::Assembled;
use super::square::Square;
use crate::dynamics::{Dynamics, Reactions, friction_pattern, slack};
use crate::geometry::Space;
use crate::mechanism::Mechanism;
use grashof_solvers::kkt::ROUND_OFF;
use grashof_solvers::weakest::weakest;
use grashof_solvers::{Block, Dims, Friction, Kkt, Pattern, Terms};

/// Newton did not reach a position at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotReached;

/// The solver of one driven mechanism; one per thread. Nothing is allocated per solution.
#[derive(Clone, Debug)]
pub struct Driven<'m, G: Space> {
    /// The evaluator, left at the solution found last.
    pub dynamics: Dynamics<'m, G>,
    /// Coordinates of the solution found last (nq).
    pub q: Vec<f64>,
    /// Velocities (nv).
    pub v: Vec<f64>,
    /// Accelerations (nv).
    pub a: Vec<f64>,
    /// Multipliers (rows).
    pub lambda: Vec<f64>,
    /// What follows for bodies and joints.
    pub reactions: Reactions<G>,
    /// Size of the correction that Newton made in all, largest component in units of `unit`.
    pub correction: f64,
    /// The row that Newton's method left open although it converged: rows contradict each other.
    pub open: Option<usize>,
    solver: Solver,
    /// The solver where friction depends on reactions.
    friction_by_reactions: Option<Box<ByReactions>>,
    /// 1 for angles, one by the size of the mechanism for lengths (nv).
    unit: Vec<f64>,
    /// The same for residuals (rows).
    row_unit: Vec<f64>,
    delta: Vec<f64>,
    rhs: Vec<f64>,
    scratch: Vec<f64>,
    zeros: Vec<f64>,
}

/// Multipliers where friction depends on reactions: M a + Gᵀλ = f + f_λ(λ) with the a that G a = γ leaves.
#[derive(Clone, Debug)]
struct ByReactions {
    friction: Friction,
    terms: Terms,
    a: Vec<f64>,
    /// D (nv).
    metric: Vec<f64>,
}

/// How G is inverted.
#[derive(Clone, Debug)]
enum Solver {
    /// As many rows as velocities: one factorisation of G, its rows scaled to unit size.
    Square(Square),
    /// Redundant rows: the regularised system with the mass metric (nv × nv) in the place of M.
    Redundant { kkt: Box<Kkt>, metric: Box<Block>, probe: Vec<f64> },
}

/// A correction below this leaves an error below round-off, and moves everything linearly to within round-off.
const QUADRATIC: f64 = 1e-8;
/// Residual, in rad and sizes, of rows that are not met.
const OPEN: f64 = 1e-6;
/// Newton steps before a position counts as not reached.
const STEPS: usize = 12;

impl<'m, G: Space<S = f64>> Driven<'m, G> {
    /// A solver that begins at the assembled start.
    #[must_use]
    pub fn new(mechanism: &'m Mechanism<G>, start: &Assembled) -> Self {
        let (nv, rows) = (mechanism.nv, mechanism.rows.len());
        let mut dynamics = Dynamics::new(mechanism);
        dynamics.time(0.0, &start.modes);
        dynamics.position(&start.q, &start.modes);
        let g_scale = dynamics.row_scale(&start.q, &start.modes, &start.metric);
        let friction_by_reactions = ByReactions::new(&dynamics, &start.metric, &g_scale);
        let solver = if rows == nv {
            let size = |row: &[f64]| row.iter().map(|x| x * x).sum::<f64>().sqrt();
            // a row that is round-off keeps its natural size, so that it leaves G as singular as it is
            let unit = |(row, natural): (&[f64], &[f64])| match size(row).max(ROUND_OFF * size(natural)) {
                0.0 => 1.0,
                least if least > size(row) => size(natural).recip(),
                _ => size(row).recip(),
            };
            let natural = dynamics.natural();
            let rows = dynamics.work.g.lines().zip(natural.lines());
            let scale = rows.map(|(row, natural)| unit((row.values, natural.values))).collect();
            Solver::Square(Square::new(dynamics.work.g.pattern(), scale))
        } else {
            // of a motion that is given, bodies without inertia are no exception
            let mut kkt = Kkt::of_blocks(dynamics.work.mass.pattern(), dynamics.work.g.pattern()).with_pivots();
            kkt.set_scale(&start.metric, &g_scale);
            let weakest = weakest(&mut kkt, &start.metric, &g_scale, &dynamics.work.g);
            kkt.set_weakest(weakest);
            let mut metric = Box::new(Block::new(dynamics.work.mass.pattern()));
            start.metric.iter().enumerate().for_each(|(i, d)| metric.set(i, i, *d));
            // a force in no special direction
            let probe = start.metric.iter().enumerate().map(|(i, d)| d.sqrt() * (1.0 + 0.37 * (i as f64 * 2.39).sin())).collect();
            Solver::Redundant { kkt: Box::new(kkt), metric, probe }
        };
        let unit = super::assemble::units(mechanism).iter().map(|u| if *u == 0 { 1.0 } else { start.size.recip() }).collect();
        let row_unit = mechanism.rows.iter().map(|row| if row.angular { 1.0 } else { start.size.recip() }).collect();
        let reactions = dynamics.reactions();
        Self {
            dynamics,
            q: start.q.clone(),
            v: start.v.clone(),
            a: vec![0.0; nv],
            lambda: vec![0.0; rows],
            reactions,
            correction: 0.0,
            open: None,
            solver,
            friction_by_reactions,
            unit,
            row_unit,
            delta: vec![0.0; nv],
            rhs: vec![0.0; rows],
            scratch: vec![0.0; rows],
            zeros: vec![0.0; nv],
        }
    }

    /// Newton's method from `self.q` at time `t` in given modes; leaves the factorisation of G at the solution.
    ///
    /// # Errors
    /// If it does not converge, or G is singular on the way.
    pub fn position(&mut self, t: f64, modes: &[i32]) -> Result<(), NotReached> {
        self.dynamics.time(t, modes);
        self.newton(|dynamics, q, delta| match delta {
            Some(delta) => dynamics.nudge(q, delta, modes),
            None => dynamics.position(q, modes),
        })
    }

    /// [`Driven::position`] with modes of driver laws and functions of position taken from the values, in each step anew.
    ///
    /// # Errors
    /// As there.
    pub fn follow(&mut self, t: f64, modes: &mut [i32]) -> Result<(), NotReached> {
        self.dynamics.follow_time(t, modes);
        self.newton(|dynamics, q, delta| {
            match delta {
                Some(delta) => dynamics.nudge(q, delta, modes),
                None => dynamics.position(q, modes),
            }
            dynamics.follow_position(modes);
        })
    }

    /// Newton's method; `place` evaluates a position, or one that a small displacement has led to.
    fn newton(&mut self, mut place: impl FnMut(&mut Dynamics<'m, G>, &[f64], Option<&[f64]>)) -> Result<(), NotReached> {
        self.correction = 0.0;
        self.open = None;
        let mut last = f64::INFINITY;
        for step in 0..STEPS {
            if last < QUADRATIC {
                place(&mut self.dynamics, &self.q, Some(&self.delta));
                let left = self.dynamics.work.phi.iter().zip(&self.row_unit).map(|(phi, unit)| phi.abs() * unit);
                let most = left.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
                self.open = most.filter(|(_, left)| *left > OPEN).map(|(row, _)| row);
                return if self.open.is_some() { Err(NotReached) } else { self.factor() };
            }
            place(&mut self.dynamics, &self.q, None);
            self.factor()?;
            for (r, phi) in self.rhs.iter_mut().zip(&self.dynamics.work.phi) {
                *r = -phi;
            }
            self.solver.solve(&self.zeros, &self.rhs, &mut self.delta, &mut self.scratch);
            let size = self.delta.iter().zip(&self.unit).map(|(d, u)| (d * u).abs()).fold(0.0, f64::max);
            // growing, or turning by more than a quarter: this is not the neighbourhood of a solution
            if !size.is_finite() || size > 1.5 || (step > 2 && size > last) {
                return Err(NotReached);
            }
            self.correction += size;
            self.dynamics.mechanism.retract(&mut self.q, &self.delta);
            last = size;
        }
        Err(NotReached)
    }

    /// Velocities and accelerations at the position found last, with the driver laws of `modes`.
    pub fn rates(&mut self, modes: &[i32]) {
        self.rhs.copy_from_slice(&self.dynamics.work.nu);
        self.solver.solve(&self.zeros, &self.rhs, &mut self.v, &mut self.scratch);
        self.dynamics.velocity(&self.v, modes);
        self.rhs.copy_from_slice(&self.dynamics.work.gamma);
        self.solver.solve(&self.zeros, &self.rhs, &mut self.a, &mut self.scratch);
    }

    /// Forces, multipliers and reactions for the motion found last.
    ///
    /// Multipliers are not numbers where friction by reactions has no solution.
    pub fn forces(&mut self, modes: &[i32]) {
        if let Some(friction_by_reactions) = &mut self.friction_by_reactions {
            friction_by_reactions.solve(&mut self.dynamics, &self.a, &mut self.lambda, modes);
            self.dynamics.apply_friction(&self.lambda);
            self.dynamics.accelerate(&self.a, &mut self.reactions.accelerations);
            self.dynamics.unbalanced(&self.a, &self.reactions.accelerations, &mut self.delta);
            return self.dynamics.distribute(&self.a, &self.lambda, &mut self.reactions);
        }
        match &mut self.solver {
            Solver::Square(square) => {
                // λ = G⁻ᵀ (f − M a), G as factored in `position`; M itself is not needed
                self.dynamics.loads(modes);
                self.dynamics.accelerate(&self.a, &mut self.reactions.accelerations);
                self.dynamics.unbalanced(&self.a, &self.reactions.accelerations, &mut self.lambda);
                square.solve_transposed(&mut self.lambda);
            }
            Solver::Redundant { kkt, .. } => {
                self.dynamics.forces(modes);
                self.dynamics.mass();
                let work = &self.dynamics.work;
                if kkt.factor(work.mass.values(), work.g.values()).is_ok() {
                    kkt.solve(&work.force, &work.gamma, &mut self.delta, &mut self.lambda);
                }
                self.dynamics.accelerate(&self.a, &mut self.reactions.accelerations);
                self.dynamics.unbalanced(&self.a, &self.reactions.accelerations, &mut self.delta);
            }
        }
        self.dynamics.distribute(&self.a, &self.lambda, &mut self.reactions);
    }

    /// Forces with the modes of the sides on which joints press taken from the reactions, beginning with those at hand.
    pub fn press(&mut self, modes: &mut [i32]) {
        for _ in 0..4 * self.dynamics.mechanism.sides().count() {
            self.forces(modes);
            let Some((_, mode)) = self.pressed().find(|(n, _)| *n < 0.0) else { return };
            modes[mode] = if modes[mode] < 0 { 1 } else { -1 };
        }
        if self.friction_by_reactions.is_some() {
            self.forces(modes);
        }
    }

    /// How far the force on each place that presses to one side is from changing it, N, with its mode; for the forces found last.
    pub fn pressed(&self) -> impl Iterator<Item = (f64, usize)> {
        let slack = self.friction_by_reactions.as_ref().map_or(0.0, |r| slack(&r.metric, &self.a, &self.lambda));
        self.dynamics.pressed(&self.lambda).map(move |(n, mode)| (n + slack, mode))
    }

    /// Whether the forces found last obey no law of friction: there are none, or a joint presses on the other side than it seems to.
    #[must_use]
    pub fn jams(&self) -> bool {
        self.friction_by_reactions.is_some()
            && (self.a.iter().all(|a| a.is_finite()) && self.lambda.iter().any(|l| l.is_nan()) || self.pressed().any(|(n, _)| n < 0.0))
    }

    /// Factors G as evaluated last.
    fn factor(&mut self) -> Result<(), NotReached> {
        let g = &self.dynamics.work.g;
        match &mut self.solver {
            Solver::Square(square) => square.factor(g).map_err(|_| NotReached),
            Solver::Redundant { kkt, metric, .. } => kkt.factor(metric.values(), g.values()).map_err(|_| NotReached),
        }
    }

    /// How far the position found last is from a singular one: near 0 there, up to 1 elsewhere.
    ///
    /// Square: the ratio of the smallest to the largest pivot. Redundant: a force makes a free motion a ~ f/D where G has a null
    /// space, and one of (1e-8/σ²)³ after the solver's two refinements elsewhere; σ comes from that.
    pub fn condition(&mut self) -> f64 {
        match &mut self.solver {
            Solver::Square(square) => square.pivot_ratio(),
            Solver::Redundant { kkt, metric, probe } => {
                self.rhs.fill(0.0);
                kkt.solve(probe, &self.rhs, &mut self.delta, &mut self.scratch);
                let weight = |x: f64, i: usize| x * x * metric.at(i, i);
                let moved: f64 = self.delta.iter().enumerate().map(|(i, x)| weight(*x, i)).sum();
                let asked: f64 = probe.iter().enumerate().map(|(i, f)| f * f / metric.at(i, i)).sum();
                let ratio = (moved / asked).sqrt();
                // within a factor of the regularisation nothing is left to tell apart
                if ratio > 1e-3 { 0.0 } else { 1.0 }
            }
        }
    }

    /// The logarithm of something that vanishes in a singular position alone, beside it in proportion to the distance.
    ///
    /// Square: |det G|. Redundant: the smallest singular value that moves, down to 1e-4, by three inverse iterations.
    pub fn regularity(&mut self) -> f64 {
        match &mut self.solver {
            Solver::Square(square) => square.log_determinant(),
            Solver::Redundant { kkt, .. } => {
                self.rhs.fill(0.0);
                (0..3).fold(0.0, |_, _| kkt.smallest_singular_value_that_moves(&mut self.rhs)).ln()
            }
        }
    }

    /// The sign of det G at the position found last; 0 where rows are redundant.
    pub(super) fn side(&self) -> f64 {
        match &self.solver {
            Solver::Square(square) => square.determinant_sign(),
            Solver::Redundant { .. } => 0.0,
        }
    }

    /// What a residual of each row counts by: rad, and sizes.
    pub(super) fn row_unit(&self) -> &[f64] {
        &self.row_unit
    }

    /// Largest component of a displacement in units of angles and of the mechanism's size.
    #[must_use]
    pub fn measure(&self, delta: &[f64]) -> f64 {
        delta.iter().zip(&self.unit).map(|(d, u)| (d * u).abs()).fold(0.0, f64::max)
    }
}

impl ByReactions {
    fn new<G: Space<S = f64>>(dynamics: &Dynamics<'_, G>, metric: &[f64], g_scale: &[f64]) -> Option<Box<Self>> {
        let (m, w) = (dynamics.mechanism, &dynamics.work);
        let dims = Dims { q: m.nq, v: m.nv, holonomic: m.rows.len(), ..Dims::default() };
        let pattern = Pattern {
            mass: w.mass.pattern().clone(),
            g: w.g.pattern().clone(),
            r_lambda: friction_pattern(m),
            metric: metric.to_vec(),
            g_scale: g_scale.to_vec(),
            vector_scale: dynamics.vector_scale(g_scale),
            ..Pattern::dense(dims)
        };
        let friction = Friction::of_pattern(dims, &pattern)?;
        Some(Box::new(Self { friction, terms: Terms::new(dims, &pattern), a: vec![0.0; m.nv], metric: metric.to_vec() }))
    }

    /// λ at the position and velocity evaluated last; not numbers where there is none.
    fn solve<G: Space<S = f64>>(&mut self, dynamics: &mut Dynamics<'_, G>, a: &[f64], lambda: &mut [f64], modes: &[i32]) {
        dynamics.forces(modes);
        dynamics.mass();
        let (t, w) = (&mut self.terms, &dynamics.work);
        t.mass.values_mut().copy_from_slice(w.mass.values());
        t.g.values_mut().copy_from_slice(w.g.values());
        t.force.copy_from_slice(&w.force);
        t.gamma.copy_from_slice(&w.gamma);
        self.a.copy_from_slice(a);
        lambda.fill(0.0);
        let friction_of = &mut |l: &[f64], f: &mut [f64], slope: &mut Block| dynamics.friction(l, f, slope);
        if self.friction.solve(t, friction_of, &mut self.a, lambda).is_err() {
            lambda.fill(f64::NAN);
        }
    }
}

impl Solver {
    /// G x = `rhs` (of least size in the metric where rows are redundant).
    fn solve(&mut self, zeros: &[f64], rhs: &[f64], x: &mut [f64], scratch: &mut [f64]) {
        match self {
            Self::Square(square) => square.solve(rhs, x),
            Self::Redundant { kkt, .. } => kkt.solve(zeros, rhs, x, scratch),
        }
    }
}
