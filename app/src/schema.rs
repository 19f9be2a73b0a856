//! JSON Schemas of what the command line prints with `--json`, made from the types that it prints.
//!
//! They stand in `docs/schemas`; `tests/tests/schemas` keeps them and holds real outputs against them.

use crate::cli;
use crate::cli::device::report;
use estimator::diagnose::Diagnosis;
use estimator::segment::Segmentation;
use haptics::recording::Meta;
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, SchemaGenerator};
use serde_json::{Value, json};

/// Every command with a schema: the name of its file, and the schema.
pub fn all() -> Vec<(&'static str, Value)> {
    vec![
        ("bench", of::<cli::bench::table::Said>("bench, bench diagnosis")),
        ("bench-ablation", of::<cli::bench::ablation::Said>("bench ablation")),
        ("bench-blind", of::<cli::bench::blind::Said>("bench blind")),
        ("bench-delay", of::<cli::bench::delay::Said<'_>>("bench delay")),
        ("bench-frames", of::<cli::bench::frames::Said>("bench frames")),
        ("bench-online", of::<cli::bench::online::Said>("bench online")),
        ("bench-scale", of::<cli::bench::scale::Said>("bench scale")),
        ("bench-servo", of::<cli::bench::Said<'_>>("bench servo")),
        ("demo", of::<cli::demo::Said>("demo")),
        ("device-list", of::<cli::device::Listed>("device list")),
        ("device-test", of::<report::Said<'_>>("device test")),
        ("gallery", of::<cli::gallery::Said>("gallery")),
        ("history", of::<cli::history::Said>("history")),
        ("history-import", of::<cli::history::Imported>("history --import")),
        ("lesson", of::<cli::lessons::One>("lessons LESSON")),
        ("lessons", of::<cli::lessons::Said>("lessons")),
        ("report", of::<cli::report::Said>("report")),
        ("score", of::<cli::score::Said>("score")),
        ("info", one_or_several::<cli::info::Said>("info", true)),
        ("info-suggest", of::<cli::suggest::Said>("info --suggest")),
        ("segment", one_or_several::<Segmentation>("segment", false)),
        ("fit", of::<cli::fit::Said<'_>>("fit")),
        ("diagnose", of::<Diagnosis>("diagnose")),
        ("diagnose-lines", of::<cli::diagnose::fleet::Line>("diagnose --json-lines, one line")),
        ("simulate", of::<cli::simulate::Said>("simulate")),
        ("convert", of::<cli::convert::Said>("convert")),
        ("export", of::<cli::export::Said>("export")),
        ("record", of::<cli::record::Said>("record")),
        ("screenshot", of::<cli::screenshot::Said>("screenshot")),
        ("sidecar", sidecar()),
    ]
}

/// Schema of the sidecar as it is read, for editors.
fn sidecar() -> Value {
    let read = SchemaSettings::draft2020_12().into_generator().into_root_schema_for::<Meta>().to_value();
    titled(read, "sidecar <stem>.meta.json")
}

/// As things are printed, not as they are read: what is always there is required.
fn generator() -> SchemaGenerator {
    SchemaSettings::draft2020_12().for_serialize().into_generator()
}

fn titled(mut schema: Value, command: &str) -> Value {
    if let Some(schema) = schema.as_object_mut() {
        schema.insert("title".to_owned(), json!(format!("touchstone {command}")));
    }
    schema
}

fn of<T: JsonSchema>(command: &str) -> Value {
    titled(generator().into_root_schema_for::<T>().to_value(), command)
}

/// Of a file with one recording the object itself, of one with several `{"recordings": […]}`.
fn one_or_several<T: JsonSchema>(command: &str, with_warnings: bool) -> Value {
    let mut one = of::<T>(command);
    let (mut definitions, mut dialect) = (json!({}), Value::Null);
    if let Some(root) = one.as_object_mut() {
        definitions = root.remove("$defs").unwrap_or(definitions);
        dialect = root.remove("$schema").unwrap_or(dialect);
        root.remove("title");
    }
    let mut several = json!({
        "type": "object",
        "properties": { "recordings": { "type": "array", "items": { "$ref": "#/$defs/recording" } } },
        "required": ["recordings"],
    });
    if with_warnings {
        several["properties"]["warnings"] = json!({ "type": "array", "items": { "$ref": "#/$defs/Warning" } });
        several["required"] = json!(["recordings", "warnings"]);
    }
    definitions["recording"] = one;
    let root = json!({ "$schema": dialect, "anyOf": [{ "$ref": "#/$defs/recording" }, several], "$defs": definitions });
    titled(root, command)
}
