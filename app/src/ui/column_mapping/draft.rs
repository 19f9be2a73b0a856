//! The mapping that is being edited, and its conversion from and to a sidecar. Fields that the dialog does not show
//! stay unchanged.

use crate::ui::column_mapping::facts::{ColumnFacts, FileFacts};
use crate::ui::column_mapping::file_units::FileUnit;
use crate::ui::column_mapping::guess::{guess, unit_of};
use crate::ui::column_mapping::names;
use crate::ui::column_mapping::names::{Form, dimension};
use crate::ui::column_mapping::words::words;
use estimator::log;
use estimator::log::units::{self, Dimension};
use estimator::log::written_units::{self, Written};
use haptics::recording::{Meta, Task};
use serde_json::Value;

/// Role of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Role {
    /// Kept under its own name, as an extra channel.
    Extra,
    /// A column name of the program in SI units, `trial`, `label`, or a name of the user's.
    Named(String),
}

/// One column of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Facts about the column in the file.
    pub facts: ColumnFacts,
    /// Role of the column.
    pub role: Role,
    /// Unit of the file's values.
    pub unit: Option<&'static FileUnit>,
    /// True if the header states the unit, false if it was inferred from the values.
    pub unit_stated: bool,
    /// True if the sign is inverted.
    pub negative: bool,
    /// Another column that may have the same meaning, if the role is a guess.
    pub rival: Option<String>,
    /// Factor applied beside the unit.
    pub scale: f64,
    /// Key of this row in the sidecar.
    key: Option<String>,
}

/// The whole mapping.
#[derive(Clone, Debug, PartialEq)]
pub struct Draft {
    /// Rows, one per column.
    pub rows: Vec<Row>,
    /// Remaining content of the sidecar; the dialog edits parts of it in place.
    pub meta: Meta,
}

impl Row {
    /// Name of the column in the program; `None` for an extra channel.
    pub fn name(&self) -> Option<&str> {
        match &self.role {
            Role::Named(name) => Some(name),
            Role::Extra => None,
        }
    }

    /// Sets the role, with its matching unit.
    pub fn set_role(&mut self, role: Role) {
        let before = self.name().and_then(dimension);
        self.role = role;
        let now = self.name().and_then(dimension);
        if now != before || self.unit.is_none() {
            (self.unit, self.unit_stated) = unit_of(&self.facts, self.name());
        }
    }

    /// Unit that the reader recognizes in the header.
    fn own_unit(&self) -> Option<units::Unit> {
        units::split(&self.facts.header).map(|(_, unit)| unit)
    }

    /// True if the file's unit is unknown, or of another dimension than the name: a factor is then required.
    pub fn needs_a_factor(&self) -> bool {
        let Some(wanted) = self.name().and_then(dimension) else { return false };
        let is_unknown = self.unit.is_none() && !self.unit_stated;
        is_unknown || self.own_unit().is_some_and(|own| own.dimension != wanted)
    }

    /// Name that the reader assigns to a column without a sidecar entry.
    fn read_as(&self) -> Option<String> {
        let header = &self.facts.header;
        if header == "trial" || header == "label" {
            return Some(header.clone());
        }
        log::program_name(header, &self.facts.stated_unit).ok().flatten().map(|(name, _)| name)
    }

    /// True if the reader would reject the header as it is, or read it as a quantity of the program.
    fn has_a_meaning(&self) -> bool {
        let header = &self.facts.header;
        matches!(header.as_str(), "trial" | "label")
            || !matches!(log::program_name(header, &self.facts.stated_unit), Ok(None))
    }

    /// Factor of the unit that the file states, for a quantity of this dimension.
    fn read_factor(&self, dimension: Dimension) -> Option<f64> {
        match written_units::parse(self.facts.unit_text(dimension), &[dimension]) {
            Written::Known(found, factor) if found == dimension => Some(factor),
            _ => None,
        }
    }

    /// Key for `columns` and factor for `scale` (`None`: none needed).
    fn stated(&self, name: &str) -> (String, Option<f64>) {
        let (Some((quantity, si)), Some(unit)) = (units::split(name), self.unit) else {
            return (name.to_owned(), (self.scale != 1.0).then_some(self.scale));
        };
        // The reader takes a unit that the file states, unless the key or a factor says otherwise.
        let is_stated = !self.facts.unit_text(si.dimension).is_empty();
        let own = self.own_unit().filter(|own| own.dimension == si.dimension && self.facts.stated_unit.is_empty());
        let scale = match (own, unit.symbol) {
            (Some(own), _) => self.scale * unit.factor / own.factor,
            _ if self.scale == 1.0
                && self.read_factor(si.dimension).is_some_and(|f| (f / unit.factor - 1.0).abs() < 1e-9) =>
            {
                1.0
            }
            (None, Some(symbol)) if !is_stated => {
                return (format!("{quantity}_{symbol}"), (self.scale != 1.0).then_some(self.scale));
            }
            // The header's unit belongs to another quantity or is unknown to the reader: only a factor helps.
            _ => return (name.to_owned(), Some(self.scale * unit.factor)),
        };
        (name.to_owned(), ((scale - 1.0).abs() > 1e-12).then_some(scale))
    }
}

