//! Named columns of numbers.

use serde::{Deserialize, Serialize};

/// A unit to show numbers in.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShownIn {
    /// Its name: `mm`.
    pub unit: String,
    /// Its size in SI.
    pub size: f64,
}

/// A named column of numbers, SI.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Column {
    /// Its name, as the model file has it.
    pub name: String,
    /// What is measured, in words: `length`, `angular speed`, `number`; empty if that has no name.
    pub quantity: String,
    /// The SI unit, `N m`; empty for a number.
    pub unit: String,
    /// The unit to show it in, if the model asks for one.
    pub shown_in: Option<ShownIn>,
    /// The values; NaN where there is none.
    pub values: Vec<f64>,
}

impl Column {
    /// The unit to show it in, and its size in SI.
    #[must_use]
    pub fn shown(&self) -> (&str, f64) {
        self.shown_in.as_ref().map_or((&self.unit, 1.0), |asked| (&asked.unit, asked.size))
    }

    /// Its name with the unit to show it in: `torque [N m]`; of a number the name alone.
    #[must_use]
    pub fn heading(&self) -> String {
        match self.shown() {
            ("", _) => self.name.clone(),
            (unit, _) => format!("{} [{unit}]", self.name),
        }
    }
}

/// Columns of one length.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Table {
    /// The columns, in the order of the file.
    pub columns: Vec<Column>,
    /// Rows that stand just before a located switch; the row that follows has the bit-equal independent variable and stands after.
    pub switches: Vec<usize>,
    /// How many rows these were selected from for figures, where all of them went elsewhere; none if these are all.
    pub selected_from: Option<usize>,
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
