//! CSV by RFC 4180, but with LF line ends: one header line of names, then rows of numbers in shortest round-trip form.

use super::Table;
use std::borrow::Cow;
use std::fmt::Write;

/// The shortest text that reads back as the same `f64`; empty for what is not a finite number.
///
/// Rust's own shortest digits; exponents only where the plain form would have long rows of zeros. Whole numbers have no `.0`.
pub fn number(x: f64) -> String {
    let size = x.abs();
    if !x.is_finite() {
        String::new()
    } else if size != 0.0 && !(1e-5..1e16).contains(&size) {
        format!("{x:e}")
    } else {
        format!("{x}")
    }
}

/// The text of the CSV file of `table`, with the `reason` column last if there is one.
pub fn write_csv(table: &Table) -> String {
    let mut text = String::with_capacity(table.rows.len() * table.columns.len() * 20 + 256);
    let names = table.columns.iter().map(|column| quoted(&column.name));
    push_line(&mut text, names.chain(table.reasons.iter().map(|_| Cow::Borrowed("reason"))));
    for (index, row) in table.rows.iter().enumerate() {
        // A short row is filled up: every line must have as many fields as the header.
        let values = (0..table.columns.len()).map(|column| Cow::Owned(number(row.get(column).copied().unwrap_or(f64::NAN))));
        let reason = table.reasons.as_ref().map(|reasons| quoted(reasons.get(index).map_or("", String::as_str)));
        push_line(&mut text, values.chain(reason));
    }
    text
}

fn push_line<'a>(text: &mut String, fields: impl Iterator<Item = Cow<'a, str>>) {
    for (index, field) in fields.enumerate() {
        let separator = if index == 0 { "" } else { "," };
        // Writing to a String cannot fail.
        let _ = write!(text, "{separator}{field}");
    }
    text.push('\n');
}

/// A field as RFC 4180 has it: in quotes, inner quotes doubled, if it holds a comma, a quote or a line end.
fn quoted(field: &str) -> Cow<'_, str> {
    if field.contains([',', '"', '\n', '\r']) { Cow::Owned(format!("\"{}\"", field.replace('"', "\"\""))) } else { Cow::Borrowed(field) }
}

#[cfg(test)]
mod tests {
    use super::super::Header;
    use super::*;

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
        let rows = vec![vec![0.0, 1.0 / 3.0], vec![1.0, f64::NAN], vec![f64::INFINITY, -7e-12]];
        let table = Table { columns: vec![Header::new("t", "s"), Header::new("atan2(a, b)", "rad")], rows, ..Table::default() };
        assert_eq!(write_csv(&table), "t,\"atan2(a, b)\"\n0,0.3333333333333333\n1,\n,-7e-12\n");
    }

    #[test]
    fn reasons_are_quoted_and_last() {
        let table = Table {
            columns: vec![Header::new("I_f", "kg m^2")],
            rows: vec![vec![1.0], vec![2.0], vec![]],
            reasons: Some(vec![String::new(), "no turn, \"dead point\"\nat 12 deg".into()]),
            ..Table::default()
        };
        assert_eq!(write_csv(&table), "I_f,reason\n1,\n2,\"no turn, \"\"dead point\"\"\nat 12 deg\"\n,\n");
    }
}
