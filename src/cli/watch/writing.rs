//! Writing one value back into the model file: the bytes of its number are replaced, all others stay.

use super::super::interrupt::uncut;
use super::board::Board;
use super::look;
use grashof::model::{Document, replaced};
use std::fs;
use std::io::Write;
use std::path::Path;
use std::sync::Arc;

/// Writes where a value was moved to into the file.
///
/// # Errors
/// Why the file stays as it is.
pub(super) fn write(board: &Board, place: &str, to: Option<f64>) -> Result<(), String> {
    let (known, literal, to) = {
        let state = board.lock();
        let literal = state.values.literal(place).cloned().ok_or_else(|| format!("there is no number at `{place}`"))?;
        let to = to.or_else(|| state.values.moved(place)).ok_or_else(|| format!("`{place}` was not moved"))?;
        (state.bytes.clone(), literal, to)
    };
    let path = fs::canonicalize(board.model()).map_err(|error| format!("the file is not there: {error}"))?;
    let changed = || "the file has changed meanwhile: look at its new value first".to_string();
    let text = String::from_utf8((*known).clone()).map_err(|_| changed())?;
    // a file that does not read has no places
    let same = look_of(board, &known).is_some_and(|document| document.literals().contains(&literal));
    if !same || fs::read(&path).ok().as_ref() != Some(&*known) {
        return Err(changed());
    }
    let next = replaced(&text, &[(&literal, to)]);
    uncut(|| renamed_over(&path, next.as_bytes())).map_err(|error| format!("the file cannot be written: {error}"))?;
    Ok(())
}

/// The model of the file's bytes; none if it does not read.
fn look_of(board: &Board, bytes: &[u8]) -> Option<Arc<Document>> {
    look::of(board.model(), bytes.to_vec()).read.ok()
}

/// Writes a file beside another one and renames it over that, with its permissions.
fn renamed_over(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let directory = path.parent().unwrap_or(Path::new("."));
    let mut file = tempfile::NamedTempFile::new_in(directory)?;
    file.write_all(bytes)?;
    file.as_file().set_permissions(fs::metadata(path)?.permissions())?;
    file.as_file().sync_all()?;
    file.persist(path).map(drop).map_err(|error| error.error)
}
