//! Metadata of files of ours: the keys of their sidecar, of their columns and of how they were written.

use std::collections::BTreeMap;

/// Name of the metadata record in which our own files carry their sidecar, and key of its text.
pub(crate) const METADATA: &str = "touchstone";

pub(crate) const SIDECAR: &str = "sidecar";

/// Key that says that the file was written block by block while recording.
pub(crate) const STREAMED: &str = "streamed";

/// Keys in a channel's metadata: our column names by field, and whether the rows have a clock.
pub(crate) const COLUMNS: &str = "touchstone.columns";

pub(crate) const CLOCKLESS: &str = "touchstone.clockless";

/// Metadata of a channel of ours.
pub(super) fn channel_metadata(columns: &BTreeMap<String, String>, clockless: bool) -> BTreeMap<String, String> {
    let names = serde_json::to_string(columns).unwrap_or_default(); // a map of texts is always JSON
    let mut metadata = BTreeMap::from([(COLUMNS.to_owned(), names)]);
    if clockless {
        metadata.insert(CLOCKLESS.to_owned(), "true".to_owned());
    }
    metadata
}
