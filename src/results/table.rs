//! Named columns of numbers.

use serde::{Deserialize, Serialize};

/// A named column of numbers, SI.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Column {
    /// Its name, as the model file has it.
    pub name: String,
    /// What is measured, in words: `length`, `angular speed`, `number`; empty if that has no name.
    pub quantity: String,
    /// The SI unit, `N m`; empty for a number.
    pub unit: String,
    /// The values; NaN where there is none.
    pub values: Vec<f64>,
}

/// Columns of one length.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Table {
    /// The columns, in the order of the file.
    pub columns: Vec<Column>,
    /// Rows that stand just before a located switch; the row that follows has the bit-equal independent variable and stands after.
    pub switches: Vec<usize>,
    /// For the runs of a sweep why each has no whole result; empty where it has.
    pub reasons: Option<Vec<String>>,
}

impl Table {
    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.columns.first().map_or_else(|| self.reasons.as_ref().map_or(0, Vec::len), |column| column.values.len())
    }

    /// The column of a name.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.name == name)
    }

    /// The numbers of a row.
    pub fn row(&self, row: usize) -> impl Iterator<Item = f64> + '_ {
        self.columns.iter().map(move |column| column.values.get(row).copied().unwrap_or(f64::NAN))
    }
}
