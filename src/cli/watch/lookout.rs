//! The look-out: tells the board what has become of the model file and of the files that it includes.
//!
//! Editors write in place, rename a new file over the old one, or delete and write again; contents are compared, whatever they do.

use super::super::files;
use super::super::interrupt::interrupted;
use super::board::Board;
use super::look::{Look, MOST, of};
use grashof::par;
use std::fs::Metadata;
use std::io::{Error, ErrorKind};
use std::sync::Arc;
use std::time::{Duration, SystemTime};

/// Between glances at the length and the time of the file, and how many of them a look at the contents takes that neither tells of: clocks of
/// file systems are coarse, and another program may hold them.
const EVERY: Duration = Duration::from_millis(10);
const GLANCES: u32 = 5;
/// A file whose time is older than this, and the same, is not read again.
const SETTLED: Duration = Duration::from_secs(3);
/// Looks at which a file must be away before that is said: it may be on its way.
const AWAY: u32 = 4;

/// Begins to look, in a thread of its own; `known` is what is known already.
pub(super) fn begin(board: Arc<Board>, known: Look) -> bool {
    par::background("look-out", move || {
        let mut lookout = Lookout { known, stamp: None, doubtful: None, away: 0 };
        let mut glances = 0;
        while !interrupted() {
            std::thread::sleep(EVERY);
            glances += 1;
            if glances >= GLANCES || lookout.stamp.is_some_and(|known| stamp(board.model()).is_some_and(|now| now != known)) {
                lookout.look(&board);
                glances = 0;
            }
        }
    })
}

/// Length and time of a file.
fn stamp(path: &str) -> Option<(u64, SystemTime)> {
    std::fs::metadata(path).ok().and_then(|of: Metadata| Some((of.len(), of.modified().ok()?)))
}

struct Lookout {
    known: Look,
    /// Of the model file when it was last read.
    stamp: Option<(u64, SystemTime)>,
    /// Bytes that are no model: perhaps half of what is being written.
    doubtful: Option<Vec<u8>>,
    away: u32,
}

impl Lookout {
    fn look(&mut self, board: &Board) {
        let model = board.model();
        if self.is_settled(model) && !self.known.included_changed() {
            return;
        }
        let bytes = match files::bytes(model, MOST) {
            Ok(bytes) => bytes,
            Err(error) => return self.miss(board, &error),
        };
        let was_away = std::mem::take(&mut self.away) >= AWAY;
        if bytes == *self.known.bytes && !self.known.included_changed() {
            self.doubtful = None;
            if was_away {
                board.read(self.known.clone());
            }
            return;
        }
        let next = of(model, bytes);
        // shown at the second look, unless it is whole by then
        if next.read.is_err() && self.doubtful.as_ref() != Some(&*next.bytes) {
            self.doubtful = Some((*next.bytes).clone());
            self.stamp = None;
            return;
        }
        self.doubtful = None;
        self.known = next.clone();
        board.read(next);
    }

    /// Whether the file is the one that was read last, without reading it.
    fn is_settled(&mut self, model: &str) -> bool {
        let stamp = stamp(model);
        let old = stamp.is_some_and(|(_, time)| SystemTime::now().duration_since(time).is_ok_and(|age| age > SETTLED));
        let same = stamp.is_some() && stamp == self.stamp && self.doubtful.is_none() && self.away == 0;
        self.stamp = stamp;
        same && old
    }

    fn miss(&mut self, board: &Board, error: &Error) {
        self.away += 1;
        if self.away == AWAY {
            let why = if error.kind() == ErrorKind::NotFound { "it is not there".to_string() } else { error.to_string() };
            board.miss(why);
        }
    }
}
