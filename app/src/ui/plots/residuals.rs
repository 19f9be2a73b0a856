//! Curves of a diagnosis: measured and modelled force over time, and the residual against each candidate variable.

use crate::text::format;
use egui_plot::PlotPoint;
use estimator::diagnose::Findings;
use estimator::diagnose::{Course, Instant};
use estimator::log::gap_above_s;
use std::f64::consts::TAU;

/// Maximum number of points of a curve, and of a cloud.
const MOST_POINTS: usize = 3_000;
/// Maximum time between neighbours of a curve, s.
const GAP_S: f64 = 0.05;
/// Number of bins of a trend, and minimum number of rows per bin.
const BINS: usize = 60;
const LEAST_ROWS: usize = 4;
/// Share of the residuals that the axis covers.
const SHOWN_SHARE: f64 = 0.995;
/// Minimum weight of a drawn row: below it the direction of motion is uncertain, and with it the sign of all friction.
const LEAST_WEIGHT: f64 = 0.5;

/// Variable on which the residual may depend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Suspect {
    /// Position along the motion.
    Position,
    /// Its rate.
    Velocity,
    /// Normal force, perpendicular to the motion.
    NormalForce,
    /// Time.
    Time,
}

/// Line of binned means, interrupted at empty bins.
pub type Trend = Vec<Vec<PlotPoint>>;

/// Residual against one variable.
#[derive(Clone, Debug)]
pub struct Cloud {
    /// Variable of the horizontal axis.
    pub suspect: Suspect,
    /// Name of the variable for the user.
    pub title: &'static str,
    /// Unit of the shown variable.
    pub unit: &'static str,
    /// Residual of the base model, thinned.
    pub before: Vec<PlotPoint>,
    /// Binned means of that residual over the variable, forwards and backwards.
    pub trend_before: [Trend; 2],
    /// Binned means of the extended model's residual, forwards and backwards.
    pub trend_after: [Trend; 2],
    /// Shown range of the variable.
    pub range: (f64, f64),
}

/// Curves of one recording.
#[derive(Clone, Debug)]
pub struct Residuals {
    /// Shown unit of the force.
    pub unit: &'static str,
    /// True if the force was computed from the free motion instead of measured by a sensor.
    pub is_free: bool,
    /// Measured force, in segments without a gap.
    pub measured: Vec<Vec<PlotPoint>>,
    /// Force of the base model.
    pub modelled: Vec<Vec<PlotPoint>>,
    /// Force of the extended model.
    pub extended: Vec<Vec<PlotPoint>>,
    /// Shown range of time, s.
    pub span_s: (f64, f64),
    /// Shown range of the force.
    pub force: (f64, f64),
    /// Magnitude of the largest shown residual, N or N m.
    pub largest: f64,
    /// Noise of one row (1 σ), N or N m.
    pub noise: f64,
    /// Residual against each measured variable.
    pub clouds: Vec<Cloud>,
}

