//! Columns as a container holds them: named numbers or text, before the sidecar has said what they mean.

use haptics::recording::Meta;
use std::collections::HashMap;

/// Marks a cell without a value. A quiet NaN with a payload that no computation makes; any other NaN is a NaN in the file.
pub const MISSING: f64 = f64::from_bits(0x7ff8_6d69_7373_6564);

/// True for [`MISSING`] and nothing else.
pub fn is_missing(value: f64) -> bool {
    value.to_bits() == MISSING.to_bits()
}

/// A column of text. Every distinct text is kept once: labels and frame names repeat.
#[derive(Clone, Debug, Default)]
pub struct Texts {
    /// Index into `known` of every row.
    codes: Vec<u32>,
    known: Vec<String>,
    lookup: HashMap<String, u32>,
    /// Bytes of all distinct texts.
    bytes: usize,
}

impl Texts {
    /// Appends one row.
    pub fn push(&mut self, text: &str) {
        // Rows repeat each other: the last text is tried before the map.
        if let Some(&last) = self.codes.last()
            && self.known[last as usize] == text
        {
            self.codes.push(last);
            return;
        }
        let code = self.lookup.get(text).copied().unwrap_or_else(|| {
            let code = self.known.len() as u32;
            self.known.push(text.to_owned());
            self.lookup.insert(text.to_owned(), code);
            self.bytes += 2 * text.len() + 64;
            code
        });
        self.codes.push(code);
    }

    /// Rows.
    pub fn len(&self) -> usize {
        self.codes.len()
    }

    /// The text of a row.
    pub fn get(&self, row: usize) -> &str {
        &self.known[self.codes[row] as usize]
    }

    /// The text of every row, when it is the same in all.
    pub fn constant(&self) -> Option<&str> {
        let &first = self.codes.first()?;
        self.codes.iter().all(|&c| c == first).then(|| self.known[first as usize].as_str())
    }
}

/// One column.
#[derive(Clone, Debug)]
pub enum Cells {
    /// Numbers; [`MISSING`] where there is none.
    Numbers(Vec<f64>),
    /// Text; empty where there is none.
    Text(Texts),
}

impl Cells {
    /// Rows.
    pub fn len(&self) -> usize {
        match self {
            Self::Numbers(values) => values.len(),
            Self::Text(texts) => texts.len(),
        }
    }

    /// Bytes held, about.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Numbers(values) => 8 * values.len(),
            Self::Text(texts) => 4 * texts.len() + texts.bytes,
        }
    }

    /// A cell as text, to select by and to tell trials apart.
    pub fn text(&self, row: usize) -> String {
        match self {
            Self::Numbers(values) if is_missing(values[row]) => String::new(),
            Self::Numbers(values) => values[row].to_string(),
            Self::Text(texts) => texts.get(row).to_owned(),
        }
    }

    /// The rows `keep`, in that order.
    pub fn gathered(&self, keep: &[usize]) -> Self {
        match self {
            Self::Numbers(values) => Self::Numbers(keep.iter().map(|&i| values[i]).collect()),
            Self::Text(texts) => {
                let mut kept = Texts::default();
                for &i in keep {
                    kept.push(texts.get(i));
                }
                Self::Text(kept)
            }
        }
    }
}

/// Every column of a container, all of one length.
#[derive(Debug, Default)]
pub struct Raw {
    /// Names, as they stand in the file or are made from topic and field.
    pub headers: Vec<String>,
    /// Full names `topic.field` beside `headers`, by which a sidecar may name a column too; empty where there are none.
    pub aliases: Vec<String>,
    /// The columns.
    pub columns: Vec<Cells>,
}

impl Raw {
    /// Rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, Cells::len)
    }

    /// The sidecar with full names (`topic.field`) put as the headers have them.
    pub fn resolved(&self, meta: &Meta) -> Meta {
        let header = |name: &String| {
            let known = self.headers.contains(name);
            let alias = self.aliases.iter().position(|a| !known && a == name);
            alias.map_or_else(|| name.clone(), |at| self.headers[at].clone())
        };
        let mut meta = meta.clone();
        for value in meta.columns.values_mut() {
            *value = header(value);
        }
        meta.select = meta.select.into_iter().map(|(k, v)| (header(&k), v)).collect();
        meta.scale = meta.scale.into_iter().map(|(k, v)| (header(&k), v)).collect();
        meta.sign = meta.sign.into_iter().map(|(k, v)| (header(&k), v)).collect();
        meta
    }
}
