//! Use of each column of a file: decided from its header and the sidecar before a single number is read.

mod clock_column;
mod own_names;
mod pairs;
mod second_clocks;
mod selection;
mod spare;
mod time_parts;

pub use selection::{Wanted, counts_runs};

pub use clock_column::is_clock;
pub use pairs::PAIRS;
pub use second_clocks::{SecondClock, TIMES, is_like_a_clock, words};

use super::csv::calendar::Form;
use super::errors::LogError;
use super::origin::Origin;
use super::raw::{name_by_place, place_of};
use super::units::{self, Dimension, Unit};
use super::written_units::{self, Written};
use haptics::recording::Meta;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::Path;

/// Use of one column of the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Use {
    /// Parsed as numbers and multiplied by `factor`.
    Number {
        /// Text in it is an error from the first row on.
        required: bool,
        /// Unit conversion, scale and sign.
        factor: f64,
    },
    /// Parsed as times of the calendar or of the day, s since `origin_ns`.
    Stamp {
        /// Nanoseconds of the first row.
        origin_ns: i64,
        /// Form of the cells.
        form: Form,
    },
    /// Not read as numbers.
    Ignore,
}

/// A channel to be made: its name in the program, its SI unit, the column it comes from.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    /// `fx1_N`, …
    pub name: String,
    /// `N`, …; empty for none.
    pub unit: String,
    /// Column of the file.
    pub column: usize,
}

/// The whole decision.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// One entry a column of the file.
    pub uses: Vec<Use>,
    /// The channels, in the order of the file's columns; the time is not among them.
    pub targets: Vec<Target>,
    /// The time column.
    pub time: Option<usize>,
    /// True if nothing states the unit of the time column.
    pub is_unit_assumed: bool,
    /// Column of the fraction of a second beside whole seconds in the time column, with seconds over its numbers.
    pub fraction: Option<(usize, f64)>,
    /// Clocks of some columns only.
    pub clocks: Vec<SecondClock>,
    /// Columns that read as clocks and that nobody calls one, with their seconds over numbers.
    pub suspects: Vec<(usize, f64)>,
    /// Zero of a time column that the format's reader made.
    pub origin: Option<Origin>,
    /// The trial column.
    pub trial: Option<usize>,
    /// True when the trial column was told by its name, which may mean something else.
    pub is_trial_guessed: bool,
    /// The label column.
    pub label: Option<usize>,
    /// Rows to keep.
    pub select: Vec<Wanted>,
    /// Runs to keep, by their names; its column means nothing.
    pub runs: Option<Wanted>,
    /// Columns whose contents are compared between trials.
    pub watched: Vec<usize>,
    /// Columns that tell the trials of the file apart: `trial` and those of `select`.
    pub trial_keys: Vec<usize>,
    /// Columns that the log can do without.
    pub spare: Vec<usize>,
    /// Texts of cells without a measurement.
    pub missing: Vec<String>,
    /// Sentences for the reader.
    pub notes: Vec<String>,
}

impl Plan {
    /// True for a cell that holds no measurement, as the sidecar says.
    pub fn is_missing(&self, cell: &str) -> bool {
        self.missing.iter().any(|text| text.eq_ignore_ascii_case(cell))
    }

    /// True if the table has a clock of some columns only, or a column that reads as one.
    pub fn has_pairs(&self) -> bool {
        !self.clocks.is_empty() || !self.suspects.is_empty()
    }
}

struct Planner<'a> {
    headers: &'a [String],
    /// Units that stand outside the names, if any.
    units: &'a [String],
    meta: &'a Meta,
    path: &'a Path,
    plan: Plan,
    /// Columns of the targets, by name: a table may have a hundred thousand.
    taken: HashMap<String, usize>,
}

