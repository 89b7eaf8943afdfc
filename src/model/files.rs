//! Files beside a model, which the caller reads: those that it includes, and measured data.

/// Gives the bytes of a file that a model names, and the name by which messages call it; the error says why not.
pub type Files<'f> = dyn Fn(&str) -> Result<(String, Vec<u8>), String> + 'f;
