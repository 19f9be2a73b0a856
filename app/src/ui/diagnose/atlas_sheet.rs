//! The residual atlas, ready to be drawn: what the model leaves of the force, or of each channel, as means over ranges of each suspect's variable, and
//! what that suspect alone would take of it.

use crate::text::diagnosis_words::{force_unit, title};
use crate::text::format;
use estimator::diagnose::Findings;
use estimator::diagnose::Variable;
use estimator::diagnose::atlas::{Against, Atlas, Channel, Seen};
use estimator::diagnose::{Course, Instant};
use std::f64::consts::TAU;

/// Ranges of a variable: fewest and most; rows that a mean needs, and usually has at least.
const BINS: (usize, usize) = (6, 40);
const LEAST_ROWS: usize = 4;
const USUAL_ROWS: usize = 8;
/// Rows that are trusted less are not drawn: there the sign of all friction is a guess.
const LEAST_WEIGHT: f64 = 0.5;
/// Most points of a cloud.
const MOST_POINTS: usize = 2_000;

/// Means over ranges, broken where there were none.
pub type Line = Vec<Vec<[f64; 2]>>;

/// Scale that all suspects of a channel are drawn by.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Scale {
    /// The channel in words; nothing for the force along the motion.
    pub channel: &'static str,
    /// Its shown unit.
    pub unit: &'static str,
    /// Noise of a row, in that unit.
    pub noise: f64,
    /// Largest mean that is shown, in that unit.
    pub largest: f64,
}

/// One suspect.
#[derive(Clone, Debug)]
pub struct Cell {
    /// Out of the catalogue.
    pub id: String,
    /// Scale that the suspect is drawn by.
    pub scale: Scale,
    /// In words.
    pub title: String,
    /// Evidence for the suspect alone: 2 ln(likelihood ratio) less the price of its parameters.
    pub score: f64,
    /// It was named.
    pub named: bool,
    /// Its variable in words, and the shown unit.
    pub variable: &'static str,
    /// See above.
    pub unit: &'static str,
    /// Shown range of the variable.
    pub range: (f64, f64),
    /// Mean residual, forwards and backwards; one line where the direction does not matter.
    pub left: Vec<Line>,
    /// Part of the residual that the suspect alone explains, over the same ranges.
    pub taken: Vec<Line>,
    /// Single rows, thinned.
    pub cloud: Vec<[f64; 2]>,
}

/// One recording's atlas.
#[derive(Clone, Debug, Default)]
pub struct Sheet {
    /// Channel after channel, most evidence first in each.
    pub cells: Vec<Cell>,
}

impl Sheet {
    /// The atlas of the recording of this number.
    pub fn new(diagnosis: &Findings, recording: usize) -> Self {
        let mut cells = along_the_motion(diagnosis, recording);
        cells.extend(diagnosis.atlas.channels.iter().flat_map(|channel| of_channel(diagnosis, channel, recording)));
        Self { cells }
    }

    /// True where nothing was compared.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// The shown unit, where there is one.
    pub fn unit(&self) -> &'static str {
        let mut units = self.cells.iter().map(|c| c.scale.unit);
        let first = units.next().unwrap_or_default();
        if units.all(|unit| unit == first) { first } else { "" }
    }

    /// The suspect that is called this.
    pub fn find(&self, key: &str) -> Option<&Cell> {
        self.cells.iter().find(|c| c.key() == key)
    }
}

impl Cell {
    /// Key of the suspect in the whole atlas: a cause may be a suspect in several channels.
    pub fn key(&self) -> String {
        if self.scale.channel.is_empty() {
            self.id.clone()
        } else {
            format!("{} in the {}", self.id, self.scale.channel)
        }
    }

    /// Its title and what it is seen against, in words.
    pub fn words(&self) -> String {
        let of = if self.scale.channel.is_empty() { String::new() } else { format!(" in the {}", self.scale.channel) };
        format!("{} against {}{of}", self.title, self.variable)
    }
}

fn is_named(diagnosis: &Findings, id: &str) -> bool {
    diagnosis.causes.iter().any(|c| c.id == id)
}

/// Gives all cells of a channel its scale.
fn scaled(mut cells: Vec<Cell>, channel: &'static str, unit: &'static str, noise: f64) -> Vec<Cell> {
    let means = cells.iter().flat_map(|c| c.left.iter().chain(&c.taken)).flatten().flatten();
    let most = means.map(|p| p[1].abs()).fold(0.0, f64::max);
    let scale = Scale { channel, unit, noise, largest: (1.12 * most).max(3.0 * noise).max(1e-9) };
    for cell in &mut cells {
        cell.scale = scale;
    }
    cells
}

fn along_the_motion(diagnosis: &Findings, recording: usize) -> Vec<Cell> {
    let (course, atlas) = (&diagnosis.course, &diagnosis.atlas);
    let trusted = |i: &usize| {
        let row = &course.instants[*i];
        row.recording == recording && row.weight >= LEAST_WEIGHT
    };
    let rows: Vec<usize> = (0..course.instants.len()).filter(trusted).collect();
    if rows.is_empty() {
        return Vec::new();
    }
    let cell = |seen: &Seen| cell(course, atlas, seen, &rows, is_named(diagnosis, &seen.id));
    scaled(atlas.suspects.iter().map(cell).collect(), "", force_unit(diagnosis), diagnosis.noise_floor_n)
}

