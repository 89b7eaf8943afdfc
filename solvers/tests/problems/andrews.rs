//! Andrews' squeezing mechanism in seven angles with six closure rows: Test Set for IVP Solvers (Mazzia & Magherini 2008)
//! and IFToMM benchmark A03, which starts from a rounded angle.
//!
//! With e(α) = (cos α, sin α), n(α) = (−sin α, cos α) and the angles q = (β, Θ, γ, Φ, δ, Ω, ε):
//!
//! ```text
//! E = 0.007 e(β) − 0.028 e(β+Θ)                 rows 1, 2: E − (B − 0.035 n(γ))
//!                                               rows 3, 4: E − (A + 0.04 e(δ) − 0.02 n(Φ+δ))
//!                                               rows 5, 6: E − (A − 0.04 n(ε) + 0.02 e(Ω+ε))
//! ```
//!
//! Three pairs of links hang on the frame, each with the absolute angle α of the first and the relative angle ψ of the second:
//! with the inertias I₁, I₂ about the two joints and h(ψ) the product of mass, length and mass-centre distance times the cosine
//! of the angle between,
//!
//! ```text
//! T = ½ I₁ α̇² + ½ I₂ (α̇+ψ̇)² + h(ψ) α̇ (α̇+ψ̇)
//! ```

use super::base::{Base, Problem, clear, scaled};
use grashof_solvers::{At, Dims, Effect, Pattern, Stage, State, System, Tangent, Terms};
use std::f64::consts::FRAC_PI_2;

/// Ground points (m).
const A: [f64; 2] = [-0.06934, -0.00227];
const B: [f64; 2] = [-0.03635, 0.03273];
const C: [f64; 2] = [0.014, 0.072];
/// Spring from D on K3 to C: stiffness (N/m), rest length (m).
const STIFFNESS: f64 = 4530.0;
const REST: f64 = 0.07785;
/// D in the frame of K3 (m).
const D: [f64; 2] = [0.02, -0.018];
/// Torque on K1 (N·m).
const TORQUE: f64 = 0.033;
/// Inertia of K3 about B (kg·m²).
const INERTIA_3: f64 = 5.255e-6 + 0.02373 * (0.01043 * 0.01043 + 0.01874 * 0.01874);
/// Index of γ.
const GAMMA: usize = 2;

/// Two links in a row.
struct Pair {
    /// Indices of α and ψ.
    alpha: usize,
    psi: usize,
    /// Inertia of the first link about its joint with the mass of the second at its end (kg·m²).
    first: f64,
    /// Inertia of the second link about the joint between (kg·m²).
    second: f64,
    /// h = product · cos(ψ + shift) (kg·m²).
    product: f64,
    shift: f64,
}

/// K1 and K2; K5 and K4; K7 and K6. Distance of a mass centre from the joint between: 0.0115; 0.02 − 0.01421, twice.
const PAIRS: [Pair; 3] = [
    Pair {
        alpha: 0,
        psi: 1,
        first: 2.194e-6 + 0.04325 * 0.00092 * 0.00092 + 0.00365 * 0.007 * 0.007,
        second: 4.41e-7 + 0.00365 * 0.0115 * 0.0115,
        product: -0.00365 * 0.007 * 0.0115,
        shift: 0.0,
    },
    Pair {
        alpha: 4,
        psi: 3,
        first: 1.169e-5 + 0.0705 * (0.02308 * 0.02308 + 0.00916 * 0.00916) + 0.00706 * 0.04 * 0.04,
        second: 5.667e-7 + 0.00706 * 0.00579 * 0.00579,
        product: -0.00706 * 0.04 * 0.00579,
        shift: FRAC_PI_2,
    },
    Pair {
        alpha: 6,
        psi: 5,
        first: 1.912e-5 + 0.05498 * (0.00449 * 0.00449 + 0.01228 * 0.01228) + 0.00706 * 0.04 * 0.04,
        second: 5.667e-7 + 0.00706 * 0.00579 * 0.00579,
        product: -0.00706 * 0.04 * 0.00579,
        shift: -FRAC_PI_2,
    },
];

/// A term of a closure: length · e(sum of the angles + shift), in the rows 2·block and 2·block + 1.
struct Arm {
    blocks: &'static [(usize, f64)],
    angles: &'static [usize],
    length: f64,
    shift: f64,
}

const ARMS: [Arm; 7] = [
    Arm { blocks: &[(0, 1.0), (1, 1.0), (2, 1.0)], angles: &[0], length: 0.007, shift: 0.0 },
    Arm { blocks: &[(0, 1.0), (1, 1.0), (2, 1.0)], angles: &[0, 1], length: -0.028, shift: 0.0 },
    Arm { blocks: &[(0, -1.0)], angles: &[2], length: -0.035, shift: FRAC_PI_2 },
    Arm { blocks: &[(1, -1.0)], angles: &[4], length: 0.04, shift: 0.0 },
    Arm { blocks: &[(1, -1.0)], angles: &[3, 4], length: -0.02, shift: FRAC_PI_2 },
    Arm { blocks: &[(2, -1.0)], angles: &[6], length: -0.04, shift: FRAC_PI_2 },
    Arm { blocks: &[(2, -1.0)], angles: &[5, 6], length: 0.02, shift: 0.0 },
];

