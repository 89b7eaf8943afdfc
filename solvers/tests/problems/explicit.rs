//! The slow twin of every integrator: Runge-Kutta of order 4 (Kutta 1901) with fixed steps on the accelerations of the KKT
//! system, without projection; events by bisection of the step.

use super::base::Problem;
use grashof_solvers::{At, Effect, Kkt, Stage, State, Terms};

/// Workspace.
#[derive(Clone, Debug)]
pub(crate) struct Explicit {
    kkt: Kkt,
    terms: Terms,
    /// Accelerations and multipliers of the last evaluation.
    pub(crate) a: Vec<f64>,
    pub(crate) lambda: Vec<f64>,
}

/// Derivatives of q, v, z and work.
type Slope = [Vec<f64>; 4];

impl Explicit {
    pub(crate) fn new(problem: &mut dyn Problem) -> Self {
        let dims = problem.dims();
        Self {
            kkt: Kkt::of_pattern(problem.pattern()),
            terms: Terms::new(dims, problem.pattern()),
            a: vec![0.0; dims.v],
            lambda: vec![0.0; dims.rows()],
        }
    }

    /// Evaluates a and λ.
    pub(crate) fn accelerate(&mut self, problem: &mut dyn Problem, at: At<'_>) {
        problem.terms(at, Stage::Dynamics, &mut self.terms);
        self.kkt.factor(self.terms.mass.values(), self.terms.g.values()).expect("regular");
        self.kkt.solve(&self.terms.force, &self.terms.gamma, &mut self.a, &mut self.lambda);
    }

    /// Adds to v the shortest change with G v = ν.
    pub(crate) fn project_velocity(&mut self, problem: &mut dyn Problem, state: &mut State) {
        problem.terms(state.at(), Stage::Velocity, &mut self.terms);
        self.kkt.factor(self.terms.mass.values(), self.terms.g.values()).expect("regular");
        let n = state.v.len();
        let miss: Vec<f64> = self.terms.g.lines().zip(&self.terms.nu).map(|(row, nu)| nu - row.dot(&state.v)).collect();
        self.kkt.solve(&vec![0.0; n], &miss, &mut self.a, &mut self.lambda);
        state.v.iter_mut().zip(&self.a).for_each(|(v, d)| *v += d);
    }

    fn slope(&mut self, problem: &mut dyn Problem, state: &State) -> Slope {
        self.accelerate(problem, state.at());
        let (mut qdot, mut power) = (vec![0.0; state.q.len()], vec![0.0; state.work.len()]);
        problem.rate(state.t, &state.q, &state.v, &mut qdot);
        problem.power(state.at(), &self.a, &self.lambda, &mut power);
        [qdot, self.a.clone(), self.terms.zdot.clone(), power]
    }

    /// One step of size h.
    pub(crate) fn step(&mut self, problem: &mut dyn Problem, state: &State, h: f64) -> State {
        let k1 = self.slope(problem, state);
        let k2 = self.slope(problem, &moved(state, 0.5 * h, &k1));
        let k3 = self.slope(problem, &moved(state, 0.5 * h, &k2));
        let k4 = self.slope(problem, &moved(state, h, &k3));
        let middle = [0, 1, 2, 3].map(|i| mix(&k2[i], &k3[i], 0.5, 0.5));
        let outer = [0, 1, 2, 3].map(|i| mix(&k1[i], &k4[i], 0.5, 0.5));
        moved(state, h, &[0, 1, 2, 3].map(|i| mix(&middle[i], &outer[i], 2.0 / 3.0, 1.0 / 3.0)))
    }

    /// `steps` equal steps from `state` to `end`; leaves a and λ of the end.
    pub(crate) fn run(&mut self, problem: &mut dyn Problem, state: &mut State, end: f64, steps: usize) {
        let h = (end - state.t) / steps as f64;
        for _ in 0..steps {
            *state = self.step(problem, state, h);
        }
        self.accelerate(problem, state.at());
    }

    /// As `run` with steps of about `h` and events; returns their times. Ends early at [`Effect::Stop`].
    pub(crate) fn run_with_events(&mut self, problem: &mut dyn Problem, state: &mut State, end: f64, h: f64) -> Vec<f64> {
        let mut events = Vec::new();
        while state.t < end - 1e-3 * h {
            let h = h.min(end - state.t);
            let mut next = self.step(problem, state, h);
            let Some(root) = self.crossed(problem, &next) else {
                *state = next;
                continue;
            };
            let (mut low, mut high) = (0.0, h);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                let trial = self.step(problem, state, middle);
                if self.crossed(problem, &trial).is_some() {
                    (high, next) = (middle, trial);
                } else {
                    low = middle;
                }
            }
            *state = next;
            events.push(state.t);
            let mut row = vec![0.0; state.v.len()];
            match problem.cross(root, state, &mut row) {
                Effect::Stop => break,
                Effect::Impulse { restitution, .. } | Effect::Bounce { restitution, .. } => self.strike(problem, state, &row, restitution),
                Effect::Record | Effect::Restart => {}
            }
        }
        events
    }

    /// The first root that is negative.
    fn crossed(&mut self, problem: &mut dyn Problem, state: &State) -> Option<usize> {
        let mut roots = vec![0.0; problem.dims().roots];
        self.accelerate(problem, state.at());
        problem.roots(state.at(), &self.a, &self.lambda, &mut roots);
        roots.iter().position(|g| *g < 0.0)
    }

    /// v += M⁻¹ row s with row·v⁺ = −e row·v⁻; for systems without constraint rows.
    fn strike(&mut self, problem: &mut dyn Problem, state: &mut State, row: &[f64], restitution: f64) {
        self.accelerate(problem, state.at());
        let mut response = vec![0.0; row.len()];
        self.kkt.solve(row, &vec![0.0; self.lambda.len()], &mut response, &mut self.lambda);
        let size = -(1.0 + restitution) * dot(row, &state.v) / dot(row, &response);
        state.v.iter_mut().zip(&response).for_each(|(v, r)| *v += size * r);
    }
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

/// a x + b y.
fn mix(x: &[f64], y: &[f64], a: f64, b: f64) -> Vec<f64> {
    x.iter().zip(y).map(|(x, y)| a * x + b * y).collect()
}

fn moved(state: &State, h: f64, slope: &Slope) -> State {
    let [q, v, z, work] = slope;
    State {
        t: state.t + h,
        q: mix(&state.q, q, 1.0, h),
        v: mix(&state.v, v, 1.0, h),
        z: mix(&state.z, z, 1.0, h),
        work: mix(&state.work, work, 1.0, h),
        ..state.clone()
    }
}
