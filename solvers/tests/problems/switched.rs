//! Systems of one coordinate, 1 kg, with switches: impacts, dry friction, a kinked force law, and crossings that only stop or note.

use super::base::{Base, Problem, clear, scaled};
use grashof_solvers::{At, Dims, Effect, Pattern, Stage, State, System, Tangent, Terms};
use std::f64::consts::PI;

/// Gravity (m/s²).
const GRAVITY: f64 = 9.81;

fn one(modes: usize, work: usize) -> Base {
    Base::new(Dims { q: 1, v: 1, modes, roots: 1, work, ..Dims::default() })
}

/// A ball that falls from rest and bounces with a coefficient of restitution; q is the height.
///
/// The first impact is at t₁ = √(2h/g) with the speed √(2gh); flight n ≥ 1 lasts 2 eⁿ t₁. Impacts pile up at
/// t₁ (1 + e)/(1 − e).
#[derive(Clone, Debug)]
pub(crate) struct BouncingBall {
    base: Base,
    height: f64,
    restitution: f64,
}

impl BouncingBall {
    /// From the given height (m).
    pub(crate) fn new(height: f64, restitution: f64) -> Self {
        scaled(Self { base: one(0, 0), height, restitution }, |p| &mut p.base, &[1])
    }

    /// Time of impact `n`, counted from 0 (s): t₁ (1 + 2e + … + 2eⁿ).
    pub(crate) fn impact(&self, n: usize) -> f64 {
        let first = (2.0 * self.height / GRAVITY).sqrt();
        first * (1.0 + 2.0 * (1..=n).map(|i| self.restitution.powi(i as i32)).sum::<f64>())
    }

    /// Where impacts accumulate (s); infinite for e = 1.
    pub(crate) fn zeno(&self) -> f64 {
        (2.0 * self.height / GRAVITY).sqrt() * (1.0 + self.restitution) / (1.0 - self.restitution)
    }

    /// Height and velocity at t, for t before [`zeno`](Self::zeno); after an impact at its very instant.
    pub(crate) fn exact(&self, t: f64) -> [f64; 2] {
        let mut n = 0;
        while n < 1000 && self.impact(n) <= t {
            n += 1;
        }
        if n == 0 {
            return [self.height - 0.5 * GRAVITY * t * t, -GRAVITY * t];
        }
        let (flight, up) = (t - self.impact(n - 1), self.restitution.powi(n as i32) * (2.0 * GRAVITY * self.height).sqrt());
        [flight * (up - 0.5 * GRAVITY * flight), up - GRAVITY * flight]
    }
}

impl System for BouncingBall {
    stored!();
    vectors!();
    conservative!();

    fn terms(&mut self, _: At<'_>, stage: Stage, out: &mut Terms) {
        out.mass.values_mut()[0] = 1.0;
        if stage >= Stage::Dynamics {
            out.force[0] = -GRAVITY;
        }
    }

    fn tangent(&mut self, _: At<'_>, _: &[f64], _: &[f64], out: &mut Tangent) {
        clear(out);
    }

    fn modes(&mut self, _: At<'_>, _: &mut [i32]) {}

    fn roots(&mut self, at: At<'_>, _: &[f64], _: &[f64], g: &mut [f64]) {
        g[0] = at.q[0];
    }

    fn cross(&mut self, _: usize, _: &mut State, row: &mut [f64]) -> Effect {
        row[0] = 1.0;
        Effect::Impulse { restitution: self.restitution, stops: false }
    }
}

impl Problem for BouncingBall {
    fn start(&self) -> State {
        State { q: vec![self.height], ..State::new(self.base.dims) }
    }

