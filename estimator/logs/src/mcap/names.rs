//! From topics and fields to column names.

use super::source::Source;
use crate::units;
use std::collections::HashMap;

/// A column's name in the program, and its full name `topic.field`.
pub struct Name {
    /// Name in the table.
    pub short: String,
    /// Full name, which is accepted as well.
    pub full: String,
}

/// Names of every field of every source.
///
/// The full name is `topic.field.part`, as in Foxglove's message paths. It is shortened to the field in files of our
/// own, in a file with a single flat topic, and for a field with a name of the program (`fx1_N`) that no other topic
/// has.
pub fn of(sources: &[Source]) -> Vec<Vec<Name>> {
    let mut count: HashMap<&str, usize> = HashMap::new();
    for field in sources.iter().flat_map(|s| &s.topic.fields) {
        *count.entry(field).or_default() += 1;
    }
    let flat = |field: &str| !field.is_empty() && !field.contains(['.', '[']);
    // Kinds of messages of one topic are sources of one name.
    let one_topic = sources.windows(2).all(|two| two[0].name == two[1].name);
    let table = one_topic && sources.iter().all(|s| s.topic.fields.iter().all(|f| flat(f)));
    sources
        .iter()
        .map(|source| {
            let name = |field: &String| {
                let full = if field.is_empty() { source.name.clone() } else { format!("{}.{field}", source.name) };
                let own = source.own.as_ref().and_then(|own| own.get(field)).cloned();
                let unique = count.get(field.as_str()) == Some(&1);
                let plain = table || (unique && flat(field) && is_known(field));
                Name { short: own.unwrap_or_else(|| if plain { field.clone() } else { full.clone() }), full }
            };
            source.topic.fields.iter().map(name).collect()
        })
        .collect()
}

/// True for a name that the program knows, in any unit.
pub fn is_known(name: &str) -> bool {
    matches!(name, "trial" | "label") || quantity(name).is_some()
}

/// The program's quantity in a name.
pub fn quantity(name: &str) -> Option<&str> {
    units::split(name)
        .filter(|(q, unit)| units::quantity_dimensions(q).is_some_and(|d| d.contains(&unit.dimension)))
        .map(|(q, _)| q)
}

/// True for a name of a position or an angle: its source has the clock of the motion.
pub fn is_motion(name: &str) -> bool {
    quantity(name).is_some_and(|q| matches!(q.trim_end_matches(['1', '2']), "x" | "y" | "z" | "q" | "qb" | "qt"))
}

/// Factor to seconds of a field that is a time of the program (`t_s`, `t_ms`, `t_us`).
pub fn time_factor(name: &str) -> Option<f64> {
    units::split(name).filter(|(q, unit)| *q == "t" && unit.dimension == units::Dimension::Time).map(|(_, u)| u.factor)
}
