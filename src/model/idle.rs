//! What a file has to no effect: a `null` that removes nothing, a parameter that nothing uses.

use super::fault::{Fault, Spot};
use super::suggest;
use serde_yaml::{Mapping, Value};
use std::collections::HashSet;

/// A map that is laid over others: the head of its paths, and what it is.
type Patch<'a> = (String, &'a Mapping);

/// Faults of what variants, and a file over the files that it includes, change though it is not there.
pub(super) fn idle<'a>(file: &'a Mapping, below: &[&'a Mapping]) -> Vec<Fault> {
    let empty = Mapping::new();
    let variants = file.get("variants").and_then(Value::as_mapping).unwrap_or(&empty);
    let variants: Vec<Patch<'_>> =
        variants.iter().filter_map(|(name, map)| Some((format!("variants.{}.", name.as_str()?), map.as_mapping()?))).collect();
    let mut faults = Vec::new();
    if !below.is_empty() {
        removals(file, &mut Vec::new(), "", below, &mut faults);
    }
    for (i, (head, patch)) in variants.iter().enumerate() {
        // another variant may have put there what this one removes
        let others = variants.iter().enumerate().filter(|(k, _)| *k != i).map(|(_, (_, map))| *map);
        let layers: Vec<&Mapping> = std::iter::once(file).chain(below.iter().copied()).chain(others).collect();
        removals(patch, &mut Vec::new(), head, &layers, &mut faults);
        faults.extend(unused(patch, head, file, below));
    }
    faults
}

/// Parameters of the file that no expression names: whoever varies one would see nothing change.
pub(super) fn without_effect(file: &Mapping) -> Vec<String> {
    let own = file.get("parameters").and_then(Value::as_mapping).map(keys).unwrap_or_default();
    let mut unnamed: HashSet<&str> = own.iter().map(String::as_str).collect();
    let telling = |key: &&Value| !["name", "about"].iter().any(|text| *key == text);
    file.iter().filter(|(key, _)| telling(key)).for_each(|(_, value)| strike(value, &mut unnamed, false));
    own.iter().filter(|name| unnamed.contains(name.as_str())).cloned().collect()
}

/// Takes the words in the texts of a value out of a set, and in its keys that are expressions; keys that are a name alone set what they
/// name, and count where `set` does, but for those of `parameters`.
fn strike(value: &Value, words: &mut HashSet<&str>, set: bool) {
    let of_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    match value {
        Value::String(text) if !words.is_empty() => text.split(|c| !of_word(c)).for_each(|word| {
            words.remove(word);
        }),
        Value::Sequence(items) => items.iter().for_each(|item| strike(item, words, set)),
        Value::Mapping(map) => map.iter().for_each(|(key, value)| {
            let name = key.as_str().unwrap_or_default();
            if set || !name.chars().all(of_word) {
                strike(key, words, set);
            }
            strike(value, words, set && name != "parameters");
        }),
        Value::Tagged(tagged) => strike(&tagged.value, words, set),
        _ => {}
    }
}

/// What stands at a path.
fn found<'a>(map: &'a Mapping, path: &[&str]) -> Option<&'a Value> {
    let (first, rest) = path.split_first()?;
    rest.iter().try_fold(map.get(*first)?, |value, key| value.as_mapping()?.get(*key))
}

/// Each `null` at whose path no layer has anything.
fn removals<'a>(patch: &'a Mapping, path: &mut Vec<&'a str>, head: &str, layers: &[&Mapping], faults: &mut Vec<Fault>) {
    for (key, value) in patch {
        let Some(key) = key.as_str() else { continue };
        path.push(key);
        match value {
            Value::Null if !layers.iter().any(|layer| found(layer, path).is_some_and(|value| !value.is_null())) => {
                let above = path[..path.len() - 1].join(".");
                let section = |layer: &&'_ Mapping| match above.is_empty() {
                    true => keys(layer),
                    false => found(layer, &path[..path.len() - 1]).and_then(Value::as_mapping).map(keys).unwrap_or_default(),
                };
                let mut known: Vec<String> = layers.iter().flat_map(section).filter(|known| known != key).collect();
                let mut seen = HashSet::new();
                known.retain(|known| seen.insert(known.clone()));
                let expected = if above.is_empty() { "a section of the file".to_owned() } else { format!("an entry of `{above}`") };
                let near = suggest::help(key, known.iter().map(String::as_str)).unwrap_or_else(|| "remove the line".to_owned());
                let message = format!("there is no `{}` that `null` could remove", path.join("."));
                faults.push(Fault::new("nothing-removed", format!("{head}{}", path.join(".")), message, expected).at(Spot::Key).help(near));
            }
            Value::Mapping(inner) if path[0] != "variants" && path[0] != "studies" => removals(inner, path, head, layers, faults),
            _ => {}
        }
        path.pop();
    }
}

