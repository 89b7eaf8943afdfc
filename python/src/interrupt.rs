//! Long computations, which a signal ends.

use crate::errors::interrupted;
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// How often it is asked whether there was a signal.
const LOOK: Duration = Duration::from_millis(40);
/// How long a computation that was told to end is waited for.
const GRACE: Duration = Duration::from_millis(30);

/// Stack of a thread, bytes: as much as that of the program.
const STACK: usize = 8 << 20;

/// Tells a computation to end.
pub(crate) type Flag = Arc<AtomicBool>;

/// Computes something in a thread of its own while the interpreter serves its other threads. A signal whose handler raises, as that of
/// Ctrl-C does, sets the flag; what does not ask for it in time goes on unheard until it ends.
///
/// # Errors
/// What the handler of a signal raises.
pub(crate) fn away<T: Send + 'static>(py: Python<'_>, work: impl FnOnce(&Flag) -> T + Send + 'static) -> PyResult<T> {
    let flag = Flag::default();
    let (sender, receiver) = channel();
    let own = Arc::clone(&flag);
    begin(move || {
        // nobody listens any more to what was given up
        let _ = sender.send(work(&own));
    })?;
    awaited(py, receiver, &flag)
}

/// Begins a thread.
///
/// # Errors
/// If the system gives none.
pub(crate) fn begin(work: impl FnOnce() + Send + 'static) -> std::io::Result<()> {
    std::thread::Builder::new().stack_size(STACK).spawn(work).map(drop)
}

/// What comes through a channel; a signal sets the flag.
///
/// # Errors
/// What the handler of a signal raises; that nothing comes any more.
pub(crate) fn awaited<T: Send>(py: Python<'_>, receiver: Receiver<T>, flag: &Flag) -> PyResult<T> {
    // a receiver alone may not be lent to the other side of the interpreter's lock
    let receiver = Mutex::new(receiver);
    let wait = |time| receiver.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(time);
    loop {
        match py.detach(|| wait(LOOK)) {
            Ok(value) => return Ok(value),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                return Err(pyo3::exceptions::PyRuntimeError::new_err("the computation has ended without a result"));
            }
        }
        if let Err(raised) = py.check_signals() {
            flag.store(true, Ordering::Relaxed);
            let _ = py.detach(|| wait(GRACE));
            return Err(interrupted(py, raised));
        }
    }
}
