//! The mapping that is being edited, and its way from a sidecar and back. What the dialog does not show stays as it was.

use super::facts::{ColumnFacts, FileFacts};
use super::file_units::{FileUnit, spelled};
use super::guess::{guess, unit_of};
use super::names::{self, Form, dimension};
use estimator::log::units;
use haptics::recording::{Meta, Task};
use serde_json::Value;

/// What a column is to be.
#[derive(Clone, Debug, PartialEq)]
pub enum Role {
    /// Kept under its own name, as an extra channel.
    Extra,
    /// A name of the program in SI units, `trial`, `label`, or a name of the user's.
    Named(String),
}

/// One column of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// What the file says.
    pub facts: ColumnFacts,
    /// What it is to be.
    pub role: Role,
    /// Its unit in the file.
    pub unit: Option<&'static FileUnit>,
    /// True when the unit stands in the header, false when it was told from the numbers.
    pub unit_stated: bool,
    /// Counts the other way round.
    pub negative: bool,
    /// Factor beside the unit.
    pub scale: f64,
    /// The key in the sidecar that this row stands for.
    key: Option<String>,
}

/// The whole mapping.
#[derive(Clone, Debug, PartialEq)]
pub struct Draft {
    /// The columns.
    pub rows: Vec<Row>,
    /// Everything else that the sidecar says; the dialog changes parts of it in place.
    pub meta: Meta,
}

impl Row {
    /// The name that it is to have in the program.
    pub fn name(&self) -> Option<&str> {
        match &self.role {
            Role::Named(name) => Some(name),
            Role::Extra => None,
        }
    }

    /// Gives it another role, with the unit that goes with it.
    pub fn set_role(&mut self, role: Role) {
        let before = self.name().and_then(dimension);
        self.role = role;
        let now = self.name().and_then(dimension);
        if now != before || self.unit.is_none() {
            (self.unit, self.unit_stated) = unit_of(&self.facts, self.name());
        }
    }

    /// The unit that stands in the header as the reader reads it.
    fn own_unit(&self) -> Option<units::Unit> {
        units::split(&self.facts.header).map(|(_, unit)| unit)
    }

    /// True when the header states a unit of something else than the name measures: its factor must be given.
    pub fn needs_a_factor(&self) -> bool {
        let Some(wanted) = self.name().and_then(dimension) else { return false };
        self.own_unit().is_some_and(|own| own.dimension != wanted)
    }

    /// The name that the reader gives a column which no sidecar mentions.
    fn read_as(&self) -> Option<String> {
        let header = &self.facts.header;
        if header == "trial" || header == "label" {
            return Some(header.clone());
        }
        let (quantity, unit) = units::split(header)?;
        let known = units::quantity_dimensions(quantity).is_some_and(|d| d.contains(&unit.dimension));
        known.then(|| format!("{quantity}_{}", unit.si))
    }

    /// True when the reader would refuse the header as it stands, or take it as something of the program's.
    fn has_a_meaning(&self) -> bool {
        let header = &self.facts.header;
        let known = |part: &str| units::quantity_dimensions(part).is_some();
        self.read_as().is_some()
            || units::split(header).is_none()
                && (known(header) || header.match_indices('_').any(|(at, _)| known(&header[..at])))
    }

    /// Key for `columns` and factor for `scale` (`None`: none needed).
    fn stated(&self, name: &str) -> (String, Option<f64>) {
        let (Some((quantity, si)), Some(unit)) = (units::split(name), self.unit) else {
            return (name.to_owned(), (self.scale != 1.0).then_some(self.scale));
        };
        let header = &self.facts.header;
        let tail_is_unit = header.rsplit_once('_').is_some_and(|(_, tail)| spelled(tail).is_some());
        let scale = match (self.own_unit(), unit.symbol) {
            (Some(own), _) if own.dimension == si.dimension => self.scale * unit.factor / own.factor,
            (None, Some(symbol)) if !tail_is_unit => {
                return (format!("{quantity}_{symbol}"), (self.scale != 1.0).then_some(self.scale));
            }
            // The header's own unit is another quantity's, or unknown to the reader: only a factor helps.
            _ => return (name.to_owned(), Some(self.scale * unit.factor)),
        };
        (name.to_owned(), ((scale - 1.0).abs() > 1e-12).then_some(scale))
    }
}

impl Draft {
    /// A draft of what `meta` says about a file; columns that it says nothing about are guessed when it maps none.
    pub fn new(file: &FileFacts, meta: Meta) -> Self {
        let row = |facts: &ColumnFacts| Row {
            facts: facts.clone(),
            role: Role::Extra,
            unit: None,
            unit_stated: false,
            negative: false,
            scale: 1.0,
            key: None,
        };
        let mut draft = Self { rows: file.columns.iter().map(row).collect(), meta };
        draft.take_columns();
        if draft.meta.columns.is_empty() {
            draft.guess();
        } else {
            draft.take_own_names();
        }
        draft
    }