impl Residuals {
    /// Curves of the recording with this index.
    pub fn new(diagnosis: &Findings, recording: usize) -> Self {
        let course = &diagnosis.course;
        let rows: Vec<&Instant> = course.instants.iter().filter(|i| i.recording == recording).collect();
        let sure: Vec<&Instant> = rows.iter().copied().filter(|i| i.weight >= LEAST_WEIGHT).collect();
        let times: Vec<f64> = rows.iter().map(|i| i.time_s).collect();
        let gap_s = gap_above_s(&times).unwrap_or(f64::INFINITY);
        let curve = |rows: &[&Instant], far_s: f64, of: &dyn Fn(&Instant) -> f64| {
            // Rows were skipped, so neighbours may be far apart, and gaps cannot be detected otherwise.
            rows.chunk_by(|a, b| b.follows && b.time_s - a.time_s <= far_s)
                .map(|stretch| thin(&stretch.iter().map(|i| [i.time_s, of(i)].into()).collect::<Vec<_>>(), rows.len()))
                .collect::<Vec<_>>()
        };
        let noise = diagnosis.noise_floor_n;
        let force = range(rows.iter().map(|i| i.measured), 0.06);
        let mut sizes: Vec<f64> = sure.iter().map(|i| i.left_before.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        let at = ((sizes.len().saturating_sub(1)) as f64 * SHOWN_SHARE) as usize;
        let largest = sizes.get(at).copied().unwrap_or(0.0).max(3.0 * noise).max(1e-9);
        let mut variables = vec![Suspect::Position, Suspect::Velocity];
        if course.has_normal_force {
            variables.push(Suspect::NormalForce);
        }
        variables.push(Suspect::Time);
        Self {
            unit: course.force_unit(),
            is_free: course.is_free(),
            measured: curve(&rows, gap_s, &|i| i.measured),
            modelled: curve(&sure, GAP_S, &Instant::simulated_before),
            extended: curve(&sure, GAP_S, &Instant::simulated_after),
            span_s: range(rows.iter().map(|i| i.time_s), 0.0),
            force,
            largest: 1.1 * largest,
            noise,
            clouds: variables.into_iter().map(|suspect| Cloud::new(suspect, course, &sure)).collect(),
        }
    }

    /// True when there is nothing to draw.
    pub fn is_empty(&self) -> bool {
        self.measured.iter().all(Vec::is_empty)
    }
}

impl Cloud {
    fn new(suspect: Suspect, course: &Course, rows: &[&Instant]) -> Self {
        let (title, si) = match suspect {
            Suspect::Position if wraps(course, rows) => ("Angle within a turn", "rad"),
            Suspect::Position if course.turns => ("Angle", "rad"),
            Suspect::Position => ("Position", "m"),
            Suspect::Velocity if course.is_angular => ("Angular velocity", "rad/s"),
            Suspect::Velocity => ("Velocity", "m/s"),
            Suspect::NormalForce => ("Normal force", "N"),
            Suspect::Time => ("Time", "s"),
        };
        let (unit, factor) = format::channel_unit(si);
        let wraps = suspect == Suspect::Position && wraps(course, rows);
        let of = |i: &Instant| {
            let value = value(suspect, course, i);
            factor * if wraps { value.rem_euclid(TAU) } else { value }
        };
        let x: Vec<f64> = rows.iter().map(|i| of(i)).collect();
        let step = rows.len().div_ceil(MOST_POINTS).max(1);
        let before =
            rows.iter().zip(&x).step_by(step).map(|(i, x)| PlotPoint::new(*x, i.left_before)).collect::<Vec<_>>();
        let range = range(x.iter().copied(), 0.02);
        let trends = |of: fn(&Instant) -> f64| {
            // Against velocity each direction already has its own half; against time they alternate.
            match suspect {
                Suspect::Velocity => [trend(rows, &x, range, of, |_| true), Trend::new()],
                _ => {
                    [trend(rows, &x, range, of, |i| i.velocity > 0.0), trend(rows, &x, range, of, |i| i.velocity < 0.0)]
                }
            }
        };
        Self {
            suspect,
            title,
            unit,
            before,
            trend_before: trends(|i| i.left_before),
            trend_after: trends(|i| i.left_after),
            range,
        }
    }
}

/// True if the motion covers more than one turn: the positions of all turns are superimposed.
fn wraps(course: &Course, rows: &[&Instant]) -> bool {
    let (low, high) = range(rows.iter().map(|i| i.angle_rad), 0.0);
    course.turns && high - low > 1.2 * TAU
}

fn value(suspect: Suspect, course: &Course, instant: &Instant) -> f64 {
    match suspect {
        Suspect::Position if course.turns => instant.angle_rad,
        Suspect::Position => instant.position,
        Suspect::Velocity => instant.velocity,
        Suspect::NormalForce => instant.normal_force_n,
        Suspect::Time => instant.time_s,
    }
}

/// Means over equal bins of x, weighted by the trust in each row; bins with few rows are omitted.
fn trend(
    rows: &[&Instant],
    x: &[f64],
    (low, high): (f64, f64),
    of: fn(&Instant) -> f64,
    keep: impl Fn(&Instant) -> bool,
) -> Trend {
    let mut bins = vec![(0.0, 0.0, 0.0, 0_usize); BINS];
    for (instant, x) in rows.iter().zip(x).filter(|(i, _)| keep(i)) {
        let place = ((x - low) / (high - low) * BINS as f64).clamp(0.0, BINS as f64 - 1.0) as usize;
        let weight = instant.weight * instant.weight;
        let (sum, sum_x, weights, count) = &mut bins[place];
        *sum += weight * of(instant);
        *sum_x += weight * x;
        *weights += weight;
        *count += 1;
    }
    let mean = |(sum, sum_x, weights, count): &(f64, f64, f64, usize)| {
        (*count >= LEAST_ROWS && *weights > 1e-6).then(|| PlotPoint::new(sum_x / weights, sum / weights))
    };
    let means: Vec<Option<PlotPoint>> = bins.iter().map(mean).collect();
    let parts = means.split(Option::is_none).filter(|part| part.len() > 1);
    parts.map(|part| part.iter().flatten().copied().collect()).collect()
}

/// Lowest and highest value with a margin at both ends; never empty.
fn range(values: impl Iterator<Item = f64>, room: f64) -> (f64, f64) {
    let (low, high) =
        values.filter(|v| v.is_finite()).fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(v), high.max(v)));
    if low >= high {
        let middle = if low > high { 0.0 } else { low };
        return (middle - 0.5, middle + 0.5);
    }
    let room = room * (high - low);
    (low - room, high + room)
}