impl Draft {
    /// Draft from a file and its `meta`; if `meta` maps no column, the columns are guessed.
    pub fn new(file: &FileFacts, meta: Meta) -> Self {
        let row = |facts: &ColumnFacts| Row {
            facts: facts.clone(),
            role: Role::Extra,
            unit: None,
            unit_stated: false,
            negative: false,
            rival: None,
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
        // Of several names for one column, the program's own is shown.
        let stranger = |name: &String| {
            units::split(name).is_none_or(|(quantity, _)| units::quantity_dimensions(quantity).is_none())
                && !matches!(name.as_str(), "trial" | "label")
        };
        let mut entries: Vec<(&String, &String)> = self.meta.columns.iter().collect();
        entries.sort_by_key(|(name, _)| stranger(name));
        for (name, source) in entries {
            let Some(row) = self.rows.iter_mut().find(|r| r.facts.source == *source && r.key.is_none()) else {
                continue;
            };
            let split = units::split(name);
            let si = split.map_or_else(|| name.clone(), |(quantity, unit)| format!("{quantity}_{}", unit.si));
            row.key = Some(name.clone());
            let own_name = name.strip_prefix(EXTRA) == Some(source.as_str());
            row.role = if own_name { Role::Extra } else { Role::Named(si.clone()) };
            (row.unit, row.unit_stated) = unit_of(&row.facts, Some(&si));
            let same = row.own_unit().filter(|own| split.is_some_and(|(_, unit)| unit.dimension == own.dimension));
            let has_factor = self.meta.scale.contains_key(&si) || self.meta.scale.contains_key(source);
            // Without any unit in the file, the name's is read.
            let is_open = |unit: &units::Unit| row.facts.unit_text(unit.dimension).is_empty() && !row.unit_stated;
            if let Some((_, unit)) = split.filter(|(_, unit)| unit.factor != 1.0 || has_factor || is_open(unit)) {
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

    /// Replaces every row by a guess.
    pub fn guess(&mut self) {
        self.rows.iter_mut().for_each(|row| row.role = Role::Extra);
        self.guess_those(|_| true);
        self.select_one_object();
    }

    /// Guesses the meanings of the columns that have none, but for meanings that others have.
    pub fn guess_the_rest(&mut self) {
        self.guess_those(|row| row.role == Role::Extra && row.key.is_none());
    }

    fn guess_those(&mut self, is_free: impl Fn(&Row) -> bool) {
        let taken: Vec<String> = self.rows.iter().filter_map(Row::name).map(str::to_owned).collect();
        let facts: Vec<ColumnFacts> = self.rows.iter().map(|r| r.facts.clone()).collect();
        for (row, guess) in self.rows.iter_mut().zip(guess(&facts)) {
            if !is_free(row) || guess.name.as_ref().is_some_and(|name| taken.contains(name)) {
                continue;
            }
            (row.unit, row.unit_stated, row.rival) = (guess.unit, guess.stated, guess.rival);
            row.role = guess.name.map_or(Role::Extra, Role::Named);
            if let Role::Named(name) = row.role.clone() {
                row.take_factors(&self.meta, &name);
            }
        }
    }

    /// In a table of several objects, the first is selected until the user chooses another.
    fn select_one_object(&mut self) {
        // Runs are recordings of one object.
        let is_object = |facts: &ColumnFacts| !facts.numeric || facts.whole && names_objects(&facts.header);
        let words = |r: &Row| is_object(&r.facts) && r.role == Role::Extra && !log::counts_runs(&r.facts.header);
        if self.meta.select.is_empty()
            && let Some(row) = self.rows.iter().find(|r| words(r) && several(&r.facts))
            && let Some(first) = row.facts.distinct.as_ref().and_then(|d| d.first())
        {
            self.meta.select.insert(row.facts.source.clone(), Value::String(first.clone()));
        }
    }

    /// Entries of `columns` whose column is missing in the file.
    pub fn strays(&self) -> Vec<(String, String)> {
        let there = |source: &str| self.rows.iter().any(|r| r.facts.source == source);
        self.meta.columns.iter().filter(|(_, s)| !there(s)).map(|(n, s)| (n.clone(), s.clone())).collect()
    }

    /// True if two columns claim this name.
    pub fn claimed_twice(&self, name: &str) -> bool {
        self.rows.iter().filter(|r| r.name() == Some(name)).count() > 1
    }

    /// First meaning that two columns claim, as one sentence.
    pub fn clash(&self) -> Option<String> {
        let name = self.rows.iter().filter_map(Row::name).find(|name| self.claimed_twice(name))?;
        let headers: Vec<String> =
            self.rows.iter().filter(|r| r.name() == Some(name)).map(|r| format!("`{}`", r.facts.header)).collect();
        Some(format!("{} both mean {name}: choose one of them.", headers.join(" and ")))
    }

    /// True if there is a column of time.
    pub fn has_time(&self) -> bool {
        self.rows.iter().any(|r| r.name() == Some("t_s"))
    }

    /// Possible values of a column of the file, or of `trial`, in `select`.
    pub fn values_of(&self, column: &str) -> &[String] {
        let source = self.rows.iter().find(|r| r.facts.header == column || r.name() == Some(column));
        source.and_then(|r| r.facts.distinct.as_deref()).unwrap_or_default()
    }

    /// Names offered for a row: those of the task, and the row's own.
    pub fn offered(&self, row: usize) -> Vec<&'static names::Name> {
        let mut offered = names::offered(self.meta.task);
        let words = !self.rows[row].facts.numeric;
        offered.retain(|n| !words || matches!(n.si, "trial" | "label"));
        if let Some(name) = self.rows[row].name().and_then(names::find)
            && !offered.contains(&name)
        {
            offered.push(name);
        }
        // Names that match the other columns come first.
        let in_use = |form| form == Form::Any || self.rows.iter().any(|r| form_of(r) == Some(form));
        offered.sort_by_key(|n| !in_use(n.form));
        offered
    }

    /// Sidecar that would be saved.
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

/// Form of recording that a column's name belongs to.
fn form_of(row: &Row) -> Option<Form> {
    row.name().and_then(names::find).map(|n| n.form)
}

/// Prefix of an extra channel whose header would otherwise have a meaning.
const EXTRA: &str = "extra_";

/// True for a name of a column that numbers objects: `Specimen No`, `part_id`.
fn names_objects(header: &str) -> bool {
    const OBJECTS: [&str; 6] = ["specimen", "part", "object", "probe", "device", "piece"];
    words(header).iter().any(|word| OBJECTS.contains(&word.as_str()))
}

/// True for a column with a few distinct values, each in a block of rows. Every row names its object; facts beside a table
/// end before it does.
fn several(facts: &ColumnFacts) -> bool {
    let is_of_blocks = |d: &Vec<String>| d.len() > 1 && facts.changes < 4 * d.len();
    facts.distinct.as_ref().is_some_and(|d| is_of_blocks(d) && !d.iter().any(String::is_empty))
}

impl Row {
    fn take_factors(&mut self, meta: &Meta, si: &str) {
        let pick = |map: &std::collections::BTreeMap<String, f64>| {
            map.get(si).or_else(|| map.get(&self.facts.header)).copied().unwrap_or(1.0)
        };
        let (scale, sign) = (pick(&meta.scale), pick(&meta.sign));
        (self.scale, self.negative) = (scale, sign < 0.0);
        // A factor can stand for a unit: `0.3048` beside metres means feet.
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

    /// Removes from `meta` the entries that this row replaces.
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
        // The factor of an extra channel is not shown, so it stays.
        let header = |key: &str| key == self.facts.header && self.name().is_some();
        let foreign = |key: &str| before.columns.get(key).is_some_and(|source| *source != self.facts.source);
        meta.scale.retain(|key, _| !(mine(key) || header(key)) || foreign(key));
        meta.sign.retain(|key, _| !(mine(key) || header(key)) || foreign(key));
    }

    /// Writes the entries of this row into `meta`.
    fn put(&self, meta: &mut Meta) {
        let (header, source) = (&self.facts.header, &self.facts.source);
        if header.is_empty() {
            return;
        }
        let Some(name) = self.name() else {
            if self.has_a_meaning() && self.facts.numeric {
                meta.columns.insert(format!("{EXTRA}{header}"), source.clone());
            }
            return;
        };
        let (key, scale) = self.stated(name);
        if self.read_as().as_deref() != Some(name) || self.key.is_some() {
            meta.columns.insert(key, source.clone());
        }
        if let Some(scale) = scale {
            meta.scale.insert(name.to_owned(), scale);
        }
        if self.negative {
            meta.sign.insert(name.to_owned(), -1.0);
        }
    }
}

/// Axes that may point up, with their labels.
pub const UP: [(&str, &str); 7] = [
    ("y", "y (usual)"),
    ("-y", "−y"),
    ("z", "z"),
    ("-z", "−z"),
    ("x", "x"),
    ("-x", "−x"),
    ("none", "none: it lies flat"),
];

/// Label of a task.
pub fn task_words(task: Option<Task>) -> String {
    task.map_or_else(|| "not stated".to_owned(), |t| t.name().replace('-', " "))
}
