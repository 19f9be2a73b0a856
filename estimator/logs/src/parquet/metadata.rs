//! Metadata of files of ours, and names and errors as the library has them.

use parquet::file::metadata::FileMetaData;
use std::collections::BTreeMap;

/// Beginning of the writer's name in the files of this program.
pub(super) const CREATED_BY: &str = "touchstone ";

/// Keys of the file's metadata: the sidecar, the units by column, and whether the rows have a clock.
pub(super) const SIDECAR: &str = "touchstone.sidecar";

pub(super) const UNITS: &str = "units";

/// Key of the attributes of a table of pandas, which may hold units by column.
const PANDAS_ATTRIBUTES: &str = "PANDAS_ATTRS";

/// Units by column that another program's metadata state. The files of this program have them in the names.
pub(super) fn units(about: &FileMetaData) -> BTreeMap<String, String> {
    let is_own = about.created_by().is_some_and(|by| by.starts_with(CREATED_BY));
    let entries = about.key_value_metadata().filter(|_| !is_own).map_or(&[][..], Vec::as_slice);
    let value = |key: &str| entries.iter().find(|entry| entry.key == key)?.value.as_deref();
    let json = |key: &str| serde_json::from_str::<serde_json::Value>(value(key)?).ok();
    let found = json(UNITS).or_else(|| json(PANDAS_ATTRIBUTES)?.get(UNITS).cloned());
    let texts = |name: &String, unit: &serde_json::Value| Some((name.clone(), unit.as_str()?.to_owned()));
    let found = found.as_ref().and_then(serde_json::Value::as_object);
    found.into_iter().flatten().filter_map(|(name, unit)| texts(name, unit)).collect()
}

/// The first line of an error of the library.
pub(super) fn one_line(error: &impl std::fmt::Display) -> String {
    let text = error.to_string();
    text.lines().next().unwrap_or("malformed").chars().take(160).collect()
}

/// Name of the index of a data frame: pandas keeps one without a name as `__index_level_0__`.
pub(super) fn index(column: &str) -> Option<&'static str> {
    column.starts_with("__index_level_").then_some("index")
}