    fn take_columns(&mut self) {
        // Where several names share a column, the program's own is the one that is shown.
        let stranger = |name: &String| {
            units::split(name).is_none_or(|(quantity, _)| units::quantity_dimensions(quantity).is_none())
                && !matches!(name.as_str(), "trial" | "label")
        };
        let mut entries: Vec<(&String, &String)> = self.meta.columns.iter().collect();
        entries.sort_by_key(|(name, _)| stranger(name));
        for (name, source) in entries {
            let Some(row) = self.rows.iter_mut().find(|r| r.facts.header == *source && r.key.is_none()) else {
                continue;
            };
            let split = units::split(name);
            let si = split.map_or_else(|| name.clone(), |(quantity, unit)| format!("{quantity}_{}", unit.si));
            row.key = Some(name.clone());
            let own_name = name.strip_prefix(EXTRA) == Some(source.as_str());
            row.role = if own_name { Role::Extra } else { Role::Named(si.clone()) };
            (row.unit, row.unit_stated) = unit_of(&row.facts, Some(&si));
            let same = row.own_unit().filter(|own| split.is_some_and(|(_, unit)| unit.dimension == own.dimension));
            if let Some((_, unit)) = split {
                row.unit = FileUnit::of_symbol(same.map_or(unit.symbol, |own| own.symbol));
            }
            row.take_factors(&self.meta, &si);
        }
    }

    fn take_own_names(&mut self) {
        for row in &mut self.rows {
            if row.key.is_none()
                && let Some(name) = row.read_as()
            {
                (row.unit, row.unit_stated) = unit_of(&row.facts, Some(&name));
                row.take_factors(&self.meta, &name);
                row.role = Role::Named(name);
            }
        }
    }

    /// Puts guesses into every row, over whatever was there.
    pub fn guess(&mut self) {
        let facts: Vec<ColumnFacts> = self.rows.iter().map(|r| r.facts.clone()).collect();
        for (row, guess) in self.rows.iter_mut().zip(guess(&facts)) {
            row.role = guess.name.map_or(Role::Extra, Role::Named);
            (row.unit, row.unit_stated) = (guess.unit, guess.stated);
            if let Role::Named(name) = row.role.clone() {
                row.take_factors(&self.meta, &name);
            }
        }
        let words = |r: &Row| !r.facts.numeric && r.role == Role::Extra;
        // A table of several things: the first of them, until another is chosen.
        if self.meta.select.is_empty()
            && let Some(row) = self.rows.iter().find(|r| words(r) && several(&r.facts))
            && let Some(first) = row.facts.distinct.as_ref().and_then(|d| d.first())
        {
            self.meta.select.insert(row.facts.header.clone(), Value::String(first.clone()));
        }
    }

    /// The columns that `columns` names and the file does not have.
    pub fn strays(&self) -> Vec<(String, String)> {
        let there = |source: &str| self.rows.iter().any(|r| r.facts.header == source);
        self.meta.columns.iter().filter(|(_, s)| !there(s)).map(|(n, s)| (n.clone(), s.clone())).collect()
    }

    /// Names that two columns claim.
    pub fn claimed_twice(&self, name: &str) -> bool {
        self.rows.iter().filter(|r| r.name() == Some(name)).count() > 1
    }

    /// The first meaning that two columns have, in one sentence.
    pub fn clash(&self) -> Option<String> {
        let name = self.rows.iter().filter_map(Row::name).find(|name| self.claimed_twice(name))?;
        let headers: Vec<String> =
            self.rows.iter().filter(|r| r.name() == Some(name)).map(|r| format!("`{}`", r.facts.header)).collect();
        Some(format!("{} both mean {name}: choose one of them.", headers.join(" and ")))
    }

    /// True when there is a column of time.
    pub fn has_time(&self) -> bool {
        self.rows.iter().any(|r| r.name() == Some("t_s"))
    }

    /// Values that a column of the file, or `trial`, can have in `select`.
    pub fn values_of(&self, column: &str) -> &[String] {
        let source = self.rows.iter().find(|r| r.facts.header == column || r.name() == Some(column));
        source.and_then(|r| r.facts.distinct.as_deref()).unwrap_or_default()
    }