    fn energy(&self, state: &State) -> f64 {
        0.5 * state.v[0] * state.v[0] + GRAVITY * state.q[0]
    }
}

/// A mass on a spring of 100 N/m with dry friction of 3 N: modes 1 and −1 slide to that side, 0 sticks.
///
/// Each half swing lasts π/ω and is a cosine about ±F/k; it loses 2F/k of the amplitude, until the spring cannot overcome F.
#[derive(Clone, Debug)]
pub(crate) struct DryOscillator {
    base: Base,
    amplitude: f64,
}

impl DryOscillator {
    /// Stiffness (N/m) and friction (N).
    pub(crate) const STIFFNESS: f64 = 100.0;
    /// Friction (N), sliding and sticking alike.
    pub(crate) const FRICTION: f64 = 3.0;
    /// F/k (m).
    const SHIFT: f64 = Self::FRICTION / Self::STIFFNESS;
    /// ω = √(k/m) (rad/s).
    const OMEGA: f64 = 10.0;

    /// Released at rest from `amplitude` (m).
    pub(crate) fn new(amplitude: f64) -> Self {
        scaled(Self { base: one(1, 1), amplitude }, |p| &mut p.base, &[1])
    }

    /// Time of reversal `n`, counted from 1 (s): nπ/ω.
    pub(crate) fn reversal(n: usize) -> f64 {
        n as f64 * PI / Self::OMEGA
    }

    /// Half swings until the mass sticks.
    pub(crate) fn swings(&self) -> usize {
        let mut n = 0;
        while (self.amplitude.abs() - 2.0 * Self::SHIFT * n as f64) > Self::SHIFT {
            n += 1;
        }
        n
    }

    /// Position and velocity at t.
    pub(crate) fn exact(&self, t: f64) -> [f64; 2] {
        let phase = Self::OMEGA * t;
        let n = ((phase / PI) as usize).min(self.swings());
        let (side, size) = (if n.is_multiple_of(2) { 1.0 } else { -1.0 }, self.amplitude.abs() - 2.0 * Self::SHIFT * n as f64);
        let side = side * self.amplitude.signum();
        if n == self.swings() {
            return [side * size, 0.0];
        }
        let (s, c) = (phase - n as f64 * PI).sin_cos();
        [side * (Self::SHIFT + (size - Self::SHIFT) * c), -side * Self::OMEGA * (size - Self::SHIFT) * s]
    }

    /// The mode at rest: where the spring pulls, or 0 if friction holds it; `present` decides at the edge.
    fn mode_at_rest(x: f64, present: i32) -> i32 {
        let excess = Self::STIFFNESS * x.abs() - Self::FRICTION;
        let slides = excess > 0.0 || (excess == 0.0 && present != 0);
        if !slides {
            0
        } else if x > 0.0 {
            -1
        } else {
            1
        }
    }
}

impl System for DryOscillator {
    stored!();
    vectors!();

    fn terms(&mut self, at: At<'_>, stage: Stage, out: &mut Terms) {
        out.mass.values_mut()[0] = 1.0;
        if stage >= Stage::Dynamics {
            let mode = at.modes[0];
            // what sticks carries the spring by friction
            out.force[0] = if mode == 0 { 0.0 } else { -Self::STIFFNESS * at.q[0] - Self::FRICTION * f64::from(mode) };
        }
    }

    fn tangent(&mut self, at: At<'_>, _: &[f64], _: &[f64], out: &mut Tangent) {
        clear(out);
        out.k.values_mut()[0] = if at.modes[0] == 0 { 0.0 } else { Self::STIFFNESS };
    }

    /// Of friction; what sticks does not move, and its force is that of the spring.
    fn power(&mut self, at: At<'_>, _: &[f64], _: &[f64], w: &mut [f64]) {
        let mode = at.modes[0];
        w[0] = at.v[0] * if mode == 0 { Self::STIFFNESS * at.q[0] } else { -Self::FRICTION * f64::from(mode) };
    }

    fn modes(&mut self, at: At<'_>, modes: &mut [i32]) {
        let v = at.v[0];
        modes[0] = if v == 0.0 { Self::mode_at_rest(at.q[0], at.modes[0]) } else { v.signum() as i32 };
    }

