//! The JSON Schema of the format (draft 2020-12), made from the tables of fields.

use super::fields::{Choice, Keys, Record, Shape, Size, Want};
use super::tables::{FILE, NOT_IN_VARIANTS};
use serde_json::{Map, Value, json};

/// The schema of a model file.
#[must_use]
pub fn schema() -> Value {
    let mut root = json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Grashof model",
    });
    if let (Value::Object(root), Value::Object(file)) = (&mut root, table(&FILE, false)) {
        root.extend(file);
    }
    root
}

/// `patch`: nothing is required and `null` removes.
fn table(table: &Record, patch: bool) -> Value {
    let mut properties = Map::new();
    // a patch of the file has no variants of its own
    let left_out = |key: &str| patch && std::ptr::eq(table, &FILE) && NOT_IN_VARIANTS.contains(&key);
    for field in table.fields.iter().filter(|field| !matches!(field.shape, Shape::Later) && !left_out(field.key)) {
        let mut value = shape(&field.shape, patch);
        if patch {
            value = json!({ "anyOf": [value, { "type": "null" }] });
        }
        if let Value::Object(map) = &mut value {
            map.insert("description".to_owned(), json!(field.doc));
        }
        properties.insert(field.key.to_owned(), value);
    }
    let mut schema = Map::new();
    schema.insert("type".to_owned(), json!("object"));
    schema.insert("properties".to_owned(), Value::Object(properties));
    schema.insert("additionalProperties".to_owned(), json!(false));
    if patch {
        return Value::Object(schema);
    }
    let required: Vec<&str> = table.fields.iter().filter(|field| field.required).map(|field| field.key).collect();
    if !required.is_empty() {
        schema.insert("required".to_owned(), json!(required));
    }
    let choices: Vec<Value> = table.choices.iter().map(choice).collect();
    match choices.len() {
        0 => {}
        1 => {
            if let Some(Value::Object(one)) = choices.into_iter().next() {
                schema.extend(one);
            }
        }
        _ => {
            schema.insert("allOf".to_owned(), Value::Array(choices));
        }
    }
    Value::Object(schema)
}

/// Exactly one, or at most one, of some keys.
fn choice(choice: &Choice) -> Value {
    let mut cases: Vec<Value> = choice.keys.iter().map(|key| json!({ "required": [key] })).collect();
    if !choice.required {
        cases.push(json!({ "not": { "anyOf": cases } }));
    }
    json!({ "oneOf": cases })
}

fn shape(of: &Shape, patch: bool) -> Value {
    match of {
        Shape::Value(want) => number(*want),
        Shape::Formula(words) => json!({ "type": ["number", "string"], "title": words }),
        Shape::Text => json!({ "type": "string" }),
        Shape::Word(words) => json!({ "enum": words }),
        Shape::Flag => json!({ "type": "boolean" }),
        Shape::Count(least, most) => json!({ "type": "integer", "minimum": least, "maximum": most }),
        Shape::CountOf(words, most) => json!({ "type": "integer", "minimum": 0, "maximum": most, "title": words }),
        Shape::Name(words) => json!({ "type": "string", "title": words }),
        Shape::List(item, size) => {
            let mut list = json!({ "type": "array", "items": shape(item, false) });
            let (least, most) = match size {
                Size::AtLeast(n) => (*n, None),
                Size::Exactly(n) => (*n, Some(*n)),
                Size::Space => (2, Some(3)),
                Size::OneOf(sizes) => (sizes.iter().copied().min().unwrap_or(0), sizes.iter().copied().max()),
            };
            if let Value::Object(map) = &mut list {
                map.insert("minItems".to_owned(), json!(least));
                if let Some(most) = most {
                    map.insert("maxItems".to_owned(), json!(most));
                }
            }
            list
        }
        Shape::Map(inner) => table(inner, patch),
        Shape::NamedBut(but, keys, what, inner) => {
            let mut map = shape(&Shape::Named(*keys, what, inner), patch);
            if let Value::Object(fields) = &mut map {
                let either = json!({ "description": but.doc, "anyOf": [shape(&but.shape, patch), shape(inner, patch)] });
                fields.insert("properties".to_owned(), json!({ but.key: either }));
            }
            map
        }
        Shape::Named(keys, _, inner) => {
            let mut value = shape(inner, patch);
            if patch {
                value = json!({ "anyOf": [value, { "type": "null" }] });
            }
            let mut map = json!({ "type": "object", "additionalProperties": value });
            let pattern = match keys {
                Keys::Name => Some("^[A-Za-z][A-Za-z0-9_]*$"),
                Keys::Title => Some("^[A-Za-z][A-Za-z0-9_-]*$"),
                Keys::Reference => None,
            };
            if let (Value::Object(map), Some(pattern)) = (&mut map, pattern) {
                map.insert("propertyNames".to_owned(), json!({ "pattern": pattern }));
            }
            map
        }
        Shape::Either(shapes) => json!({ "anyOf": shapes.iter().map(|s| shape(s, patch)).collect::<Vec<_>>() }),
        Shape::Patch => table(&FILE, true),
        Shape::Later => json!(false),
    }
}

/// A number, a quantity or an expression.
fn number(want: Want) -> Value {
    json!({ "type": ["number", "string"], "title": format!("{}: a number in SI, a quantity, or an expression", want.name()) })
}
