//! Use of each column of a file: decided from its header and the sidecar before a single number is read.

use super::errors::LogError;
use super::units::{self, Unit};
use haptics::recording::Meta;
use serde_json::Value;
use std::collections::{HashMap, HashSet};
use std::path::Path;

/// Columns that are of no use without each other; a log that has one of a pair must have both.
pub const PAIRS: [(&str, &str); 12] = [
    ("x_m", "y_m"),
    ("fx_N", "fy_N"),
    ("qb_rad", "qt_rad"),
    ("x1_m", "y1_m"),
    ("x2_m", "y2_m"),
    ("fx1_N", "fy1_N"),
    ("fx2_N", "fy2_N"),
    ("qb1_rad", "qt1_rad"),
    ("qb2_rad", "qt2_rad"),
    ("x1_m", "x2_m"),
    ("fx1_N", "fx2_N"),
    ("qb1_rad", "qb2_rad"),
];

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
    /// Not read as numbers.
    Ignore,
}

/// One condition of `select`.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// Column of the file.
    pub column: usize,
    /// The value, as text.
    pub text: String,
    number: Option<f64>,
}

impl Wanted {
    fn new(column: usize, value: &Value) -> Self {
        let text = value.as_str().map_or_else(|| value.to_string(), |s| s.trim().to_owned());
        let number = text.parse().ok();
        Self { column, text, number }
    }

    /// True when the cell is this value, as text or as a number (`1` = `1.0`).
    pub fn matches(&self, cell: &[u8]) -> bool {
        if cell == self.text.as_bytes() {
            return true;
        }
        let Some(number) = self.number else { return false };
        std::str::from_utf8(cell).ok().and_then(|t| t.parse::<f64>().ok()) == Some(number)
    }
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
    /// The trial column.
    pub trial: Option<usize>,
    /// The label column.
    pub label: Option<usize>,
    /// Rows to keep.
    pub select: Vec<Wanted>,
    /// Columns whose contents are compared between trials.
    pub watched: Vec<usize>,
    /// Columns that tell the trials of the file apart: `trial` and those of `select`.
    pub trial_keys: Vec<usize>,
    /// Sentences for the reader.
    pub notes: Vec<String>,
}

struct Planner<'a> {
    headers: &'a [String],
    meta: &'a Meta,
    path: &'a Path,
    plan: Plan,
    /// Columns of the targets, by name: a table may have a hundred thousand.
    taken: HashMap<String, usize>,
}

/// Decides the use of each column.
pub fn plan(headers: &[String], meta: &Meta, path: &Path) -> Result<Plan, LogError> {
    let empty = Plan { uses: vec![Use::Ignore; headers.len()], ..Plan::default() };
    let mut planner = Planner { headers, meta, path, plan: empty, taken: HashMap::new() };
    planner.refuse_repeated_headers()?;
    let mapped: HashSet<usize> = planner.take_mapping()?.into_iter().collect();
    for column in (0..headers.len()).filter(|c| !mapped.contains(c)) {
        planner.take_own_name(column)?;
    }
    planner.guess_time();
    planner.take_select()?;
    planner.note_unused_keys();
    planner.plan.targets.sort_by_key(|t| t.column);
    planner.complete()?;
    planner.watch();
    Ok(planner.plan)
}

