//! Entries of a sidecar with which a refused file is read.

use super::errors::LogError;
use haptics::recording::Suggested;
use serde_json::{Value, json};

impl LogError {
    /// The shortest entries of a sidecar that settle this error, with null for a value that only the user knows. `None` if
    /// no sidecar helps.
    pub fn suggested(&self) -> Option<Suggested> {
        let entries = match self {
            // The values may show the unit.
            Self::UnknownUnit { unit, .. } if unit.is_empty() => return None,
            Self::UnknownUnit { name, column, .. } => json!({ "columns": { name: column }, "scale": { name: null } }),
            Self::TwoUnits { column, .. } => json!({ "scale": { column: null } }),
            Self::WrongDimension { target, .. } => json!({ "scale": { target: null } }),
            Self::DuplicateColumn { column, choice: Some(choice), .. } => json!({ "columns": { column: choice } }),
            Self::MissingColumn { instead, .. } if !instead.is_empty() => json!({ "columns": instead }),
            Self::BadCell { mend, .. } => return mend.as_deref().cloned(),
            // Another order of the rows would go with them.
            Self::Time { goes_back: true, .. } => return None,
            Self::Time { rate_hz, .. } => json!({ "columns": { "t_s": null }, "rate_hz": rate_hz }),
            Self::NoClock { .. } => json!({ "rate_hz": null }),
            _ => return None,
        };
        as_entries(entries)
    }
}

/// One entry of a sidecar, as an error carries it.
pub fn entry(key: &str, value: Value) -> Suggested {
    std::iter::once((key.to_owned(), value)).collect()
}

/// An object as entries of a sidecar.
fn as_entries(value: Value) -> Option<Suggested> {
    if let Value::Object(entries) = value { Some(entries) } else { None }
}

/// Puts entries into those of a sidecar. Objects and lists are joined, and factors of `scale` are multiplied.
pub fn put_into(entries: &Suggested, sidecar: &mut Suggested) {
    for (key, value) in entries {
        match (sidecar.get_mut(key), value) {
            (Some(Value::Object(there)), Value::Object(new)) => {
                for (name, new) in new {
                    let both = (there.get(name).and_then(Value::as_f64), new.as_f64());
                    let value = match both {
                        (Some(old), Some(new)) if key == "scale" => json!(old * new),
                        _ => new.clone(),
                    };
                    there.insert(name.clone(), value);
                }
            }
            (Some(Value::Array(there)), Value::Array(new)) => there.extend(new.iter().cloned()),
            _ => {
                sidecar.insert(key.clone(), value.clone());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{load, sidecar_path};

    /// The error of a table, and the table read with the entries that the error suggests.
    fn mended(table: &str, fill: Option<f64>) -> (String, Vec<haptics::recording::Recording>) {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let log = folder.path().join("log.csv");
        std::fs::write(&log, table).expect("writable");
        let error = load(&log, None).expect_err("refused");
        let entries = error.suggested().expect("a sidecar helps");
        let text = Value::Object(entries).to_string();
        let text = fill.map_or(text.clone(), |value| text.replace("null", &value.to_string()));
        std::fs::write(sidecar_path(&log), &text).expect("writable");
        (error.to_string(), load(&log, None).unwrap_or_else(|error| panic!("{text}: {error}")))
    }

    #[test]
    fn what_an_error_suggests_makes_the_file_load() {
        let (error, log) = mended("t_s,q_m,f_stone\n0,1,2\n1,2,3\n", Some(62.3));
        assert!(error.contains("\"scale\": {\"f_N\": SI value of 1}"), "{error}");
        assert!((log[0].channel("f_N").expect("a force")[0] - 124.6).abs() < 1e-9);
        let (error, log) = mended("t_s,q_m,q_mm\n0,1,2\n1,2,3\n", None);
        assert!(error.contains("like {\"q_m\": \"q_m\"}") && log[0].channel("q_m").expect("one")[1] == 2.0, "{error}");
        let (error, log) = mended("t_s,x_mm,fx_N\n0,1,2\n1,2,3\n", None);
        assert!(error.contains("\"f_N\": \"fx_N\", \"q_m\": \"x_mm\""), "{error}");
        assert!(log[0].channel("q_m").expect("one")[1] == 0.002 && log[0].channel("f_N").is_some());
        let gappy = |i: u32| if i % 20 == 7 { "OVLD".to_owned() } else { f64::from(i).sin().to_string() };
        let rows: Vec<String> = (0..60).map(|i| format!("{},{},1", 0.01 * f64::from(i), gappy(i))).collect();
        let (error, log) = mended(&format!("t_s,q_m,f_N\n{}\n", rows.join("\n")), None);
        assert!(error.contains("leave such rows out: \"missing\": [\"OVLD\"] in the sidecar"), "{error}");
        assert_eq!(log[0].len(), 57);
        let coarse: Vec<String> = (0..40).map(|i| format!("{},{}", i / 10, f64::from(i).sin())).collect();
        let (_, log) = mended(&format!("t_s,q_m\n{}\n", coarse.join("\n")), None);
        assert!((log[0].rate_hz().expect("a rate") - 10.0).abs() < 1e-9);
    }

    #[test]
    fn entries_are_joined() {
        let entries = |value: Value| as_entries(value).expect("an object");
        let mut sidecar = entries(json!({ "task": "crank", "scale": { "f_N": 2.0, "q_m": 1.5 }, "missing": ["--"] }));
        put_into(&entries(json!({ "scale": { "q_m": 0.001 }, "rate_hz": null, "missing": ["NaN"] })), &mut sidecar);
        let joined = json!({ "task": "crank", "scale": { "f_N": 2.0, "q_m": 0.0015 }, "missing": ["--", "NaN"], "rate_hz": null });
        assert_eq!(Value::Object(sidecar), joined);
    }
}
