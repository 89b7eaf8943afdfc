//! Bodies that turn in space: the torque-free body, and the heavy symmetric top without and with constraint rows.

use super::base::{Base, Problem, clear, diagonal, scaled};
use super::quaternion::{self as quat, cross, gyroscopic, multiplied, rotation, skew, turned, turned_back};
use grashof_solvers::{At, Dims, Effect, Pattern, Span, Stage, State, System, Tangent, Terms};

/// Gravity (m/s²), in −z.
const GRAVITY: f64 = 9.81;
/// Mass (kg) of the top and distance of its centre from the fixed point along its axis (m).
const MASS: f64 = 1.0;
const ARM: f64 = 0.3;
/// Inertia about the mass centre: a disc of radius 0.1 m (kg·m²).
const CENTRAL: [f64; 3] = [0.0025, 0.0025, 0.005];
/// The same about the fixed point.
const ABOUT_PIVOT: [f64; 3] = [0.0925, 0.0925, 0.005];
/// Spin about the axis (rad/s).
const SPIN: f64 = 200.0;

fn three(x: &[f64]) -> [f64; 3] {
    [x[0], x[1], x[2]]
}

/// ½ ωᵀJω.
fn spin_energy(inertia: [f64; 3], omega: &[f64]) -> f64 {
    inertia.iter().zip(omega).map(|(j, w)| 0.5 * j * w * w).sum()
}

/// Writes a 3 × 3 block into a row-major matrix with `n` columns.
fn put(matrix: &mut [f64], n: usize, row: usize, column: usize, block: [[f64; 3]; 3]) {
    for (i, line) in block.iter().enumerate() {
        matrix[(row + i) * n + column..][..3].copy_from_slice(line);
    }
}

/// Coordinates that are one quaternion, velocities ω in the body's frame.
macro_rules! attitude {
    () => {
        fn rate(&self, _: f64, q: &[f64], v: &[f64], qdot: &mut [f64]) {
            quat::rate(q, v, qdot);
        }

        fn retract(&self, _: Span, q: &mut [f64], delta: &[f64]) {
            quat::retract(q, delta);
        }

        fn displace(&self, _: Span, q: &mut [f64], u: &[f64]) {
            quat::displace(q, u);
        }
    };
}

/// A free body with J = diag(1, 2, 3) kg·m² that tumbles about its middle axis: Euler's equations J ω̇ = −ω × Jω.
#[derive(Clone, Debug)]
pub(crate) struct FreeBody {
    base: Base,
}

impl FreeBody {
    const INERTIA: [f64; 3] = [1.0, 2.0, 3.0];

    /// Time between sign changes of ω₂ (s), the first after half of it; reference `dzhanibekov.json`, 18 digits.
    pub(crate) const FLIP: f64 = 18.851_035_793_687_3;

    /// t, ω, q (w, x, y, z); same source.
    pub(crate) const OUTPUTS: [(f64, [f64; 3], [f64; 4]); 7] = [
        (
            5.0,
            [-0.153_937_569_508_545_67, 0.988_080_576_012_807_6, 0.089_436_710_036_014_36],
            [-0.799_050_815_645_447_6, 0.024_817_870_785_836_61, 0.595_969_199_966_331_9, 0.075_647_736_235_084_64],
        ),
        (
            10.0,
            [-0.947_392_709_739_121_4, -0.320_073_512_701_637, 0.547_068_839_808_067_5],
            [0.164_162_862_325_968_72, 0.190_853_556_419_087_7, -0.553_131_816_456_661_8, -0.794_147_762_232_246_7],
        ),
        (
            15.0,
            [-0.078_955_856_976_151_96, -0.996_878_113_236_097_4, 0.046_669_145_234_792_84],
            [0.020_057_948_024_500_897, -0.768_063_981_096_122_6, 0.032_791_666_436_393_786, 0.639_218_355_709_647_7],
        ),
        (
            20.0,
            [0.012_350_688_029_325_006, -0.999_923_727_343_842, 0.012_281_958_242_312_34],
            [-0.016_848_404_004_929_75, 0.998_481_738_283_92, 0.002_993_488_731_459_799_7, -0.052_358_271_755_501_645],
        ),
        (
            30.0,
            [0.650_404_045_714_257_5, 0.759_588_426_266_834_4, 0.375_644_079_185_547_6],
            [0.169_974_798_014_469_27, 0.117_010_087_642_558_69, 0.919_782_143_731_774_2, 0.333_793_372_465_666_2],
        ),
        (
            40.0,
            [-0.030_333_460_265_219_533, 0.999_539_834_718_125_9, 0.020_166_959_873_860_118],
            [0.994_460_735_875_372_9, -0.008_378_481_294_427_594, 0.104_646_386_670_695_98, -0.005_174_901_948_626_579],
        ),
        (
            50.0,
            [-0.367_341_554_809_338_33, -0.930_086_115_427_092, 0.212_320_369_481_076_2],
            [0.070_579_964_403_415_3, 0.128_625_976_516_292_32, -0.165_580_985_821_834_9, -0.975_221_392_261_425],
        ),
    ];

