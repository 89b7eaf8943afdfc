//! Linkages with closed forms: the slider-crank, the N four-bar and its twin of one freedom, and a chain of rods.

use super::base::{Base, Problem, clear, scaled};
use super::elliptic;
use super::linkage::{Joint, Linkage};
use grashof_solvers::{At, Dims, Effect, Pattern, Stage, State, System, Tangent, Terms};
use std::f64::consts::{FRAC_PI_2, PI};

/// Gravity (m/s²).
const GRAVITY: f64 = 9.81;

/// Mass and inertia of a thin uniform rod.
fn rod(mass: f64, length: f64) -> [f64; 2] {
    [mass, mass * length * length / 12.0]
}

/// A rigid slider-crank without gravity, running free: φ̇² M(φ) is constant. Crank and rod are thin uniform rods; the slider
/// runs on the x axis through the pivot. Nine coordinates, eight rows.
#[derive(Clone, Debug)]
pub(crate) struct SliderCrank {
    inner: Linkage,
    crank: f64,
    rod: f64,
    masses: [f64; 3],
}

impl SliderCrank {
    /// Time from 45° to the singular position at 90° of [`equal_arms`](Self::equal_arms) (s); reference
    /// `slider_crank_singular.json`, 18 digits.
    pub(crate) const EQUAL_ARMS_TO_90: f64 = 0.965_061_291_255_087_9;
    /// Time of a revolution of [`equal_arms`](Self::equal_arms) (s); same source.
    pub(crate) const EQUAL_ARMS_TURN: f64 = 5.958_711_782_735_61;
    /// t, φ, φ̇ and slider position of [`equal_arms`](Self::equal_arms); same source.
    pub(crate) const EQUAL_ARMS: [[f64; 4]; 4] = [
        [0.5, 1.219_443_953_532_711, 0.784_620_986_182_669_6, 0.688_335_752_086_279_6],
        [1.0, 1.596_710_176_854_394_3, 0.741_844_008_335_830_6, -0.051_821_899_691_695_22],
        [2.0, 2.428_234_829_106_999_6, 1.064_478_568_560_347_3, -1.512_337_722_905_995],
        [5.0, 5.592_029_858_056_958, 1.086_766_407_367_075, 1.541_020_028_002_429_7],
    ];

    /// Crank and rod lengths, masses of crank, rod and slider, crank angle and rate at t = 0.
    pub(crate) fn new(crank: f64, rod: f64, masses: [f64; 3], phi: f64, rate: f64) -> Self {
        Self::with_noise(crank, rod, masses, phi, rate, 0.0)
    }

    /// Crank and rod of 1 m, 1 kg each and the slider, from 45° at 1 rad/s: at 90° a second branch crosses.
    pub(crate) fn equal_arms(noise: f64) -> Self {
        Self::with_noise(1.0, 1.0, [1.0; 3], 0.25 * PI, 1.0, noise)
    }

    fn with_noise(r: f64, l: f64, masses: [f64; 3], phi: f64, rate: f64, noise: f64) -> Self {
        let bodies = vec![rod(masses[0], r), rod(masses[1], l), [masses[2], 1.0]];
        let joints = vec![
            Joint::Ground((0, [-0.5 * r, 0.0]), [0.0, 0.0]),
            Joint::Pin((0, [0.5 * r, 0.0]), (1, [-0.5 * l, 0.0])),
            Joint::Pin((1, [0.5 * l, 0.0]), (2, [0.0, 0.0])),
            Joint::Slide(2),
        ];
        let [theta, theta1, x, x1] = rod_and_slider(r, l, phi);
        let ((s, c), (ts, tc)) = (phi.sin_cos(), theta.sin_cos());
        let q = vec![0.5 * r * c, 0.5 * r * s, phi, r * c + 0.5 * l * tc, r * s + 0.5 * l * ts, theta, x, 0.0, 0.0];
        let (rod_x, rod_y) = (-r * s - 0.5 * l * ts * theta1, r * c + 0.5 * l * tc * theta1);
        let slopes = [-0.5 * r * s, 0.5 * r * c, 1.0, rod_x, rod_y, theta1, x1, 0.0, 0.0];
        let v = slopes.iter().map(|slope| slope * rate).collect();
        Self { inner: Linkage::new(bodies, joints, 0.0, noise, q, v), crank: r, rod: l, masses }
    }

