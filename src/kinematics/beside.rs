//! How well constraints fix a state: what else they cannot tell from it.
//!
//! Rows Φ are sums of lengths, which numbers hold to their round-off ε. Where rows are nearly dependent, with a singular value σ, positions
//! that differ by ε/σ close them alike. There the directions of motions differ by ε/σ² and the curvatures of the branch by ε/σ³, if the
//! rows are curved along what they hardly hold; where they are not, as for light bodies between heavy ones, nothing differs. So no bound
//! of σ says how many digits are left, but another state does, from which the same is computed.

use super::assemble::Assembled;
use crate::dynamics::{Dynamics, mass_pattern, row_pattern};
use crate::geometry::Space;
use crate::mechanism::Mechanism;
use crate::results::{Finding, six_digits};
use grashof_solvers::weakest::weakest;
use grashof_solvers::{Kkt, Sparsity};
use nalgebra::Complex;

/// σ from which on positions are known to all digits that matter.
const WELL_HELD: f64 = 0.02;

/// Part of the sizes of which rows are sums that is round-off.
const ROUND_OFF: f64 = 2.0 * f64::EPSILON;

/// Part of an eigenvalue that may be open without a word, and of the largest one, which round-off takes from all.
const OPEN: f64 = 1e-6;
const OF_LARGEST: f64 = 1e-12;

/// Part of velocities that is open without a word, however small the tolerance.
const ALLOWED: f64 = 1e-8;

/// Part of accelerations that is open without a word: from rest, where of light structures digits are lost to their masses, and while bodies
/// move, when they are of one moment.
const FROM_REST: f64 = 1e-6;
const MOVING: f64 = 1e-4;

/// Part of the displacement into which forces at rest draw that is open without a word: only its direction counts. And part of reactions.
const DRAWN: f64 = 1e-3;
const REACTIONS: f64 = 1e-6;

/// A state that constraints cannot tell from a given one.
pub(crate) struct Beside {
    /// Coordinates (nq).
    pub(crate) q: Vec<f64>,
    /// Velocities (nv).
    pub(crate) v: Vec<f64>,
    /// How far it is from the given one, rad or sizes of the mechanism.
    pub(crate) far: f64,
}

impl Beside {
    /// That eigenvalues are other ones in this state: the most different one, if it differs by more than a part in a million. `squares` are
    /// compared, in which double ones at 0 are known to all digits: x itself for those of unit 1/s², x² for 1/s.
    pub(crate) fn other_eigenvalues(
        &self,
        [here, there]: [&[Complex<f64>]; 2],
        unit: &str,
        squares: fn(Complex<f64>) -> Complex<f64>,
        place: &str,
    ) -> Option<Finding> {
        let noise = OF_LARGEST * here.iter().chain(there).fold(0.0, |most: f64, x| most.max(squares(*x).norm()));
        let mut left: Vec<Complex<f64>> = there.to_vec();
        let mut worst: Option<(f64, Complex<f64>, Complex<f64>)> = None;
        for &x in here {
            let away = |y: Complex<f64>| (squares(x) - squares(y)).norm();
            let Some((i, off)) = left.iter().map(|y| away(*y)).enumerate().min_by(|a, b| a.1.total_cmp(&b.1)) else { break };
            let y = left.swap_remove(i);
            let part = (off - noise) / squares(x).norm();
            if part > worst.map_or(OPEN, |worst| worst.0) {
                worst = Some((part, x, y));
            }
        }
        let (_, x, y) = worst?;
        let number = |x: Complex<f64>| match x.im {
            0.0 => six_digits(x.re),
            im => format!("{} {} {} i", six_digits(x.re), if im < 0.0 { '-' } else { '+' }, six_digits(im.abs())),
        };
        Some(self.finding(&format!("there the eigenvalue {} {unit} is {}", number(x), number(y)), place))
    }

    fn finding(&self, other: &str, place: &str) -> Finding {
        Finding {
            code: "nearly-singular".into(),
            message: format!(
                "the position is so near to a singular one that the constraints hold it to {:.0e} rad, or sizes of the mechanism, only; another one, that far from it, meets them as well, and {other}. Digits behind that are round-off: take a position farther from the singular one",
                self.far
            ),
            path: place.into(),
        }
    }
}