impl Planner<'_> {
    fn missing(&self, column: &str, why: String) -> LogError {
        LogError::MissingColumn {
            column: column.to_owned(),
            why,
            present: list(self.headers),
            path: self.path.to_path_buf(),
        }
    }

    fn refuse_repeated_headers(&self) -> Result<(), LogError> {
        let mut known = HashMap::new();
        for (column, name) in self.headers.iter().enumerate().filter(|(_, n)| !n.is_empty()) {
            if let Some(first) = known.insert(name, column) {
                return Err(self.duplicate(name, first, column));
            }
        }
        Ok(())
    }

    fn duplicate(&self, name: &str, first: usize, second: usize) -> LogError {
        let place = |column: usize| format!("column {}, `{}`", column + 1, self.headers[column]);
        LogError::DuplicateColumn {
            column: name.to_owned(),
            first: place(first),
            second: place(second),
            path: self.path.to_path_buf(),
        }
    }

    fn position(&self, name: &str) -> Option<usize> {
        self.headers.iter().position(|h| h == name)
    }

    /// Puts the sidecar's `columns` in; returns the columns it used.
    fn take_mapping(&mut self) -> Result<Vec<usize>, LogError> {
        let mut used = Vec::new();
        for (name, source) in &self.meta.columns {
            let column = self
                .position(source)
                .ok_or_else(|| self.missing(source, format!("\"columns\" in the sidecar maps it to `{name}`")))?;
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
        let Some((quantity, target)) = units::split(name) else {
            if units::quantity_dimensions(name).is_some() {
                return Err(self.unknown_unit(name, "", name));
            }
            return self.add(name.to_owned(), String::new(), column, 1.0, true);
        };
        let header = &self.headers[column];
        let own = units::split(header).map(|(_, unit)| unit);
        let scaled = self.meta.scale.contains_key(name) || self.meta.scale.contains_key(header);
        let unit = match own {
            Some(own) if own.dimension == target.dimension => own,
            Some(own) if !scaled => {
                return Err(LogError::WrongDimension {
                    target: name.to_owned(),
                    column: header.clone(),
                    unit: own.symbol.to_owned(),
                    path: self.path.to_path_buf(),
                });
            }
            None if !scaled && foreign_unit(header).is_some() => {
                let unit = foreign_unit(header).unwrap_or_default();
                return Err(self.unknown_unit(header, unit, quantity));
            }
            // Its own name says nothing usable, or a scale states the conversion: the program's name sets the unit.
            _ => target,
        };
        let si = format!("{quantity}_{}", target.si);
        self.add(si, target.si.to_owned(), column, unit.factor, true)
    }

    fn unknown_unit(&self, column: &str, unit: &str, quantity: &str) -> LogError {
        LogError::UnknownUnit {
            column: column.to_owned(),
            unit: unit.to_owned(),
            accepted: units::accepted(units::quantity_dimensions(quantity).unwrap_or(&[])),
            path: self.path.to_path_buf(),
        }
    }

    /// A column that the sidecar does not mention.
    fn take_own_name(&mut self, column: usize) -> Result<(), LogError> {
        let header = self.headers[column].clone();
        match header.as_str() {
            "trial" if self.plan.trial.is_none() => {
                self.plan.trial = Some(column);
                return Ok(());
            }
            "label" if self.plan.label.is_none() => {
                self.plan.label = Some(column);
                return Ok(());
            }
            _ => {}
        }
        let split = units::split(&header);
        let known = split.and_then(|(quantity, unit)| Some((quantity, unit, units::quantity_dimensions(quantity)?)));
        if let Some((quantity, unit, _)) = known.filter(|(_, unit, dimensions)| dimensions.contains(&unit.dimension)) {
            let name = format!("{quantity}_{}", unit.si);
            if self.mapped(&name) {
                self.plan.notes.push(format!(
                    "the column `{header}` is not used: \"columns\" in the sidecar maps another one to `{name}`"
                ));
                return Ok(());
            }
            return self.add(name, unit.si.to_owned(), column, unit.factor, true);
        }
        if split.is_none() {
            self.refuse_unknown_unit(&header)?;
        }
        let (name, unit, factor) = match split {
            Some((quantity, unit)) => (format!("{quantity}_{}", unit.si), unit.si.to_owned(), unit.factor),
            None => (header.clone(), header.rsplit_once('_').map_or(String::new(), |(_, u)| u.to_owned()), 1.0),
        };
        self.add(name, unit, column, factor, false)
    }

    /// `fx1_lbf`, `q_turns`, `x`: a quantity of the program in a unit that it cannot convert.
    fn refuse_unknown_unit(&self, header: &str) -> Result<(), LogError> {
        let mut parts = header.match_indices('_').map(|(at, _)| (&header[..at], &header[at + 1..]));
        let found = parts.find(|(quantity, _)| units::quantity_dimensions(quantity).is_some());
        let alone = units::quantity_dimensions(header).is_some().then_some((header, ""));
        let word = header.split_once('_').filter(|(q, _)| ["force", "torque", "angle", "position"].contains(q));
        let foreign = foreign_unit(header).and_then(|unit| word.map(|(quantity, _)| (quantity, unit)));
        let Some((quantity, unit)) = found.or(alone).or(foreign) else { return Ok(()) };
        let mapped = self.meta.columns.keys().any(|k| units::split(k).is_some_and(|(q, _)| q == quantity));
        if mapped { Ok(()) } else { Err(self.unknown_unit(header, unit, quantity)) }
    }

    fn mapped(&self, name: &str) -> bool {
        self.taken.contains_key(name) && self.meta.columns.keys().any(|k| canonical(k) == name)
            || name == "t_s" && self.plan.time.is_some()
    }

    fn add(&mut self, name: String, unit: String, column: usize, factor: f64, required: bool) -> Result<(), LogError> {
        let header = &self.headers[column];
        if header.is_empty() && !required {
            self.plan.uses[column] = Use::Number { required: false, factor };
            return Ok(());
        }
        let keys = [name.as_str(), header.as_str()];
        let pick = |map: &std::collections::BTreeMap<String, f64>| {
            map.get(keys[0]).or_else(|| map.get(keys[1])).copied().unwrap_or(1.0)
        };
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

    /// `time_s`, `time_ms`: the time, when nothing else claims to be it.
    fn guess_time(&mut self) {
        if self.plan.time.is_some() || self.meta.rate_hz.is_some() {
            return;
        }
        if let Some(at) = self.plan.targets.iter().position(|t| t.name == "time_s" || t.name == "timestamp_s") {
            let target = self.plan.targets.remove(at);
            self.plan.time = Some(target.column);
            self.plan.notes.push(format!("the column `{}` is taken as the time t_s", self.headers[target.column]));
        }
    }

    fn take_select(&mut self) -> Result<(), LogError> {
        for (name, value) in &self.meta.select {
            let source = self.meta.columns.get(name).unwrap_or(name);
            let column = self
                .position(source)
                .ok_or_else(|| self.missing(source, "\"select\" in the sidecar names it".to_owned()))?;
            self.plan.select.push(Wanted::new(column, value));
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

    /// Vectors must be complete: half a position or half a force is of no use.
    fn complete(&self) -> Result<(), LogError> {
        let has = |name: &str| self.plan.targets.iter().any(|t| t.name == name);
        for (a, b) in PAIRS {
            for (there, absent) in [(a, b), (b, a)] {
                if has(there) && !has(absent) {
                    return Err(self.missing(absent, format!("`{there}` is there and needs it")));
                }
            }
        }
        Ok(())
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

/// The SI form of a program name: `q_mm` → `q_m`.
fn canonical(name: &str) -> String {
    units::split(name)
        .map_or_else(|| name.to_owned(), |(quantity, unit): (&str, Unit)| format!("{quantity}_{}", unit.si))
}

/// A unit that people use and the program does not convert.
fn foreign_unit(header: &str) -> Option<&str> {
    const FOREIGN: [&str; 18] = [
        "lbf", "lb", "kgf", "kp", "kN", "oz", "ozf", "dyn", "in", "inch", "ft", "mil", "grad", "gon", "turns", "rev",
        "lbfin", "ozin",
    ];
    header.rsplit_once('_').map(|(_, unit)| unit).filter(|unit| FOREIGN.contains(unit))
}

/// The first names of a list, for a sentence.
fn list(names: &[String]) -> String {
    let shown: Vec<String> = names.iter().take(12).map(|n| format!("`{n}`")).collect();
    if names.len() > 12 { format!("{}, … ({} columns)", shown.join(", "), names.len()) } else { shown.join(", ") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn headers(text: &str) -> Vec<String> {
        text.split(',').map(str::to_owned).collect()
    }

    fn meta(json: &str) -> Meta {
        serde_json::from_str(json).expect("a sidecar")
    }

    fn names(plan: &Plan) -> Vec<&str> {
        plan.targets.iter().map(|t| t.name.as_str()).collect()
    }

    #[test]
    fn a_mapped_column_brings_its_own_unit() {
        let meta = meta(r#"{"columns":{"t_s":"time_ms","q_m":"position_mm","f_N":"pull"},"sign":{"f_N":-1}}"#);
        let plan = plan(&headers("time_ms,position_mm,pull"), &meta, Path::new("a")).expect("plans");
        assert_eq!(plan.uses[0], Use::Number { required: true, factor: 1e-3 });
        assert_eq!(plan.uses[1], Use::Number { required: true, factor: 1e-3 });
        assert_eq!(plan.uses[2], Use::Number { required: true, factor: -1.0 });
        assert_eq!((names(&plan), plan.time), (vec!["q_m", "f_N"], Some(0)));
    }

    #[test]
    fn a_scale_turns_volts_into_newtons_and_without_it_they_are_refused() {
        let columns = headers("t_s,q_m,command_V");
        let scaled = meta(r#"{"columns":{"f_N":"command_V"},"scale":{"f_N":35.0}}"#);
        assert_eq!(
            plan(&columns, &scaled, Path::new("a")).expect("plans").uses[2],
            Use::Number { required: true, factor: 35.0 }
        );
        let error = plan(&columns, &meta(r#"{"columns":{"f_N":"command_V"}}"#), Path::new("a")).expect_err("volts");
        assert!(error.to_string().contains("`command_V`") && error.to_string().contains("scale"), "{error}");
    }

    #[test]
    fn unknown_units_of_known_quantities_are_named() {
        for header in ["fx1_lbf", "q_turns", "x", "x_inch", "force_lbf"] {
            let error = plan(&headers(&format!("t_s,{header}")), &Meta::default(), Path::new("a")).expect_err(header);
            assert!(error.to_string().contains(&format!("`{header}`")), "{error}");
        }
        // Extra channels may carry any unit.
        let plan =
            plan(&headers("t_s,q_m,load_percent,oil_degC,q1_rad"), &Meta::default(), Path::new("a")).expect("fine");
        assert_eq!(names(&plan), ["q_m", "load_percent", "oil_degC", "q1_rad"]);
    }

    #[test]
    fn half_a_vector_and_a_clash_are_refused() {
        let no = |text: &str| plan(&headers(text), &Meta::default(), Path::new("a")).expect_err(text).to_string();
        assert!(no("t_s,x1_m,y1_m,x2_m,y2_m,fy1_N,fx2_N,fy2_N").contains("`fx1_N` is missing"));
        assert!(no("t_s,x_m,x_mm,y_m").contains("two columns give `x_m`"));
        assert!(no("t_s,q_m,q_m").contains("two columns give `q_m`"));
    }

    #[test]
    fn select_matches_text_and_numbers() {
        let one = Wanted::new(0, &Value::from("1"));
        assert!(one.matches(b"1") && one.matches(b"1.0") && !one.matches(b"10") && !one.matches(b"x"));
        assert!(Wanted::new(0, &Value::from(1)).matches(b"1.0"));
        assert!(Wanted::new(0, &Value::from("00")).matches(b"00"));
        assert!(Wanted::new(0, &Value::from("drawer")).matches(b"drawer"));
    }
}