    /// M(φ): twice the kinetic energy at φ̇ = 1 (kg·m²).
    pub(crate) fn inertia(&self, phi: f64) -> f64 {
        let (r, l, [crank, rod, slider]) = (self.crank, self.rod, self.masses);
        let [theta, theta1, _, x1] = rod_and_slider(r, l, phi);
        let ((s, c), (ts, tc)) = (phi.sin_cos(), theta.sin_cos());
        let (rod_x, rod_y) = (-r * s - 0.5 * l * ts * theta1, r * c + 0.5 * l * tc * theta1);
        crank * r * r / 3.0 + rod * (rod_x * rod_x + rod_y * rod_y + l * l * theta1 * theta1 / 12.0) + slider * x1 * x1
    }

    /// φ̇ at the angle φ, from the start's φ̇² M(φ).
    pub(crate) fn rate_at(&self, phi: f64) -> f64 {
        let start = self.start();
        start.v[2] * (self.inertia(start.q[2]) / self.inertia(phi)).sqrt()
    }
}

/// Rod angle θ and slider position x with their derivatives by φ: θ, θ′, x, x′. With equal arms the branch θ = −φ.
fn rod_and_slider(r: f64, l: f64, phi: f64) -> [f64; 4] {
    let (s, c) = phi.sin_cos();
    let theta = if r == l { -phi } else { -(r / l * s).asin() };
    let theta1 = if r == l { -1.0 } else { -r * c / (l * theta.cos()) };
    [theta, theta1, r * c + l * theta.cos(), -r * s - l * theta.sin() * theta1]
}

delegate!(SliderCrank);

/// N four-bars in a row, all rods 1 m and 1 kg: links from (i, 0), i = 0..N, upright at 1 rad/s clockwise, couplers between their
/// tips. IFToMM benchmark A02. At φ = π/2 and 3π/2 N ranks are lost; the closed form goes on with all links parallel.
///
/// Bodies: link 0, then coupler i and link i for i = 1..N.
#[derive(Clone, Debug)]
pub(crate) struct NFourBar {
    inner: Linkage,
    n: usize,
}

impl NFourBar {
    /// `noise` is the amplitude of what is added to Φ and γ.
    pub(crate) fn new(n: usize, noise: f64) -> Self {
        let (mut joints, low, high) = (vec![Joint::Ground((0, [-0.5, 0.0]), [0.0, 0.0])], [-0.5, 0.0], [0.5, 0.0]);
        let (mut q, mut v) = (vec![0.0, 0.5, FRAC_PI_2], vec![0.5, 0.0, -1.0]);
        for i in 1..=n {
            let (coupler, link) = (2 * i - 1, 2 * i);
            // the tip of the link before this one is its local (½, 0)
            joints.push(Joint::Pin((coupler - 1, high), (coupler, low)));
            joints.push(Joint::Pin((coupler, high), (link, high)));
            joints.push(Joint::Ground((link, low), [i as f64, 0.0]));
            q.extend([i as f64 - 0.5, 1.0, 0.0, i as f64, 0.5, FRAC_PI_2]);
            v.extend([1.0, 0.0, 0.0, 0.5, 0.0, -1.0]);
        }
        Self { inner: Linkage::new(vec![rod(1.0, 1.0); 2 * n + 1], joints, GRAVITY, noise, q, v), n }
    }

    /// ω² of φ″ = ω² sin φ, φ from upright, clockwise.
    pub(crate) fn omega_squared(n: usize) -> f64 {
        1.5 * GRAVITY * (3 * n + 1) as f64 / (4 * n + 1) as f64
    }

    /// φ and φ̇ at t: φ = π + 2 am(√(1 + 4ω²) t/2 − K(m) | m), m = 4ω²/(1 + 4ω²).
    pub(crate) fn exact(n: usize, t: f64) -> [f64; 2] {
        let square = 4.0 * Self::omega_squared(n);
        let (root, m1) = ((1.0 + square).sqrt(), 1.0 / (1.0 + square));
        let phi = PI + 2.0 * elliptic::am(0.5 * root * t - elliptic::k(m1), m1);
        [phi, (1.0 + square * (0.5 * phi).sin().powi(2)).sqrt()]
    }

