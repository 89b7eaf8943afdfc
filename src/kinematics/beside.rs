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
    let [here, there] = [accelerations(m, [&start.q, &start.v], start)?, accelerations(m, [&other.q, &other.v], start)?];
    let units = m.units(start.size);
    let largest = |a: &mut dyn Iterator<Item = f64>| a.zip(&units).fold(0.0, |most, (a, unit)| f64::max(most, a.abs() / unit));
    let off = |here: &[f64], there: &[f64]| largest(&mut here.iter().zip(there).map(|(a, b)| a - b));
    let part = |off: f64, of: f64| if of > 0.0 { off / of } else { 0.0 };
    let moves = start.v.iter().any(|v| *v != 0.0);
    let by_velocities = part(off(&start.v, &other.v), largest(&mut start.v.iter().copied()));
    let size = f64::max(largest(&mut here.found.iter().copied()), largest(&mut here.free.iter().copied()));
    let by_accelerations = part(off(&here.found, &there.found), size);
    let told = |what: &str, part: f64| other.finding(&format!("its {what} differ by {part:.1e} of the largest"), "start");
    if by_velocities > allowed.max(ALLOWED) {
        return Some(told("velocities", by_velocities));
    }
    (by_accelerations > if moves { MOVING } else { allowed.max(FROM_REST) }).then(|| told("accelerations", by_accelerations))
}

/// Accelerations (nv), and D⁻¹f (nv): about what they would be without the constraints.
struct Accelerations {
    found: Vec<f64>,
    free: Vec<f64>,
}

/// Accelerations at coordinates (nq) and velocities (nv) next to a start; none if they are not determined.
fn accelerations<G: Space<S = f64>>(m: &Mechanism<G>, [q, v]: [&[f64]; 2], start: &Assembled) -> Option<Accelerations> {
    let (modes, metric) = (&start.modes, &start.metric);
    let mut dynamics = Dynamics::new(m);
    dynamics.work.z.copy_from_slice(&m.state_starts);
    dynamics.terms(0.0, q, v, modes);
    let scale = dynamics.row_scale(q, modes, metric);
    let mut kkt = Kkt::of_blocks(&mass_pattern(m), &row_pattern(m));
    kkt.set_scale(metric, &scale);
    let sigma = weakest(&mut kkt, metric, &scale, &dynamics.work.g);
    kkt.set_weakest(sigma);
    let work = &dynamics.work;
    kkt.factor(work.mass.values(), work.g.values()).ok()?;
    let (mut a, mut lambda) = (vec![0.0; m.nv], vec![0.0; m.rows.len()]);
    kkt.solve(&work.force, &work.gamma, &mut a, &mut lambda);
    Some(Accelerations { found: a, free: work.force.iter().zip(metric).map(|(f, d)| f / d).collect() })
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
    let mut kkt = Kkt::of_blocks(&Sparsity::new(m.nv, m.nv, (0..m.nv).map(|i| (i, i))), dynamics.work.g.pattern());
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