    fn roots(&mut self, at: At<'_>, _: &[f64], _: &[f64], g: &mut [f64]) {
        let mode = at.modes[0];
        g[0] = if mode == 0 { Self::FRICTION - Self::STIFFNESS * at.q[0].abs() } else { f64::from(mode) * at.v[0] };
    }

    fn cross(&mut self, _: usize, state: &mut State, _: &mut [f64]) -> Effect {
        state.modes[0] = Self::mode_at_rest(state.q[0], state.modes[0]);
        if state.modes[0] == 0 {
            state.v[0] = 0.0;
        }
        Effect::Restart
    }
}

impl Problem for DryOscillator {
    fn start(&self) -> State {
        let modes = vec![Self::mode_at_rest(self.amplitude, 1)];
        State { q: vec![self.amplitude], modes, ..State::new(self.base.dims) }
    }

    fn energy(&self, state: &State) -> f64 {
        0.5 * (state.v[0] * state.v[0] + Self::STIFFNESS * state.q[0] * state.q[0])
    }
}

/// A mass on a spring whose stiffness is k₁ for x < 0 (mode −1) and k₂ for x > 0 (mode 1): half sines, period π (1/ω₁ + 1/ω₂).
#[derive(Clone, Debug)]
pub(crate) struct KinkedSpring {
    base: Base,
    stiffness: [f64; 2],
}

impl KinkedSpring {
    /// k₁ and k₂ (N/m).
    pub(crate) fn new(negative: f64, positive: f64) -> Self {
        scaled(Self { base: one(1, 0), stiffness: [negative, positive] }, |p| &mut p.base, &[1])
    }

    /// The period (s).
    pub(crate) fn period(&self) -> f64 {
        self.stiffness.iter().map(|k| PI / k.sqrt()).sum()
    }

    /// Position and velocity at t.
    pub(crate) fn exact(&self, t: f64) -> [f64; 2] {
        let [slow, fast] = self.stiffness.map(f64::sqrt);
        let phase = t % self.period();
        let (side, omega, since) = if phase < PI / fast { (1.0, fast, phase) } else { (-1.0, slow, phase - PI / fast) };
        let (s, c) = (omega * since).sin_cos();
        [side * s / omega, side * c]
    }

    fn of(&self, mode: i32) -> f64 {
        self.stiffness[usize::from(mode > 0)]
    }
}

/// The side of `x`; `present` decides at 0.
fn side(x: f64, present: i32) -> i32 {
    if x > 0.0 || (x == 0.0 && present > 0) { 1 } else { -1 }
}

impl System for KinkedSpring {
    stored!();
    vectors!();
    conservative!();

    fn terms(&mut self, at: At<'_>, stage: Stage, out: &mut Terms) {
        out.mass.values_mut()[0] = 1.0;
        if stage >= Stage::Dynamics {
            out.force[0] = -self.of(at.modes[0]) * at.q[0];
        }
    }

    fn tangent(&mut self, at: At<'_>, _: &[f64], _: &[f64], out: &mut Tangent) {
        clear(out);
        out.k.values_mut()[0] = self.of(at.modes[0]);
    }

    fn modes(&mut self, at: At<'_>, modes: &mut [i32]) {
        modes[0] = side(at.q[0], at.modes[0]);
    }

    fn roots(&mut self, at: At<'_>, _: &[f64], _: &[f64], g: &mut [f64]) {
        g[0] = f64::from(at.modes[0]) * at.q[0];
    }

    fn cross(&mut self, _: usize, state: &mut State, _: &mut [f64]) -> Effect {
        state.modes[0] = -state.modes[0];
        Effect::Restart
    }
}

impl Problem for KinkedSpring {
    /// In the middle, to the right at 1 m/s.
    fn start(&self) -> State {
        State { v: vec![1.0], modes: vec![1], ..State::new(self.base.dims) }
    }