/// Decides the use of each column. `stated`: the text of each column's unit outside its name, or nothing.
pub fn plan(headers: &[String], stated: &[String], meta: &Meta, path: &Path) -> Result<Plan, LogError> {
    let empty = Plan { uses: vec![Use::Ignore; headers.len()], missing: meta.missing.clone(), ..Plan::default() };
    let mut planner = Planner { headers, units: stated, meta, path, plan: empty, taken: HashMap::new() };
    let mapped: HashSet<usize> = planner.take_mapping()?.into_iter().collect();
    let repeated = planner.repeated();
    for column in (0..headers.len()).filter(|c| !mapped.contains(c)) {
        if repeated.contains(&column) && !planner.is_program_column(column) {
            let (name, place) = (&headers[column], name_by_place(column));
            planner
                .plan
                .notes
                .push(format!("the name `{name}` stands above several columns: `{place}` is one of them"));
            planner.add(place, planner.shown_unit(column), column, 1.0, false)?;
        } else {
            planner.take_own_name(column)?;
        }
    }
    planner.guess_time();
    planner.note_assumed_unit();
    planner.take_fraction();
    planner.take_clocks()?;
    planner.suspect_clocks();
    planner.guess_runs();
    planner.take_select()?;
    planner.note_unused_keys();
    planner.plan.targets.sort_by_key(|t| t.column);
    planner.complete()?;
    planner.watch();
    Ok(planner.plan)
}

/// Names by which a sidecar calls the columns: by their places where several have one name.
pub fn sources(headers: &[String]) -> Vec<String> {
    let mut counts: HashMap<&str, usize> = HashMap::new();
    for header in headers {
        *counts.entry(header).or_default() += 1;
    }
    let source = |(column, header): (usize, &String)| match counts.get(header.as_str()) {
        Some(1) => header.clone(),
        _ => name_by_place(column),
    };
    headers.iter().enumerate().map(source).collect()
}

/// Name of the program and factor of a column by its own name, as it is read without a sidecar.
pub fn program_name(header: &str, unit: &str) -> Result<Option<(String, f64)>, LogError> {
    let (headers, units, meta) = ([header.to_owned()], [unit.to_owned()], Meta::default());
    let plan = Plan { uses: vec![Use::Ignore], ..Plan::default() };
    let planner =
        Planner { headers: &headers, units: &units, meta: &meta, path: Path::new(""), plan, taken: HashMap::new() };
    Ok(planner.program_name(0)?.map(|(name, _, factor)| (name, factor)))
}

