//! The C library behind a safe interface: the only module that may be unsafe.
//!
//! A [`Solver`] owns all of its C objects. The equations are lent to it for the time of one step. IDA keeps copies of its user data
//! from its first step on, so these are the address of a slot that never moves, in which the equations stand while `IDASolve` runs.
//! A panic inside of them is caught before it reaches C and goes on behind it.

#![allow(unsafe_code)]

use std::any::Any;
use std::cell::Cell;
use std::ffi::{c_int, c_long, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::ptr::null_mut;
use sundials_sys as sys;

/// Newton's method ends when what follows is below this part of the tolerance. (A third, the library's own choice, leaves noise in
/// the differences that choose order and step: twice as many steps on the pendulum.)
const CLOSE: f64 = 0.01;

/// The equations F(t, y, ẏ) = 0.
pub(super) trait Equations {
    /// F, into `out`; false if it is not finite, so that a shorter step is tried.
    fn residual(&mut self, t: f64, y: &[f64], rates: &[f64], out: &mut [f64]) -> bool;

    /// ∂F/∂y + c ∂F/∂ẏ, column after column; false if it does not exist.
    fn jacobian(&mut self, t: f64, c: f64, y: &[f64], rates: &[f64], out: &mut [f64]) -> bool;

    /// Weights of errors: the root mean square of weight times error is 1 at the tolerance.
    fn weights(&mut self, y: &[f64], out: &mut [f64]);
}

/// What a step has cost since the last restart.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Spent {
    /// Failures of the error test and of Newton's method.
    pub(super) rejected: usize,
    /// Evaluations and factorisations of the Jacobian.
    pub(super) jacobians: usize,
    /// Newton iterations.
    pub(super) iterations: usize,
}

/// Why a step failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Failure {
    /// The error test failed too often.
    Error,
    /// Newton's method failed too often, or the equations cannot be evaluated.
    Newton,
}

/// Equations at work, and what they have thrown.
struct Call<'a> {
    equations: &'a mut dyn Equations,
    panic: Option<Box<dyn Any + Send>>,
}

/// Where the address of the [`Call`] at work stands; null between steps.
type Slot = Cell<*mut c_void>;

/// IDA with its vectors, its matrix and its dense solver.
pub(super) struct Solver {
    n: usize,
    /// Time reached, s.
    t: f64,
    slot: Box<Slot>,
    context: sys::SUNContext,
    memory: *mut c_void,
    matrix: sys::SUNMatrix,
    linear: sys::SUNLinearSolver,
    y: sys::N_Vector,
    rates: sys::N_Vector,
    id: sys::N_Vector,
}

impl Solver {
    /// A solver for as many unknowns as `differential` tells apart: those that are false are algebraic, out of the error test.
    ///
    /// # Panics
    /// If the library has no memory left.
    pub(super) fn new(differential: &[bool]) -> Self {
        let n = differential.len();
        let length = n as sys::sunindextype;
        let mut context = null_mut();
        // SAFETY: the pointer to the context is valid for a write; handlers are taken off the new context, if there is one
        let created = unsafe { sys::SUNContext_Create(sys::comm_no_mpi(), &raw mut context) };
        enough(created == 0 && !context.is_null());
        // SAFETY: the context is valid. Without handlers, errors are told by return values and nothing is printed
        unsafe { sys::SUNContext_ClearErrHandlers(context) };
        let vector = || {
            // SAFETY: the context is valid and outlives the vector (see `drop`)
            let vector = unsafe { sys::N_VNew_Serial(length, context) };
            enough(!vector.is_null());
            vector
        };
        let (y, rates, id) = (vector(), vector(), vector());
        // SAFETY: the context is valid and outlives all of these; the vector and the matrix have the same size
        let (matrix, linear, memory) = unsafe {
            let matrix = sys::SUNDenseMatrix(length, length, context);
            enough(!matrix.is_null());
            (matrix, sys::SUNLinSol_Dense(y, matrix, context), sys::IDACreate(context))
        };
        enough(!linear.is_null() && !memory.is_null());
        let slot = Box::new(Cell::new(null_mut()));
        let mut solver = Self { n, t: 0.0, slot, context, memory, matrix, linear, y, rates, id };
        solver.entries_mut(y).fill(0.0);
        solver.entries_mut(rates).fill(0.0);
        for (id, differential) in solver.entries_mut(id).iter_mut().zip(differential) {
            *id = f64::from(u8::from(*differential));
        }
        solver.configure();
        solver
    }

