//! Columns as a container holds them: named numbers or text, before the sidecar has assigned their meanings.

use haptics::recording::{Labels, Meta};

/// Marks a cell without a value. A quiet NaN with a payload that no computation makes; any other NaN is a NaN in the file.
pub const MISSING: f64 = f64::from_bits(0x7ff8_6d69_7373_6564);

/// True for [`MISSING`] and nothing else.
pub fn is_missing(value: f64) -> bool {
    value.to_bits() == MISSING.to_bits()
}

/// Name of a column that no name of its own tells from the others.
pub fn name_by_place(column: usize) -> String {
    format!("column {}", column + 1)
}

/// Column that a name by place means.
pub fn place_of(name: &str) -> Option<usize> {
    name.strip_prefix("column ")?.parse::<usize>().ok()?.checked_sub(1)
}

/// One column.
#[derive(Clone, Debug)]
pub enum Cells {
    /// Numbers; [`MISSING`] where there is none.
    Numbers(Vec<f64>),
    /// Text; empty where there is none.
    Text(Labels),
}

impl Cells {
    /// Rows.
    pub fn len(&self) -> usize {
        match self {
            Self::Numbers(values) => values.len(),
            Self::Text(texts) => texts.len(),
        }
    }

    /// Adds rows without a value until there are so many.
    pub fn pad(&mut self, rows: usize) {
        match self {
            Self::Numbers(values) => values.resize(rows.max(values.len()), MISSING),
            Self::Text(texts) => (texts.len()..rows).for_each(|_| texts.push("")),
        }
    }

    /// Bytes held, about.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Numbers(values) => 8 * values.len(),
            Self::Text(texts) => texts.bytes(),
        }
    }

    /// A cell as text, to select by and to tell trials apart.
    pub fn text(&self, row: usize) -> String {
        match self {
            Self::Numbers(values) if is_missing(values[row]) => String::new(),
            Self::Numbers(values) => values[row].to_string(),
            Self::Text(texts) => texts[row].to_owned(),
        }
    }

    /// The rows `keep`, in that order.
    pub fn gathered(&self, keep: &[usize]) -> Self {
        match self {
            Self::Numbers(values) => Self::Numbers(keep.iter().map(|&i| values[i]).collect()),
            Self::Text(texts) => Self::Text(texts.gathered(keep.iter().copied())),
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
    /// Texts of the units that stand outside the names; empty where there are none.
    pub units: Vec<String>,
    /// The columns.
    pub columns: Vec<Cells>,
    /// Full names of items of lists by place, and by the name of the item.
    pub renamed: Vec<(String, String)>,
    /// Nanoseconds since 1970 of the zero of the first column, if the reader made it of dated stamps.
    pub origin_ns: Option<i64>,
}

impl Raw {
    /// Rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, Cells::len)
    }

    /// Adds a column. `unit`: text of its unit outside its name.
    pub fn push(&mut self, (header, alias): (String, String), unit: String, cells: Cells) {
        self.headers.push(header);
        self.aliases.push(alias);
        self.units.push(unit);
        self.columns.push(cells);
    }

    /// The sidecar with full names (`topic.field`) put as the headers have them.
    pub fn resolved(&self, meta: &Meta) -> Meta {
        let header = |name: &String| {
            let known = self.headers.contains(name);
            let alias = self.aliases.iter().position(|a| !known && a == name);
            alias.map_or_else(|| name.clone(), |at| self.headers[at].clone())
        };
        with_names(&renamed(meta, &self.renamed), &header)
    }
}

/// The sidecar with every name of the first kind put as the second.
pub fn renamed(meta: &Meta, names: &[(String, String)]) -> Meta {
    let name = |name: &String| names.iter().find(|(from, _)| from == name).map_or(name, |(_, to)| to).clone();
    if names.is_empty() { meta.clone() } else { with_names(meta, &name) }
}

/// The sidecar with other names for the columns of the file.
fn with_names(meta: &Meta, name: &dyn Fn(&String) -> String) -> Meta {
    let mut meta = meta.clone();
    for value in meta.columns.values_mut() {
        *value = name(value);
    }
    meta.clocks = meta.clocks.into_iter().map(|(k, v)| (name(&k), v.renamed(name))).collect();
    meta.select = meta.select.into_iter().map(|(k, v)| (name(&k), v)).collect();
    meta.scale = meta.scale.into_iter().map(|(k, v)| (name(&k), v)).collect();
    meta.sign = meta.sign.into_iter().map(|(k, v)| (name(&k), v)).collect();
    meta
}