    /// ω = (0, 1, 0.01) rad/s, identity attitude.
    pub(crate) fn new() -> Self {
        let dims = Dims { q: 4, v: 3, ..Dims::default() };
        scaled(Self { base: Base::new(dims) }, |p| &mut p.base, &[0; 3])
    }
}

impl System for FreeBody {
    stored!();
    attitude!();
    conservative!();
    smooth!();

    fn terms(&mut self, at: At<'_>, stage: Stage, out: &mut Terms) {
        diagonal(&mut out.mass, Self::INERTIA);
        if stage >= Stage::Dynamics {
            out.force.copy_from_slice(&gyroscopic(Self::INERTIA, three(at.v)).0.map(|x| -x));
        }
    }

    fn tangent(&mut self, at: At<'_>, _: &[f64], _: &[f64], out: &mut Tangent) {
        clear(out);
        put(out.c.values_mut(), 3, 0, 0, gyroscopic(Self::INERTIA, three(at.v)).1);
    }
}

impl Problem for FreeBody {
    fn start(&self) -> State {
        State { q: vec![1.0, 0.0, 0.0, 0.0], v: vec![0.0, 1.0, 0.01], ..State::new(self.base.dims) }
    }

    fn energy(&self, state: &State) -> f64 {
        spin_energy(Self::INERTIA, &state.v)
    }
}

/// Attitude of the start: the axis 60° from the vertical, towards +x.
fn leaning() -> [f64; 4] {
    let (s, c) = (std::f64::consts::PI / 6.0).sin_cos();
    [c, 0.0, s, 0.0]
}

/// ω in the body's frame of a precession (rad/s) about the vertical with [`SPIN`] about the axis in all.
fn precessing(precession: f64) -> [f64; 3] {
    let up = turned_back(&rotation(&leaning()), [0.0, 0.0, precession]);
    [up[0], up[1], SPIN]
}

/// The heavy symmetric top about its fixed point, without rows: J ω̇ = −ω × Jω − m g l e₃ × Rᵀe_z.
#[derive(Clone, Debug)]
pub(crate) struct HeavyTop {
    base: Base,
    omega: [f64; 3],
}

impl HeavyTop {
    /// Nutation period of [`cusp`](Self::cusp) (s); reference `heavy_top.json`, 18 digits.
    pub(crate) const NUTATION: f64 = 0.616_009_236_084_964_4;
    /// Lowest cos θ of [`cusp`](Self::cusp), half a nutation after the start; same source.
    pub(crate) const LOWEST: f64 = -0.043_428_155_324_722_83;
    /// Rates of the slow and fast steady precession (rad/s); same source.
    pub(crate) const PRECESSIONS: [f64; 2] = [3.514_154_182_278_023, 18.107_467_439_343_6];

