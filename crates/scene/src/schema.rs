//! The JSON Schema of the scene format, from the same description of keys that the reader checks against.
//!
//! A scene is TOML; editors with a TOML language server (and anything that reads TOML as JSON) check and complete
//! by this schema. Units, intervals beyond numbers and regions that hold nothing are left to `souple check`.

use std::collections::BTreeMap;

use serde_json::{Map, Value as Json, json};
use souple_table::{Kind, Parameter, Range, Value};

use crate::keys::{EntryShape, Key, Keys, Need, Others, Outline, Shape};
use crate::spec::SCENE;
use crate::spec::region::REGION;

/// The schema of scene files (draft 2020-12).
pub fn schema() -> Json {
    let mut definitions = Definitions::default();
    let root = definitions.reference(&SCENE);
    definitions.reference(&REGION);
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Souple scene, format 1",
        "allOf": [root],
        "$defs": definitions.0,
    })
}

/// A kind of table that scenes hold under a key.
#[derive(Clone, Debug)]
pub struct SceneTable {
    /// Keys from the root, such as `networks.NAME.actuators.NAME`.
    pub path: String,
    pub summary: &'static str,
    pub keys: Vec<SceneKey>,
}

/// What may stand in such a table.
#[derive(Clone, Debug)]
pub struct SceneKey {
    pub name: &'static str,
    pub summary: &'static str,
    /// SI unit of numbers, empty for pure ones.
    pub unit: &'static str,
    /// What would be accepted, in words.
    pub expected: String,
    pub default: Option<String>,
}

