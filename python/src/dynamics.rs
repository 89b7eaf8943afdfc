//! The equations of motion, evaluated in many states at once.
//!
//! Arrays come with one row a state and go back so; the shapes in front are those of `grashof/dynamics.py`. What evaluates takes longer to
//! be made than a few states take, so one is kept, in a thread of its own, since it borrows the mechanism; many states have their own.

use crate::functions::Trouble;
use crate::interrupt::{Flag, awaited, away, begin};
use grashof::api::{Evaluator, Mechanism};
use grashof::{Error, solvers};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};

/// States for which the evaluator that is kept serves, at most: others wait meanwhile.
const FEW: usize = 64;
/// States that are placed between two looks at whether to end.
const SOME: usize = 10_000;

type Times<'py> = PyReadonlyArray1<'py, f64>;
type States<'py> = PyReadonlyArray2<'py, f64>;
type Rows<'py> = Bound<'py, PyArray2<f64>>;

/// Something to be evaluated.
type Work = Box<dyn FnOnce(&mut Evaluator<'_>) + Send>;

/// A mechanism whose equations of motion can be evaluated.
#[pyclass(frozen, module = "grashof._grashof")]
pub(crate) struct Dynamics {
    mechanism: Arc<Mechanism>,
    /// Where the evaluator that is kept takes its work, and the process in which it does: the thread does not follow into a fork.
    kept: Mutex<Option<(u32, Sender<Work>)>>,
    trouble: Trouble,
}

impl Dynamics {
    pub(crate) fn new(mechanism: Mechanism, trouble: Trouble) -> Self {
        Self { mechanism: Arc::new(mechanism), kept: Mutex::default(), trouble }
    }

    /// Evaluates something of each state, `width` numbers, without the lock of the interpreter.
    fn each<'py>(
        &self,
        py: Python<'py>,
        (count, width): (usize, usize),
        evaluate: impl Fn(&mut Evaluator<'_>, usize, &mut Vec<f64>) -> Result<(), Error> + Send + 'static,
    ) -> PyResult<Rows<'py>> {
        let all = move |evaluator: &mut Evaluator<'_>, flag: &Flag| {
            let mut out = Vec::with_capacity(count * width);
            let mut wanted = (0..count).take_while(|_| !flag.load(Ordering::Relaxed));
            wanted.try_for_each(|i| evaluate(evaluator, i, &mut out)).map(|()| out)
        };
        let done = if count > FEW {
            let mechanism = Arc::clone(&self.mechanism);
            away(py, move |flag| all(&mut mechanism.evaluator(), flag))?
        } else {
            let (sender, receiver) = channel();
            let flag = Flag::default();
            let own = Arc::clone(&flag);
            self.give(Box::new(move |evaluator| drop(sender.send(all(evaluator, &own)))))?;
            awaited(py, receiver, &flag)?
        };
        PyArray1::from_vec(py, self.trouble.settle(py, done)?).reshape([count, width])
    }

    /// Gives work to the evaluator that is kept; it is made when it is needed first.
    fn give(&self, work: Work) -> PyResult<()> {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let here = std::process::id();
        let (_, sender) = match &mut *kept {
            Some(known) if known.0 == here => known,
            none => {
                let (sender, receiver) = channel::<Work>();
                let mechanism = Arc::clone(&self.mechanism);
                begin(move || {
                    let mut evaluator = mechanism.evaluator();
                    receiver.iter().for_each(|work| work(&mut evaluator));
                })?;
                none.insert((here, sender))
            }
        };
        // it takes work as long as it is kept
        let _ = sender.send(work);
        Ok(())
    }
}

/// Rows of numbers of one width, one behind the other.
struct Given {
    width: usize,
    values: Vec<f64>,
}

impl Given {
    fn of(states: &States<'_>, width: usize) -> PyResult<Self> {
        Ok(Self { width, values: states.as_slice()?.to_vec() })
    }

    fn row(&self, index: usize) -> &[f64] {
        &self.values[index * self.width..][..self.width]
    }
}

/// States with their times.
struct InTime {
    t: Vec<f64>,
    q: Given,
    v: Given,
}

impl InTime {
    fn of(t: &Times<'_>, q: &States<'_>, v: &States<'_>, (nq, nv, _): (usize, usize, usize)) -> PyResult<Self> {
        Ok(Self { t: t.as_slice()?.to_vec(), q: Given::of(q, nq)?, v: Given::of(v, nv)? })
    }
}

#[pymethods]
impl Dynamics {
    /// Names of the coordinates behind the velocities.
    #[getter]
    fn coordinates(&self) -> Vec<String> {
        self.mechanism.coordinates()
    }

    /// Numbers of coordinates, velocities and constraint rows.
    #[getter]
    fn sizes(&self) -> (usize, usize, usize) {
        self.mechanism.sizes()
    }

