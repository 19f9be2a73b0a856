//! Reports of the estimator: the changes that were noticed, and all that is known at one instant.

use super::block::pull::Pull;
use super::information::Enough;
use super::leak::LeakAnswer;
use foundation::estimate::Parameter;
use serde::Serialize;

/// A change that was noticed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Event {
    /// Index of the object, from 0.
    pub object: usize,
    /// Name of the parameter.
    pub parameter: &'static str,
    /// True if it grew.
    pub grows: bool,
    /// Time of detection, s.
    pub noticed_s: f64,
    /// When it began, s.
    pub began_s: f64,
    /// Value before, in the parameter's unit.
    pub before: f64,
}

/// Present estimates.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// Time of the newest state, s.
    pub time_s: f64,
    /// The state, by its name.
    pub state: &'static str,
    /// Parameters of all objects, as a fit reports them.
    pub parameters: Vec<Parameter>,
    /// Information still missing for them.
    pub enough: Vec<Enough>,
    /// Changes, oldest first.
    pub events: Vec<Event>,
    /// Object and answer, where a weight changes.
    pub leaks: Vec<(String, LeakAnswer)>,
    /// Share of the largest shear that surely held which is free now; below zero it may slip. Absent while nothing is held.
    pub slip_margin: Option<f64>,
    /// Name of the held object.
    pub held: Option<String>,
    /// Pulls of other things on an object.
    pub pulls: Vec<Pull>,
}