/// The tables that scenes hold under keys, each kind once, at its shortest path.
pub fn scene_tables() -> Vec<SceneTable> {
    let (mut tables, mut known) = (Vec::new(), vec![SCENE.name]);
    let mut next: Vec<(String, &'static Keys)> = vec![(String::new(), &SCENE)];
    while !next.is_empty() {
        let mut deeper = Vec::new();
        for (path, keys) in next {
            for key in keys.keys {
                let (within, more) = match key.shape {
                    Shape::Table(within) => (within, ""),
                    Shape::Tables(within) => (within, "[]"),
                    Shape::Named(within) => (within, ".NAME"),
                    _ => continue,
                };
                if known.contains(&within.name) {
                    continue;
                }
                known.push(within.name);
                let dot = if path.is_empty() { "" } else { "." };
                let path = format!("{path}{dot}{}{more}", key.name);
                let keys = within.keys.iter().map(SceneKey::of).collect();
                tables.push(SceneTable { path: path.clone(), summary: within.summary, keys });
                deeper.push((path, within));
            }
        }
        next = deeper;
    }
    tables
}

impl SceneTable {
    /// The key that holds it.
    pub fn name(&self) -> &str {
        let path = self.path.trim_end_matches(".NAME").trim_end_matches("[]");
        path.rsplit('.').next().unwrap_or(path)
    }
}

impl SceneKey {
    fn of(key: &Key) -> Self {
        let default = match key.need {
            Need::Default(default) => Some(default.to_string()),
            Need::Required | Need::Optional => None,
        };
        Self { name: key.name, summary: key.summary, unit: key.unit, expected: key.expected(), default }
    }
}

/// Tables described so far, by name.
#[derive(Default)]
struct Definitions(BTreeMap<String, Json>);

impl Definitions {
    fn reference(&mut self, keys: &'static Keys) -> Json {
        if !self.0.contains_key(keys.name) {
            // entered first: regions refer to themselves
            self.0.insert(keys.name.to_owned(), Json::Null);
            let table = self.table(keys);
            self.0.insert(keys.name.to_owned(), table);
        }
        json!({ "$ref": format!("#/$defs/{}", keys.name) })
    }

    fn table(&mut self, keys: &'static Keys) -> Json {
        let mut properties = Map::new();
        let mut beside = Map::new();
        for key in keys.keys {
            properties.insert(key.name.to_owned(), self.key(key));
            if let (Others::ParametersOf(name), Shape::Entry(entry)) = (keys.others, key.shape)
                && name == key.name
            {
                for parameter in (entry.outlines)().iter().flat_map(|outline| outline.parameters) {
                    beside.insert(parameter.name.to_owned(), parameter_schema(parameter));
                }
            }
        }
        for (name, schema) in beside {
            properties.entry(name).or_insert(schema);
        }
        let required: Vec<&str> =
            keys.keys.iter().filter(|key| matches!(key.need, Need::Required)).map(|key| key.name).collect();
        json!({
            "type": "object",
            "description": keys.summary,
            "properties": properties,
            "required": required,
            "additionalProperties": false,
        })
    }

    fn key(&mut self, key: &Key) -> Json {
        let mut schema = self.shape(key);
        if let Json::Object(object) = &mut schema {
            let unit = if key.unit.is_empty() { String::new() } else { format!(" [{}]", key.unit) };
            object.insert("description".to_owned(), json!(format!("{}{unit}", key.summary)));
            if let Need::Default(default) = key.need {
                object.insert("default".to_owned(), value(default));
            }
        }
        schema
    }

    fn shape(&mut self, key: &Key) -> Json {
        let text = || json!({ "type": "string" });
        let list = |items: Json| json!({ "type": "array", "items": items });
        let number = || number(key.unit, key.range);
        match key.shape {
            Shape::Number => number(),
            Shape::Integer => integer(key.range),
            Shape::Boolean => json!({ "type": "boolean" }),
            Shape::Vector => vector(number()),
            Shape::Corners => {
                json!({ "type": "array", "items": vector(number()), "minItems": 2, "maxItems": 2 })
            }
            Shape::Text => text(),
            Shape::Choice(choices) => json!({ "enum": choices }),
            Shape::Texts => json!({ "anyOf": [text(), list(text())] }),
            Shape::Integers => list(integer(Range::NOT_NEGATIVE)),
            Shape::Numbers => list(number()),
            Shape::Vectors => list(vector(number())),
            Shape::Formula(_) => json!({ "type": ["number", "string"] }),
            Shape::VectorFormula(_) => {
                json!({ "anyOf": [text(), vector(json!({ "type": ["number", "string"] }))] })
            }
            Shape::Condition(_) => text(),
            Shape::NumberOrVector => json!({ "anyOf": [number(), vector(number())] }),
            Shape::Axes => json!({ "type": "string", "pattern": "^[xyz]+$" }),
            Shape::Entry(entry) => self.entry(&entry),
            Shape::Region => self.region(),
            Shape::Regions => list(self.region()),
            Shape::Table(keys) => json!({ "allOf": [self.reference(keys)] }),
            Shape::Tables(keys) => list(self.reference(keys)),
            Shape::Named(keys) => json!({ "type": "object", "additionalProperties": self.reference(keys) }),
            Shape::Values => json!({ "type": "object" }),
        }
    }

    fn region(&mut self) -> Json {
        json!({ "anyOf": [{ "type": "string", "description": "a group of the mesh" }, self.reference(&REGION)] })
    }

    fn entry(&mut self, shape: &EntryShape) -> Json {
        let outlines = (shape.outlines)();
        let names: Vec<&str> = outlines.iter().map(|outline| outline.name).collect();
        let mut forms =
            vec![json!({ "enum": names, "description": format!("a {} by name alone", shape.kind) })];
        forms.extend(outlines.iter().map(|outline| outlined(shape.tag, outline)));
        if !shape.instead.is_empty() {
            forms.push(json!({ "type": "string" }));
        }
        forms.extend(shape.instead.iter().map(|keys| self.reference(keys)));
        json!({ "anyOf": forms })
    }
}

/// `{ name = "…", parameters }`.
fn outlined(tag: &str, outline: &Outline) -> Json {
    let mut properties = Map::new();
    properties.insert(tag.to_owned(), json!({ "const": outline.name }));
    for parameter in outline.parameters {
        properties.insert(parameter.name.to_owned(), parameter_schema(parameter));
    }
    let mut required = vec![tag];
    required.extend(outline.parameters.iter().filter(|p| p.default.is_none()).map(|p| p.name));
    json!({
        "type": "object",
        "description": outline.summary,
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    })
}

fn parameter_schema(parameter: &Parameter) -> Json {
    let number = || number(parameter.unit, parameter.range);
    let mut schema = match parameter.kind {
        Kind::Number => number(),
        Kind::Integer => integer(parameter.range),
        Kind::Boolean => json!({ "type": "boolean" }),
        Kind::Vector => vector(number()),
        Kind::Numbers => json!({ "type": "array", "items": number(), "minItems": 1 }),
        Kind::Text => json!({ "type": "string" }),
        Kind::Texts => {
            let entry = json!({ "anyOf": [
                { "type": "string" },
                { "type": "number" },
                vector(json!({ "type": "number" })),
            ] });
            json!({ "type": "object", "additionalProperties": entry })
        }
        Kind::Choice(choices) => json!({ "enum": choices }),
    };
    if let Json::Object(object) = &mut schema {
        let unit = if parameter.unit.is_empty() { String::new() } else { format!(" [{}]", parameter.unit) };
        object.insert("description".to_owned(), json!(format!("{}{unit}", parameter.summary)));
        if let Some(default) = parameter.default {
            object.insert("default".to_owned(), value(default));
        }
    }
    schema
}

/// A number within a range, or a text: a quantity with its unit, or a parameter.
fn number(unit: &str, range: Range) -> Json {
    let text = if unit.is_empty() { "a number or \"$parameter\"" } else { "a quantity with its unit" };
    json!({ "anyOf": [ranged("number", range), { "type": "string", "description": text }] })
}

fn integer(range: Range) -> Json {
    json!({ "anyOf": [ranged("integer", range), { "type": "string", "pattern": "\\$" }] })
}

fn ranged(kind: &str, range: Range) -> Json {
    let mut schema = Map::new();
    schema.insert("type".to_owned(), json!(kind));
    let bounds = [
        (range.low, range.low_included, "minimum", "exclusiveMinimum"),
        (range.high, range.high_included, "maximum", "exclusiveMaximum"),
    ];
    for (bound, is_included, closed, open) in bounds {
        if bound.is_finite() {
            schema.insert((if is_included { closed } else { open }).to_owned(), json!(bound));
        }
    }
    Json::Object(schema)
}

fn vector(items: Json) -> Json {
    json!({ "type": "array", "items": items, "minItems": 3, "maxItems": 3 })
}

fn value(value: Value) -> Json {
    match value {
        Value::Number(number) => json!(number),
        Value::Integer(number) => json!(number),
        Value::Boolean(truth) => json!(truth),
        Value::Vector(vector) => json!(vector),
        Value::Numbers(numbers) => json!(numbers),
        Value::Text(text) => json!(text),
        Value::Texts(texts) => {
            texts.iter().map(|(name, text)| (name.clone(), json!(text))).collect::<Map<_, _>>().into()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every reference leads to a definition, and every material and stepper of the tables is named.
    #[test]
    fn the_schema_is_complete() {
        let schema = schema();
        let text = schema.to_string();
        for reference in text.split("#/$defs/").skip(1) {
            let name = reference.split('"').next().unwrap_or("");
            assert!(schema["$defs"][name]["properties"].is_object(), "{name}");
        }
        let materials = souple_models::materials::TABLE.names();
        for name in materials
            .chain(souple_engine::steppers::TABLE.names())
            .chain(souple_mesh::GENERATORS.names())
            .chain(souple_mesh::implicit::SHAPES.names())
        {
            assert!(text.contains(&format!("\"{name}\"")), "{name}");
        }
        assert_eq!(schema["$defs"]["world"]["required"], json!(["period"]));
    }
}
