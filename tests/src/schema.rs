//! Holds documents against JSON Schemas, as far as those go that are made of our types.
//!
//! Not a library's work: the one that there is asks for features of crates that the window uses, too, and all of it would be built
//! twice. A keyword that is not known here is a panic, never a pass; `tests/python/check_schemas.py` holds the same documents
//! against a library's opinion.

use serde_json::Value;

/// Keywords that say nothing about what is valid.
const WORDS: [&str; 7] = ["$schema", "$defs", "title", "description", "default", "examples", "x-absent"];

/// What is wrong with a document, one sentence a fault.
pub fn faults(schema: &Value, document: &Value) -> Vec<String> {
    let mut found = Vec::new();
    hold(schema, schema, document, ("", &[]), &mut found);
    found
}

/// Where something stands in the document, and the members that a schema around this one knows: an alternative of an object with
/// members of its own says nothing about these.
type Place<'a> = (&'a str, &'a [&'a str]);

fn hold(root: &Value, schema: &Value, document: &Value, (at, around): Place<'_>, found: &mut Vec<String>) {
    let Some(keywords) = schema.as_object() else {
        assert!(schema == &Value::Bool(true), "{at}: {schema} is no schema");
        return;
    };
    let around: Vec<&str> = around.iter().copied().chain(own_names(schema)).collect();
    for (keyword, wanted) in keywords {
        match keyword.as_str() {
            "$ref" => {
                hold(root, referred(root, wanted), document, (at, &around), found);
            }
            "type" => must(is_of(wanted, document), at, &format!("is no {wanted}"), found),
            "enum" => must(array(wanted).contains(document), at, &format!("{document} is none of {wanted}"), found),
            "const" => must(wanted == document, at, &format!("{document} is not {wanted}"), found),
            "anyOf" | "oneOf" => {
                let met = array(wanted).iter().filter(|one| {
                    let mut faults = Vec::new();
                    hold(root, one, document, (at, &around), &mut faults);
                    faults.is_empty()
                });
                let count = met.count();
                let enough = if keyword == "oneOf" { count == 1 } else { count > 0 };
                must(enough, at, &format!("meets {count} of {} alternatives", array(wanted).len()), found);
            }
            "allOf" => array(wanted).iter().for_each(|one| hold(root, one, document, (at, &around), found)),
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
            "minItems" => must(
                length(document).is_none_or(|n| n >= number(wanted)),
                at,
                &format!("has less than {wanted} items"),
                found,
            ),
            "maxItems" => must(
                length(document).is_none_or(|n| n <= number(wanted)),
                at,
                &format!("has more than {wanted} items"),
                found,
            ),
            "format" | "properties" | "additionalProperties" | "unevaluatedProperties" | "items" | "prefixItems" => {}
            other => assert!(WORDS.contains(&other), "{at}: the keyword {other} is not known here"),
        }
    }
    within(root, schema, document, (at, &around), found);
}

/// The members of an object and the items of an array.
fn within(root: &Value, schema: &Value, document: &Value, (at, around): Place<'_>, found: &mut Vec<String>) {
    match document {
        Value::Object(members) => {
            let inner = names(root, schema);
            let is_known = |name: &str| around.contains(&name) || inner.contains(&name);
            for (name, value) in members {
                let own = schema["properties"].get(name).or_else(|| schema.get("additionalProperties"));
                match own {
                    Some(Value::Bool(false)) => found.push(format!("{at}: {name} is not known")),
                    Some(own) => hold(root, own, value, (&format!("{at}/{name}"), &[]), found),
                    // Objects with named members hold no others: ours are made of types.
                    None if schema.get("properties").is_some() && !is_known(name) => {
                        found.push(format!("{at}: {name} is not known"));
                    }
                    None => {}
                }
            }
        }
        Value::Array(items) => {
            for (index, item) in items.iter().enumerate() {
                let own = schema["prefixItems"].get(index).or_else(|| schema.get("items"));
                if let Some(own) = own {
                    hold(root, own, item, (&format!("{at}/{index}"), &[]), found);
                }
            }
        }
        _ => {}
    }
}

fn own_names(schema: &Value) -> impl Iterator<Item = &str> {
    schema["properties"].as_object().into_iter().flat_map(|members| members.keys().map(String::as_str))
}

/// The members that a schema knows, its alternatives' among them.
fn names<'a>(root: &'a Value, schema: &'a Value) -> Vec<&'a str> {
    let inner = ["anyOf", "oneOf", "allOf"].into_iter().flat_map(|keyword| array(&schema[keyword]));
    let other = schema.get("$ref").map(|path| referred(root, path));
    own_names(schema).chain(inner.chain(other).flat_map(|one| names(root, one))).collect()
}

fn referred<'a>(root: &'a Value, path: &Value) -> &'a Value {
    let path = path.as_str().and_then(|path| path.strip_prefix('#')).expect("a reference within the file");
    root.pointer(path).expect("it points somewhere")
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

/// Of an array; what is none keeps every bound.
fn length(document: &Value) -> Option<f64> {
    document.as_array().map(|items| items.len() as f64)
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
    fn members_beside_alternatives_are_told_from_strangers() {
        let kind = |name: &str, member: &str| json!({ "type": "object", "properties": { "kind": { "const": name }, member: { "type": "number" } }, "required": ["kind", member] });
        let schema = json!({
            "type": "object",
            "properties": { "says": { "type": "string" } },
            "required": ["says"],
            "oneOf": [kind("press", "least_n"), kind("turn", "turns")],
        });
        assert!(faults(&schema, &json!({ "says": "press", "kind": "press", "least_n": 1.0 })).is_empty());
        for wrong in [
            json!({ "kind": "press", "least_n": 1.0 }),
            json!({ "says": "press", "kind": "press", "turns": 1.0 }),
            json!({ "says": "press", "kind": "press", "least_n": 1.0, "turns": 1.0 }),
            json!({ "says": "press", "kind": "press", "least_n": 1.0, "more": 1.0 }),
        ] {
            assert!(!faults(&schema, &wrong).is_empty(), "{wrong}");
        }
    }

    #[test]
    fn every_kind_of_fault_is_found() {
        let schema = json!({
            "$defs": { "side": { "type": "string", "enum": ["left", "right"] } },
            "type": "object",
            "properties": {
                "side": { "$ref": "#/$defs/side" },
                "count": { "type": "integer", "minimum": 0 },
                "pair": { "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2 },
                "perhaps": { "type": ["array", "null"], "items": { "type": "number" }, "maxItems": 2 },
                "maybe": { "anyOf": [{ "type": "string" }, { "type": "null" }] },
            },
            "required": ["side", "count"],
        });
        let good = json!({ "side": "left", "count": 3, "pair": [1, 2.5], "perhaps": null, "maybe": null });
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
