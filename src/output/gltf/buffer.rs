//! The numbers of a file: bytes, what part of them is what, and how it is read.

use serde_json::{Value, json};

/// What the bytes of corners and of their order are for.
pub(super) const VERTICES: u32 = 34962;
const INDICES: u32 = 34963;
/// Kinds of numbers.
const FLOAT: u32 = 5126;
const UNSIGNED: u32 = 5125;

/// Numbers, all of them of 4 bytes.
#[derive(Clone, Debug, Default)]
pub(super) struct Buffer {
    pub(super) bytes: Vec<u8>,
    pub(super) views: Vec<Value>,
    pub(super) accessors: Vec<Value>,
}

impl Buffer {
    /// Adds values of N numbers each, with their `bounds` if these are wanted; gives the number of the accessor.
    pub(super) fn floats<const N: usize>(&mut self, values: &[[f64; N]], target: Option<u32>, bounds: bool) -> usize {
        let singles: Vec<[f32; N]> = values.iter().map(|value| value.map(|x| x as f32)).collect();
        let view = self.view(singles.iter().flatten().flat_map(|x| x.to_le_bytes()), target);
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][N - 1];
        let mut accessor = json!({ "bufferView": view, "componentType": FLOAT, "count": values.len(), "type": kind });
        if bounds {
            let bound = |pick: fn(f32, f32) -> f32| -> Vec<f32> {
                (0..N).map(|i| singles.iter().map(|value| value[i]).reduce(pick).unwrap_or_default()).collect()
            };
            accessor["min"] = numbers(&bound(f32::min));
            accessor["max"] = numbers(&bound(f32::max));
        }
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// Adds corners of triangles by their numbers.
    pub(super) fn indices(&mut self, indices: &[u32]) -> usize {
        let view = self.view(indices.iter().flat_map(|i| i.to_le_bytes()), Some(INDICES));
        self.accessors.push(json!({ "bufferView": view, "componentType": UNSIGNED, "count": indices.len(), "type": "SCALAR" }));
        self.accessors.len() - 1
    }

    fn view(&mut self, bytes: impl Iterator<Item = u8>, target: Option<u32>) -> usize {
        let from = self.bytes.len();
        self.bytes.extend(bytes);
        let mut view = json!({ "buffer": 0, "byteOffset": from, "byteLength": self.bytes.len() - from });
        if let Some(target) = target {
            view["target"] = target.into();
        }
        self.views.push(view);
        self.views.len() - 1
    }
}

/// Numbers exactly as they stand in the bytes.
fn numbers(values: &[f32]) -> Value {
    values.iter().map(|x| f64::from(*x)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_those_of_the_bytes() {
        let mut buffer = Buffer::default();
        let first = buffer.floats(&[[0.1, 2.0, -3.0], [0.2, 1.0, 5.0]], None, true);
        assert_eq!(buffer.accessors[first]["min"], json!([f64::from(0.1f32), 1.0, -3.0]));
        assert_eq!(buffer.accessors[first]["max"], json!([f64::from(0.2f32), 2.0, 5.0]));
        buffer.indices(&[0, 1, 2]);
        assert_eq!((buffer.bytes.len(), &buffer.views[1]["byteOffset"]), (36, &json!(24)));
    }
}
