//! Shapes in files: in text an object with its `kind`, in binary form as serde has it by itself, which needs no look ahead.

use super::shape::Shape;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// The same as [`Shape`], in text.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Shape", tag = "kind", rename_all = "kebab-case")]
enum Kinds {
    Bar { from: Vec<f64>, to: Vec<f64>, width: Option<f64> },
    Hull { points: Vec<Vec<f64>> },
    Polygon { points: Vec<Vec<f64>> },
    Disc { center: Vec<f64>, radius: f64, axis: Option<Vec<f64>>, thickness: Option<f64> },
    Gear { center: Vec<f64>, radius: f64, teeth: usize, first: f64 },
    Box { center: Vec<f64>, size: Vec<f64> },
    Cylinder { from: Vec<f64>, to: Vec<f64>, radius: f64 },
    Sphere { center: Vec<f64>, radius: f64 },
    Mass { at: Vec<f64>, mass: f64, radius: f64 },
}

#[derive(Serialize, Deserialize)]
struct Named(#[serde(with = "Kinds")] Shape);

/// Writes shapes.
///
/// # Errors
/// Those of the serializer.
pub(super) fn serialize<S: Serializer>(shapes: &[Shape], serializer: S) -> Result<S::Ok, S::Error> {
    if serializer.is_human_readable() {
        serializer.collect_seq(shapes.iter().map(|shape| Named(shape.clone())))
    } else {
        shapes.serialize(serializer)
    }
}

/// Reads shapes.
///
/// # Errors
/// Those of the deserializer.
pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Shape>, D::Error> {
    if deserializer.is_human_readable() {
        Ok(Vec::<Named>::deserialize(deserializer)?.into_iter().map(|named| named.0).collect())
    } else {
        Vec::deserialize(deserializer)
    }
}

#[cfg(test)]
mod tests {
    use super::Shape;
    use crate::results::scene::Body;

    #[test]
    fn shapes_are_objects_with_their_kind_in_text_and_come_back_from_both_forms() {
        let bar = Shape::Bar { from: vec![0.0, 0.0], to: vec![1.0, 0.0], width: None };
        let body = Body { name: "b".into(), shapes: vec![bar, Shape::Sphere { center: vec![0.0; 3], radius: 2.0 }] };
        let text = serde_json::to_string(&body).expect("text");
        assert!(text.contains(r#"{"kind":"bar","from":[0.0,0.0],"to":[1.0,0.0],"width":null}"#), "{text}");
        assert_eq!(serde_json::from_str::<Body>(&text).expect("a body"), body);
        #[cfg(feature = "cli")]
        {
            let bytes = postcard::to_stdvec(&body).expect("bytes");
            assert_eq!(postcard::from_bytes::<Body>(&bytes).expect("a body"), body);
        }
    }
}
