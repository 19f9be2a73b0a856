//! Reports of the estimator: the changes that were noticed, and all that is known at one instant.

use super::block::pull::Pull;
use super::information::Enough;
use super::leak::LeakAnswer;
use crate::estimate::Parameter;
use serde::Serialize;

/// A change that was noticed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Event {
    /// Which object, from 0.
    pub object: usize,
    /// Name of the parameter.
    pub parameter: &'static str,
    /// Whether it grew.
    pub grows: bool,
    /// When it was noticed, s.
    pub noticed_s: f64,
    /// When it began, s.
    pub began_s: f64,
    /// Value before, in the parameter's unit.
    pub before: f64,
}

/// What is known now.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// Time of the newest state, s.
    pub time_s: f64,
    /// The state, by its name.
    pub state: &'static str,
    /// Parameters of all objects, as a fit reports them.
    pub parameters: Vec<Parameter>,
    /// What is still missing for them.
    pub enough: Vec<Enough>,
    /// Changes, oldest first.
    pub events: Vec<Event>,
    /// Object and answer, where a weight changes.
    pub leaks: Vec<(String, LeakAnswer)>,
    /// Share of the largest shear that surely held which is free now; below zero it may slip. Absent while nothing is held.
    pub slip_margin: Option<f64>,
    /// What is held now.
    pub held: Option<String>,
    /// What else holds an object.
    pub pulls: Vec<Pull>,
}