    fn energy(&self, state: &State) -> f64 {
        0.5 * (state.v[0] * state.v[0] + self.of(state.modes[0]) * state.q[0] * state.q[0])
    }
}

/// A mass without force until t = ½ s; from then on each evaluation gives a force of the other sign, so that no iteration ends, however short
/// the step.
#[derive(Clone, Debug)]
pub(crate) struct Wavering {
    base: Base,
    force: f64,
}

impl Wavering {
    pub(crate) fn new() -> Self {
        scaled(Self { base: one(0, 0), force: 1e20 }, |p| &mut p.base, &[])
    }
}

impl System for Wavering {
    stored!();
    vectors!();
    smooth!();
    conservative!();

    fn terms(&mut self, at: At<'_>, stage: Stage, out: &mut Terms) {
        out.mass.values_mut()[0] = 1.0;
        if stage >= Stage::Dynamics {
            self.force = -self.force;
            out.force[0] = if at.t > 0.5 { self.force } else { 0.0 };
        }
    }

    fn tangent(&mut self, _: At<'_>, _: &[f64], _: &[f64], out: &mut Tangent) {
        clear(out);
    }
}

impl Problem for Wavering {
    fn start(&self) -> State {
        State { v: vec![1.0], ..State::new(self.base.dims) }
    }

    fn energy(&self, _: &State) -> f64 {
        0.0
    }
}

/// x = sin t, watched at x = c: mode 1 below, −1 above.
#[derive(Clone, Debug)]
pub(crate) struct Gate<const STOP: bool> {
    base: Base,
    at: f64,
}

/// Ends a run where x = c for the first time.
pub(crate) type StopAt = Gate<true>;
/// Notes every passage of x = c, up or down.
pub(crate) type RecordAt = Gate<false>;

impl<const STOP: bool> Gate<STOP> {
    /// The place c in (0, 1).
    pub(crate) fn new(at: f64) -> Self {
        scaled(Self { base: one(1, 0), at }, |p| &mut p.base, &[1])
    }

    /// Time of passage `n`, counted from 0 (s): asin c, π − asin c, and so on every 2π.
    pub(crate) fn passage(&self, n: usize) -> f64 {
        let up = self.at.asin();
        2.0 * PI * (n / 2) as f64 + if n.is_multiple_of(2) { up } else { PI - up }
    }
}

impl<const STOP: bool> System for Gate<STOP> {
    stored!();
    vectors!();
    conservative!();

    fn terms(&mut self, at: At<'_>, stage: Stage, out: &mut Terms) {
        out.mass.values_mut()[0] = 1.0;
        if stage >= Stage::Dynamics {
            out.force[0] = -at.q[0];
        }
    }

    fn tangent(&mut self, _: At<'_>, _: &[f64], _: &[f64], out: &mut Tangent) {
        clear(out);
        out.k.values_mut()[0] = 1.0;
    }

    fn modes(&mut self, at: At<'_>, modes: &mut [i32]) {
        modes[0] = side(self.at - at.q[0], at.modes[0]);
    }

    fn roots(&mut self, at: At<'_>, _: &[f64], _: &[f64], g: &mut [f64]) {
        g[0] = f64::from(at.modes[0]) * (self.at - at.q[0]);
    }

    fn cross(&mut self, _: usize, state: &mut State, _: &mut [f64]) -> Effect {
        state.modes[0] = -state.modes[0];
        if STOP { Effect::Stop } else { Effect::Record }
    }
}

impl<const STOP: bool> Problem for Gate<STOP> {
    fn start(&self) -> State {
        State { v: vec![1.0], modes: vec![1], ..State::new(self.base.dims) }
    }

    fn energy(&self, state: &State) -> f64 {
        0.5 * (state.v[0] * state.v[0] + state.q[0] * state.q[0])
    }
}
