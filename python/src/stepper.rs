//! A motion that is advanced from outside. It lives in a thread of its own, to which calls are sent.

use crate::errors::refused;
use crate::functions::Trouble;
use crate::interrupt::{self, Flag, awaited};
use grashof::Error;
use grashof::api::{Reached, Stepper as Motion, Stepping};
use numpy::PyArray1;
use pyo3::prelude::*;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// What a motion is asked.
enum Call {
    /// To go to a time, s.
    Advance(f64),
    /// To go on with a parameter at another value, SI.
    Set(String, f64),
}

/// Who waits for the end of a call.
type Reply = Sender<Result<Present, Error>>;
/// A call, and who waits for its end.
type Asked = (Call, Reply);

/// Where a motion is.
#[derive(Clone, Default)]
struct Present {
    t: f64,
    q: Vec<f64>,
    v: Vec<f64>,
    z: Vec<f64>,
    columns: Vec<f64>,
    /// Times, s, and names of the events so far.
    events: Vec<(f64, String)>,
    ended: bool,
}

impl Present {
    fn of(motion: &mut Motion<'_>) -> Self {
        let columns = motion.columns();
        let events = motion.events().iter().map(|event| (event.at, event.name.clone())).collect();
        let (state, ended) = (motion.state(), motion.ended());
        Self { t: state.t, q: state.q.clone(), v: state.v.clone(), z: state.z.clone(), columns, events, ended }
    }
}

/// A motion that is advanced from outside.
#[pyclass(frozen, module = "grashof._grashof")]
pub(crate) struct Stepper {
    calls: Mutex<Sender<Asked>>,
    present: Mutex<Present>,
    columns: Vec<String>,
    /// The process in which the motion lives: its thread does not follow into a fork.
    process: u32,
    flag: Flag,
    trouble: Trouble,
}

impl Stepper {
    /// Begins the motion of a study.
    pub(crate) fn new(py: Python<'_>, model: grashof::Model, trouble: Trouble, study: String) -> PyResult<Self> {
        let (calls, asked) = channel();
        let (begun, begin) = channel();
        let flag = Flag::default();
        let own = Arc::clone(&flag);
        let thread = trouble.clone();
        let serving = move || match model.stepping(&study) {
            Ok(stepping) => {
                let columns = stepping.columns();
                serve(stepping, &own, &asked, Waiting::First(begun, columns));
            }
            Err(error) => drop(begun.send(Err(error))),
        };
        interrupt::begin(move || thread.known(serving))?;
        let begun = awaited(py, begin, &flag)?;
        let (present, columns) = trouble.settle(py, begun)?;
        Ok(Self { calls: Mutex::new(calls), present: Mutex::new(present), columns, process: std::process::id(), flag, trouble })
    }

    /// Sends a call and waits for its end.
    fn ask(&self, py: Python<'_>, call: Call) -> PyResult<()> {
        if self.process != std::process::id() {
            return Err(refused(py, "the motion has stayed in the process that was forked", "begin a new one in this process"));
        }
        let (reply, replied) = channel();
        self.flag.store(false, Ordering::Relaxed);
        let sent = self.calls.lock().unwrap_or_else(PoisonError::into_inner).send((call, reply));
        sent.map_err(|_| refused(py, "the motion has ended", "begin a new one"))?;
        let present = awaited(py, replied, &self.flag)?;
        *self.present() = self.trouble.settle(py, present)?;
        Ok(())
    }

    fn present(&self) -> MutexGuard<'_, Present> {
        self.present.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Who waits for a motion to begin.
enum Waiting {
    /// The call that made the stepper, with the names of the columns.
    First(Sender<Result<(Present, Vec<String>), Error>>, Vec<String>),
    /// A call to it.
    Call(Reply),
}

impl Waiting {
    fn told(self, begun: Result<Present, Error>) {
        // nobody listens any more to what was given up
        let _ = match self {
            Self::First(first, columns) => first.send(begun.map(|present| (present, columns))).is_ok(),
            Self::Call(call) => call.send(begun).is_ok(),
        };
    }
}

/// Answers calls until nobody is there to make them, with one mechanism after the other.
fn serve(mut stepping: Stepping, flag: &Flag, asked: &Receiver<Asked>, mut waiting: Waiting) {
    let mut from = None;
    while let Some((next, reached, reply)) = follow(&stepping, from.as_ref(), flag, asked, waiting) {
        (stepping, from, waiting) = (next, Some(reached), Waiting::Call(reply));
    }
}

/// Answers calls to one mechanism; gives the next one, with how far the motion has come and who waits for it.
fn follow(
    stepping: &Stepping,
    from: Option<&Reached>,
    flag: &Flag,
    asked: &Receiver<Asked>,
    waiting: Waiting,
) -> Option<(Stepping, Reached, Reply)> {
    let begun = from.map_or_else(|| stepping.begin(), |reached| stepping.begin_at(reached));
    let mut motion = match begun {
        Ok(motion) => motion,
        Err(error) => {
            waiting.told(Err(error));
            return None;
        }
    };
    waiting.told(Ok(Present::of(&mut motion)));
    while let Ok((call, reply)) = asked.recv() {
        let answer = match call {
            Call::Advance(t) => motion.advance(t, &|| flag.load(Ordering::Relaxed)).map(|()| Present::of(&mut motion)),
            Call::Set(name, value) => match stepping.set(&name, value) {
                Ok(next) => return Some((next, motion.reached(), reply)),
                Err(error) => Err(error),
            },
        };
        let _ = reply.send(answer);
    }
    None
}

#[pymethods]
impl Stepper {
    /// Goes to a time, s.
    fn advance_to(&self, py: Python<'_>, t: f64) -> PyResult<()> {
        self.ask(py, Call::Advance(t))
    }

    /// Goes on with a parameter at another value, SI.
    fn set_input(&self, py: Python<'_>, name: String, value: f64) -> PyResult<()> {
        self.ask(py, Call::Set(name, value))
    }

    /// The present time, s.
    #[getter]
    fn time(&self) -> f64 {
        self.present().t
    }

    /// Present coordinates, velocities and first-order states.
    fn state<'py>(&self, py: Python<'py>) -> [Bound<'py, PyArray1<f64>>; 3] {
        let Present { q, v, z, .. } = self.present().clone();
        [q, v, z].map(|values| PyArray1::from_vec(py, values))
    }

    /// Times, s, and names of the events so far.
    #[getter]
    fn events(&self) -> Vec<(f64, String)> {
        self.present().events.clone()
    }

    /// Whether an event has ended the motion.
    #[getter]
    fn ended(&self) -> bool {
        self.present().ended
    }

    /// Names of the columns of the study.
    #[getter]
    fn column_names(&self) -> Vec<String> {
        self.columns.clone()
    }

    /// Their present values, SI.
    fn columns<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.present().columns.clone())
    }
}
