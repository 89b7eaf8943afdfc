//! What all problems share: storage, the residual from the terms, vector coordinates, the absence of events, and noise.

use grashof_solvers::kkt::{Kind, metric, row_scale};
use grashof_solvers::{Block, Dims, Pattern, Stage, State, System, Tangent, Terms};

/// A system with a start and an energy.
pub(crate) trait Problem: System {
    /// Consistent initial values.
    fn start(&self) -> State;

    /// Kinetic and potential energy (J); its rate is the sum of [`System::power`].
    fn energy(&self, state: &State) -> f64;

    /// Name of the type, for messages.
    fn name(&self) -> &'static str {
        std::any::type_name::<Self>()
    }
}

/// Sizes, patterns and workspace of a problem.
#[derive(Clone, Debug)]
pub(crate) struct Base {
    pub(crate) dims: Dims,
    pub(crate) pattern: Pattern,
    pub(crate) terms: Terms,
}

impl Base {
    /// Full patterns; scales of one.
    pub(crate) fn new(dims: Dims) -> Self {
        Self { dims, pattern: Pattern::dense(dims), terms: Terms::new(dims, &Pattern::dense(dims)) }
    }
}

/// Gives a problem the scales of its start; `kind` numbers the unit of each velocity (0 an angle, 1 a length).
pub(crate) fn scaled<P: Problem>(mut problem: P, base: impl Fn(&mut P) -> &mut Base, kind: &[usize]) -> P {
    let start = problem.start();
    let mut terms = Terms::new(problem.dims(), problem.pattern());
    problem.terms(start.at(), Stage::Position, &mut terms);
    let pattern = &mut base(&mut problem).pattern;
    let kinds: Vec<Kind> = kind.iter().map(|kind| (0, (*kind == 1).then_some(1.0))).collect();
    pattern.metric = metric((0..kind.len()).map(|i| terms.mass.at(i, i)), &kinds);
    pattern.g_scale = row_scale(&pattern.g, terms.g.values(), &pattern.metric);
    let pattern = pattern.clone();
    let base = base(&mut problem);
    base.terms = Terms::new(base.dims, &pattern);
    problem
}

/// r = M a + Gᵀλ − f.
pub(crate) fn residual(terms: &Terms, a: &[f64], lambda: &[f64], r: &mut [f64]) {
    for ((i, r), mass) in r.iter_mut().enumerate().zip(terms.mass.lines()) {
        let constraints: f64 = lambda.iter().enumerate().map(|(j, l)| terms.g.at(j, i) * l).sum();
        *r = mass.dot(a) + constraints - terms.force[i];
    }
}

/// Sets every block to zero.
pub(crate) fn clear(t: &mut Tangent) {
    for block in [&mut t.k, &mut t.c, &mut t.r_z, &mut t.r_lambda, &mut t.z_q, &mut t.z_v, &mut t.z_z] {
        block.values_mut().fill(0.0);
    }
}

/// A diagonal matrix.
pub(crate) fn diagonal(matrix: &mut Block, values: impl IntoIterator<Item = f64>) {
    matrix.values_mut().fill(0.0);
    values.into_iter().enumerate().for_each(|(i, x)| matrix.set(i, i, x));
}

/// Adds to an entry.
pub(crate) fn add(matrix: &mut Block, i: usize, j: usize, x: f64) {
    matrix.set(i, j, matrix.at(i, j) + x);
}

/// A number in [−1, 1) that depends on the bits of (t, q) and on `salt` alone (the finaliser of MurmurHash3, A. Appleby 2011).
pub(crate) fn noise(t: f64, q: &[f64], salt: usize) -> f64 {
    let mut h = 0x9e37_79b9_7f4a_7c15_u64.wrapping_mul(1 + salt as u64);
    for x in q.iter().chain([&t]) {
        h = (h ^ x.to_bits()).wrapping_mul(0xff51_afd7_ed55_8ccd);
        h = (h ^ (h >> 33)).wrapping_mul(0xc4ce_b9fe_1a85_ec53);
        h ^= h >> 33;
    }
    (h >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// Adds noise of the given amplitude to the rows `out`; Φ and γ take different salts.
pub(crate) fn add_noise(amplitude: f64, t: f64, q: &[f64], salt: usize, out: &mut [f64]) {
    if amplitude != 0.0 {
        out.iter_mut().enumerate().for_each(|(i, x)| *x += amplitude * noise(t, q, 2 * i + salt));
    }
}

/// `dims`, `pattern` and `residual` of a struct with a field `base`.
macro_rules! stored {
    () => {
        fn dims(&self) -> Dims {
            self.base.dims
        }

        fn pattern(&self) -> &Pattern {
            &self.base.pattern
        }

        fn residual(&mut self, at: At<'_>, a: &[f64], lambda: &[f64], r: &mut [f64]) {
            let mut terms = std::mem::take(&mut self.base.terms);
            self.terms(at, Stage::Dynamics, &mut terms);
            $crate::problems::base::residual(&terms, a, lambda, r);
            self.base.terms = terms;
        }
    };
}

/// q̇ = v.
macro_rules! vectors {
    () => {
        fn rate(&self, _: f64, _: &[f64], v: &[f64], qdot: &mut [f64]) {
            qdot.copy_from_slice(v);
        }

        fn retract(&self, _: grashof_solvers::Span, q: &mut [f64], delta: &[f64]) {
            q.iter_mut().zip(delta).for_each(|(q, d)| *q += d);
        }

        fn displace(&self, _: grashof_solvers::Span, q: &mut [f64], u: &[f64]) {
            q.iter_mut().zip(u).for_each(|(q, u)| *q += u);
        }
    };
}

/// Nothing switches and nothing is crossed.
macro_rules! smooth {
    () => {
        fn modes(&mut self, _: At<'_>, _: &mut [i32]) {}

        fn roots(&mut self, _: At<'_>, _: &[f64], _: &[f64], _: &mut [f64]) {}

        fn cross(&mut self, _: usize, _: &mut State, _: &mut [f64]) -> Effect {
            Effect::Record
        }
    };
}

/// Energy is conserved.
macro_rules! conservative {
    () => {
        fn power(&mut self, _: At<'_>, _: &[f64], _: &[f64], _: &mut [f64]) {}
    };
}

/// Everything from the field `inner`.
macro_rules! delegate {
    ($name:ty) => {
        impl System for $name {
            fn dims(&self) -> Dims {
                self.inner.dims()
            }

            fn pattern(&self) -> &Pattern {
                self.inner.pattern()
            }

            fn terms(&mut self, at: At<'_>, stage: Stage, out: &mut Terms) {
                self.inner.terms(at, stage, out);
            }

            fn residual(&mut self, at: At<'_>, a: &[f64], lambda: &[f64], r: &mut [f64]) {
                self.inner.residual(at, a, lambda, r);
            }

            fn tangent(&mut self, at: At<'_>, a: &[f64], lambda: &[f64], out: &mut Tangent) {
                self.inner.tangent(at, a, lambda, out);
            }

            vectors!();
            conservative!();
            smooth!();
        }

        impl Problem for $name {
            fn start(&self) -> State {
                self.inner.start()
            }

            fn energy(&self, state: &State) -> f64 {
                self.inner.energy(state)
            }
        }
    };
}
