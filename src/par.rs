//! Threads, in one place: work that is the same whatever their number.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// f(0), …, f(n − 1) in this order, computed by at most `threads` threads; `done` is called after each, from any thread.
pub fn map<T: Send>(n: usize, threads: usize, f: impl Fn(usize) -> T + Sync, done: impl Fn() + Sync) -> Vec<T> {
    let next = AtomicUsize::new(0);
    let results: Mutex<Vec<Option<T>>> = Mutex::new((0..n).map(|_| None).collect());
    let work = || {
        loop {
            let i = next.fetch_add(1, Ordering::Relaxed);
            if i >= n {
                break;
            }
            let result = f(i);
            if let Ok(mut results) = results.lock() {
                results[i] = Some(result);
            }
            done();
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..threads.min(n) {
            scope.spawn(work);
        }
        work();
    });
    results.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner).into_iter().flatten().collect()
}

/// Work beside everything else, which ends with the program at the latest; false if there is no room for one more thread.
pub fn background(name: &str, work: impl FnOnce() + Send + 'static) -> bool {
    std::thread::Builder::new().name(name.into()).spawn(work).is_ok()
}

/// Number of processors that are there for the taking; 1 if that is not known.
#[must_use]
pub fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, std::num::NonZero::get)
}