    /// The names that a task offers a row: those of the task, and the one it has.
    pub fn offered(&self, row: usize) -> Vec<&'static names::Name> {
        let mut offered = names::offered(self.meta.task);
        let words = !self.rows[row].facts.numeric;
        offered.retain(|n| !words || matches!(n.si, "trial" | "label"));
        if let Some(name) = self.rows[row].name().and_then(names::find)
            && !offered.contains(&name)
        {
            offered.push(name);
        }
        // What goes with the rest of the columns comes first.
        let in_use = |form| form == Form::Any || self.rows.iter().any(|r| form_of(r) == Some(form));
        offered.sort_by_key(|n| !in_use(n.form));
        offered
    }

    /// The sidecar as it would be saved.
    pub fn sidecar(&self) -> Meta {
        let mut meta = self.meta.clone();
        for row in &self.rows {
            row.forget(&mut meta, &self.meta);
        }
        for row in &self.rows {
            row.put(&mut meta);
        }
        meta
    }
}

/// The way of recording that a column's meaning belongs to.
fn form_of(row: &Row) -> Option<Form> {
    row.name().and_then(names::find).map(|n| n.form)
}

/// Put before the name of a column that is not to be what its name says.
const EXTRA: &str = "extra_";

/// True for a column of a few words, each in a block of rows.
fn several(facts: &ColumnFacts) -> bool {
    facts.distinct.as_ref().is_some_and(|d| d.len() > 1 && facts.changes < 4 * d.len())
}

impl Row {
    fn take_factors(&mut self, meta: &Meta, si: &str) {
        let pick = |map: &std::collections::BTreeMap<String, f64>| {
            map.get(si).or_else(|| map.get(&self.facts.header)).copied().unwrap_or(1.0)
        };
        let (scale, sign) = (pick(&meta.scale), pick(&meta.sign));
        (self.scale, self.negative) = (scale, sign < 0.0);
        // A factor that is a unit's: `0.3048` beside metres is feet.
        let own = self.own_unit().map_or(1.0, |u| u.factor);
        if let Some(unit) = self.unit.filter(|u| scale != 1.0 && !self.needs_factor_for(u)) {
            let same = |other: &&FileUnit| (other.factor / (scale * own) - 1.0).abs() < 1e-9;
            if let Some(found) = FileUnit::all_of(unit.dimension).find(same) {
                (self.unit, self.scale) = (Some(found), 1.0);
            }
        }
    }

    fn needs_factor_for(&self, unit: &FileUnit) -> bool {
        self.own_unit().is_some_and(|own| own.dimension != unit.dimension)
    }

    /// Takes out of `meta` what this row says anew.
    fn forget(&self, meta: &mut Meta, before: &Meta) {
        let mut keys: Vec<&str> = vec![];
        if let Some(key) = &self.key {
            meta.columns.remove(key);
            keys.push(key);
        }
        let read_as = self.read_as();
        keys.extend(read_as.as_deref());
        keys.extend(self.name());
        let si = |key: &str| units::split(key).map(|(q, unit)| format!("{q}_{}", unit.si));
        let canonical: Vec<String> = keys.iter().filter_map(|k| si(k)).collect();
        let mine = |key: &str| keys.contains(&key) || canonical.iter().any(|c| c == key);
        // A factor of an extra channel is not shown, so it stays.
        let header = |key: &str| key == self.facts.header && self.name().is_some();
        let foreign = |key: &str| before.columns.get(key).is_some_and(|source| *source != self.facts.header);
        meta.scale.retain(|key, _| !(mine(key) || header(key)) || foreign(key));
        meta.sign.retain(|key, _| !(mine(key) || header(key)) || foreign(key));
    }

    /// Puts into `meta` what this row says.
    fn put(&self, meta: &mut Meta) {
        let header = &self.facts.header;
        if header.is_empty() {
            return;
        }
        let Some(name) = self.name() else {
            if self.has_a_meaning() && self.facts.numeric {
                meta.columns.insert(format!("{EXTRA}{header}"), header.clone());
            }
            return;
        };
        let (key, scale) = self.stated(name);
        if self.read_as().as_deref() != Some(name) || self.key.is_some() {
            meta.columns.insert(key, header.clone());
        }
        if let Some(scale) = scale {
            meta.scale.insert(name.to_owned(), scale);
        }
        if self.negative {
            meta.sign.insert(name.to_owned(), -1.0);
        }
    }
}

/// Axes that may point up, with words.
pub const UP: [(&str, &str); 7] = [
    ("y", "y (usual)"),
    ("-y", "−y"),
    ("z", "z"),
    ("-z", "−z"),
    ("x", "x"),
    ("-x", "−x"),
    ("none", "none: it lies flat"),
];

/// What a task is called.
pub fn task_words(task: Option<Task>) -> String {
    task.map_or_else(|| "not stated".to_owned(), |t| t.name().replace('-', " "))
}
