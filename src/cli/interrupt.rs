//! Ctrl-C and the request to end: SIGINT and SIGTERM.
//!
//! Whatever computes asks [`interrupted`] as often as it can, and ends by itself. What does not ask in time has nothing to keep,
//! and a watch ends the program for it; only a motion in time, which keeps its rows up to there, and the writing of files are
//! waited for. A second signal ends the program at once.

use super::code;
use super::end::end;
use super::terminal::{print_interrupted, print_note, take_errors};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, LazyLock, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Between looks of the watch.
const LOOK: Duration = Duration::from_millis(5);
/// What ends by itself does so within this.
const GRACE: Duration = Duration::from_millis(30);
/// What the watch gives itself to say so.
const TO_PRINT: Duration = Duration::from_millis(50);
/// What the writing of files is given to clear what it has begun; if the disc is slower, the next run does so.
const FOR_FILES: Duration = Duration::from_millis(70);
/// What a motion in time that has heard the signal is given for its rows.
const FOR_ROWS: Duration = Duration::from_secs(20);

static INTERRUPTED: LazyLock<Arc<AtomicBool>> = LazyLock::new(|| Arc::new(AtomicBool::new(false)));
/// Whether the user was told so.
static HEARD: AtomicBool = AtomicBool::new(false);
/// What is going on that must not be cut: writing of files.
static UNCUT: AtomicUsize = AtomicUsize::new(0);
/// Whether what runs has results to keep when it is interrupted.
static KEEPS: AtomicBool = AtomicBool::new(false);
/// Whether the program is ending by itself.
static ENDING: AtomicBool = AtomicBool::new(false);
/// What is to be said of what runs if it is cut off.
static CUT_OFF: Mutex<String> = Mutex::new(String::new());

/// From here on signals are noted.
pub(super) fn watch_interrupts() {
    for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM] {
        // in this order: the first signal finds nothing noted yet
        let _ = signal_hook::flag::register_conditional_shutdown(signal, i32::from(code::INTERRUPTED), Arc::clone(&INTERRUPTED));
        let _ = signal_hook::flag::register(signal, Arc::clone(&INTERRUPTED));
    }
    std::thread::spawn(watch);
}

/// Whether a signal has come.
pub(super) fn interrupted() -> bool {
    let yes = INTERRUPTED.load(Ordering::Relaxed);
    if yes {
        HEARD.store(true, Ordering::Relaxed);
    }
    yes
}

/// What is to be said if what runs from here on is cut off; `keeps` if it has results to keep once it has heard the signal.
pub(super) fn begins(cut_off: String, keeps: bool) {
    *CUT_OFF.lock().unwrap_or_else(PoisonError::into_inner) = cut_off;
    KEEPS.store(keeps, Ordering::Relaxed);
}

/// Does what must not be cut.
pub(super) fn uncut<T>(work: impl FnOnce() -> T) -> T {
    UNCUT.fetch_add(1, Ordering::SeqCst);
    let done = work();
    UNCUT.fetch_sub(1, Ordering::SeqCst);
    done
}

/// Says what was interrupted; the program ends by itself from here.
pub(super) fn print_end(message: &str) {
    if ENDING.swap(true, Ordering::SeqCst) {
        // the watch is printing it, and ends the program any moment
        std::thread::sleep(Duration::from_secs(1));
    } else {
        print_interrupted(message);
    }
}

fn watch() {
    while !INTERRUPTED.load(Ordering::Relaxed) {
        std::thread::sleep(LOOK);
    }
    let begun = Instant::now();
    std::thread::sleep(GRACE);
    let mut told = false;
    loop {
        let keeps = KEEPS.load(Ordering::Relaxed) && HEARD.load(Ordering::Relaxed) && begun.elapsed() < FOR_ROWS;
        let writes = UNCUT.load(Ordering::SeqCst) > 0 && begun.elapsed() < FOR_FILES;
        if ENDING.load(Ordering::SeqCst) || !(keeps || writes) {
            break;
        }
        if keeps && !std::mem::replace(&mut told, true) {
            std::thread::spawn(|| {
                print_note("interrupted: what there is up to here is being written; a second signal ends the program at once")
            });
        }
        std::thread::sleep(LOOK);
    }
    if ENDING.swap(true, Ordering::SeqCst) {
        return;
    }
    // stderr may be a pipe that nobody reads
    let told = std::thread::spawn(|| {
        let message = std::mem::take(&mut *CUT_OFF.lock().unwrap_or_else(PoisonError::into_inner));
        print_interrupted(if message.is_empty() { "interrupted: nothing is written" } else { &message });
        end(code::INTERRUPTED, take_errors())
    });
    let printing = Instant::now();
    while !told.is_finished() && printing.elapsed() < TO_PRINT {
        std::thread::sleep(LOOK / 10);
    }
    std::process::exit(i32::from(code::INTERRUPTED));
}