    /// Time of a turn (s): 4 K(m)/√(1 + 4ω²).
    pub(crate) fn turn(n: usize) -> f64 {
        let square = 4.0 * Self::omega_squared(n);
        4.0 * elliptic::k(1.0 / (1.0 + square)) / (1.0 + square).sqrt()
    }

    /// φ of each link, 0 to N, from the coordinates.
    pub(crate) fn angles(&self, q: &[f64]) -> Vec<f64> {
        (0..=self.n).map(|i| FRAC_PI_2 - q[6 * i + 2]).collect()
    }

    /// n, t and the tip B₀ of the first link; reference `iftomm_a02_n_four_bar.json`, 18 digits.
    pub(crate) const TIPS: [(usize, f64, [f64; 2]); 3] = [
        (1, 10.0, [0.478_385_057_760_970_54, 0.878_150_178_791_209_3]),
        (2, 10.0, [0.328_458_111_540_815_4, 0.944_518_538_178_601]),
        (40, 20.0, [0.410_901_153_762_945_2, 0.911_679_900_971_980_7]),
    ];

    /// n, time of a turn, of the first and of the second flat position (s); same source.
    pub(crate) const TIMES: [(usize, [f64; 3]); 3] = [
        (1, [1.923_711_817_338_965_9, 0.708_450_008_835_758_9, 1.215_261_808_503_207]),
        (2, [1.942_514_922_607_083_7, 0.714_355_529_292_960_5, 1.228_159_393_314_123_2]),
        (40, [1.965_601_928_704_650_4, 0.721_581_024_825_656_8, 1.244_020_903_878_993_6]),
    ];
}

delegate!(NFourBar);

/// The N four-bar without constraints: q = φ, φ″ = ω² sin φ; closed form [`NFourBar::exact`].
#[derive(Clone, Debug)]
pub(crate) struct FourBarTwin {
    base: Base,
    square: f64,
}

impl FourBarTwin {
    /// The twin of [`NFourBar::new`].
    pub(crate) fn new(n: usize) -> Self {
        let dims = Dims { q: 1, v: 1, ..Dims::default() };
        scaled(Self { base: Base::new(dims), square: NFourBar::omega_squared(n) }, |p| &mut p.base, &[0])
    }
}

impl System for FourBarTwin {
    stored!();
    vectors!();
    conservative!();
    smooth!();

    fn terms(&mut self, at: At<'_>, stage: Stage, out: &mut Terms) {
        out.mass.values_mut()[0] = 1.0;
        if stage >= Stage::Dynamics {
            out.force[0] = self.square * at.q[0].sin();
        }
    }

    fn tangent(&mut self, at: At<'_>, _: &[f64], _: &[f64], out: &mut Tangent) {
        clear(out);
        out.k.values_mut()[0] = -self.square * at.q[0].cos();
    }
}

impl Problem for FourBarTwin {
    fn start(&self) -> State {
        State { v: vec![1.0], ..State::new(self.base.dims) }
    }

    fn energy(&self, state: &State) -> f64 {
        0.5 * state.v[0] * state.v[0] + self.square * state.q[0].cos()
    }
}

/// A chain of thin uniform rods, 1 m and 1 kg together, hanging on one end, released at rest along +x: 3n coordinates, 2n rows.
#[derive(Clone, Debug)]
pub(crate) struct RodChain {
    inner: Linkage,
}

impl RodChain {
    /// `n` rods of length and mass 1/n.
    pub(crate) fn new(n: usize) -> Self {
        let length = 1.0 / n as f64;
        let (low, high) = ([-0.5 * length, 0.0], [0.5 * length, 0.0]);
        let pins = (1..n).map(|i| Joint::Pin((i - 1, high), (i, low)));
        let joints = std::iter::once(Joint::Ground((0, low), [0.0, 0.0])).chain(pins).collect();
        let q = (0..n).flat_map(|i| [(i as f64 + 0.5) * length, 0.0, 0.0]).collect();
        Self { inner: Linkage::new(vec![rod(length, length); n], joints, GRAVITY, 0.0, q, vec![0.0; 3 * n]) }
    }
}

delegate!(RodChain);