    /// Coordinates and velocities of the start.
    fn start<'py>(&self, py: Python<'py>) -> (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>) {
        let (q, v) = self.mechanism.start();
        (PyArray1::from_vec(py, q), PyArray1::from_vec(py, v))
    }

    /// One of the terms that depend on positions: `mass`, `constraints`, `jacobian`.
    fn position<'py>(&self, py: Python<'py>, term: &str, t: Times<'py>, q: States<'py>) -> PyResult<Rows<'py>> {
        let (nq, nv, m) = self.mechanism.sizes();
        let (t, q) = (t.as_slice()?.to_vec(), Given::of(&q, nq)?);
        let (width, take): (usize, fn(&solvers::Terms, &mut Vec<f64>)) = match term {
            "mass" => (nv * nv, |terms, out| out.extend(terms.mass.to_dense())),
            "constraints" => (m, |terms, out| out.extend(&terms.phi)),
            _ => (m * nv, |terms, out| out.extend(terms.g.to_dense())),
        };
        self.each(py, (t.len(), width), move |evaluator, i, out| {
            take(evaluator.position(t[i], q.row(i))?, out);
            Ok(())
        })
    }

    /// The applied forces f along the velocities.
    fn force<'py>(&self, py: Python<'py>, t: Times<'py>, q: States<'py>, v: States<'py>) -> PyResult<Rows<'py>> {
        let sizes = self.mechanism.sizes();
        let at = InTime::of(&t, &q, &v, sizes)?;
        self.each(py, (at.t.len(), sizes.1), move |evaluator, i, out| {
            out.extend(&evaluator.terms(at.t[i], at.q.row(i), at.v.row(i))?.force);
            Ok(())
        })
    }

    /// Accelerations, and behind them the multipliers.
    fn accelerations<'py>(&self, py: Python<'py>, t: Times<'py>, q: States<'py>, v: States<'py>) -> PyResult<Rows<'py>> {
        let sizes = self.mechanism.sizes();
        let at = InTime::of(&t, &q, &v, sizes)?;
        self.each(py, (at.t.len(), sizes.1 + sizes.2), move |evaluator, i, out| {
            let (a, lambda) = evaluator.accelerations(at.t[i], at.q.row(i), at.v.row(i))?;
            out.extend(a);
            out.extend(lambda);
            Ok(())
        })
    }

    /// The forces that, added to the applied ones, give accelerations with multipliers.
    fn inverse<'py>(
        &self,
        py: Python<'py>,
        t: Times<'py>,
        state: (States<'py>, States<'py>),
        wanted: (States<'py>, States<'py>),
    ) -> PyResult<Rows<'py>> {
        let sizes = self.mechanism.sizes();
        let at = InTime::of(&t, &state.0, &state.1, sizes)?;
        let (a, lambda) = (Given::of(&wanted.0, sizes.1)?, Given::of(&wanted.1, sizes.2)?);
        self.each(py, (at.t.len(), sizes.1), move |evaluator, i, out| {
            out.extend(evaluator.inverse(at.t[i], at.q.row(i), at.v.row(i), a.row(i), lambda.row(i))?);
            Ok(())
        })
    }

    /// Coordinates on the constraints next to those given, and behind them the velocities.
    fn project<'py>(&self, py: Python<'py>, t: Times<'py>, q: States<'py>, v: States<'py>) -> PyResult<Rows<'py>> {
        let sizes = self.mechanism.sizes();
        let at = InTime::of(&t, &q, &v, sizes)?;
        self.each(py, (at.t.len(), sizes.0 + sizes.1), move |evaluator, i, out| {
            let (q, v) = evaluator.project(at.t[i], at.q.row(i), at.v.row(i))?;
            out.extend(q);
            out.extend(v);
            Ok(())
        })
    }

    /// Where a body is: its place, then its axes as the columns of a matrix that is written row by row.
    fn pose<'py>(&self, py: Python<'py>, body: &str, q: States<'py>) -> PyResult<Rows<'py>> {
        let (count, width) = (q.as_array().nrows(), self.mechanism.sizes().0);
        let (mechanism, body, q) = (Arc::clone(&self.mechanism), body.to_owned(), q.as_slice()?.to_vec());
        let placed = away(py, move |flag| {
            let mut out = Vec::with_capacity(12 * count);
            // without coordinates there is one state
            let all = if q.is_empty() { vec![&q[..]] } else { q.chunks(SOME * width).collect() };
            let mut wanted = all.into_iter().take_while(|_| !flag.load(Ordering::Relaxed));
            wanted.try_for_each(|states| {
                mechanism.placements(&body, states, |at| {
                    out.extend(at.position.iter());
                    out.extend(at.rotation.transpose().iter());
                })
            })?;
            Ok::<_, Error>(out)
        })?;
        PyArray1::from_vec(py, self.trouble.settle(py, placed)?).reshape([count, 12])
    }
}