    /// t, mass centre, vertical force of the pivot (N) of [`cusp`](Self::cusp); same source.
    pub(crate) const OUTPUTS: [(f64, [f64; 3], f64); 6] = [
        (0.0, [0.259_807_621_135_331_57, 0.0, 0.15], 2.651_351_351_351_351),
        (0.1, [0.276_343_716_972_870_86, 0.014_230_970_207_636_14, 0.115_894_907_466_062_65], 4.837_219_987_409_124),
        (0.2, [0.281_754_967_482_841_3, 0.096_092_014_571_922_83, 0.037_154_582_950_860_944], 12.710_881_557_394_073),
        (0.3, [0.198_161_383_535_969_63, 0.224_878_957_730_138_88, -0.012_709_069_411_910_301], 19.737_278_968_650_493),
        (0.5, [-0.039_918_396_032_306_944, 0.278_196_953_826_174_74, 0.104_942_729_810_335_55], 5.696_173_723_391_974),
        (1.0, [-0.299_520_524_508_774_2, 0.009_973_286_955_228_125, 0.013_710_906_071_352_955], 15.817_318_141_962_597),
    ];

    /// The axis at rest, 60° from the vertical, spinning at 200 rad/s: it falls, precesses and stops again (cusps).
    pub(crate) fn cusp() -> Self {
        Self::with([0.0, 0.0, SPIN])
    }

    /// Precession at a constant 60°, slow or fast.
    pub(crate) fn steady(fast: bool) -> Self {
        Self::with(precessing(Self::PRECESSIONS[usize::from(fast)]))
    }

    fn with(omega: [f64; 3]) -> Self {
        let dims = Dims { q: 4, v: 3, ..Dims::default() };
        scaled(Self { base: Base::new(dims), omega }, |p| &mut p.base, &[0; 3])
    }

    /// The mass centre.
    pub(crate) fn centre(q: &[f64]) -> [f64; 3] {
        turned(&rotation(q), [0.0, 0.0, ARM])
    }
}

/// m g l e₃ in the body's frame.
const WEIGHT: [f64; 3] = [0.0, 0.0, MASS * GRAVITY * ARM];

impl System for HeavyTop {
    stored!();
    attitude!();
    conservative!();
    smooth!();

    fn terms(&mut self, at: At<'_>, stage: Stage, out: &mut Terms) {
        diagonal(&mut out.mass, ABOUT_PIVOT);
        if stage >= Stage::Dynamics {
            let gyro = gyroscopic(ABOUT_PIVOT, three(at.v)).0;
            let weight = cross(WEIGHT, turned_back(&rotation(at.q), [0.0, 0.0, 1.0]));
            (0..3).for_each(|i| out.force[i] = -gyro[i] - weight[i]);
        }
    }

    fn tangent(&mut self, at: At<'_>, _: &[f64], _: &[f64], out: &mut Tangent) {
        clear(out);
        // a turn δ of the body takes ζ = Rᵀe_z to ζ + ζ × δ
        let up = turned_back(&rotation(at.q), [0.0, 0.0, 1.0]);
        put(out.k.values_mut(), 3, 0, 0, multiplied(skew(WEIGHT), skew(up)));
        put(out.c.values_mut(), 3, 0, 0, gyroscopic(ABOUT_PIVOT, three(at.v)).1);
    }
}

impl Problem for HeavyTop {
    fn start(&self) -> State {
        State { q: leaning().to_vec(), v: self.omega.to_vec(), ..State::new(self.base.dims) }
    }

    fn energy(&self, state: &State) -> f64 {
        spin_energy(ABOUT_PIVOT, &state.v) + MASS * GRAVITY * Self::centre(&state.q)[2]
    }
}

/// The heavy top as a free body, q = (mass centre, quaternion), v = (its velocity in the world, ω in the body's frame), held by
/// three rows: Φ = x − R l e₃. λ is the force of the top on the pivot.
#[derive(Clone, Debug)]
pub(crate) struct HeavyTopCartesian {
    base: Base,
    omega: [f64; 3],
}

impl HeavyTopCartesian {
    /// As [`HeavyTop::cusp`].
    pub(crate) fn cusp() -> Self {
        Self::with([0.0, 0.0, SPIN])
    }

