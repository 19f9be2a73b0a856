//! The residual atlas, ready to be drawn: what the model leaves of the force as means over ranges of each suspect's variable, and
//! what that suspect alone would take of it.

use super::format;
use crate::diagnosis_words::{force_unit, title};
use estimator::diagnose::Diagnosis;
use estimator::diagnose::atlas::{Atlas, Seen, Variable};
use estimator::diagnose::course::{Course, Instant};
use std::f64::consts::TAU;

/// Ranges of a variable, and rows that a mean needs.
const BINS: usize = 40;
const LEAST_ROWS: usize = 4;
/// Rows that are trusted less are not drawn: there the sign of all friction is a guess.
const LEAST_WEIGHT: f64 = 0.5;
/// Most points of a cloud.
const MOST_POINTS: usize = 2_000;

/// Means over ranges, broken where there were none.
pub type Line = Vec<Vec<[f64; 2]>>;

/// One suspect.
#[derive(Clone, Debug)]
pub struct Cell {
    /// Out of the catalogue.
    pub id: String,
    /// In words.
    pub title: String,
    /// What it explains alone, in units of 2 ln(likelihood), parameters paid.
    pub score: f64,
    /// It was named.
    pub named: bool,
    /// Its variable in words, and the shown unit.
    pub variable: &'static str,
    /// See above.
    pub unit: &'static str,
    /// Shown range of the variable.
    pub range: (f64, f64),
    /// What is left, forwards and backwards; one line where the direction does not matter.
    pub left: Vec<Line>,
    /// What the suspect alone takes of it, over the same ranges.
    pub taken: Vec<Line>,
    /// Single rows, thinned.
    pub cloud: Vec<[f64; 2]>,
}

/// One recording's atlas.
#[derive(Clone, Debug, Default)]
pub struct Sheet {
    /// Shown unit of the force.
    pub unit: &'static str,
    /// Noise of a row, N or N m.
    pub noise: f64,
    /// Largest mean that is shown, N or N m.
    pub largest: f64,
    /// Most evidence first.
    pub cells: Vec<Cell>,
}

impl Sheet {
    /// The atlas of the recording of this number.
    pub fn new(diagnosis: &Diagnosis, recording: usize) -> Self {
        let (course, atlas) = (&diagnosis.course, &diagnosis.atlas);
        let trusted = |i: &usize| {
            let row = &course.instants[*i];
            row.recording == recording && row.weight >= LEAST_WEIGHT
        };
        let rows: Vec<usize> = (0..course.instants.len()).filter(trusted).collect();
        if rows.is_empty() {
            return Self::default();
        }
        let named = |id: &str| diagnosis.causes.iter().any(|c| c.id == id);
        let cells: Vec<Cell> =
            atlas.suspects.iter().map(|seen| cell(course, atlas, seen, &rows, named(&seen.id))).collect();
        let means = cells.iter().flat_map(|c| c.left.iter().chain(&c.taken)).flatten().flatten();
        let most = means.map(|p| p[1].abs()).fold(0.0, f64::max);
        let noise = diagnosis.noise_floor_n;
        Self { unit: force_unit(diagnosis), noise, largest: (1.12 * most).max(3.0 * noise).max(1e-9), cells }
    }
}

fn cell(course: &Course, atlas: &Atlas, seen: &Seen, rows: &[usize], named: bool) -> Cell {
    let (variable, si) = words(seen.variable, course, rows);
    let (unit, factor) = format::channel_unit(si);
    let turn = (variable == WRAPPED).then_some(TAU);
    let x: Vec<f64> = rows
        .iter()
        .map(|i| {
            let value = value(seen.variable, course, atlas, *i);
            factor * turn.map_or(value, |turn| value.rem_euclid(turn))
        })
        .collect();
    let range = range(&x);
    // Against the place both directions of motion have a mean of their own: friction has the other sign.
    let ways: &[fn(&Instant) -> bool] =
        if seen.variable == Variable::Place { &[|i| i.velocity > 0.0, |i| i.velocity < 0.0] } else { &[|_| true] };
    let lines = |y: &dyn Fn(usize) -> f64| -> Vec<Line> {
        ways.iter().map(|way| means(course, rows, &x, range, y, *way)).collect()
    };
    let step = rows.len().div_ceil(MOST_POINTS).max(1);
    let point = |(i, x): (&usize, &f64)| [*x, course.instants[*i].left_before];
    Cell {
        id: seen.id.clone(),
        title: title(&seen.id),
        score: seen.score,
        named,
        variable,
        unit,
        range,
        left: lines(&|i| course.instants[i].left_before),
        taken: lines(&|i| seen.taken.get(i).copied().unwrap_or(0.0)),
        cloud: rows.iter().zip(&x).step_by(step).map(point).collect(),
    }
}

