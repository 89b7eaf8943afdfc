//! The way of a file.

use super::notes::Notes;
use super::options::{Options, Translated};
use super::translation::Translation;
use super::{grammar, guard, robot, translate};
use crate::model::fault::Fault;

/// Reads a URDF and translates it.
///
/// # Errors
/// Everything that is wrong with the file, as far as it can be read.
pub(crate) fn read(text: &str, options: &Options<'_>) -> Result<Translated, Vec<Fault>> {
    let tree = guard::tree(text).map_err(|fault| vec![*fault])?;
    let root = tree.root_element();
    let mut notes = Notes::default();
    let faults = grammar::check(root, &mut notes);
    if !faults.is_empty() {
        return Err(faults);
    }
    let robot = robot::read(root, &mut notes)?;
    let Translation { sections, base, places, remarks } = translate::translate(&robot, options, &mut notes)?;
    Ok(Translated { name: robot.name, sections, base, places, remarks, notes })
}