fn keys(map: &Mapping) -> Vec<String> {
    map.keys().filter_map(|key| key.as_str().map(str::to_owned)).collect()
}

/// Parameters that a variant brings and that nothing names.
fn unused(patch: &Mapping, head: &str, file: &Mapping, below: &[&Mapping]) -> Vec<Fault> {
    let parameters = |map: &Mapping| map.get("parameters").and_then(Value::as_mapping).map(keys).unwrap_or_default();
    let known: Vec<String> = std::iter::once(file).chain(below.iter().copied()).flat_map(parameters).collect();
    let new: Vec<String> = parameters(patch).into_iter().filter(|name| !known.contains(name)).collect();
    let mut unnamed: HashSet<&str> = new.iter().map(String::as_str).collect();
    file.iter().for_each(|(_, value)| strike(value, &mut unnamed, true));
    new.iter()
        .filter(|name| unnamed.contains(name.as_str()))
        .map(|name| {
            let near = suggest::nearest(name, known.iter().map(String::as_str));
            let help = near.map_or_else(|| "use it in an expression, or remove it".to_owned(), |near| format!("did you mean `{near}`?"));
            let message = format!("nothing uses the parameter `{name}`");
            let place = format!("{head}parameters.{name}");
            Fault::new("unused-parameter", place, message, "a parameter that an expression of the model names").at(Spot::Key).help(help)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places(file: &str, below: &str) -> Vec<(String, Option<String>)> {
        let [file, below]: [Mapping; 2] = [file, below].map(|text| serde_yaml::from_str(text).unwrap());
        let below: Vec<&Mapping> = if below.is_empty() { vec![] } else { vec![&below] };
        idle(&file, &below).into_iter().map(|fault| (fault.place, fault.help)).collect()
    }

    #[test]
    fn nulls_that_remove_nothing_are_found() {
        let file = "{loads: {push: 1, pull: {x: 1}}, start: {S.position: 1}, variants: {a: {loads: {psuh: null, pull: {x: null}}}, \
                    b: {start: {S.positon: null}, drivers: {d: null}}, c: {drivers: {e: {}}}, d: {drivers: {e: null}, loads: null}}}";
        let found = places(file, "{}");
        let wanted = [
            ("variants.a.loads.psuh", "did you mean `push`?"),
            ("variants.b.start.S.positon", "did you mean `S.position`?"),
            ("variants.b.drivers.d", "known: `e`"),
        ];
        assert_eq!(found, wanted.map(|(place, help)| (place.to_owned(), Some(help.to_owned()))));
    }

    #[test]
    fn a_file_removes_what_it_includes() {
        let found = places("{joints: {elbow: null, elbo: null}}", "{joints: {elbow: {}}}");
        assert_eq!(found, [("joints.elbo".to_owned(), Some("did you mean `elbow`?".to_owned()))]);
    }

    #[test]
    fn parameters_of_the_file_without_effect_are_told() {
        let file = "{about: of lost, parameters: {k: 1, c: k/2, lost: 3, v: 1}, springs: {s: {stiffness: 2*c}}, \
                    studies: {s: {sweep: {lost: [1]}, expect: {last(A.omega)-v: 0}}}}";
        let file: Mapping = serde_yaml::from_str(file).unwrap();
        assert_eq!(without_effect(&file), ["lost"]);
    }

    #[test]
    fn parameters_that_nothing_uses_are_found() {
        let file = "{parameters: {k: 1}, springs: {s: {stiffness: 2*k + c}}, studies: {s: {sweep: {n: [1]}}}, \
                    variants: {a: {parameters: {kk: 2, k: 3, c: 4, n: 5}}}}";
        assert_eq!(places(file, "{}"), [("variants.a.parameters.kk".to_owned(), Some("did you mean `k`?".to_owned()))]);
        let expected = "{studies: {s: {expect: {last(A.omega)-v: 0}}}, variants: {a: {parameters: {v: 1}}}}";
        assert_eq!(places(expected, "{}"), []);
    }
}
