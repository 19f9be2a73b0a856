//! Values of variables, as a MATLAB file holds them.

use std::rc::Rc;

/// Value of a variable, of a field or of a cell.
#[derive(Debug)]
pub enum Value {
    /// Real numbers of any class, one dimension after the other: columns first.
    Numbers { dims: Vec<usize>, values: Vec<f64> },
    /// Rows of a character array, without the blanks at their ends.
    Text(Vec<String>),
    /// Values of any kind, columns first.
    Cells { dims: Vec<usize>, items: Vec<Value> },
    /// Elements of an array of structures: each has one value a name.
    Structs { names: Rc<[String]>, items: Vec<Vec<Value>> },
    /// Content that is not read, and the reason.
    Unread(Unread),
}

/// Reason why a value is not read.
#[derive(Clone, Debug, PartialEq)]
pub enum Unread {
    /// A kind of value, in words.
    Kind(&'static str),
    /// An object of this class.
    Object(String),
}

impl Value {
    /// The value of nothing: `[]`.
    pub fn empty() -> Self {
        Self::Numbers { dims: vec![0, 0], values: Vec::new() }
    }

    /// Text in a list: rows of characters, or cells with one text each.
    pub fn texts(&self) -> Option<Vec<&str>> {
        match self {
            Self::Text(rows) => Some(rows.iter().map(String::as_str).collect()),
            Self::Cells { items, .. } => items.iter().map(Self::one_text).collect(),
            _ => None,
        }
    }

    /// A single text; the empty array stands for an empty one.
    fn one_text(&self) -> Option<&str> {
        match self {
            Self::Text(rows) if rows.len() == 1 => rows.first().map(String::as_str),
            Self::Numbers { values, .. } if values.is_empty() => Some(""),
            _ => None,
        }
    }

    /// Number of columns of a matrix, or of the matrices in cells; none for other values.
    pub fn columns(&self) -> Option<usize> {
        match self {
            Self::Numbers { dims, .. } => sides(dims).map(|(_, columns)| columns),
            Self::Cells { items, .. } => items.first().and_then(Self::columns),
            _ => None,
        }
    }
}

/// Number of samples and of columns of an array: samples run along the longer side. None for more than two dimensions
/// that are not one.
pub fn sides(dims: &[usize]) -> Option<(usize, usize)> {
    let wide: Vec<usize> = dims.iter().copied().filter(|d| *d != 1).collect();
    match *wide.as_slice() {
        [] => Some((1, 1)),
        [samples] => Some((samples, 1)),
        [a, b] => Some((a.max(b), a.min(b))),
        _ => None,
    }
}