/// That a motion begins with other velocities, or from rest accelerations, in a state which the constraints cannot tell from its start, by more
/// than this part of the largest; or with quite other accelerations. Where forces are in balance, accelerations are round-off, and count beside
/// those that the forces would give without the constraints.
pub(crate) fn other_beginning<G: Space<S = f64>>(m: &Mechanism<G>, start: &Assembled, allowed: f64) -> Option<Finding> {
    let other = state_beside(m, [&start.q, &start.v], &start.modes, &start.metric, start.size)?;
    let by_mass = |q: &[f64], v: &[f64]| solved(m, start, [q, v, &m.state_starts], &start.modes, Resisted::Mass);
    let [here, there] = [by_mass(&start.q, &start.v)?, by_mass(&other.q, &other.v)?];
    let units = m.units(start.size);
    let moves = start.v.iter().any(|v| *v != 0.0);
    let by_velocities = part(off(&start.v, &other.v, &units), largest(&start.v, &units));
    let by_accelerations = part(off(&here.x, &there.x, &units), here.drawn(start, &units));
    let told = |what: &str, part: f64| other.finding(&format!("its {what} differ by {part:.1e} of the largest"), "start");
    if by_velocities > allowed.max(ALLOWED) {
        return Some(told("velocities", by_velocities));
    }
    (by_accelerations > if moves { MOVING } else { allowed.max(FROM_REST) }).then(|| told("accelerations", by_accelerations))
}

/// That forces draw a mechanism at rest another way from a position which the constraints cannot tell from its start.
pub(crate) fn other_sinking<G: Space<S = f64>>(m: &Mechanism<G>, start: &Assembled) -> Option<Finding> {
    let rest = vec![0.0; m.nv];
    let other = state_beside(m, [&start.q, &rest], &start.modes, &start.metric, start.size)?;
    let by_metric = |q: &[f64]| solved(m, start, [q, &rest, &m.state_starts], &start.modes, Resisted::Metric);
    let [here, there] = [by_metric(&start.q)?, by_metric(&other.q)?];
    let units = m.units(start.size);
    let part = part(off(&here.x, &there.x, &units), here.drawn(start, &units));
    (part > DRAWN).then(|| other.finding(&format!("from there forces draw it another way, by {part:.1e} of the first one"), "start"))
}

/// That an equilibrium at coordinates (nq) and states (nz) has other reactions in a position which the constraints cannot tell from it.
pub(crate) fn other_reactions<G: Space<S = f64>>(
    m: &Mechanism<G>,
    start: &Assembled,
    [q, z]: [&[f64]; 2],
    modes: &[i32],
    place: &str,
) -> Option<Finding> {
    let rest = vec![0.0; m.nv];
    let other = state_beside(m, [q, &rest], modes, &start.metric, start.size)?;
    let by_metric = |q: &[f64]| solved(m, start, [q, &rest, z], modes, Resisted::Metric);
    let [here, there] = [by_metric(q)?, by_metric(&other.q)?];
    // forces, and moments by the size
    let of_rows: Vec<f64> = m.rows.iter().map(|row| if row.angular { start.size } else { 1.0 }).collect();
    let of_motions: Vec<f64> = m.units(start.size).iter().map(|unit| start.size / unit).collect();
    let size = f64::max(largest(&here.lambda, &of_rows), largest(&here.force, &of_motions));
    let part = part(off(&here.lambda, &there.lambda, &of_rows), size);
    (part > REACTIONS).then(|| other.finding(&format!("its reactions differ by {part:.1e} of the largest"), place))
}

/// Largest |x|, each in its own unit.
fn largest(x: &[f64], units: &[f64]) -> f64 {
    x.iter().zip(units).fold(0.0, |most, (x, unit)| f64::max(most, x.abs() / unit))
}

/// Largest difference, each in its own unit.
fn off(here: &[f64], there: &[f64], units: &[f64]) -> f64 {
    largest(&here.iter().zip(there).map(|(a, b)| a - b).collect::<Vec<f64>>(), units)
}

fn part(off: f64, of: f64) -> f64 {
    if of > 0.0 { off / of } else { 0.0 }
}

/// What resists motions: M gives accelerations; D, which is regular without mass as well, the way into which forces draw what rests.
#[derive(Clone, Copy)]
enum Resisted {
    Mass,
    Metric,
}

/// x and λ with M x + Gᵀλ = f, G x = γ; or with D in the place of M.
struct Solved {
    /// x (nv).
    x: Vec<f64>,
    /// λ (rows).
    lambda: Vec<f64>,
    /// f (nv).
    force: Vec<f64>,
}

