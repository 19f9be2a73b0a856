//! What a cause would leave in the residual.

use haptics::law::Kind;

/// A value that was searched for, not solved for.
#[derive(Clone, Debug, PartialEq)]
pub struct Searched {
    pub name: &'static str,
    pub value: f64,
    pub unit: &'static str,
}

/// One cause with its searched values set: columns that are linear in what is left.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// Out of `spec/causes.md`; terms of the base and of the generic library have names of their own.
    pub id: &'static str,
    pub kind: Kind,
    /// One column a linear parameter, one entry a row.
    pub columns: Vec<Vec<f64>>,
    /// Name and unit of the linear parameters.
    pub linear: Vec<(&'static str, &'static str)>,
    pub searched: Vec<Searched>,
    /// Parameters that count in the evidence: linear and searched ones.
    pub cost: f64,
    /// The sign that its first parameter must have, or 0.
    pub sign: f64,
    /// Side of a one-sided law: +1, −1, or 0 where there is none.
    pub side: f64,
    /// Of a generic term that is no cause: its expression.
    pub expression: Option<String>,
}

impl Candidate {
    /// A cause with one linear parameter.
    pub fn one(id: &'static str, kind: Kind, name: &'static str, unit: &'static str, column: Vec<f64>) -> Self {
        Self {
            id,
            kind,
            columns: vec![column],
            linear: vec![(name, unit)],
            searched: Vec::new(),
            cost: 1.0,
            sign: 0.0,
            side: 0.0,
            expression: None,
        }
    }

    /// A cause with several linear parameters.
    pub fn several(
        id: &'static str,
        kind: Kind,
        columns: Vec<Vec<f64>>,
        linear: Vec<(&'static str, &'static str)>,
    ) -> Self {
        let cost = columns.len() as f64;
        Self { id, kind, columns, linear, searched: Vec::new(), cost, sign: 0.0, side: 0.0, expression: None }
    }

    /// With one more value that was searched for.
    pub fn at(mut self, name: &'static str, value: f64, unit: &'static str) -> Self {
        self.searched.push(Searched { name, value, unit });
        self.cost += 1.0;
        self
    }

    /// Whose first parameter is positive.
    pub fn positive(mut self) -> Self {
        self.sign = 1.0;
        self
    }
}
