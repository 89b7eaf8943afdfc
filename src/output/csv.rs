//! CSV by RFC 4180, but with LF line ends: one header line of names, then rows of numbers in shortest round-trip form.

use crate::results::{Column, Table, number};
use std::borrow::Cow;
use std::fmt::Write;

/// The text of the CSV file of `table`, with the `reason` column last if there is one.
pub fn write_csv(table: &Table) -> String {
    let mut text = String::with_capacity(table.rows() * table.columns.len() * 20 + 256);
    let names = table.columns.iter().map(|column| quoted(&column.name));
    push_line(&mut text, names.chain(table.reasons.iter().map(|_| Cow::Borrowed("reason"))));
    for index in 0..table.rows() {
        // a short column is filled up: every line must have as many fields as the header
        let value = |column: &Column| Cow::Owned(number(column.values.get(index).copied().unwrap_or(f64::NAN)));
        let values = table.columns.iter().map(value);
        let reason = table.reasons.as_ref().map(|reasons| quoted(reasons.get(index).map_or("", String::as_str)));
        push_line(&mut text, values.chain(reason));
    }
    text
}

pub(super) fn push_line<'a>(text: &mut String, fields: impl Iterator<Item = Cow<'a, str>>) {
    for (index, field) in fields.enumerate() {
        let separator = if index == 0 { "" } else { "," };
        // Writing to a String cannot fail.
        let _ = write!(text, "{separator}{field}");
    }
    text.push('\n');
}

/// A field as RFC 4180 has it: in quotes, inner quotes doubled, if it holds a comma, a quote or a line end.
pub(super) fn quoted(field: &str) -> Cow<'_, str> {
    if field.contains([',', '"', '\n', '\r']) { Cow::Owned(format!("\"{}\"", field.replace('"', "\"\""))) } else { Cow::Borrowed(field) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column(name: &str, unit: &str, values: &[f64]) -> Column {
        Column { name: name.into(), unit: unit.into(), values: values.to_vec(), ..Column::default() }
    }

    #[test]
    fn every_number_reads_back_bit_for_bit() {
        let samples =
            [0.0, -0.0, 0.1 + 0.2, 1.0, 1e15, 1e16, 1e22, 1.5e-7, 1e-5, f64::MIN_POSITIVE, 5e-324, f64::MAX, std::f64::consts::PI];
        for x in samples {
            assert_eq!(number(x).parse::<f64>().map(f64::to_bits), Ok(x.to_bits()), "{}", number(x));
        }
        assert_eq!(number(360.0), "360");
        assert_eq!(number(-2.5), "-2.5");
        assert_eq!(number(1e22), "1e22");
    }

    #[test]
    fn a_table_reads_back() {
        let columns = vec![column("t", "s", &[0.0, 1.0, f64::INFINITY]), column("atan2(a, b)", "rad", &[1.0 / 3.0, f64::NAN, -7e-12])];
        let table = Table { columns, ..Table::default() };
        assert_eq!(write_csv(&table), "t,\"atan2(a, b)\"\n0,0.3333333333333333\n1,\n,-7e-12\n");
    }

    #[test]
    fn reasons_are_quoted_and_last() {
        let table = Table {
            columns: vec![column("I_f", "kg m^2", &[1.0, 2.0, f64::NAN])],
            reasons: Some(vec![String::new(), "no turn, \"dead point\"\nat 12 deg".into()]),
            ..Table::default()
        };
        assert_eq!(write_csv(&table), "I_f,reason\n1,\n2,\"no turn, \"\"dead point\"\"\nat 12 deg\"\n,\n");
    }
}