impl Solved {
    /// Size of x, at least that of D⁻¹f, about what it would be without the constraints.
    fn drawn(&self, start: &Assembled, units: &[f64]) -> f64 {
        let free: Vec<f64> = self.force.iter().zip(&start.metric).map(|(f, d)| f / d).collect();
        f64::max(largest(&self.x, units), largest(&free, units))
    }
}

/// The linear equations at coordinates (nq), velocities (nv) and states (nz); none if they have no solution.
fn solved<G: Space<S = f64>>(
    m: &Mechanism<G>,
    start: &Assembled,
    [q, v, z]: [&[f64]; 3],
    modes: &[i32],
    resisted: Resisted,
) -> Option<Solved> {
    let metric = &start.metric;
    let mut dynamics = Dynamics::new(m);
    dynamics.work.z.copy_from_slice(z);
    dynamics.terms(0.0, q, v, modes);
    let scale = dynamics.row_scale(q, modes, metric);
    let by_metric = diagonal(m.nv);
    let mut kkt = match resisted {
        Resisted::Mass => Kkt::of_blocks(&mass_pattern(m), &row_pattern(m)),
        Resisted::Metric => Kkt::of_blocks(&by_metric, &row_pattern(m)),
    };
    kkt.set_scale(metric, &scale);
    let sigma = weakest(&mut kkt, metric, &scale, &dynamics.work.g);
    kkt.set_weakest(sigma);
    let work = &dynamics.work;
    let resistance = match resisted {
        Resisted::Mass => work.mass.values(),
        Resisted::Metric => metric,
    };
    kkt.factor(resistance, work.g.values()).ok()?;
    let (mut x, mut lambda) = (vec![0.0; m.nv], vec![0.0; m.rows.len()]);
    kkt.solve(&work.force, &work.gamma, &mut x, &mut lambda);
    Some(Solved { x, lambda, force: work.force.clone() })
}

/// The pattern of a diagonal matrix.
fn diagonal(n: usize) -> Sparsity {
    Sparsity::new(n, n, (0..n).map(|i| (i, i)))
}

/// A state at time 0 (q: nq, v: nv) that the constraints cannot tell from a given one; none where they hold it well. `metric` is D (nv), `size`
/// that of the mechanism, m.
pub(crate) fn state_beside<G>(m: &Mechanism<G>, [q, v]: [&[f64]; 2], modes: &[i32], metric: &[f64], size: f64) -> Option<Beside>
where
    G: Space<S = f64>,
{
    if m.rows.is_empty() {
        return None;
    }
    let mut dynamics = Dynamics::without_mass(m);
    dynamics.time(0.0, modes);
    dynamics.position(q, modes);
    let scale = dynamics.row_scale(q, modes, metric);
    let mut kkt = Kkt::of_blocks(&diagonal(m.nv), dynamics.work.g.pattern());
    kkt.set_scale(metric, &scale);
    let sigma = weakest(&mut kkt, metric, &scale, &dynamics.work.g);
    if sigma > WELL_HELD {
        return None;
    }
    kkt.set_weakest(sigma);
    let shortest = |kkt: &mut Kkt, g: &[f64], gaps: &[f64]| {
        let (mut x, mut mu) = (vec![0.0; m.nv], vec![0.0; gaps.len()]);
        kkt.factor(metric, g).ok()?;
        kkt.solve(&vec![0.0; m.nv], gaps, &mut x, &mut mu);
        Some(x)
    };
    // rows rounded up and down in no special order
    let sign = |i: usize| (2.4 * (i + 1) as f64).sin().signum();
    let gaps: Vec<f64> = m.rows.iter().enumerate().map(|(i, row)| sign(i) * ROUND_OFF * if row.angular { 1.0 } else { size }).collect();
    let way = shortest(&mut kkt, dynamics.work.g.values(), &gaps)?;
    let far = way.iter().zip(&m.units(size)).fold(0.0, |most, (x, unit)| f64::max(most, x.abs() / unit));
    let (mut q, mut v) = (q.to_vec(), v.to_vec());
    m.retract(&mut q, &way);
    dynamics.position(&q, modes);
    dynamics.velocity(&v, modes);
    let open: Vec<f64> =
        dynamics.work.g.lines().zip(&dynamics.work.nu).map(|(line, nu)| nu - line.entries().map(|(j, g)| g * v[j]).sum::<f64>()).collect();
    let more = shortest(&mut kkt, dynamics.work.g.values(), &open)?;
    v.iter_mut().zip(&more).for_each(|(v, more)| *v += more);
    Some(Beside { q, v, far })
}
