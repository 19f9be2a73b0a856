//! Curves of a diagnosis: measured against modelled force over time, and what is left against each suspect variable.

use crate::text::format;
use egui_plot::PlotPoint;
use estimator::diagnose::Diagnosis;
use estimator::diagnose::course::{Course, Instant};
use estimator::log::gap_above_s;
use std::f64::consts::TAU;

/// Most points of a curve, and of a cloud.
const MOST_POINTS: usize = 3_000;
/// Longest time between neighbours of a curve, s.
const GAP_S: f64 = 0.05;
/// Bins of a trend, and rows that a bin needs.
const BINS: usize = 60;
const LEAST_ROWS: usize = 4;
/// Share of what is left that the axis shows.
const SHOWN_SHARE: f64 = 0.995;
/// Rows that are trusted less are not drawn: there the direction of motion is a guess, and with it the sign of all friction.
const LEAST_WEIGHT: f64 = 0.5;

/// A variable that what is left may depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Suspect {
    /// Place along the motion.
    Position,
    /// Its rate.
    Velocity,
    /// Force across the motion.
    NormalForce,
    /// Time.
    Time,
}

/// A line of means, broken where there were none.
pub type Trend = Vec<Vec<PlotPoint>>;

/// What is left against one variable.
#[derive(Clone, Debug)]
pub struct Cloud {
    /// Which variable.
    pub suspect: Suspect,
    /// In words.
    pub title: &'static str,
    /// Its shown unit.
    pub unit: &'static str,
    /// What the model leaves, thinned.
    pub before: Vec<PlotPoint>,
    /// Means of it over ranges of the variable, forwards and backwards.
    pub trend_before: [Trend; 2],
    /// The same with what was found.
    pub trend_after: [Trend; 2],
    /// Shown range of the variable.
    pub range: (f64, f64),
}

/// One recording's curves.
#[derive(Clone, Debug)]
pub struct Residuals {
    /// Shown unit of the force.
    pub unit: &'static str,
    /// Whether that is what a free motion needs, not what a sensor told.
    pub is_free: bool,
    /// Measured force, in stretches without a gap.
    pub measured: Vec<Vec<PlotPoint>>,
    /// The model's.
    pub modelled: Vec<Vec<PlotPoint>>,
    /// That of the model with what was found.
    pub extended: Vec<Vec<PlotPoint>>,
    /// Shown range of time, s.
    pub span_s: (f64, f64),
    /// Shown range of the force.
    pub force: (f64, f64),
    /// Largest residual that is shown, N or N m.
    pub largest: f64,
    /// Noise of one row, N or N m.
    pub noise: f64,
    /// What is left against each variable that was measured.
    pub clouds: Vec<Cloud>,
}

impl Residuals {
    /// The curves of the recording of this number.
    pub fn new(diagnosis: &Diagnosis, recording: usize) -> Self {
        let course = &diagnosis.course;
        let rows: Vec<&Instant> = course.instants.iter().filter(|i| i.recording == recording).collect();
        let sure: Vec<&Instant> = rows.iter().copied().filter(|i| i.weight >= LEAST_WEIGHT).collect();
        let times: Vec<f64> = rows.iter().map(|i| i.time_s).collect();
        let gap_s = gap_above_s(&times).unwrap_or(f64::INFINITY);
        let curve = |rows: &[&Instant], far_s: f64, of: &dyn Fn(&Instant) -> f64| {
            // Without the rows in between, neighbours may be far apart; nor is anything known of a gap.
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
            // Against velocity both directions have their own half already; against time they alternate.
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

/// More than one turn was made: places of all turns are laid over each other.
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

/// Means over even ranges of x, each row as far as it is trusted; ranges with few rows are left out.
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

/// Lowest and highest value with a share of room at both ends; never empty.
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

/// The extremes of equal numbers of points, in their order, so that all curves together have no more than [`MOST_POINTS`].
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
