//! Names and units of columns that stand in variables or fields of their own, beside the numbers.

use super::value::Value;
use crate::written_units::{Written, parse};

/// Words that a list of names has in its own name: `colheaders`, `labels`, `varnames`.
const WORDS: [&str; 7] = ["name", "label", "column", "header", "channel", "signal", "variable"];

/// Names and units among the variables of a file, or the fields of a structure.
#[derive(Debug, Default)]
pub struct Beside {
    /// Name of a matrix, and the names of its columns.
    names: Vec<(String, Vec<String>)>,
    /// Name of a matrix, a vector or a column, and the texts of the units: one, or one a column.
    units: Vec<(String, Vec<String>)>,
    /// List of units that could belong to any columns, with the reason for which it is not used.
    pub unclear: Option<(String, String)>,
    /// Variables or fields that have been understood.
    pub used: Vec<String>,
}

impl Beside {
    /// Looks at all values that stand beside each other.
    pub fn of(fields: &[(String, Value)]) -> Self {
        let mut beside = Self::default();
        let numbers: Vec<(&str, usize)> =
            fields.iter().filter_map(|(name, value)| Some((name.as_str(), value.columns()?))).collect();
        for (name, value) in fields.iter().filter(|(name, _)| is_unit(name)) {
            beside.take_units(name, value, fields, &numbers);
        }
        let lists: Vec<(&str, Vec<&str>)> = fields
            .iter()
            .filter(|(name, _)| !is_unit(name))
            .filter_map(|(n, v)| Some((n.as_str(), v.texts()?)))
            .collect();
        for &(matrix, columns) in numbers.iter().filter(|(_, columns)| *columns > 1) {
            let fitting = lists.iter().filter(|(_, texts)| texts.len() == columns && are_names(texts));
            let mut best: Vec<_> = fitting.map(|(list, texts)| (likeness(list, matrix), *list, texts)).collect();
            best.sort_by_key(|(likeness, ..)| std::cmp::Reverse(*likeness));
            // Two lists that are equally good are none.
            let clear = best.len() < 2 || best[0].0 > best[1].0;
            if let Some((_, list, texts)) = best.first().filter(|_| clear) {
                beside.names.push((matrix.to_owned(), texts.iter().map(|text| (*text).to_owned()).collect()));
                beside.used.push((*list).to_owned());
            }
        }
        beside
    }

    fn take_units(&mut self, name: &str, value: &Value, fields: &[(String, Value)], numbers: &[(&str, usize)]) {
        let before = self.units.len();
        let owned = |texts: Vec<&str>| texts.into_iter().map(str::to_owned).collect::<Vec<String>>();
        if let Value::Structs { names, items } = value
            && let [one] = items.as_slice()
        {
            let named = names.iter().zip(one).filter_map(|(name, unit)| Some((name.clone(), owned(unit.texts()?))));
            self.units.extend(named);
        } else if let Some(texts) = value.texts() {
            let is_one = |(name, _): &&(&str, usize)| fields.iter().any(|(n, v)| n == name && is_series(v));
            let series: Vec<_> = numbers.iter().filter(is_one).collect();
            let fits =
                |(_, columns): &&&(&str, usize)| *columns == texts.len() || texts.len() == 1 && series.len() == 1;
            self.units.extend(series.iter().filter(fits).map(|(n, _)| ((*n).to_owned(), owned(texts.clone()))));
            // One unit beside several vectors could be that of any.
            if texts.len() == 1 && series.len() > 1 {
                self.units.truncate(before);
            }
        }
        if self.units.len() > before {
            self.used.push(name.to_owned());
        } else if let Some(texts) = value.texts().filter(|texts| texts.iter().all(|unit| is_known(unit))) {
            let why = format!(
                "it states {} and not for which columns; state factors to SI units with \"scale\" in the sidecar",
                texts.join(", ")
            );
            self.unclear = Some((name.to_owned(), why));
            self.used.push(name.to_owned());
        }
    }

    /// Names of the `columns` columns of a matrix.
    pub fn names(&self, matrix: &str, columns: usize) -> Option<&[String]> {
        let found = self.names.iter().find(|(name, names)| name == matrix && names.len() == columns);
        found.map(|(_, names)| names.as_slice())
    }

    /// Text of the unit of a column, by its own name or by its place in `matrix`; empty if there is none.
    pub fn unit(&self, matrix: &str, column: &str, place: usize) -> &str {
        let of = |wanted: &str| self.units.iter().find(|(name, _)| name == wanted).map(|(_, units)| units);
        let own = of(column).filter(|units| units.len() == 1 && column != matrix);
        let units = own.or_else(|| of(matrix)).map_or(&[][..], Vec::as_slice);
        let text = if let [one] = units { Some(one) } else { units.get(place) };
        text.map_or("", String::as_str)
    }
}

fn is_unit(name: &str) -> bool {
    name.eq_ignore_ascii_case("units") || name.eq_ignore_ascii_case("unit")
}

fn is_known(unit: &str) -> bool {
    matches!(parse(unit, &[]), Written::Known(..))
}

/// True for more than one number.
fn is_series(value: &Value) -> bool {
    match value {
        Value::Numbers { values, .. } => values.len() > 1,
        Value::Cells { items, .. } => items.iter().any(is_series),
        _ => false,
    }
}

fn are_names(texts: &[&str]) -> bool {
    let mut sorted = texts.to_vec();
    sorted.sort_unstable();
    sorted.iter().all(|text| !text.trim().is_empty()) && sorted.windows(2).all(|two| two[0] != two[1])
}

/// Likeness of a list of texts to the names of the columns of `matrix`.
fn likeness(list: &str, matrix: &str) -> usize {
    let list = list.to_lowercase();
    let is_its_own = list.starts_with(&matrix.to_lowercase());
    2 * usize::from(is_its_own) + usize::from(WORDS.iter().any(|word| list.contains(word)))
}
