//! Checksums of a file's content. The library writes pages without any, so that a flipped bit would be a changed number
//! without notice. Ours are of the values, not of the pages, and are believed only in files that no other program has
//! rewritten (such a program may keep the metadata and change the columns).

use super::metadata::{CREATED_BY, SIDECAR, UNITS};
use crate::raw::{Cells, Raw};
use crc32fast::Hasher;
use parquet::file::metadata::{FileMetaData, KeyValue};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Key of the file's metadata.
const SUMS: &str = "touchstone.crc32";
/// Numbers that are turned into bytes at a time.
const BATCH: usize = 512;

/// CRC-32 of every column and of its metadata.
#[derive(Default, Deserialize, Serialize)]
pub struct Sums {
    columns: BTreeMap<String, u32>,
    facts: BTreeMap<String, u32>,
}

impl Sums {
    /// Of columns by name, and of the entries of the metadata.
    pub fn new<'a>(columns: impl Iterator<Item = (&'a str, Sum)>, facts: &[KeyValue]) -> Self {
        Self {
            columns: columns.map(|(name, sum)| (name.to_owned(), sum.0.finalize())).collect(),
            facts: of_facts(facts),
        }
    }

    /// As an entry of the file's metadata.
    pub fn entry(&self) -> KeyValue {
        // Maps from texts to numbers are always JSON.
        KeyValue::new(SUMS.to_owned(), serde_json::to_string(self).unwrap_or_default())
    }

    /// Mismatch with the sums that a file of ours carries; files of others and older ones have none.
    pub fn fault(about: &FileMetaData, raw: &Raw) -> Option<String> {
        if about.created_by().is_none_or(|by| !by.starts_with(CREATED_BY)) {
            return None;
        }
        let entries = about.key_value_metadata()?;
        let text = entries.iter().find(|entry| entry.key == SUMS)?.value.as_deref().unwrap_or_default();
        let Ok(sums) = serde_json::from_str::<Self>(text) else {
            return Some("checksums that cannot be read".to_owned());
        };
        // One that is left out because it seems to hold something else.
        if sums.columns.len() != raw.aliases.len() {
            return Some("a column that it was written with cannot be told".to_owned());
        }
        let off = raw.aliases.iter().zip(&raw.columns).find(|(name, cells)| {
            let mut sum = Sum::default();
            sum.cells(cells);
            sums.columns.get(*name) != Some(&sum.0.finalize())
        });
        if let Some((name, _)) = off {
            return Some(format!("the checksum of the column `{name}` does not fit its values"));
        }
        let facts = of_facts(entries);
        (facts != sums.facts).then(|| "the checksum of its facts does not fit them".to_owned())
    }
}

fn of_facts(entries: &[KeyValue]) -> BTreeMap<String, u32> {
    let ours = entries.iter().filter(|entry| [SIDECAR, UNITS].contains(&entry.key.as_str()));
    ours.map(|e| (e.key.clone(), crc32fast::hash(e.value.as_deref().unwrap_or_default().as_bytes()))).collect()
}

/// CRC-32 of one column, taken block by block.
#[derive(Clone, Default)]
pub struct Sum(Hasher);

impl Sum {
    /// Takes numbers, to the bit.
    pub fn numbers(&mut self, values: &[f64]) {
        let mut bytes = [0; 8 * BATCH];
        for batch in values.chunks(BATCH) {
            for (to, value) in bytes.chunks_exact_mut(8).zip(batch) {
                to.copy_from_slice(&value.to_le_bytes());
            }
            self.0.update(&bytes[..8 * batch.len()]);
        }
    }

    /// Takes texts; their lengths keep `ab`, `c` from being `a`, `bc`.
    pub fn texts<'a>(&mut self, texts: impl Iterator<Item = &'a str>) {
        for text in texts {
            self.0.update(&(text.len() as u64).to_le_bytes());
            self.0.update(text.as_bytes());
        }
    }

    fn cells(&mut self, cells: &Cells) {
        match cells {
            Cells::Numbers(values) => self.numbers(values),
            Cells::Text(labels) => self.texts(labels.iter()),
        }
    }
}
