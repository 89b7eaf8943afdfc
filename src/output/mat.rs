//! MAT-files of level 4, which MATLAB, Octave and SciPy read: full matrices of doubles, and texts, one after the other.
//!
//! ```text
//! header   type 1000 M + 100 O + 10 P + T (M = 0: little endian, P = 0: doubles, T = 0 numbers or 1 text), rows, columns,
//!          0 (no imaginary part), length of the name with its zero; each a 32-bit integer
//! name     with a zero behind
//! data     doubles, column after column; of a text the codes of its letters
//! ```
//!
//! (The MathWorks, MAT-File Format, "Level 4 MAT-Files".)

/// What a variable holds.
#[derive(Clone, Debug, PartialEq)]
pub enum MatValue {
    /// A matrix: its number of columns, and its rows.
    Matrix(usize, Vec<Vec<f64>>),
    /// Lines of text, in ASCII; other letters become `?`.
    Text(Vec<String>),
}

/// The bytes of a MAT-file with these variables; names are letters, digits and `_`, and begin with a letter.
pub fn write_mat(variables: &[(String, MatValue)]) -> Vec<u8> {
    let mut out = Vec::new();
    for (name, value) in variables {
        let (kind, rows, columns) = match value {
            MatValue::Matrix(columns, rows) => (0, rows.len(), *columns),
            MatValue::Text(lines) => (1, lines.len(), lines.iter().map(|l| l.chars().count()).max().unwrap_or(0)),
        };
        for number in [kind, rows, columns, 0, name.len() + 1] {
            // sizes of what fits in memory as text are far below the limit
            out.extend(u32::try_from(number).unwrap_or(u32::MAX).to_le_bytes());
        }
        out.extend(name.bytes().chain([0]));
        for column in 0..columns {
            for row in 0..rows {
                out.extend(entry(value, row, column).to_le_bytes());
            }
        }
    }
    out
}

/// An entry as a number; short rows and lines are filled up.
fn entry(value: &MatValue, row: usize, column: usize) -> f64 {
    match value {
        MatValue::Matrix(_, rows) => rows[row].get(column).copied().unwrap_or(f64::NAN),
        MatValue::Text(lines) => {
            let letter = lines[row].chars().nth(column).unwrap_or(' ');
            f64::from(if letter.is_ascii() { letter as u32 } else { u32::from(b'?') })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Name, type, rows, columns and data of each variable.
    fn read(mut bytes: &[u8]) -> Vec<(String, u32, usize, usize, Vec<f64>)> {
        let mut out = Vec::new();
        while !bytes.is_empty() {
            let (head, rest) = bytes.split_at(20);
            let number = |i: usize| u32::from_le_bytes([head[4 * i], head[4 * i + 1], head[4 * i + 2], head[4 * i + 3]]);
            let (rows, columns, length) = (number(1) as usize, number(2) as usize, number(4) as usize);
            assert_eq!(number(3), 0, "real");
            let (name, rest) = rest.split_at(length);
            let (data, rest) = rest.split_at(8 * rows * columns);
            let data = data.chunks_exact(8).map(|c| f64::from_le_bytes(c.try_into().unwrap())).collect();
            assert_eq!(name[length - 1], 0);
            out.push((String::from_utf8(name[..length - 1].to_vec()).unwrap(), number(0), rows, columns, data));
            bytes = rest;
        }
        out
    }

    #[test]
    fn matrices_and_texts_read_back() {
        let a = MatValue::Matrix(3, vec![vec![1.0, 2.0, 3.0], vec![4.0, 5.0, 1e-300]]);
        let none = MatValue::Matrix(2, vec![]);
        let text = MatValue::Text(vec!["ab".into(), "c".into(), "é".into()]);
        let found = read(&write_mat(&[("A".into(), a), ("B".into(), none), ("names".into(), text)]));
        assert_eq!(found[0], ("A".into(), 0, 2, 3, vec![1.0, 4.0, 2.0, 5.0, 3.0, 1e-300]));
        assert_eq!(found[1], ("B".into(), 0, 0, 2, vec![]));
        let codes = [b'a', b'c', b'?', b'b', b' ', b' '].map(f64::from);
        assert_eq!(found[2], ("names".into(), 1, 3, 2, codes.to_vec()));
    }
}