/// A channel of a task without one coordinate.
fn of_channel(diagnosis: &Findings, channel: &Channel, recording: usize) -> Vec<Cell> {
    let (unit, factor) = format::channel_unit(channel.unit);
    // Short recordings are seen all together.
    let is_of = |row: usize| channel.recording.get(row).is_none_or(|of| *of == recording);
    let cell = |against: &Against| {
        let rows: Vec<usize> = (0..against.rows.len()).filter(|k| is_of(against.rows[*k])).collect();
        let (variable, si) = words_of(against.variable, channel.is_angular);
        let (shown, stretch) = format::channel_unit(si);
        let x: Vec<f64> = rows.iter().map(|k| stretch * against.over[*k]).collect();
        let range = range(&x);
        let left = |k: usize| factor * channel.left[against.rows[k]];
        let both = [1.0, -1.0];
        let seen_both_ways = matches!(against.variable, Variable::Place | Variable::Depth) && !channel.way.is_empty();
        let ways: &[f64] = if seen_both_ways { &both } else { &[0.0] };
        let line = |y: &dyn Fn(usize) -> f64| -> Vec<Line> {
            let along = |way: &f64| {
                let goes = |k: usize| *way == 0.0 || channel.way[against.rows[k]] * way > 0.0;
                let points = rows.iter().zip(&x).filter(|(k, _)| goes(**k)).map(|(k, x)| ([*x, y(*k)], 1.0));
                means(points, range)
            };
            ways.iter().map(along).collect()
        };
        let step = rows.len().div_ceil(MOST_POINTS).max(1);
        Cell {
            id: against.id.clone(),
            scale: Scale::default(),
            title: title(&against.id),
            score: against.score,
            named: is_named(diagnosis, &against.id),
            variable,
            unit: shown,
            range,
            left: line(&left),
            taken: line(&|k| factor * against.taken[k]),
            cloud: rows.iter().zip(&x).step_by(step).map(|(k, x)| [*x, left(*k)]).collect(),
        }
    };
    let cells: Vec<Cell> = channel.suspects.iter().map(cell).filter(|cell| !cell.cloud.is_empty()).collect();
    scaled(cells, channel.name, unit, factor * channel.noise)
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
        let along = |way: &fn(&Instant) -> bool| {
            let rows = rows.iter().zip(&x).filter(|(i, _)| way(&course.instants[**i]));
            means(rows.map(|(i, x)| ([*x, y(*i)], course.instants[*i].weight.powi(2))), range)
        };
        ways.iter().map(along).collect()
    };
    let step = rows.len().div_ceil(MOST_POINTS).max(1);
    let point = |(i, x): (&usize, &f64)| [*x, course.instants[*i].left_before];
    Cell {
        id: seen.id.clone(),
        scale: Scale::default(),
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
        Variable::Velocity if angular => ("angular velocity", "rad_s"),
        Variable::Acceleration if angular => ("angular acceleration", "rad/s²"),
        Variable::Force if angular => ("measured torque", "Nm"),
        Variable::ForceRate if angular => ("change of the torque", "N·m/s"),
        other => words_of(other, angular),
    }
}

/// The same of channels of tasks without one coordinate.
fn words_of(variable: Variable, is_angular: bool) -> (&'static str, &'static str) {
    match variable {
        Variable::Place if is_angular => ("angle", "rad"),
        Variable::Velocity if is_angular => ("angular velocity", "rad_s"),
        Variable::Load if is_angular => ("load", "Nm"),
        Variable::Load => ("load", "N"),
        Variable::Depth => ("depth in the sheet", "m"),
        Variable::Place => ("position", "m"),
        Variable::Velocity => ("velocity", "m_s"),
        Variable::Acceleration => ("acceleration", "m_s2"),
        Variable::Across => ("force across", "N"),
        Variable::Force => ("measured force", "N"),
        Variable::ForceRate => ("change of the force", "N/s"),
        Variable::Time => ("time", "s"),
        Variable::Grip => ("grip force", "N"),
        Variable::Lift => ("lift", "N"),
        Variable::Width => ("distance of the tips", "m"),
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
        // Nothing is gripped along one coordinate.
        Variable::Grip | Variable::Lift | Variable::Width | Variable::Depth | Variable::Load => 0.0,
    }
}

/// Means over even ranges of x, each point as far as it is trusted (second entry).
fn means(points: impl Iterator<Item = ([f64; 2], f64)>, (low, high): (f64, f64)) -> Line {
    let points: Vec<([f64; 2], f64)> = points.collect();
    let count = (points.len() / USUAL_ROWS).clamp(BINS.0, BINS.1);
    let mut bins = vec![([0.0; 3], 0_usize); count];
    for ([x, y], weight) in points {
        let place = ((x - low) / (high - low) * count as f64).clamp(0.0, count as f64 - 1.0) as usize;
        let (sums, count) = &mut bins[place];
        for (sum, value) in sums.iter_mut().zip([weight * x, weight * y, weight]) {
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

/// Range that holds nearly all values; never empty. A few outliers would compress the others.
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
