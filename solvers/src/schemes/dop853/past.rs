//! The steps before the last: with two of them the continuous solution needs no further stages.

use crate::engine::{Engine, Node};

/// Least and largest length of a step in lengths of the next: shorter ones enlarge the round-off of their node, longer ones say little of
/// it.
const LENGTHS: (f64, f64) = (0.5, 3.0);

/// Round-off of a coordinate that may show in the rate of the polynomial, in units of the tolerance, and its size in units of
/// ε |q|/h.
const SHOWN: f64 = 0.1;
const ROUNDED: f64 = 4.0;

/// Error that the polynomial may have by its estimate, in units of the tolerance [measured with a safety of 0.8, a force that turns round
/// within 10 to 100 ms: velocities inside of steps are off by at most 12 tolerances, beside 8 by three more stages and 56 without an
/// estimate; where 1e-6 lets a step pass over 10 ms it is 303 with either and 515].
pub(super) const ERROR: f64 = 0.3;

/// Begins of the last three steps: y = (q, v, z) and ẏ of each.
pub(super) struct Past {
    begins: [[Vec<f64>; 2]; 3],
    /// Lengths of those steps, s.
    lengths: [f64; 3],
    /// Number of steps, up to three, since what came before does not count any more.
    count: usize,
    round_off: Vec<f64>,
    zeros: Vec<f64>,
}

/// y and ẏ of a node.
type Flowing<'a> = (&'a [f64], &'a [f64]);

impl Past {
    /// Room for y of `n` numbers.
    pub(super) fn new(n: usize) -> Self {
        let vector = || vec![0.0; n];
        let begins = std::array::from_fn(|_| [vector(), vector()]);
        Self { begins, lengths: [0.0; 3], count: 0, round_off: vector(), zeros: vector() }
    }

    pub(super) fn forget(&mut self) {
        self.count = 0;
    }

    /// Takes a step that was accepted: its length (s), y and ẏ at its begin, and whether a singular position is near, beside which no
    /// polynomial follows the motion.
    pub(super) fn accept(&mut self, h: f64, begin: [&[f64]; 2], singular: bool) {
        self.begins.rotate_left(1);
        self.lengths = [self.lengths[1], self.lengths[2], h];
        self.begins[2].iter_mut().zip(begin).for_each(|(to, from)| to.copy_from_slice(from));
        self.count = if singular { 0 } else { (self.count + 1).min(3) };
    }

    /// The lengths of the two steps before the last, and y and ẏ at their begins and at the end of the last, which are those given; nothing
    /// where the polynomial through them would not do.
    pub(super) fn nodes<'a>(&'a mut self, engine: &Engine, to: &Node, end: Flowing<'a>) -> Option<([f64; 2], [Flowing<'a>; 4])> {
        let (nq, nv) = (to.state.q.len(), to.state.v.len());
        let (least, most) = LENGTHS;
        let fits = self.lengths.windows(2).all(|pair| pair[0] >= least * pair[1] && pair[0] <= most * pair[1]);
        if self.count < 3 || nq == 0 || nq != nv || !to.state.z.is_empty() || !fits {
            return None;
        }
        for (noise, q) in self.round_off.iter_mut().zip(&to.state.q) {
            *noise = ROUNDED * f64::EPSILON * q.abs() / self.lengths[2];
        }
        if engine.norm(&to.state, &self.zeros[..nq], &self.round_off[..nv], &[]) > SHOWN {
            return None;
        }
        let [far, near, begin] = self.begins.each_ref().map(|[y, rate]| (&y[..], &rate[..]));
        let nodes = [far, near, begin, end];
        nodes.iter().all(|(y, rate)| y[nq..] == rate[..nq]).then_some(([self.lengths[0], self.lengths[1]], nodes))
    }
}
