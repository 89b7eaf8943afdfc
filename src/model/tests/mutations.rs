//! Files damaged at random with a fixed seed: whatever they become, they are read or refused, never a panic.

use super::super::*;
use super::FILES;

/// xorshift64*: small, the same everywhere.
struct Dice(u64);

impl Dice {
    fn next(&mut self, below: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 33) as usize % below.max(1)
    }
}

const PIECES: [&str; 40] = [
    "{", "}", "[", "]", ":", ": ", ",", "-", "- ", "*", "&a ", "!t ", "|", ">", "%", "@", "#", "'", "\"", "~", "null", "\t", "\n", "\n  ",
    "0", "1e400", ".nan", "ü", "💥", "(", ")", "rate(", "max(", "rad", "-", "^", "ground", "{}", "[]", "\\",
];

fn mutate(text: &str, dice: &mut Dice) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    for _ in 0..=dice.next(3) {
        let at = dice.next(bytes.len());
        match dice.next(8) {
            0 => bytes[at] = dice.next(256) as u8,
            1 => {
                bytes.remove(at);
            }
            2 | 3 => {
                let piece = PIECES[dice.next(PIECES.len())];
                bytes.splice(at..at, piece.bytes());
            }
            // a line removed, doubled, or exchanged with another
            kind @ 4..=6 => {
                let mut lines: Vec<&[u8]> = bytes.split(|c| *c == b'\n').collect();
                let (i, j) = (dice.next(lines.len()), dice.next(lines.len()));
                match kind {
                    4 => {
                        lines.remove(i);
                    }
                    5 => lines.insert(j, lines[i]),
                    _ => lines.swap(i, j),
                }
                bytes = lines.join(&b'\n');
            }
            // a word replaced by another of the file
            _ => {
                let words: Vec<&str> = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').filter(|w| !w.is_empty()).collect();
                let (from, to) = (words[dice.next(words.len())], words[dice.next(words.len())]);
                let now = String::from_utf8_lossy(&bytes).replacen(from, to, 1 + dice.next(3));
                bytes = now.into_bytes();
            }
        }
        if bytes.is_empty() {
            break;
        }
    }
    bytes
}

#[test]
fn damaged_files_never_panic() {
    let mut dice = Dice(0x5EED_0FA1_2B3C_4D5E);
    let rounds = std::env::var("GRASHOF_MUTATIONS").ok().and_then(|n| n.parse().ok()).unwrap_or(2000);
    let mut read = 0;
    for round in 0..rounds {
        // the largest file takes most of the time and is damaged less often
        let (name, text) = match round % 16 {
            0 => FILES[2],
            k => FILES[[0, 1, 3, 4, 5][k % 5]],
        };
        let bytes = mutate(text, &mut dice);
        let report = match Document::from_bytes(&bytes, name) {
            Ok(document) => {
                read += 1;
                if let Some(study) = document.study_names().first() {
                    let _ = document.model(&Selection { study: Some(study), ..Selection::default() });
                }
                document.check_all(&Selection::default())
            }
            Err(report) => report,
        };
        assert!(!report.render(false).contains('\0'));
    }
    assert!(read > rounds / 4, "most damage should still be YAML: {read}");
}