impl Arm {
    /// The vector of the arm.
    fn vector(&self, q: &[f64]) -> [f64; 2] {
        let (s, c) = (self.sum(q) + self.shift).sin_cos();
        [self.length * c, self.length * s]
    }

    fn sum(&self, q: &[f64]) -> f64 {
        self.angles.iter().map(|&i| q[i]).sum()
    }
}

impl Pair {
    /// h, dh/dψ and d²h/dψ².
    fn coupling(&self, q: &[f64]) -> [f64; 3] {
        let (s, c) = (q[self.psi] + self.shift).sin_cos();
        [self.product * c, -self.product * s, -self.product * c]
    }
}

/// Spring length l and its derivatives by γ.
fn spring(gamma: f64) -> [f64; 3] {
    let (s, c) = gamma.sin_cos();
    let arm = [c * D[0] - s * D[1], s * D[0] + c * D[1]];
    let span = [B[0] + arm[0] - C[0], B[1] + arm[1] - C[1]];
    let length = span[0].hypot(span[1]);
    // arm′ = n(arm), arm″ = −arm; l l′ = span·arm′, l l″ + l′² = arm·arm − span·arm
    let slope = (span[1] * arm[0] - span[0] * arm[1]) / length;
    let bend = (arm[0] * arm[0] + arm[1] * arm[1] - span[0] * arm[0] - span[1] * arm[1] - slope * slope) / length;
    [length, slope, bend]
}

/// q = (β, Θ, γ, Φ, δ, Ω, ε).
#[derive(Clone, Debug)]
pub(crate) struct Andrews {
    base: Base,
    start: [f64; 7],
}

impl Andrews {
    /// q at t = 0.03 s of [`new`](Self::new); reference `andrews_test_set.json`, 13 digits or more.
    pub(crate) const Q_03: [f64; 7] = [
        15.810_771_195_153_707,
        -15.756_371_058_411_84,
        0.040_822_240_119_645_8,
        -0.534_730_116_342_079_6,
        0.524_409_965_879_954,
        0.534_730_116_342_079_6,
        1.048_080_741_041_938,
    ];
    /// v at t = 0.03 s; same source.
    pub(crate) const V_03: [f64; 7] = [
        1_139.920_302_259_106,
        -1_424.379_295_177_54,
        11.032_911_910_618_594,
        19.293_374_105_032_04,
        0.573_569_914_829_502_5,
        -19.293_374_105_032_04,
        0.323_179_149_249_130_9,
    ];
    /// λ at t = 0.03 s (N); same source.
    pub(crate) const LAMBDA_03: [f64; 6] = [
        199.175_348_104_538_63,
        -29.755_309_974_971_763,
        23.066_543_611_622_15,
        31.452_725_275_771_137,
        22.642_494_786_394_38,
        11.617_392_352_611_256,
    ];
    /// β″, Θ″ and λ₁, λ₂ at the start of [`new`](Self::new); same source. The other accelerations and multipliers are zero.
    pub(crate) const AT_START: [f64; 4] = [14_222.443_919_954_114, -10_666.832_939_965_585, 98.566_870_396_241_09, -6.122_688_344_255_663];
    /// q at t = 0.05 s of [`iftomm`](Self::iftomm); reference `iftomm_a03_andrews.json`.
    pub(crate) const IFTOMM_Q_05: [f64; 7] = [
        33.815_340_721_360_17,
        -33.571_155_378_219_37,
        0.115_158_527_591_552_42,
        -0.404_764_941_308_129_4,
        0.526_051_256_322_152_4,
        0.404_764_941_308_129_4,
        1.057_271_755_907_570_6,
    ];

    /// The start of the Test Set: Θ = 0, a dead centre.
    pub(crate) fn new() -> Self {
        let phi = 0.222_668_390_165_885_88;
        Self::from([-0.061_713_890_014_276_45, 0.0, 0.455_279_819_163_070_4, phi, 0.487_364_979_543_842_55, -phi, 1.230_547_444_549_821_2])
    }

    /// The start of the IFToMM library: β = −0.0620, the other angles from the closure.
    pub(crate) fn iftomm() -> Self {
        let phi = 0.222_668_375_903_027_47;
        let (theta, gamma) = (0.000_214_586_853_799_515_3, 0.455_279_812_100_370_2);
        Self::from([-0.062, theta, gamma, phi, 0.487_364_981_140_632_8, -phi, 1.230_547_439_156_600_8])
    }

