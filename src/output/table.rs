//! The table of a study: named columns of numbers.

/// The head of one column.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Header {
    /// The name as the model file has it; an expression may contain commas.
    pub name: String,
    /// The SI unit as text, `N m`; empty for a pure number.
    pub unit: String,
}

impl Header {
    /// A column `name` in `unit`.
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { name: name.into(), unit: unit.into() }
    }
}

/// Rows of numbers under named columns, all in SI units; NaN stands for "no value".
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// The heads, in the order of the file.
    pub columns: Vec<Header>,
    /// One number for each column, row by row.
    pub rows: Vec<Vec<f64>>,
    /// Rows that stand just before a located switch; the row that follows has the bit-equal independent variable and stands after.
    pub switches: Vec<usize>,
    /// A sweep's last column `reason`: one text for each row, empty where the run succeeded.
    pub reasons: Option<Vec<String>>,
}

impl Table {
    /// The index of the column `name`.
    pub fn index(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.name == name)
    }

    /// The numbers of column `index`; NaN where a row is too short.
    pub fn column(&self, index: usize) -> impl Iterator<Item = f64> + '_ {
        self.rows.iter().map(move |row| row.get(index).copied().unwrap_or(f64::NAN))
    }

    /// The values of column `index` at the located switches: the `breaks` of a figure over that column.
    pub fn switch_values(&self, index: usize) -> Vec<f64> {
        let at = |&row: &usize| self.rows.get(row).and_then(|row| row.get(index)).copied();
        self.switches.iter().filter_map(at).collect()
    }

    /// The points of a curve of column `y` over column `x`.
    pub fn points(&self, x: usize, y: usize) -> Vec<(f64, f64)> {
        self.column(x).zip(self.column(y)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_and_switches_are_found_by_name_and_row() {
        let table = Table {
            columns: vec![Header::new("theta", "rad"), Header::new("torque", "N m")],
            rows: vec![vec![0.0, 1.0], vec![0.5, 2.0], vec![0.5, -2.0], vec![1.0]],
            switches: vec![1],
            reasons: None,
        };
        assert_eq!(table.index("torque"), Some(1));
        assert_eq!(table.switch_values(0), [0.5]);
        let points = table.points(0, 1);
        assert_eq!(points[2], (0.5, -2.0));
        assert!(points[3].1.is_nan(), "a missing number is no value");
    }
}
