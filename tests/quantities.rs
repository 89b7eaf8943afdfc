//! Quantities of bodies and joints, works of stops, frames of points, point masses and fields of gravity: held to closed forms, to
//! differences and to other ways of saying the same.

mod fields;
mod frames;
mod points;
mod rates;
mod stops;

use crate::common;
use grashof::mechanism::Coordinates;
use grashof::results::March;
use grashof::studies::common::outcome::Outcome;

/// Columns of a study by their names.
struct Columns {
    names: Vec<String>,
    outcome: Outcome,
}

impl Columns {
    fn of(text: &str, study: &str, coordinates: Coordinates) -> Self {
        Self { names: common::columns(text, study), outcome: common::study(text, study, coordinates) }
    }

    #[track_caller]
    fn get(&self, name: &str) -> Vec<f64> {
        let Some(column) = self.names.iter().position(|n| n == name) else { panic!("no column `{name}` in {:?}", self.names) };
        self.outcome.rows.iter().map(|row| row[column]).collect()
    }

    /// Components of a vector, row by row.
    fn vectors(&self, names: [&str; 3]) -> Vec<[f64; 3]> {
        let [x, y, z] = names.map(|name| self.get(name));
        (0..x.len()).map(|i| [x[i], y[i], z[i]]).collect()
    }

    fn march(&self) -> &March {
        self.outcome.certificate.march.as_ref().expect("a motion in time")
    }
}

#[track_caller]
fn near(what: &str, found: f64, right: f64, within: f64) {
    assert!((found - right).abs() <= within, "{what}: found {found:e}, right is {right:e}, off by {:e}", (found - right).abs());
}

fn apply(r: &[[f64; 3]; 3], x: [f64; 3]) -> [f64; 3] {
    r.map(|row| row.iter().zip(x).map(|(a, b)| a * b).sum())
}

fn product(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|k| (0..3).map(|j| a[i][j] * b[j][k]).sum()))
}

fn transposed(r: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|k| r[k][i]))
}

/// R = R_z(yaw) R_y(pitch) R_x(roll), from the three rotations themselves; degrees.
fn turned([roll, pitch, yaw]: [f64; 3]) -> [[f64; 3]; 3] {
    let [(sr, cr), (sp, cp), (sy, cy)] = [roll, pitch, yaw].map(|x| f64::to_radians(x).sin_cos());
    let x = [[1.0, 0.0, 0.0], [0.0, cr, -sr], [0.0, sr, cr]];
    let y = [[cp, 0.0, sp], [0.0, 1.0, 0.0], [-sp, 0.0, cp]];
    let z = [[cy, -sy, 0.0], [sy, cy, 0.0], [0.0, 0.0, 1.0]];
    product(&z, &product(&y, &x))
}

/// The refusal of a text: all its messages in one.
fn refusal(text: &str, study: Option<&str>) -> String {
    use grashof::model::{Document, Selection};
    let document = match Document::read(text, "test.yaml") {
        Ok(document) => document,
        Err(report) => return format!("{report}"),
    };
    match document.model(&Selection { study, ..Selection::default() }) {
        Ok(_) => panic!("not refused"),
        Err(report) => format!("{report}"),
    }
}