    fn from(start: [f64; 7]) -> Self {
        let dims = Dims { q: 7, v: 7, holonomic: 6, work: 1, ..Dims::default() };
        scaled(Self { base: Base::new(dims), start }, |p| &mut p.base, &[0; 7])
    }
}

impl System for Andrews {
    stored!();
    vectors!();
    smooth!();

    fn terms(&mut self, at: At<'_>, stage: Stage, out: &mut Terms) {
        mass(at.q, out.mass.values_mut());
        rows(at, stage, out);
        if stage < Stage::Dynamics {
            return;
        }
        out.force.fill(0.0);
        out.force[0] = TORQUE;
        let [length, slope, _] = spring(at.q[GAMMA]);
        out.force[GAMMA] = -STIFFNESS * (length - REST) * slope;
        for pair in &PAIRS {
            let [_, h1, _] = pair.coupling(at.q);
            let (a, p) = (at.v[pair.alpha], at.v[pair.psi]);
            out.force[pair.alpha] -= h1 * p * (2.0 * a + p);
            out.force[pair.psi] += h1 * a * a;
        }
    }

    fn tangent(&mut self, at: At<'_>, acceleration: &[f64], lambda: &[f64], out: &mut Tangent) {
        clear(out);
        let [length, slope, bend] = spring(at.q[GAMMA]);
        out.k.values_mut()[8 * GAMMA] = STIFFNESS * (slope * slope + (length - REST) * bend);
        for pair in &PAIRS {
            let [_, h1, h2] = pair.coupling(at.q);
            let (i, j) = (pair.alpha, pair.psi);
            let (a, p) = (at.v[i], at.v[j]);
            out.k.values_mut()[7 * i + j] += h1 * (2.0 * acceleration[i] + acceleration[j]) + h2 * p * (2.0 * a + p);
            out.k.values_mut()[8 * j] += h1 * acceleration[i] - h2 * a * a;
            out.c.values_mut()[8 * i] += 2.0 * h1 * p;
            out.c.values_mut()[7 * i + j] += 2.0 * h1 * (a + p);
            out.c.values_mut()[7 * j + i] -= 2.0 * h1 * a;
        }
        for arm in &ARMS {
            let [x, y] = arm.vector(at.q);
            let bent: f64 = arm.blocks.iter().map(|&(b, sign)| -sign * (x * lambda[2 * b] + y * lambda[2 * b + 1])).sum();
            for (&i, &j) in arm.angles.iter().flat_map(|i| arm.angles.iter().map(move |j| (i, j))) {
                out.k.values_mut()[7 * i + j] += bent;
            }
        }
    }

    /// Of the torque on K1.
    fn power(&mut self, at: At<'_>, _: &[f64], _: &[f64], w: &mut [f64]) {
        w[0] = TORQUE * at.v[0];
    }
}

/// M (7 × 7).
fn mass(q: &[f64], m: &mut [f64]) {
    m.fill(0.0);
    m[8 * GAMMA] = INERTIA_3;
    for pair in &PAIRS {
        let h = pair.coupling(q)[0];
        let (i, j) = (pair.alpha, pair.psi);
        m[8 * i] = pair.first + pair.second + 2.0 * h;
        m[7 * i + j] = pair.second + h;
        m[7 * j + i] = pair.second + h;
        m[8 * j] = pair.second;
    }
}

/// Φ and G, and from the velocity stage on ν and γ.
fn rows(at: At<'_>, stage: Stage, out: &mut Terms) {
    out.phi.copy_from_slice(&[-B[0], -B[1], -A[0], -A[1], -A[0], -A[1]]);
    out.g.values_mut().fill(0.0);
    if stage >= Stage::Velocity {
        out.nu.fill(0.0);
        out.gamma.fill(0.0);
    }
    for arm in &ARMS {
        let [x, y] = arm.vector(at.q);
        for &(block, sign) in arm.blocks {
            let row = 2 * block;
            out.phi[row] += sign * x;
            out.phi[row + 1] += sign * y;
            for &i in arm.angles {
                out.g.values_mut()[7 * row + i] -= sign * y;
                out.g.values_mut()[7 * (row + 1) + i] += sign * x;
            }
            if stage >= Stage::Velocity {
                let omega = arm.sum(at.v);
                out.gamma[row] += sign * x * omega * omega;
                out.gamma[row + 1] += sign * y * omega * omega;
            }
        }
    }
}

impl Problem for Andrews {
    fn start(&self) -> State {
        State { q: self.start.to_vec(), ..State::new(self.base.dims) }
    }

    fn energy(&self, state: &State) -> f64 {
        let mut m = [0.0; 49];
        mass(&state.q, &mut m);
        let v = &state.v;
        let kinetic: f64 = (0..49).map(|k| 0.5 * m[k] * v[k / 7] * v[k % 7]).sum();
        kinetic + 0.5 * STIFFNESS * (spring(state.q[GAMMA])[0] - REST).powi(2)
    }
}