    /// Tells IDA its functions, its linear solver, and which unknowns are algebraic.
    fn configure(&mut self) {
        let memory = self.memory;
        let slot: *const Slot = &raw const *self.slot;
        // SAFETY: `memory` comes from IDACreate; vectors, matrix, linear solver and slot are owned by self and freed after it;
        // the functions have the signatures asked for and live for ever
        let results = unsafe {
            [
                sys::IDAInit(memory, Some(residual), 0.0, self.y, self.rates),
                sys::IDAWFtolerances(memory, Some(weights)),
                sys::IDASetLinearSolver(memory, self.linear, self.matrix),
                sys::IDASetJacFn(memory, Some(jacobian)),
                sys::IDASetId(memory, self.id),
                sys::IDASetNonlinConvCoef(memory, CLOSE),
                sys::IDASetSuppressAlg(memory, sys::SUNTRUE as c_int),
                sys::IDASetUserData(memory, slot.cast_mut().cast()),
            ]
        };
        enough(results.iter().all(|r| *r == sys::IDA_SUCCESS));
    }

    /// Starts afresh at `t` with a first step of `h`: `fill` writes y and ẏ.
    pub(super) fn begin(&mut self, t: f64, h: f64, fill: impl FnOnce(&mut [f64], &mut [f64])) {
        let (y, rates) = (self.y, self.rates);
        // SAFETY: y and ẏ are different vectors of n entries, owned by self, and nothing else refers to them here
        let (y, rates) = unsafe { (slice_mut(y, self.n), slice_mut(rates, self.n)) };
        fill(y, rates);
        self.t = t;
        // SAFETY: IDA is initialised, its vectors are valid
        let results = unsafe { [sys::IDAReInit(self.memory, t, self.y, self.rates), sys::IDASetInitStep(self.memory, h)] };
        debug_assert!(results.iter().all(|r| *r == sys::IDA_SUCCESS));
    }

    /// Longest step, s.
    pub(super) fn set_longest(&mut self, h: f64) {
        // SAFETY: IDA is initialised
        unsafe { sys::IDASetMaxStep(self.memory, h) };
    }

    /// One step that does not pass `until`; returns the time reached, [`Solver::y`] is the solution there.
    pub(super) fn step(&mut self, equations: &mut dyn Equations, until: f64) -> Result<f64, Failure> {
        let mut call = Call { equations, panic: None };
        let mut t = 0.0;
        // else IDA would go on for ever with steps that no longer change the time
        let shortest = 8.0 * f64::EPSILON * self.t.abs();
        self.slot.set((&raw mut call).cast());
        // SAFETY: IDA is initialised; the call outlives IDASolve, and its address is taken back afterwards. The functions are
        // called on this thread only, one at a time
        let result = unsafe {
            sys::IDASetMinStep(self.memory, shortest);
            sys::IDASetStopTime(self.memory, until);
            sys::IDASolve(self.memory, until, &raw mut t, self.y, self.rates, sys::IDA_ONE_STEP)
        };
        self.slot.set(null_mut());
        if let Some(panic) = call.panic {
            resume_unwind(panic);
        }
        match result {
            sys::IDA_SUCCESS | sys::IDA_TSTOP_RETURN => {
                self.t = t;
                Ok(t)
            }
            sys::IDA_ERR_FAIL => Err(Failure::Error),
            _ => Err(Failure::Newton),
        }
    }

    /// y at the time reached.
    pub(super) fn y(&self) -> &[f64] {
        // SAFETY: a vector of n entries, owned by self and borrowed with it
        unsafe { slice(self.y, self.n) }
    }

    /// Order of the last step.
    pub(super) fn order(&self) -> usize {
        let mut order: c_int = 0;
        // SAFETY: IDA is initialised, the pointer is valid for a write
        unsafe { sys::IDAGetLastOrder(self.memory, &raw mut order) };
        order.max(1) as usize
    }

    /// The step that is proposed next, s.
    pub(super) fn next(&self) -> f64 {
        let mut h = 0.0;
        // SAFETY: IDA is initialised, the pointer is valid for a write
        unsafe { sys::IDAGetCurrentStep(self.memory, &raw mut h) };
        h
    }

