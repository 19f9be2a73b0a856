//! Readings of an object that is carried, and rates with their errors.

use serde::{Deserialize, Serialize};

/// Times, s, and forces, N, one each a sample, in the order of time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Series<'a> {
    /// Times, s.
    pub time_s: &'a [f64],
    /// Forces, N.
    pub force_n: &'a [f64],
}

/// Readings of one object, and of no object. Biases stay in: their change is the question.
#[derive(Clone, Copy, Debug, Default)]
pub struct Weighing<'a> {
    /// Sum of the vertical forces of both fingers while the object is in the air (one carry or several), inertia taken out.
    pub carried: Series<'a>,
    /// The same sum in free motion, before and after. May be empty.
    pub free: Series<'a>,
    /// The same sum while other objects were carried, one series an object; each has a weight of its own that does not change.
    pub others: &'a [Series<'a>],
    /// Sum of the horizontal forces at the samples of `carried`, inertia taken out. May be absent.
    pub across_n: Option<&'a [f64]>,
    /// The vertical force of each finger at the samples of `carried`. May be absent.
    pub fingers_n: Option<[&'a [f64]; 2]>,
    /// Gravity, m/s², positive.
    pub gravity_m_s2: f64,
}

impl<'a> Weighing<'a> {
    /// The least that is needed: the carried reading and the free ones, times in s, forces in N, gravity in m/s².
    pub fn new(carried: Series<'a>, free: Series<'a>, gravity_m_s2: f64) -> Self {
        Self { carried, free, gravity_m_s2, ..Self::default() }
    }
}

/// A value and its standard error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// The value.
    pub value: f64,
    /// One standard error.
    pub std_error: f64,
}

impl Measured {
    /// True when it is this many standard errors from zero.
    pub fn is_significant(&self, errors: f64) -> bool {
        self.value.abs() > errors * self.std_error
    }
}
