//! From variables to columns: fields by their paths, columns of matrices, and the runs of arrays of structures and cells.

use super::names::Beside;
use super::value::{Unread, Value, sides};
use crate::raw::Cells;
use haptics::recording::Labels;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Matrices with more columns (pictures, maps) are left out.
pub const MOST_COLUMNS: usize = 64;

/// Rows that one element of an array has in a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Run {
    /// Number of the element among all of the file; 0 outside of arrays.
    place: u64,
    /// Number of rows.
    pub rows: usize,
}

/// A column that grows run by run.
#[derive(Debug)]
pub struct Column {
    /// Full name: `struct.field`.
    pub path: String,
    /// Last part of the full name.
    pub short: String,
    /// Text of the unit, if one stands beside it.
    pub unit: String,
    pub cells: Cells,
    pub runs: Vec<Run>,
}

/// Columns of all lengths, and everything that is none.
#[derive(Debug, Default)]
pub struct Gathered {
    pub columns: Vec<Column>,
    /// Reasons, and the values that are left out for them.
    pub left_out: BTreeMap<String, BTreeSet<String>>,
    index: HashMap<String, usize>,
    places: HashMap<(u64, usize), u64>,
    /// Columns that have grown, for the array that is being read.
    grown: Vec<usize>,
}

/// A value with its surroundings.
#[derive(Clone, Copy)]
struct Field<'a> {
    /// Path of the structure around it; empty for a variable.
    around: &'a str,
    /// Its own name.
    name: &'a str,
    beside: &'a Beside,
    /// Element of an array in which it stands.
    place: u64,
}

impl Field<'_> {
    fn path(&self) -> String {
        join(self.around, self.name)
    }
}

fn join(around: &str, name: &str) -> String {
    if around.is_empty() { name.to_owned() } else { format!("{around}.{name}") }
}

impl Gathered {
    /// Takes the variables of a file.
    pub fn of(variables: Vec<(String, Value)>) -> Self {
        let mut gathered = Self::default();
        gathered.fields(variables, "", 0);
        gathered
    }

    /// Takes the variables of a file, or the fields of a structure.
    fn fields(&mut self, fields: Vec<(String, Value)>, around: &str, place: u64) {
        let beside = Beside::of(&fields);
        if let Some((name, why)) = &beside.unclear {
            self.leave_out(&join(around, name), why.clone());
        }
        let is_signals = |(name, value): &(String, Value)| name == "signals" && is_list_of_signals(value);
        let has_time = fields.iter().any(|(name, _)| name == "time");
        for (name, value) in fields {
            if beside.used.contains(&name) {
                continue;
            }
            match (name, value) {
                named if has_time && is_signals(&named) => self.signals(named.1, around, place),
                (name, value) => self.value(value, Field { around, name: &name, beside: &beside, place }),
            }
        }
    }

    fn value(&mut self, value: Value, field: Field<'_>) {
        match value {
            Value::Numbers { dims, values } => self.numbers(&dims, values, field),
            Value::Text(rows) => self.append(field, Cells::Text(rows.iter().map(String::as_str).collect())),
            Value::Cells { dims, items } => self.cells(&dims, items, field),
            Value::Structs { names, items } => {
                let path = field.path();
                self.array(items, field.place, |this, values, place| {
                    this.fields(names.iter().cloned().zip(values).collect(), &path, place);
                });
            }
            Value::Unread(why) => self.leave_out(&field.path(), reason(&why, &field.path())),
        }
    }

    /// Takes the elements of an array, which are runs if there are several. Elements of one row each are one run.
    fn array<T>(&mut self, elements: Vec<T>, around: u64, mut take: impl FnMut(&mut Self, T, u64)) {
        if elements.len() < 2 {
            for element in elements {
                take(self, element, around);
            }
            return;
        }
        let outer = std::mem::take(&mut self.grown);
        let mut places = Vec::with_capacity(elements.len());
        for (at, element) in elements.into_iter().enumerate() {
            let fresh = self.places.len() as u64 + 1;
            let place = *self.places.entry((around, at)).or_insert(fresh);
            places.push(place);
            take(self, element, place);
        }
        self.grown.sort_unstable();
        self.grown.dedup();
        for &column in &self.grown {
            let runs = &mut self.columns[column].runs;
            let first = runs.len().saturating_sub(places.len());
            let rows = &runs[first..];
            if rows.len() == places.len() && rows.iter().zip(&places).all(|(run, p)| run.place == *p && run.rows == 1) {
                runs.truncate(first);
                runs.push(Run { place: around, rows: places.len() });
            }
        }
        self.grown.extend(outer);
    }

    fn cells(&mut self, dims: &[usize], items: Vec<Value>, field: Field<'_>) {
        let cells = Value::Cells { dims: Vec::new(), items };
        let is_text = cells.texts().is_some_and(|texts| texts.iter().any(|text| !text.is_empty()));
        let texts: Option<Labels> = cells.texts().filter(|_| is_text).map(|texts| texts.into_iter().collect());
        let Value::Cells { items, .. } = cells else { return };
        let has_texts = items.iter().any(|item| matches!(item, Value::Text(_)));
        match texts {
            _ if sides(dims).is_none_or(|(_, columns)| columns > 1) => {
                self.leave_out(&field.path(), "a cell array of rows and columns".to_owned());
            }
            Some(texts) => self.append(field, Cells::Text(texts)),
            None if has_texts => self.leave_out(&field.path(), "a cell array of text and numbers".to_owned()),
            None => self.array(items, field.place, |this, value, place| this.value(value, Field { place, ..field })),
        }
    }

