//! Holds documents against JSON Schemas, as far as those go that are made of our types.
//!
//! Not a library's work: the one that there is asks for features of crates that the window uses, too, and all of it would be built
//! twice. A keyword that is not known here is a panic, never a pass; `tests/python/check_schemas.py` holds the same documents
//! against a library's opinion.

use serde_json::Value;

/// Keywords that say nothing about what is valid.
const WORDS: [&str; 5] = ["$schema", "$defs", "title", "description", "default"];

/// What is wrong with a document, one sentence a fault.
pub fn faults(schema: &Value, document: &Value) -> Vec<String> {
    let mut found = Vec::new();
    hold(schema, schema, document, "", &mut found);
    found
}

fn hold(root: &Value, schema: &Value, document: &Value, at: &str, found: &mut Vec<String>) {
    let Some(keywords) = schema.as_object() else {
        assert!(schema == &Value::Bool(true), "{at}: {schema} is no schema");
        return;
    };
    for (keyword, wanted) in keywords {
        match keyword.as_str() {
            "$ref" => {
                let path =
                    wanted.as_str().and_then(|path| path.strip_prefix('#')).expect("a reference within the file");
                hold(root, root.pointer(path).expect("it points somewhere"), document, at, found);
            }
            "type" => must(is_of(wanted, document), at, &format!("is no {wanted}"), found),
            "enum" => must(array(wanted).contains(document), at, &format!("{document} is none of {wanted}"), found),
            "const" => must(wanted == document, at, &format!("{document} is not {wanted}"), found),
            "anyOf" | "oneOf" => {
                let met = array(wanted).iter().filter(|one| {
                    let mut faults = Vec::new();
                    hold(root, one, document, at, &mut faults);
                    faults.is_empty()
                });
                let count = met.count();
                let enough = if keyword == "oneOf" { count == 1 } else { count > 0 };
                must(enough, at, &format!("meets {count} of {} alternatives", array(wanted).len()), found);
            }
            "required" => {
                for name in array(wanted).iter().filter_map(Value::as_str) {
                    must(
                        document.as_object().is_none_or(|o| o.contains_key(name)),
                        at,
                        &format!("has no {name}"),
                        found,
                    );
                }
            }
            "minimum" => must(number(document) >= number(wanted), at, &format!("is below {wanted}"), found),
            "maximum" => must(number(document) <= number(wanted), at, &format!("is above {wanted}"), found),
            "minItems" => must(length(document) >= number(wanted), at, &format!("has less than {wanted} items"), found),
            "maxItems" => must(length(document) <= number(wanted), at, &format!("has more than {wanted} items"), found),
            "format" | "properties" | "additionalProperties" | "items" | "prefixItems" => {}
            other => assert!(WORDS.contains(&other), "{at}: the keyword {other} is not known here"),
        }
    }
    within(root, schema, document, at, found);
}

/// The members of an object and the items of an array.
fn within(root: &Value, schema: &Value, document: &Value, at: &str, found: &mut Vec<String>) {
    match document {
        Value::Object(members) => {
            for (name, value) in members {
                let own = schema["properties"].get(name).or_else(|| schema.get("additionalProperties"));
                match own {
                    Some(Value::Bool(false)) => found.push(format!("{at}: {name} is not known")),
                    Some(own) => hold(root, own, value, &format!("{at}/{name}"), found),
                    // Objects with named members hold no others: ours are made of types.
                    None if schema.get("properties").is_some() => found.push(format!("{at}: {name} is not known")),
                    None => {}
                }
            }
        }
        Value::Array(items) => {
            for (index, item) in items.iter().enumerate() {
                let own = schema["prefixItems"].get(index).or_else(|| schema.get("items"));
                if let Some(own) = own {
                    hold(root, own, item, &format!("{at}/{index}"), found);
                }
            }
        }
        _ => {}
    }
}

fn must(met: bool, at: &str, fault: &str, found: &mut Vec<String>) {
    if !met {
        found.push(format!("{at}: {fault}"));
    }
}

fn array(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

/// Values that are no numbers keep every bound.
fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(0.0)
}

fn length(document: &Value) -> f64 {
    document.as_array().map_or(f64::INFINITY, |items| items.len() as f64)
}

fn is_of(kinds: &Value, document: &Value) -> bool {
    let is = |kind: &Value| match kind.as_str() {
        Some("object") => document.is_object(),
        Some("array") => document.is_array(),
        Some("string") => document.is_string(),
        Some("boolean") => document.is_boolean(),
        Some("null") => document.is_null(),
        Some("number") => document.is_number(),
        Some("integer") => document.is_i64() || document.is_u64(),
        _ => panic!("{kind} is no type"),
    };
    if kinds.is_array() { array(kinds).iter().any(is) } else { is(kinds) }
}

#[cfg(test)]
mod tests {
    use super::faults;
    use serde_json::json;

    #[test]
    fn every_kind_of_fault_is_found() {
        let schema = json!({
            "$defs": { "side": { "type": "string", "enum": ["left", "right"] } },
            "type": "object",
            "properties": {
                "side": { "$ref": "#/$defs/side" },
                "count": { "type": "integer", "minimum": 0 },
                "pair": { "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2 },
                "maybe": { "anyOf": [{ "type": "string" }, { "type": "null" }] },
            },
            "required": ["side", "count"],
        });
        let good = json!({ "side": "left", "count": 3, "pair": [1, 2.5], "maybe": null });
        assert!(faults(&schema, &good).is_empty());
        for (name, wrong) in [
            ("side", json!("up")),
            ("count", json!(-1)),
            ("count", json!(1.5)),
            ("pair", json!([1])),
            ("pair", json!([1, "b"])),
            ("maybe", json!(4)),
            ("another", json!(4)),
        ] {
            let mut bad = good.clone();
            bad[name] = wrong;
            assert_eq!(faults(&schema, &bad).len(), 1, "{bad}");
        }
        assert_eq!(faults(&schema, &json!({ "side": "left" })).len(), 1);
        assert!(!faults(&schema, &json!(7)).is_empty());
    }

    #[test]
    #[should_panic(expected = "not known here")]
    fn an_unknown_keyword_is_no_pass() {
        faults(&json!({ "pattern": "a" }), &json!("b"));
    }
}