const WRAPPED: &str = "angle within a turn";

/// A variable in words, and its SI unit as columns of logs have it.
fn words(variable: Variable, course: &Course, rows: &[usize]) -> (&'static str, &'static str) {
    let angular = course.is_angular;
    match variable {
        Variable::Place if course.turns => {
            let angles: Vec<f64> = rows.iter().map(|i| course.instants[*i].angle_rad).collect();
            let (low, high) = range(&angles);
            (if high - low > 1.2 * TAU { WRAPPED } else { "angle" }, "rad")
        }
        Variable::Place => ("position", "m"),
        Variable::Velocity if angular => ("angular velocity", "rad_s"),
        Variable::Velocity => ("velocity", "m_s"),
        Variable::Acceleration if angular => ("angular acceleration", "rad/s²"),
        Variable::Acceleration => ("acceleration", "m_s2"),
        Variable::Across => ("force across", "N"),
        Variable::Force if angular => ("measured torque", "Nm"),
        Variable::Force => ("measured force", "N"),
        Variable::ForceRate if angular => ("change of the torque", "N·m/s"),
        Variable::ForceRate => ("change of the force", "N/s"),
        Variable::Time => ("time", "s"),
    }
}

fn value(variable: Variable, course: &Course, atlas: &Atlas, i: usize) -> f64 {
    let instant = &course.instants[i];
    match variable {
        Variable::Place if course.turns => instant.angle_rad,
        Variable::Place => instant.position,
        Variable::Velocity => instant.velocity,
        Variable::Acceleration => atlas.acceleration.get(i).copied().unwrap_or(0.0),
        Variable::Across => instant.normal_force_n,
        Variable::Force => instant.measured,
        Variable::ForceRate => atlas.force_rate.get(i).copied().unwrap_or(0.0),
        Variable::Time => instant.time_s,
    }
}

/// Means over even ranges of x, each row as far as it is trusted.
fn means(
    course: &Course,
    rows: &[usize],
    x: &[f64],
    (low, high): (f64, f64),
    y: &dyn Fn(usize) -> f64,
    way: fn(&Instant) -> bool,
) -> Line {
    let mut bins = [([0.0; 3], 0_usize); BINS];
    for (i, x) in rows.iter().zip(x).filter(|(i, _)| way(&course.instants[**i])) {
        let place = ((x - low) / (high - low) * BINS as f64).clamp(0.0, BINS as f64 - 1.0) as usize;
        let weight = course.instants[*i].weight.powi(2);
        let (sums, count) = &mut bins[place];
        for (sum, value) in sums.iter_mut().zip([weight * x, weight * y(*i), weight]) {
            *sum += value;
        }
        *count += 1;
    }
    let mean = |([x, y, weight], count): &([f64; 3], usize)| {
        (*count >= LEAST_ROWS && *weight > 1e-9).then(|| [x / weight, y / weight])
    };
    let means: Vec<Option<[f64; 2]>> = bins.iter().map(mean).collect();
    let parts = means.split(Option::is_none).filter(|part| part.len() > 1);
    parts.map(|part| part.iter().flatten().copied().collect()).collect()
}

/// Where nearly all values are; never empty. A few that are far out would press the others together.
fn range(values: &[f64]) -> (f64, f64) {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let at = |share: f64| sorted.get(((sorted.len().saturating_sub(1)) as f64 * share) as usize).copied();
    match (at(0.003), at(0.997)) {
        (Some(low), Some(high)) if high > low => (low, high),
        (Some(middle), _) => (middle - 0.5, middle + 0.5),
        _ => (-0.5, 0.5),
    }
}