/// Thins points to their extremes in equal groups, in order, so that all curves together have at most [`MOST_POINTS`].
fn thin(points: &[PlotPoint], all: usize) -> Vec<PlotPoint> {
    let bucket = 2 * all.div_ceil(MOST_POINTS);
    if bucket <= 2 {
        return points.to_vec();
    }
    let mut thinned = Vec::with_capacity(2 * points.len() / bucket + 2);
    for part in points.chunks(bucket) {
        let by_y = |a: &&PlotPoint, b: &&PlotPoint| a.y.total_cmp(&b.y);
        let (Some(low), Some(high)) = (part.iter().min_by(by_y), part.iter().max_by(by_y)) else { continue };
        let (first, second) = if low.x <= high.x { (low, high) } else { (high, low) };
        thinned.push(*first);
        if second.x > first.x {
            thinned.push(*second);
        }
    }
    thinned
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_the_extremes_and_the_order() {
        let points: Vec<PlotPoint> = (0..30_000)
            .map(|i| PlotPoint::new(f64::from(i), if i == 17_001 { 9.0 } else { (f64::from(i) * 0.01).sin() }))
            .collect();
        let thinned = thin(&points, points.len());
        assert!(thinned.len() <= MOST_POINTS + 2 && thinned.iter().any(|p| p.y == 9.0), "{}", thinned.len());
        assert!(thinned.windows(2).all(|w| w[1].x > w[0].x));
        assert_eq!(thin(&points[..100], 100).len(), 100);
    }

    #[test]
    fn a_range_is_never_empty() {
        assert_eq!(range(std::iter::empty(), 0.1), (-0.5, 0.5));
        assert_eq!(range([2.0, 2.0].into_iter(), 0.1), (1.5, 2.5));
        assert_eq!(range([0.0, 10.0].into_iter(), 0.1), (-1.0, 11.0));
    }

    #[test]
    fn a_trend_is_the_mean_of_what_is_trusted() {
        let instant = |x: f64, left: f64, weight: f64| Instant {
            recording: 0,
            time_s: x,
            position: x,
            angle_rad: x,
            velocity: 1.0,
            normal_force_n: 0.0,
            measured: left,
            left_before: left,
            left_after: 0.0,
            weight,
            is_locked: false,
            follows: true,
        };
        let rows: Vec<Instant> = (0..400)
            .map(|k| {
                instant(f64::from(k) / 400.0, if k % 2 == 0 { 1.0 } else { 9.0 }, if k % 2 == 0 { 1.0 } else { 0.0 })
            })
            .collect();
        let rows: Vec<&Instant> = rows.iter().collect();
        let x: Vec<f64> = rows.iter().map(|i| i.position).collect();
        let trend = trend(&rows, &x, (0.0, 1.0), |i| i.left_before, |_| true);
        let points: Vec<&PlotPoint> = trend.iter().flatten().collect();
        assert!(
            points.len() > 40 && points.iter().all(|p| (p.y - 1.0).abs() < 1e-12),
            "rows without weight do not count"
        );
        let halves: Vec<&Instant> = rows.iter().copied().filter(|i| (i.position - 0.5).abs() > 0.1).collect();
        let x: Vec<f64> = halves.iter().map(|i| i.position).collect();
        assert_eq!(
            super::trend(&halves, &x, (0.0, 1.0), |i| i.left_before, |_| true).len(),
            2,
            "broken where nothing was"
        );
    }
}