    /// What was spent since the last [`Solver::begin`].
    pub(super) fn spent(&self) -> Spent {
        let [mut errors, mut failures, mut jacobians, mut iterations]: [c_long; 4] = [0; 4];
        // SAFETY: IDA is initialised, the pointers are valid for a write
        unsafe {
            sys::IDAGetNumErrTestFails(self.memory, &raw mut errors);
            sys::IDAGetNumNonlinSolvConvFails(self.memory, &raw mut failures);
            sys::IDAGetNumJacEvals(self.memory, &raw mut jacobians);
            sys::IDAGetNumNonlinSolvIters(self.memory, &raw mut iterations);
        }
        let count = |x: c_long| usize::try_from(x).unwrap_or(0);
        Spent { rejected: count(errors) + count(failures), jacobians: count(jacobians), iterations: count(iterations) }
    }

    fn entries_mut(&mut self, vector: sys::N_Vector) -> &mut [f64] {
        // SAFETY: only called with the vectors of self, which have n entries, while nothing else refers to them
        unsafe { slice_mut(vector, self.n) }
    }
}

impl Drop for Solver {
    fn drop(&mut self) {
        // SAFETY: each object was made by the library, is owned by self alone, and is freed once, users before what they use
        unsafe {
            sys::IDAFree(&raw mut self.memory);
            sys::SUNLinSolFree(self.linear);
            sys::SUNMatDestroy(self.matrix);
            for vector in [self.y, self.rates, self.id] {
                sys::N_VDestroy(vector);
            }
            sys::SUNContext_Free(&raw mut self.context);
        }
    }
}

/// As Vec does it: to be out of memory is no result.
fn enough(memory: bool) {
    assert!(memory, "SUNDIALS could not be set up: out of memory");
}

/// The entries of a vector.
///
/// # Safety
/// The vector is serial, has n entries, and nobody writes to it while the slice lives.
unsafe fn slice<'a>(vector: sys::N_Vector, n: usize) -> &'a [f64] {
    if n == 0 {
        return &[];
    }
    // SAFETY: a serial vector keeps its entries in one piece
    unsafe { std::slice::from_raw_parts(sys::N_VGetArrayPointer(vector), n) }
}

/// The entries of a vector.
///
/// # Safety
/// The vector is serial, has n entries, and nobody else reads or writes it while the slice lives.
unsafe fn slice_mut<'a>(vector: sys::N_Vector, n: usize) -> &'a mut [f64] {
    if n == 0 {
        return &mut [];
    }
    // SAFETY: a serial vector keeps its entries in one piece
    unsafe { std::slice::from_raw_parts_mut(sys::N_VGetArrayPointer(vector), n) }
}

/// Number of entries.
///
/// # Safety
/// The vector is valid.
unsafe fn length(vector: sys::N_Vector) -> usize {
    // SAFETY: as above
    usize::try_from(unsafe { sys::N_VGetLength(vector) }).unwrap_or(0)
}