    /// As [`HeavyTop::steady`].
    pub(crate) fn steady(fast: bool) -> Self {
        Self::with(precessing(HeavyTop::PRECESSIONS[usize::from(fast)]))
    }

    fn with(omega: [f64; 3]) -> Self {
        let dims = Dims { q: 7, v: 6, holonomic: 3, ..Dims::default() };
        scaled(Self { base: Base::new(dims), omega }, |p| &mut p.base, &[1, 1, 1, 0, 0, 0])
    }
}

/// From the mass centre to the fixed point in the body's frame.
const TO_PIVOT: [f64; 3] = [0.0, 0.0, -ARM];

impl System for HeavyTopCartesian {
    stored!();
    conservative!();
    smooth!();

    fn terms(&mut self, at: At<'_>, stage: Stage, out: &mut Terms) {
        let r = rotation(&at.q[3..]);
        let omega = three(&at.v[3..]);
        diagonal(&mut out.mass, [MASS; 3].into_iter().chain(CENTRAL));
        let arm = turned(&r, TO_PIVOT);
        out.g.values_mut().fill(0.0);
        (0..3).for_each(|i| {
            out.phi[i] = at.q[i] + arm[i];
            out.g.values_mut()[7 * i] = 1.0;
        });
        // d(R s)/dt = R (ω × s) = −R [s]× ω
        put(out.g.values_mut(), 6, 0, 3, multiplied(r, skew(TO_PIVOT.map(|x| -x))));
        if stage >= Stage::Velocity {
            out.nu.fill(0.0);
            out.gamma.copy_from_slice(&turned(&r, cross(omega, cross(omega, TO_PIVOT))).map(|x| -x));
        }
        if stage >= Stage::Dynamics {
            out.force[..3].copy_from_slice(&[0.0, 0.0, -MASS * GRAVITY]);
            out.force[3..].copy_from_slice(&gyroscopic(CENTRAL, omega).0.map(|x| -x));
        }
    }

    fn tangent(&mut self, at: At<'_>, _: &[f64], lambda: &[f64], out: &mut Tangent) {
        clear(out);
        // the moment of λ is s × Rᵀλ, and a turn δ takes Rᵀλ to Rᵀλ + Rᵀλ × δ
        let force = turned_back(&rotation(&at.q[3..]), three(lambda));
        put(out.k.values_mut(), 6, 3, 3, multiplied(skew(TO_PIVOT), skew(force)));
        put(out.c.values_mut(), 6, 3, 3, gyroscopic(CENTRAL, three(&at.v[3..])).1);
    }

    fn rate(&self, _: f64, q: &[f64], v: &[f64], qdot: &mut [f64]) {
        qdot[..3].copy_from_slice(&v[..3]);
        quat::rate(&q[3..], &v[3..], &mut qdot[3..]);
    }

    fn retract(&self, _: Span, q: &mut [f64], delta: &[f64]) {
        (0..3).for_each(|i| q[i] += delta[i]);
        quat::retract(&mut q[3..], &delta[3..]);
    }

    fn displace(&self, _: Span, q: &mut [f64], u: &[f64]) {
        (0..3).for_each(|i| q[i] += u[i]);
        quat::displace(&mut q[3..], &u[3..]);
    }
}

impl Problem for HeavyTopCartesian {
    fn start(&self) -> State {
        let r = rotation(&leaning());
        let centre = HeavyTop::centre(&leaning());
        let velocity = turned(&r, cross(self.omega, [0.0, 0.0, ARM]));
        let q = centre.into_iter().chain(leaning()).collect();
        State { q, v: velocity.into_iter().chain(self.omega).collect(), ..State::new(self.base.dims) }
    }

    fn energy(&self, state: &State) -> f64 {
        let kinetic: f64 = state.v[..3].iter().map(|v| 0.5 * MASS * v * v).sum();
        kinetic + spin_energy(CENTRAL, &state.v[3..]) + MASS * GRAVITY * state.q[2]
    }
}