    fn numbers(&mut self, dims: &[usize], values: Vec<f64>, field: Field<'_>) {
        match sides(dims) {
            Some((_, 1)) => self.append(field, Cells::Numbers(values)),
            Some((_, columns)) if columns > MOST_COLUMNS => {
                self.leave_out(&field.path(), format!("more than {MOST_COLUMNS} columns"));
            }
            Some((rows, columns)) => {
                // The first side that is not one is the one that runs first.
                let is_upright = dims.iter().find(|d| **d != 1) == Some(&rows);
                let names = field.beside.names(field.name, columns);
                for column in 0..columns {
                    let (first, step) = if is_upright { (column * rows, 1) } else { (column, columns) };
                    let own = Cells::Numbers(values.iter().skip(first).step_by(step).take(rows).copied().collect());
                    let (around, name) = match names.and_then(|names| names.get(column)) {
                        Some(name) => (field.path(), name.clone()),
                        None => (field.around.to_owned(), format!("{}_{}", field.name, column + 1)),
                    };
                    let unit = field.beside.unit(field.name, &name, column);
                    self.put((&around, &name, unit), own, field.place);
                }
            }
            None => self.leave_out(&field.path(), "more than two dimensions".to_owned()),
        }
    }

    /// Takes the signals that Simulink logs beside a `time`: a matrix each, with names of their own.
    fn signals(&mut self, signals: Value, around: &str, place: u64) {
        let Value::Structs { names, items } = signals else { return };
        let mut known = BTreeSet::new();
        for (at, values) in items.into_iter().enumerate() {
            let mut fields: HashMap<&str, Value> = names.iter().map(String::as_str).zip(values).collect();
            let Some(values) = fields.remove("values") else { continue };
            let labels: Vec<String> =
                fields.get("label").and_then(Value::texts).unwrap_or_default().into_iter().map(str::to_owned).collect();
            let unnamed = format!("signals_{}", at + 1);
            let is_free = |label: &&String| !label.trim().is_empty() && !known.contains(*label);
            let name = labels.first().filter(|_| labels.len() == 1).filter(is_free).unwrap_or(&unnamed).clone();
            known.insert(name.clone());
            let mut beside = vec![(name.clone(), values)];
            if let Some(unit) = fields.remove("unit").or_else(|| fields.remove("units")) {
                beside.push(("unit".to_owned(), unit));
            }
            if labels.len() > 1 {
                let cells = labels.into_iter().map(|label| Value::Text(vec![label])).collect::<Vec<_>>();
                beside.push(("label".to_owned(), Value::Cells { dims: vec![cells.len(), 1], items: cells }));
            }
            self.fields(beside, around, place);
        }
    }

    fn append(&mut self, field: Field<'_>, cells: Cells) {
        self.put((field.around, field.name, field.beside.unit(field.name, field.name, 0)), cells, field.place);
    }

    /// Appends a run to the column of this name, which is made if it is new.
    fn put(&mut self, (around, short, unit): (&str, &str, &str), cells: Cells, place: u64) {
        let path = join(around, short);
        let run = Run { place, rows: cells.len() };
        let at = *self.index.entry(path.clone()).or_insert(self.columns.len());
        self.grown.push(at);
        let Some(column) = self.columns.get_mut(at) else {
            let (short, unit) = (short.to_owned(), unit.to_owned());
            self.columns.push(Column { path, short, unit, cells, runs: vec![run] });
            return;
        };
        column.runs.push(run);
        match (&mut column.cells, cells) {
            _ if column.unit != unit => self.leave_out(&path, "a unit that changes from run to run".to_owned()),
            (Cells::Numbers(all), Cells::Numbers(more)) => all.extend(more),
            (Cells::Text(all), Cells::Text(more)) => all.extend_from(&more, 0..more.len()),
            _ => self.leave_out(&path, "text in some runs and numbers in others".to_owned()),
        }
    }

    fn leave_out(&mut self, path: &str, why: String) {
        self.left_out.entry(why).or_default().insert(path.to_owned());
    }
}

/// True for the signals of Simulink's structure with time.
fn is_list_of_signals(value: &Value) -> bool {
    matches!(value, Value::Structs { names, .. } if names.iter().any(|name| name == "values"))
}

/// Reason for leaving out a value that is not read, with the way to convert it.
fn reason(why: &Unread, path: &str) -> String {
    let class = match why {
        Unread::Kind(kind) => return (*kind).to_owned(),
        Unread::Object(class) => class.as_str(),
    };
    let save = "save('log.mat', '-struct', 'S', '-v7')";
    let table = "S = table2struct(T, 'ToScalar', true)";
    let convert = match class {
        "table" => format!("T = {path}; {table}; {save}"),
        "timetable" => {
            format!("T = timetable2table({path}); T.(1) = seconds(T.(1) - T.(1)(1)); {table}; {save}")
        }
        "timeseries" => format!("S = struct('time', {path}.Time, 'data', {path}.Data); {save}"),
        "datetime" => format!("S.time_s = posixtime({path}); {save}"),
        "duration" => format!("S.time_s = seconds({path}); {save}"),
        "string" | "categorical" => format!("S.label = cellstr({path}); {save}"),
        _ => format!("S = struct({path}); {save}"),
    };
    format!("a {class}, an object that only MATLAB can open; convert it there: {convert}")
}