/// Runs one function of the equations: 0 if it succeeds, 1 if a shorter step may help, −1 if it panics.
///
/// # Safety
/// `data` is null or the address of a [`Slot`] with null or the address of a [`Call`] that nobody else uses at the same time.
unsafe fn guarded(data: *mut c_void, run: impl FnOnce(&mut dyn Equations) -> bool) -> c_int {
    // SAFETY: as above; the slot itself is only shared
    let call = unsafe { data.cast::<Slot>().as_ref().and_then(|slot| slot.get().cast::<Call<'_>>().as_mut()) };
    let Some(call) = call else { return -1 };
    match catch_unwind(AssertUnwindSafe(|| run(call.equations))) {
        Ok(true) => 0,
        Ok(false) => 1,
        Err(panic) => {
            call.panic = Some(panic);
            -1
        }
    }
}

unsafe extern "C" fn residual(t: f64, y: sys::N_Vector, rates: sys::N_Vector, out: sys::N_Vector, data: *mut c_void) -> c_int {
    // SAFETY: IDA lends three different vectors of n entries for the time of this call, and hands on the slot
    unsafe {
        let n = length(y);
        let (y, rates, out) = (slice(y, n), slice(rates, n), slice_mut(out, n));
        guarded(data, |equations| equations.residual(t, y, rates, out))
    }
}

#[allow(clippy::too_many_arguments, reason = "the signature is the library's")]
unsafe extern "C" fn jacobian(
    t: f64,
    c: f64,
    y: sys::N_Vector,
    rates: sys::N_Vector,
    _: sys::N_Vector,
    matrix: sys::SUNMatrix,
    data: *mut c_void,
    _: sys::N_Vector,
    _: sys::N_Vector,
    _: sys::N_Vector,
) -> c_int {
    // SAFETY: IDA lends two vectors of n entries and a dense n × n matrix, whose columns lie in one piece, for the time of this
    // call, and hands on the slot
    unsafe {
        let n = length(y);
        let (y, rates) = (slice(y, n), slice(rates, n));
        let out = std::slice::from_raw_parts_mut(sys::SUNDenseMatrix_Data(matrix), n * n);
        guarded(data, |equations| equations.jacobian(t, c, y, rates, out))
    }
}

unsafe extern "C" fn weights(y: sys::N_Vector, out: sys::N_Vector, data: *mut c_void) -> c_int {
    // SAFETY: IDA lends two different vectors of n entries for the time of this call, and hands on the slot
    unsafe {
        let n = length(y);
        let (y, out) = (slice(y, n), slice_mut(out, n));
        guarded(data, |equations| {
            equations.weights(y, out);
            true
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ẏ = −y, x = y², with a fault from a time on.
    struct Decay {
        until: f64,
        fault: fn() -> bool,
    }

    impl Equations for Decay {
        fn residual(&mut self, t: f64, y: &[f64], rates: &[f64], out: &mut [f64]) -> bool {
            out[0] = rates[0] + y[0];
            out[1] = y[1] - y[0] * y[0];
            t <= self.until || (self.fault)()
        }

        fn jacobian(&mut self, _: f64, c: f64, y: &[f64], _: &[f64], out: &mut [f64]) -> bool {
            out.copy_from_slice(&[c + 1.0, -2.0 * y[0], 0.0, 1.0]);
            true
        }

        fn weights(&mut self, _: &[f64], out: &mut [f64]) {
            out.fill(1e8);
        }
    }

    fn started() -> Solver {
        let mut solver = Solver::new(&[true, false]);
        solver.begin(0.0, 1e-4, |y, rates| {
            y.fill(1.0);
            rates.copy_from_slice(&[-1.0, 0.0]);
        });
        solver
    }

    #[test]
    fn steps_end_where_they_are_told() {
        let (mut solver, mut decay, mut t) = (started(), Decay { until: 9.0, fault: || true }, 0.0);
        while t < 1.0 {
            // IDA must not keep the address of the equations between steps
            let mut moved = Box::new(Decay { ..decay });
            t = solver.step(&mut *moved, 1.0).unwrap();
            decay = *moved;
        }
        assert_eq!(t, 1.0);
        assert!((solver.y()[0] - (-1.0_f64).exp()).abs() < 1e-6);
        assert!((solver.y()[1] - (-2.0_f64).exp()).abs() < 1e-6);
        assert!(solver.spent().jacobians > 0 && solver.spent().iterations > 0);
    }

    #[test]
    fn what_cannot_be_evaluated_is_a_failure_not_an_end() {
        let (mut solver, mut decay) = (started(), Decay { until: 0.5, fault: || false });
        let mut t = 0.0;
        let failure = loop {
            match solver.step(&mut decay, 1.0) {
                Ok(reached) => t = reached,
                Err(failure) => break failure,
            }
        };
        assert_eq!(failure, Failure::Newton);
        assert!(t > 0.4 && t <= 0.5);
    }

    #[test]
    fn a_panic_goes_through_c_unharmed() {
        let (mut solver, mut decay) = (started(), Decay { until: 0.1, fault: || panic!("as told") });
        let thrown = catch_unwind(AssertUnwindSafe(|| while solver.step(&mut decay, 1.0).is_ok() {}));
        assert_eq!(thrown.unwrap_err().downcast_ref::<&str>(), Some(&"as told"));
        // the solver is as good as new behind it
        solver.begin(0.0, 1e-4, |y, rates| {
            y.fill(1.0);
            rates.copy_from_slice(&[-1.0, 0.0]);
        });
        assert!(solver.step(&mut Decay { until: 9.0, fault: || true }, 1.0).is_ok());
    }
}