impl Planner<'_> {
    fn missing(&self, column: &str, why: String) -> LogError {
        LogError::MissingColumn {
            column: column.to_owned(),
            why,
            present: list(self.headers),
            instead: Box::default(),
            path: self.path.to_path_buf(),
        }
    }

    /// Columns whose name an earlier one has.
    fn repeated(&self) -> HashSet<usize> {
        let mut known = HashSet::new();
        (0..self.headers.len()).filter(|&c| !self.headers[c].is_empty() && !known.insert(&self.headers[c])).collect()
    }

    fn is_program_column(&self, column: usize) -> bool {
        let header = self.headers[column].as_str();
        let known = units::split(header).is_some_and(|(quantity, _)| units::quantity_dimensions(quantity).is_some());
        known || matches!(header, "trial" | "label")
    }

    fn duplicate(&self, name: &str, first: usize, second: usize) -> LogError {
        let place = |column: usize| format!("column {}, `{}`", column + 1, self.headers[column]);
        let is_named_apart = self.headers[first] != self.headers[second];
        let choice = if is_named_apart { self.headers[first].clone() } else { name_by_place(first) };
        LogError::DuplicateColumn {
            column: name.to_owned(),
            first: place(first),
            second: place(second),
            choice: (first != second).then(|| choice.into()),
            path: self.path.to_path_buf(),
        }
    }

    /// Column that a sidecar calls so: by its name, or as `column 3` by its place.
    fn position(&self, name: &str) -> Option<usize> {
        let by_place = || place_of(name).filter(|column| *column < self.headers.len());
        self.headers.iter().position(|h| h == name).or_else(by_place)
    }

    /// Puts the sidecar's `columns` in; returns the columns it used.
    fn take_mapping(&mut self) -> Result<Vec<usize>, LogError> {
        let mut used = Vec::new();
        for (name, source) in self.meta.columns.iter().filter(|(_, source)| !source.is_empty()) {
            let column = self
                .position(source)
                .ok_or_else(|| self.missing(source, format!("\"columns\" in the sidecar maps it to `{name}`")))?;
            if let Some(other) = (column + 1..self.headers.len()).find(|&c| self.headers[c] == *source) {
                return Err(self.duplicate(name, column, other));
            }
            used.push(column);
            match name.as_str() {
                "trial" => self.plan.trial = Some(column),
                "label" => self.plan.label = Some(column),
                _ => self.take_mapped_number(name, column)?,
            }
        }
        Ok(used)
    }

    fn take_mapped_number(&mut self, name: &str, column: usize) -> Result<(), LogError> {
        let Some((quantity, target)) = own_names::parted(name) else {
            if units::quantity_dimensions(name).is_some() {
                return Err(self.unknown_unit(name, "", name));
            }
            return self.add(name.to_owned(), String::new(), column, 1.0, true);
        };
        let factor = self.mapped_factor(name, target, column)?;
        self.note_doubtful_unit(name, target, column);
        self.add(format!("{quantity}_{}", target.si), target.si.to_owned(), column, factor, true)
    }

    /// SI value over number of a mapped column. A unit in the program's name (`q_mm`) is a statement of the user's, and so
    /// is a scale, which takes the place of any unit but those of the log format's own names.
    fn mapped_factor(&self, name: &str, target: Unit, column: usize) -> Result<f64, LogError> {
        let header = &self.headers[column];
        let scaled = self.meta.scale.contains_key(name) || self.meta.scale.contains_key(header);
        let wanted = [target.dimension];
        let measures_else = |unit: &str| LogError::WrongDimension {
            target: name.to_owned(),
            column: header.clone(),
            unit: unit.to_owned(),
            path: self.path.to_path_buf(),
        };
        if target.factor != 1.0 {
            return Ok(target.factor);
        }
        let own = units::split(header).map(|(_, unit)| unit).filter(|_| self.stated(column).is_empty());
        let text = self.unit_text(column, &wanted);
        match own {
            Some(own) if own.dimension == target.dimension => Ok(own.factor),
            _ if scaled || text.is_empty() => Ok(1.0),
            Some(own) if own.dimension != Dimension::Other => Err(measures_else(own.symbol)),
            _ => match written_units::parse(&text, &wanted) {
                Written::Known(dimension, factor) if dimension == target.dimension => Ok(factor),
                Written::Known(..) => Err(measures_else(&text)),
                Written::Counts | Written::Unknown => Err(self.unknown_unit(header, &text, name)),
            },
        }
    }

    /// Says that a word that may be a unit was taken for none.
    fn note_doubtful_unit(&mut self, name: &str, target: Unit, column: usize) {
        let header = self.headers[column].as_str();
        let scaled = self.meta.scale.contains_key(name) || self.meta.scale.contains_key(header);
        let word = header.rsplit_once(['_', ' ', '/']).map_or("", |(_, word)| word);
        let is_unit = matches!(written_units::parse(word, &[]), Written::Known(..));
        let is_word = (word.chars().count() > 1 || is_unit) && word.chars().all(char::is_alphabetic);
        if is_word && !scaled && target.factor == 1.0 && self.unit_text(column, &[target.dimension]).is_empty() {
            let note = format!("the name `{header}` states no known unit: its values are taken as {}", target.si);
            self.plan.notes.push(note);
        }
    }

    fn stated(&self, column: usize) -> &str {
        self.units.get(column).map_or("", String::as_str)
    }

    /// Text of the unit of a column for a quantity of these dimensions; empty if none is stated.
    fn unit_text(&self, column: usize, wanted: &[Dimension]) -> String {
        let stated = self.stated(column);
        if stated.is_empty() { written_units::in_header(&self.headers[column], wanted).1 } else { stated }.to_owned()
    }

    /// `name`: one of the program's, or its quantity alone.
    fn unknown_unit(&self, column: &str, unit: &str, name: &str) -> LogError {
        let own = units::split(name).map(|(_, unit)| [unit.dimension]);
        let dimensions = own.as_ref().map(<[_; 1]>::as_slice).or(units::quantity_dimensions(name)).unwrap_or(&[]);
        let name = match dimensions.first() {
            Some(dimension) if own.is_none() => format!("{name}_{}", units::si(*dimension)),
            _ => name.to_owned(),
        };
        LogError::UnknownUnit {
            column: column.to_owned(),
            unit: unit.to_owned(),
            accepted: units::accepted(dimensions),
            name,
            path: self.path.to_path_buf(),
        }
    }

    fn mapped(&self, name: &str) -> bool {
        self.taken.contains_key(name) && self.meta.columns.keys().any(|k| own_names::canonical(k) == name)
            || name == "t_s" && self.plan.time.is_some()
    }

    fn add(&mut self, name: String, unit: String, column: usize, factor: f64, required: bool) -> Result<(), LogError> {
        let header = &self.headers[column];
        if header.is_empty() && !required {
            self.plan.uses[column] = Use::Number { required: false, factor };
            return Ok(());
        }
        if required {
            self.name_and_unit_agree(&name, column)?;
        }
        let keys = [name.as_str(), header.as_str()];
        let pick = |map: &BTreeMap<String, f64>| map.get(keys[0]).or_else(|| map.get(keys[1])).copied().unwrap_or(1.0);
        let factor = factor * pick(&self.meta.scale) * pick(&self.meta.sign);
        if let Some(&first) = self.taken.get(&name) {
            return Err(self.duplicate(&name, first, column));
        }
        if let Use::Number { factor: other, .. } = self.plan.uses[column]
            && other != factor
        {
            return Err(self.duplicate(&name, column, column));
        }
        self.plan.uses[column] = Use::Number { required, factor };
        if name == "t_s" {
            self.plan.time = Some(column);
        } else {
            self.taken.insert(name.clone(), column);
            self.plan.targets.push(Target { name, unit, column });
        }
        Ok(())
    }

    fn note_unused_keys(&mut self) {
        let known = |key: &str| {
            self.position(key).is_some()
                || self.meta.columns.contains_key(key)
                || key == "t_s"
                || self.plan.targets.iter().any(|t| t.name == key)
        };
        let stray: Vec<String> =
            self.meta.scale.keys().chain(self.meta.sign.keys()).filter(|k| !known(k)).cloned().collect();
        for key in stray {
            self.plan
                .notes
                .push(format!("the sidecar gives a scale or sign for `{key}`, which the file does not have"));
        }
    }

    fn watch(&mut self) {
        let mut keys: Vec<usize> = self.plan.select.iter().map(|w| w.column).chain(self.plan.trial).collect();
        keys.sort_unstable();
        keys.dedup();
        if !keys.is_empty() {
            let watched = self.plan.targets.iter().filter(|t| units::is_program_name(&t.name)).map(|t| t.column);
            self.plan.watched = watched.collect();
            self.plan.trial_keys = keys;
        }
    }
}

/// The first names of a list, for a sentence.
fn list(names: &[String]) -> String {
    let shown: Vec<String> = names.iter().take(12).map(|n| format!("`{n}`")).collect();
    if names.len() > 12 { format!("{}, … ({} columns)", shown.join(", "), names.len()) } else { shown.join(", ") }
}

#[cfg(test)]
mod tests;
