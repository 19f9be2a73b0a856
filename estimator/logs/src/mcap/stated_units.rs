//! Units that messages state in a field of their own, `{"value": 3.1, "unit": "lbf"}`, or in their schema.

use super::schema_units::{self, Units};
use super::topic::Topic;
use crate::plan::is_like_a_clock;
use crate::raw::Cells;
use crate::written_units::{Written, in_header, parse};

/// Part of a message that a field belongs to, and the name of the field in it.
fn parted(field: &str) -> (&str, &str) {
    field.rsplit_once('.').unwrap_or(("", field))
}

/// Texts of the units of the topic's columns; `in_schema`: those of the schema. A field that states the same known unit throughout is taken out, if one
/// number without a unit stands beside it.
pub fn take(topic: &mut Topic, in_schema: &Units) -> Vec<String> {
    let mut found: Vec<(String, String, String)> = Vec::new();
    for (field, cells) in topic.fields.iter().zip(&topic.columns) {
        let ((part, name), Cells::Text(texts)) = (parted(field), cells) else { continue };
        let Some(unit) = (!texts.is_empty()).then(|| &texts[0]) else { continue };
        let is_unit = ["unit", "units"].iter().any(|word| name.eq_ignore_ascii_case(word));
        let is_known = is_unit && matches!(parse(unit, &[]), Written::Known(..));
        let mut beside = topic.fields.iter().zip(&topic.columns).filter(|(other, cells)| {
            let (of, name) = parted(other);
            of == part && matches!(cells, Cells::Numbers(_)) && !is_like_a_clock(name)
        });
        if let (true, Some((of, _)), None) = (is_known, beside.next(), beside.next())
            && (0..texts.len()).all(|row| texts[row] == *unit)
            && in_header(of, &[]).1.is_empty()
        {
            found.push((of.clone(), field.clone(), unit.to_owned()));
        }
    }
    topic.forget(|field| found.iter().any(|(_, unit, _)| unit == field));
    let stated = |field: &String| found.iter().find(|(of, ..)| of == field).map(|(.., unit)| unit.clone());
    let unit = |field: &String| stated(field).unwrap_or_else(|| schema_units::of(in_schema, field).to_owned());
    topic.fields.iter().map(unit).collect()
}
