//! Keys that are written in another table than their own.

use super::decode::STUDY;
use super::fields::{Field, Record, Shape};
use super::suggest::clip;
use super::tables::FILE;

/// Words for a section of the file that are not its name.
const SYNONYMS: [(&str, &str); 6] = [
    ("initial", "start"),
    ("initials", "start"),
    ("initial_conditions", "start"),
    ("initial_values", "start"),
    ("initial_state", "start"),
    ("init", "start"),
];

/// Where an unknown key of a table belongs: in a table that one of its keys holds (first of all one that is there), beside the table
/// in a study, or in the file. None if no table near has it, or if it is like a key of its own table and none that is there has it.
pub(super) fn help(key: &str, table: &'static Record, is_like_own: bool, is_there: &dyn Fn(&Field) -> bool) -> Option<String> {
    let holds = |field: &&Field| records(&field.shape).any(|record| record.field(key).is_some());
    let holders: Vec<&Field> = table.fields.iter().filter(holds).collect();
    if let Some(field) = holders.iter().find(|field| is_there(field)) {
        return Some(format!("write it inside of `{0}`: `{0}: {{ {key}: .. }}`", field.key));
    }
    let of_file = std::ptr::eq(table, &FILE);
    if key == "name" && !of_file {
        return Some("remove it: what is named in the model has its name as its key, before this table".into());
    }
    if is_like_own {
        return None;
    }
    if !holders.is_empty() {
        let names: Vec<String> = holders.iter().take(3).map(|field| format!("`{}`", field.key)).collect();
        return Some(format!("`{key}` is a key of {}: write `{}: {{ {key}: .. }}`", names.join(", "), holders[0].key));
    }
    let of_study = STUDY.fields.iter().find(|field| records(&field.shape).any(|record| std::ptr::eq(record, table)));
    if let Some(kind) = of_study
        && STUDY.field(key).is_some()
    {
        return Some(format!("`{key}` is a key of the study: write it beside `{}`, not inside of it", kind.key));
    }
    let section = SYNONYMS.iter().find(|(word, _)| *word == key).map_or(key, |(_, section)| section);
    if of_file {
        return (section != key).then(|| format!("write `{section}:` in place of `{}:`", clip(key)));
    }
    if key == "about" {
        return Some("write it as a comment, behind `#`: a model and its studies have an `about`".into());
    }
    let field = FILE.field(section).filter(|field| !matches!(field.shape, Shape::Later))?;
    Some(format!("`{}` is a section of the model: write it at the beginning of a line, beside `studies:`", field.key))
}

/// The tables that a value of this shape can be.
fn records(shape: &Shape) -> impl Iterator<Item = &'static Record> {
    let of = |shape: &Shape| match shape {
        Shape::Map(record) => Some(*record),
        _ => None,
    };
    let choices: &[Shape] = if let Shape::Either(choices) = shape { choices } else { &[] };
    of(shape).into_iter().chain(choices.iter().filter_map(of))
}
