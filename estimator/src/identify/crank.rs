//! Centre, radius, rigidity and friction of a crank turned by its handle (thesis, 5.3.1, eqs. 5.1 and 5.2).
//!
//! Geometry before forces: the give of the pads displaces the tips by the force they carry, which would tilt the tangent. The
//! radius residual shows it (it goes with the force, not with the angle), so it is fitted together with centre and radius, the
//! handle's position is corrected, and only then are the forces split into normal and tangential parts.

use super::linear::{LinearFit, least_squares};
use crate::estimate::{Constraint, ConstraintKind, EstimateError, Fit, Parameter, Quality};
use crate::segment::{Segmentation, Thresholds, segment};
use crate::signal::derive::savitzky_golay;
use crate::signal::noise::{quantum, white_noise};
use crate::signal::task::{
    CUBIC_HALF, TaskSignals, TipSeries, half_width, has_velocity, is_two_fingered, smooth, task_signals, times,
    tip_series,
};
use haptics::Vec2;
use haptics::law::{
    CoulombFriction, Inertia, Law, LoadFriction, MAX_PARAMETERS, Motion, ViscousFriction, Weight, drive_force,
};
use haptics::recording::{Channel, Recording, Task};
use haptics::world::Crank;
use std::collections::BTreeMap;

/// The laws of eq. 5.2, with the two that it left out: each linear in one parameter.
static LAWS: [&dyn Law; 5] = [&Weight, &LoadFriction, &ViscousFriction, &CoulombFriction, &Inertia];
const WEIGHT: usize = 0;
const INERTIA: usize = 4;
const COULOMB: usize = 3;
const FRICTION: [usize; 3] = [1, 2, COULOMB];
/// Names of the laws' parameters in a fit; inertia is reported about the axis.
const NAMES: [&str; 5] = ["weight_N", "friction_mu", "viscous_N_s_m", "coulomb_N", "inertia_kg_m2"];

/// A path that misses its best circle by more than this share of the radius is no crank's.
const LARGEST_RESIDUAL: f64 = 0.08;
/// A parameter whose error alone moves the predicted force by more than this share of the measured one is not identified.
const LARGEST_ERROR: f64 = 0.3;
/// A radial stiffness is reported when its give is this many standard errors above zero.
const SIGNIFICANT: f64 = 3.0;
/// The force passes through zero in a turn, too: shorter rests are not free motion, s.
const LEAST_FREE_S: f64 = 0.25;
/// Fewer turning samples than this cannot carry nine parameters.
const LEAST_SAMPLES: usize = 40;

/// The handle's motion and force while it is held, all channels through the same smoothing filter. One entry a sample.
struct Held {
    time_s: Vec<f64>,
    /// Mean of the tips, m.
    position: Vec<Vec2>,
    velocity: Vec<Vec2>,
    /// Derivative of the velocity, m/s².
    acceleration: Vec<Vec2>,
    /// Net force on the handle, N, bias taken out, with its first two derivatives, N/s and N/s².
    force: Vec<Vec2>,
    force_rate: Vec<Vec2>,
    force_bend: Vec<Vec2>,
    /// Samples that turn (the rest is held still or let go).
    turning: Vec<usize>,
    /// Noise of one velocity component after smoothing, m/s.
    velocity_noise: f64,
    /// Standard error of the vertical force bias that was taken out, N; `None` without a free phase to see it in.
    bias_error_n: Option<f64>,
    /// Error by the resolution of the log, m and N.
    resolution_m: f64,
    resolution_n: f64,
}

/// Circle and give of the pads.
struct Geometry {
    center_m: Vec2,
    radius_m: f64,
    /// Displacement of the tips against the handle per force, x and y, m/N.
    give_m_per_n: Vec2,
    /// Its standard errors, m/N.
    give_errors: Vec2,
    /// Standard errors of centre x, centre y, radius, m.
    errors_m: [f64; 3],
    /// Radial stiffness from one common give and its standard error, N/m.
    stiffness: Option<(f64, f64)>,
    rms_m: f64,
}

/// Fits one recording of a crank, with `thresholds` or those chosen from its noise. The segmentation that was used comes with
/// the fit.
pub fn fit(recording: &Recording, thresholds: Option<Thresholds>) -> Result<(Fit, Segmentation), EstimateError> {
    let segmentation = segment(recording, Some(Task::Crank), thresholds)?;
    let held = held(recording, &segmentation)?;
    if held.turning.len() < LEAST_SAMPLES {
        return Err(EstimateError::TooFewSamples {
            recording: recording.name.clone(),
            samples: held.turning.len(),
            what: " in which the crank turns".to_owned(),
            needed: LEAST_SAMPLES,
        });
    }
    let geometry = geometry(&held)?;
    if geometry.rms_m > LARGEST_RESIDUAL * geometry.radius_m {
        return Err(EstimateError::Other(format!(
            "{} does not move on a circle: the best one, of radius {:.1} mm, is missed by {:.1} mm RMS; is it a crank?",
            recording.name,
            geometry.radius_m * 1e3,
            geometry.rms_m * 1e3
        )));
    }
    let (motions, tangential) = motions(recording, &held, &geometry);
    let rows = Rows::new(&held, &motions, &tangential);
    let mut friction = friction(recording, &rows)?;
    friction.geometry_errors = geometry_errors(recording, &held, &geometry, &friction);

    let mut parameters = geometry_parameters(&held, &geometry);
    parameters.extend(friction.parameters(&held, &geometry, &rows));
    if is_two_fingered(recording) {
        parameters.extend(grip_parameters(recording, &held, &geometry)?);
    }
    let turning: Vec<Motion> = held.turning.iter().map(|i| motions[*i]).collect();
    let constraint = constraint(recording, &held, &geometry, &turning, &friction);
    let quality = heldout_quality(recording, &rows);
    let mut warnings = warnings(&segmentation, &turning, &constraint);
    if held.bias_error_n.is_none() && !warnings.iter().any(|w| w.contains("let go")) {
        warnings.push(
            "the handle was never let go in this recording: a bias of the force sensor would pass for weight; start and \
             end with a second of free motion"
                .to_owned(),
        );
    }
    let fit = Fit { task: Task::Crank.name().to_owned(), parameters, constraints: vec![constraint], quality, warnings };
    Ok((fit, segmentation))
}

fn held(recording: &Recording, segmentation: &Segmentation) -> Result<Held, EstimateError> {
    let time_s = times(recording);
    let (position, velocity, force) = if is_two_fingered(recording) {
        let TaskSignals { position, velocity, net_force_n, .. } = task_signals(recording)?;
        (position, velocity, net_force_n)
    } else {
        let TipSeries { position, velocity, force } = tip_series(recording, "")?;
        let clockless =
            || EstimateError::Clockless { what: "friction in a crank".to_owned(), recording: recording.name.clone() };
        let missing = || EstimateError::MissingColumn {
            task: "the crank".to_owned(),
            column: "fx_N".to_owned(),
            recording: recording.name.clone(),
        };
        (position, velocity.ok_or_else(clockless)?, force.ok_or_else(missing)?)
    };
    let free: Vec<usize> = segmentation
        .states
        .iter()
        .filter(|i| i.state == crate::segment::SystemState::FreeMotion && i.t1 - i.t0 >= LEAST_FREE_S)
        .flat_map(|i| i.first..i.end)
        .collect();
    let bias =
        if free.is_empty() { Vec2::zeros() } else { free.iter().map(|i| force[*i]).sum::<Vec2>() / free.len() as f64 };
    let bias_error_n = (!free.is_empty()).then(|| {
        let vertical: Vec<f64> = free.iter().map(|i| force[*i].y).collect();
        least_squares(&[vec![1.0; vertical.len()]], &vertical, None).map_or(0.0, |fit| fit.std_errors[0])
    });
    let turning = segmentation
        .states
        .iter()
        .filter_map(|i| i.subtask.as_deref())
        .flat_map(|subtask| segmentation.samples_of(subtask))
        .collect();
    let axis = |series: &[Vec2], pick: fn(&Vec2) -> f64| series.iter().map(pick).collect::<Vec<f64>>();
    let half = (2 * half_width(&time_s)).max(CUBIC_HALF);
    // Five samples of a slow log span much of a motion: there only their full polynomial does not weaken its bends.
    let order = if half == CUBIC_HALF { 4 } else { 3 };
    // Cubics, because lines and plain averages would shrink a rotating vector towards the centre of its arc.
    let smoothed = |series: &[Vec2]| {
        let x = savitzky_golay(&time_s, &axis(series, |v| v.x), half, order);
        let y = savitzky_golay(&time_s, &axis(series, |v| v.y), half, order);
        let pair = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| Vec2::new(*x, *y)).collect::<Vec<_>>();
        [pair(&x.value, &y.value), pair(&x.first, &y.first), pair(&x.second, &y.second)]
    };
    let [position_smooth, position_rate, position_bend] = smoothed(&position);
    let [mut velocity_smooth, mut acceleration, _] = smoothed(&velocity);
    let [force_smooth, force_rate, force_bend] = smoothed(&force);
    if !has_velocity(recording, if is_two_fingered(recording) { "1" } else { "" }) {
        // Derived twice over, a velocity would be weaker than the motion: take it from the positions' own cubics.
        velocity_smooth = position_rate;
        acceleration = position_bend;
    }
    // What the filter took out, scaled to what it left: a cubic fit over m samples leaves 9/(4 m) of the variance.
    let removed: Vec<f64> = velocity.iter().zip(&velocity_smooth).map(|(a, b)| (a - b).y).collect();
    let velocity_noise = white_noise(&removed) * (2.25 / (2 * half + 1) as f64).min(1.0).sqrt();
    // 1/√12: the standard deviation of an error that is even over one step (GUM, 4.3.7).
    let resolution = |series: &[Vec2]| 0.288_675 * quantum(&axis(series, |v| v.x)).max(quantum(&axis(series, |v| v.y)));
    Ok(Held {
        velocity_noise,
        bias_error_n,
        resolution_m: resolution(&position),
        resolution_n: resolution(&force),
        position: position_smooth,
        velocity: velocity_smooth,
        acceleration,
        force: force_smooth.iter().map(|f| f - bias).collect(),
        force_rate,
        force_bend,
        turning,
        time_s,
    })
}

/// Circle through the positions: Kåsa's linear fit as a start, then Gauss–Newton on the radius residual with the pads' give.
fn geometry(held: &Held) -> Result<Geometry, EstimateError> {
    let points: Vec<Vec2> = held.turning.iter().map(|i| held.position[*i]).collect();
    let forces: Vec<Vec2> = held.turning.iter().map(|i| held.force[*i]).collect();
    let mut center = kasa(&points)?;
    let mut give = [true, true];
    let mut solved = None;
    for _ in 0..12 {
        let (fit, columns) = radius_fit(&points, &forces, center, give)?;
        let step = Vec2::new(fit.values[1], fit.values[2]);
        center += step;
        // A give stays in the fit even when it is small: leaving it out would hide what it does to the centre, because the
        // steady part of the load (the weight) moves the tips as a shifted centre would.
        let keep = |k: usize| columns[k].is_some_and(|j| fit.identified[j]);
        let next = [give[0] && keep(0), give[1] && keep(1)];
        let settled = step.norm() < 1e-9 && next == give;
        give = next;
        solved = Some((fit, columns));
        if settled {
            break;
        }
    }
    let Some((fit, columns)) = solved else { return Err(EstimateError::Other("no circle was fitted".to_owned())) };
    let value = |k: usize| columns[k].map_or(0.0, |j| fit.values[j]);
    let error = |k: usize| columns[k].map_or(0.0, |j| fit.std_errors[j]);
    Ok(Geometry {
        center_m: center,
        radius_m: fit.values[0],
        give_m_per_n: Vec2::new(value(0), value(1)),
        give_errors: Vec2::new(error(0), error(1)),
        errors_m: [fit.std_errors[1], fit.std_errors[2], fit.std_errors[0]],
        stiffness: common_stiffness(&points, &forces, center)?,
        rms_m: fit.rms,
    })
}

/// Centre by Kåsa (1976): |p|² = 2 c·p + const is linear.
fn kasa(points: &[Vec2]) -> Result<Vec2, EstimateError> {
    let mean = points.iter().sum::<Vec2>() / points.len() as f64;
    let columns = vec![
        points.iter().map(|p| 2.0 * (p - mean).x).collect(),
        points.iter().map(|p| 2.0 * (p - mean).y).collect(),
        vec![1.0; points.len()],
    ];
    let squares: Vec<f64> = points.iter().map(|p| (p - mean).norm_squared()).collect();
    let fit = least_squares(&columns, &squares, None)?;
    Ok(mean + Vec2::new(fit.values[0], fit.values[1]))
}

/// Linearised radius residual at `center`: columns 1, cos θ, sin θ and the wanted gives. The second part of the answer says
/// which column carries the give along x and along y.
fn radius_fit(
    points: &[Vec2],
    forces: &[Vec2],
    center: Vec2,
    give: [bool; 2],
) -> Result<(LinearFit, [Option<usize>; 2]), EstimateError> {
    let outward: Vec<Vec2> = points.iter().map(|p| (p - center).normalize()).collect();
    let radius: Vec<f64> = points.iter().map(|p| (p - center).norm()).collect();
    let mut columns =
        vec![vec![1.0; points.len()], outward.iter().map(|n| n.x).collect(), outward.iter().map(|n| n.y).collect()];
    let mut place = [None; 2];
    for (k, wanted) in give.into_iter().enumerate() {
        if wanted {
            place[k] = Some(columns.len());
            columns.push(outward.iter().zip(forces).map(|(n, f)| n[k] * f[k]).collect());
        }
    }
    Ok((least_squares(&columns, &radius, None)?, place))
}

/// Radial stiffness if the give is the same in all directions: r = R + Fn/k.
fn common_stiffness(points: &[Vec2], forces: &[Vec2], center: Vec2) -> Result<Option<(f64, f64)>, EstimateError> {
    let outward: Vec<Vec2> = points.iter().map(|p| (p - center).normalize()).collect();
    let radius: Vec<f64> = points.iter().map(|p| (p - center).norm()).collect();
    let columns = vec![
        vec![1.0; points.len()],
        outward.iter().map(|n| n.x).collect(),
        outward.iter().map(|n| n.y).collect(),
        outward.iter().zip(forces).map(|(n, f)| n.dot(f)).collect(),
    ];
    let fit = least_squares(&columns, &radius, None)?;
    let (give, error) = (fit.values[3], fit.std_errors[3]);
    Ok((fit.identified[3] && give > SIGNIFICANT * error).then(|| (1.0 / give, error / (give * give))))
}

/// The handle's motion along the circle and the tangential force, N, at every sample (they mean something while it is held).
fn motions(recording: &Recording, held: &Held, geometry: &Geometry) -> (Vec<Motion>, Vec<f64>) {
    let up = if recording.meta.up.as_deref() == Some("-y") { -1.0 } else { 1.0 };
    let frame = |i: usize| {
        let handle = held.position[i] - held.force[i].component_mul(&geometry.give_m_per_n) - geometry.center_m;
        let outward = handle.normalize();
        (outward, Vec2::new(-outward.y, outward.x))
    };
    // The sign of a velocity within its noise is a guess: it is blurred over twice that (and never less than 0.5 mm/s).
    let blur = (2.0 * held.velocity_noise).max(0.5e-3);
    let mut angle_before = 0.0;
    (0..held.time_s.len())
        .map(|i| {
            let (outward, along) = frame(i);
            // The tips move with the handle plus the changing give of the pads.
            let give = &geometry.give_m_per_n;
            let speed = (held.velocity[i] - held.force_rate[i].component_mul(give)).dot(&along);
            let wrapped = outward.y.atan2(outward.x);
            let turns = ((angle_before - wrapped) / std::f64::consts::TAU).round();
            let angle = wrapped + turns * std::f64::consts::TAU;
            angle_before = angle;
            let motion = Motion {
                time_s: held.time_s[i],
                position: geometry.radius_m * angle,
                velocity: speed,
                acceleration: (held.acceleration[i] - held.force_bend[i].component_mul(give)).dot(&along),
                direction: (speed / blur).tanh(),
                normal_force_n: held.force[i].dot(&outward),
                up_along: up * along.y,
            };
            (motion, held.force[i].dot(&along))
        })
        .unzip()
}

/// The forces that the measured motion of a crank needs, channels named as measured.
///
/// Along the circle the world's laws say what it takes; the pull along the arm and the grip are the operator's own and stay as
/// measured. Where nothing is held the prediction is the measured (free) force.
pub fn needed_forces(crank: &Crank, recording: &Recording) -> Result<Vec<Channel>, EstimateError> {
    let segmentation = segment(recording, Some(Task::Crank), None)?;
    let held = held(recording, &segmentation)?;
    let geometry = Geometry {
        center_m: crank.center_m,
        radius_m: crank.radius_m,
        give_m_per_n: Vec2::zeros(),
        give_errors: Vec2::zeros(),
        errors_m: [0.0; 3],
        stiffness: None,
        rms_m: 0.0,
    };
    let (motions, tangential) = motions(recording, &held, &geometry);
    let mut correction = vec![Vec2::zeros(); motions.len()];
    for i in &held.turning {
        let outward = (held.position[*i] - crank.center_m).normalize();
        let along = Vec2::new(-outward.y, outward.x);
        correction[*i] = along * (drive_force(&crank.effects, &motions[*i]) - tangential[*i]);
    }
    let fingers: &[&str] = if is_two_fingered(recording) { &["1", "2"] } else { &[""] };
    let mut channels = Vec::new();
    for finger in fingers {
        for (axis, letter) in ["x", "y"].into_iter().enumerate() {
            let name = format!("f{letter}{finger}_N");
            let Some(measured) = recording.channel(&name) else { continue };
            let share = |i: usize| correction[i][axis] / fingers.len() as f64;
            let values = measured.iter().enumerate().map(|(i, force)| force + share(i)).collect();
            channels.push(Channel { name, unit: "N".to_owned(), values });
        }
    }
    Ok(channels)
}

/// The regression's rows: every law's column and the tangential force, all through one more low-pass.
///
/// A linear filter over both sides leaves the equation as it is (parallel filtering, Gautier 1997). It takes out what the
/// equation does not hold for: the noise of accelerations, which would flatten the inertia, and the tremor of the hand, which
/// the handle does not quite follow because of the pads.
struct Rows {
    columns: [Vec<f64>; LAWS.len()],
    tangential: Vec<f64>,
    weights: Vec<f64>,
}

/// Half of the low-pass window, s: what is slower than about 5 Hz stays.
const LOW_PASS_HALF_S: f64 = 0.06;

impl Rows {
    fn new(held: &Held, motions: &[Motion], tangential: &[f64]) -> Self {
        let period_s = (held.time_s[held.time_s.len() - 1] - held.time_s[0]) / (held.time_s.len() - 1) as f64;
        let half = (LOW_PASS_HALF_S / period_s).round() as usize;
        // Only where the whole window turns: elsewhere the equation does not hold.
        let mut turns = vec![0_u32; motions.len() + 1];
        for i in &held.turning {
            turns[i + 1] = 1;
        }
        for i in 0..motions.len() {
            turns[i + 1] += turns[i];
        }
        let inside: Vec<usize> = held
            .turning
            .iter()
            .copied()
            .filter(|i| *i >= half && i + half < motions.len())
            .filter(|i| turns[i + half + 1] - turns[i - half] == 2 * half as u32 + 1)
            // After the filter, rows closer than its window share samples (parallel decimation).
            .filter(|i| i % (2 * half).max(1) == 0)
            .collect();
        let reach = (half as f64 + 0.5).powi(2);
        let weight = |k: usize, i: usize| reach - (k as f64 - i as f64).powi(2);
        let pass = |value: &dyn Fn(usize) -> f64| -> Vec<f64> {
            let total: f64 = (0..=2 * half).map(|k| weight(k, half)).sum();
            let at = |i: usize| (i - half..=i + half).map(|k| weight(k, i) * value(k)).sum::<f64>() / total;
            inside.iter().map(|i| at(*i)).collect()
        };
        let direction = pass(&|k| motions[k].direction.abs());
        Self {
            columns: std::array::from_fn(|law| pass(&|k| column(LAWS[law], &motions[k]))),
            tangential: pass(&|k| tangential[k]),
            // Around a reversal the direction is a guess within the noise: such rows count less, and not at all when the
            // direction is quite unknown.
            weights: direction.iter().map(|d| d.powi(4)).collect(),
        }
    }

    fn len(&self) -> usize {
        self.tangential.len()
    }

    /// The first rows, as they come in time.
    fn head(&self, rows: usize) -> Self {
        Self {
            columns: std::array::from_fn(|law| self.columns[law][..rows].to_vec()),
            tangential: self.tangential[..rows].to_vec(),
            weights: self.weights[..rows].to_vec(),
        }
    }
}

/// The fitted friction laws.
struct Friction {
    fit: LinearFit,
    /// Which of [`LAWS`] took part, in the order of the fit's columns.
    used: Vec<usize>,
    known: BTreeMap<usize, f64>,
    /// What the uncertainty of centre and give adds to the error of each fitted parameter.
    geometry_errors: Vec<f64>,
}

impl Friction {
    fn value(&self, law: usize) -> f64 {
        let fitted = self.used.iter().position(|l| *l == law).map(|column| self.fit.values[column]);
        fitted.or_else(|| self.known.get(&law).copied()).unwrap_or(0.0)
    }

    /// Whether the recording shows the parameter of a column: it is told from the others, its error matters little, and it is
    /// not the other side of one that is not shown.
    fn shown(&self, column: usize, rows: &Rows, load_n: f64) -> bool {
        const SAME_THING: f64 = 0.9;
        let covariance = &self.fit.covariance;
        let tied = |other: usize| {
            let scale = (covariance[(column, column)] * covariance[(other, other)]).sqrt();
            covariance[(column, other)].abs() > SAME_THING * scale
        };
        // Where one kind of friction is not shown, another one near zero may only have lost its share to it.
        let is_friction = |law: usize| FRICTION.contains(&law);
        let doubtful = is_friction(self.used[column])
            && self.fit.t_value(column).abs() < SIGNIFICANT
            && (0..self.used.len()).any(|o| is_friction(self.used[o]) && !self.certain(o, rows, load_n));
        !doubtful
            && self.certain(column, rows, load_n)
            && (0..self.used.len()).filter(|o| *o != column).all(|o| self.certain(o, rows, load_n) || !tied(o))
    }

    fn certain(&self, column: usize, rows: &Rows, load_n: f64) -> bool {
        let regressor = &rows.columns[self.used[column]];
        let size = (regressor.iter().map(|c| c * c).sum::<f64>() / regressor.len().max(1) as f64).sqrt();
        self.fit.identified[column] && self.fit.std_errors[column] * size <= LARGEST_ERROR * load_n
    }

    fn parameters(&self, held: &Held, geometry: &Geometry, rows: &Rows) -> Vec<Parameter> {
        let samples = held.turning.len();
        let load = (rows.tangential.iter().map(|f| f * f).sum::<f64>() / rows.len().max(1) as f64).sqrt();
        let mut parameters = Vec::new();
        for (law, name) in NAMES.into_iter().enumerate() {
            let scale = if law == INERTIA { geometry.radius_m.powi(2) } else { 1.0 };
            if let Some(known) = self.known.get(&law) {
                parameters.push(Parameter::identified("crank", name, known * scale, 0.0, 0, "stated in the sidecar"));
                continue;
            }
            let column = self.used.iter().position(|l| *l == law);
            match column {
                Some(column) if self.shown(column, rows, load) => {
                    // A force that is off by the log's resolution shifts every parameter by that share of the load.
                    let resolution = self.fit.values[column].abs() * held.resolution_n / load.max(1e-9);
                    let fitted = self.fit.std_errors[column].hypot(self.geometry_errors[column]);
                    // A vertical bias acts just as the weight does.
                    let bias = if law == WEIGHT { held.bias_error_n.unwrap_or(0.0) } else { 0.0 };
                    let error = fitted.hypot(resolution).hypot(bias) * scale;
                    let how = format!("{} in the tangential force (eq. 5.2)", LAWS[law].title());
                    let value = self.fit.values[column] * scale;
                    parameters.push(Parameter::identified("crank", name, value, error, samples, &how));
                }
                _ => parameters.push(Parameter::unidentified("crank", name, samples, missing_motion(law))),
            }
        }
        parameters
    }
}

fn missing_motion(law: usize) -> &'static str {
    match law {
        WEIGHT => "the handle was not turned far enough round for its weight to be told from friction",
        INERTIA => "the crank was turned too evenly for its inertia to show; accelerate it",
        COULOMB => "the normal force hardly varied, so constant and load friction are one; push as well as pull",
        _ => "the recording does not excite it; vary speed and normal force, and reverse",
    }
}

fn friction(recording: &Recording, rows: &Rows) -> Result<Friction, EstimateError> {
    let known: BTreeMap<usize, f64> = NAMES
        .iter()
        .enumerate()
        .filter_map(|(law, name)| recording.meta.known.get(*name).map(|value| (law, *value)))
        .collect();
    let mut used: Vec<usize> = (0..LAWS.len()).filter(|law| !known.contains_key(law)).collect();
    let mut fit = regress(rows, &used, &known)?;
    // What this recording cannot separate is left out, the least essential first; what remains keeps its meaning.
    for law in [INERTIA, COULOMB] {
        if fit.identified.iter().all(|i| *i) {
            break;
        }
        used.retain(|l| *l != law);
        fit = regress(rows, &used, &known)?;
    }
    let geometry_errors = vec![0.0; used.len()];
    Ok(Friction { fit, used, known, geometry_errors })
}

/// Change of every friction parameter when centre and give are off by one standard error each, added in quadrature.
fn geometry_errors(recording: &Recording, held: &Held, geometry: &Geometry, friction: &Friction) -> Vec<f64> {
    let [ex, ey, _] = geometry.errors_m;
    let give = geometry.give_errors;
    let shifts = [
        (Vec2::new(ex, 0.0), Vec2::zeros()),
        (Vec2::new(0.0, ey), Vec2::zeros()),
        (Vec2::zeros(), Vec2::new(give.x, 0.0)),
        (Vec2::zeros(), Vec2::new(0.0, give.y)),
    ];
    let mut squares = vec![0.0; friction.used.len()];
    for (center, give) in shifts {
        let shifted =
            Geometry { center_m: geometry.center_m + center, give_m_per_n: geometry.give_m_per_n + give, ..*geometry };
        let (motions, tangential) = motions(recording, held, &shifted);
        if let Ok(fit) = regress(&Rows::new(held, &motions, &tangential), &friction.used, &friction.known) {
            for (square, (a, b)) in squares.iter_mut().zip(fit.values.iter().zip(&friction.fit.values)) {
                *square += (a - b).powi(2);
            }
        }
    }
    squares.into_iter().map(f64::sqrt).collect()
}

/// One weighted regression of the tangential force on the laws.
fn regress(rows: &Rows, used: &[usize], known: &BTreeMap<usize, f64>) -> Result<LinearFit, EstimateError> {
    let columns: Vec<Vec<f64>> = used.iter().map(|law| rows.columns[*law].clone()).collect();
    let rest: Vec<f64> = (0..rows.len())
        .map(|i| rows.tangential[i] - known.iter().map(|(law, value)| value * rows.columns[*law][i]).sum::<f64>())
        .collect();
    least_squares(&columns, &rest, Some(&rows.weights))
}

fn column(law: &dyn Law, motion: &Motion) -> f64 {
    let mut columns = [0.0; MAX_PARAMETERS];
    law.regressor(motion, &mut columns);
    columns[0]
}

fn geometry_parameters(held: &Held, geometry: &Geometry) -> Vec<Parameter> {
    let samples = held.turning.len();
    let how = "circle through the handle's positions, the give of the pads taken out";
    let with_resolution = |error: f64| error.hypot(held.resolution_m);
    let mut parameters = vec![
        Parameter::identified(
            "crank",
            "radius_m",
            geometry.radius_m,
            with_resolution(geometry.errors_m[2]),
            samples,
            how,
        ),
        Parameter::identified(
            "crank",
            "center_x_m",
            geometry.center_m.x,
            with_resolution(geometry.errors_m[0]),
            samples,
            how,
        ),
        Parameter::identified(
            "crank",
            "center_y_m",
            geometry.center_m.y,
            with_resolution(geometry.errors_m[1]),
            samples,
            how,
        ),
    ];
    parameters.push(match geometry.stiffness {
        Some((stiffness, error)) => Parameter::identified(
            "crank",
            "constraint_stiffness_N_m",
            stiffness,
            error,
            samples,
            "growth of the radius with the outward force: arm, bearing and pads in series",
        ),
        None => Parameter::unidentified(
            "crank",
            "constraint_stiffness_N_m",
            samples,
            "the radius does not grow with the outward force: stiffer than this recording can show",
        ),
    });
    parameters
}

/// Width of the handle and stiffness of one pad: what a virtual grip needs to feel like the real one.
///
/// The tips' distance is the handle's width less the give of both pads, 2 F / k; along y two pads side by side carry the
/// handle in shear, as the radius residual shows.
fn grip_parameters(recording: &Recording, held: &Held, geometry: &Geometry) -> Result<Vec<Parameter>, EstimateError> {
    let signals = task_signals(recording)?;
    let width = smooth(&held.time_s, &signals.grip_width_m);
    // The mean of the two normal forces: their difference moves the handle, not the tips apart.
    let normal = |finger: usize, i: usize| signals.tips[finger].force.as_ref().map_or(0.0, |f| f[i].x);
    let grip: Vec<f64> = (0..signals.len()).map(|i| 0.5 * (normal(0, i) - normal(1, i))).collect();
    let grip = smooth(&held.time_s, &grip).value;
    let stride = 2 * half_width(&held.time_s);
    let rows: Vec<usize> = held.turning.iter().copied().step_by(stride).collect();
    let column = |series: &[f64]| rows.iter().map(|i| series[*i]).collect::<Vec<f64>>();
    let columns = [vec![1.0; rows.len()], column(&grip), column(&width.slope)];
    let fit = least_squares(&columns, &column(&width.value), None)?;
    let samples = held.turning.len();
    let (give, give_error) = (-0.5 * fit.values[1], 0.5 * fit.std_errors[1]);
    let mut parameters = Vec::new();
    if fit.identified[1] && give > SIGNIFICANT * give_error {
        let how = "distance of the tips while turning, extrapolated to zero grip force";
        let error = fit.std_errors[0].hypot(held.resolution_m);
        parameters.push(Parameter::identified("crank", "handle_width_m", fit.values[0], error, samples, how));
        parameters.push(stiffness("stiffness_N_m", give, give_error, samples));
    } else {
        let why = "the grip was too even to tell the handle's width from the pads' give";
        parameters.push(Parameter::unidentified("crank", "handle_width_m", samples, why));
        let (give, error) = (geometry.give_m_per_n.x, geometry.give_errors.x);
        parameters.push(stiffness("stiffness_N_m", 2.0 * give, 2.0 * error, samples));
    }
    let (give, error) = (geometry.give_m_per_n.y, geometry.give_errors.y);
    parameters.push(stiffness("shear_stiffness_N_m", 2.0 * give, 2.0 * error, samples));
    Ok(parameters)
}

/// Stiffness of one pad from its give, m/N.
fn stiffness(name: &str, give: f64, error: f64, samples: usize) -> Parameter {
    if give > SIGNIFICANT * error {
        Parameter::identified("pad", name, 1.0 / give, error / (give * give), samples, "give of the grip, one pad")
    } else {
        Parameter::unidentified("pad", name, samples, "no give shows under the forces of this recording")
    }
}

fn constraint(
    recording: &Recording,
    held: &Held,
    geometry: &Geometry,
    motions: &[Motion],
    friction: &Friction,
) -> Constraint {
    let weight = friction.value(WEIGHT);
    // Fc = Fn − (mg)n, the weight's part along the outward normal being mg sin θ (eq. 5.1).
    let angle = |m: &Motion| m.position / geometry.radius_m;
    let force = motions.iter().map(|m| m.normal_force_n - weight * angle(m).sin()).sum::<f64>() / motions.len() as f64;
    let (low, high) = motions.iter().map(angle).fold((f64::MAX, f64::MIN), |(low, high), a| (low.min(a), high.max(a)));
    let [ex, ey, er] = geometry.errors_m.map(|e| e.hypot(held.resolution_m));
    let points: Vec<Vec2> = held.turning.iter().map(|i| held.position[*i]).collect();
    let by_normals = crate::constraint::normals_center(&points, crate::constraint::THESIS_SAMPLES);
    let rigid = geometry.stiffness.is_none_or(|(k, _)| k > RIGID_N_M);
    Constraint {
        kind: ConstraintKind::Revolute,
        recording: Some(recording.name.clone()),
        center_m: Some(vec![geometry.center_m.x, geometry.center_m.y]),
        normals_center_m: by_normals.map(|center| vec![center.x, center.y]),
        radius_m: Some(geometry.radius_m),
        radius_interval_m: Some((geometry.radius_m - 1.96 * er, Some(geometry.radius_m + 1.96 * er))),
        direction: None,
        rigid: Some(rigid),
        std_error: BTreeMap::from([("center_m".to_owned(), ex.max(ey)), ("radius_m".to_owned(), er)]),
        coverage_rad: Some(high - low),
        coverage_m: None,
        residual_m: Some(geometry.rms_m),
        constraint_force_n: Some(force),
        evidence: format!(
            "the handle stays within {:.3} mm (RMS) of one circle over {:.1} turns; {}",
            geometry.rms_m * 1e3,
            (high - low) / std::f64::consts::TAU,
            normals_sentence(by_normals, geometry.center_m)
        ),
    }
}

/// Stiffer than the manipulator's own finger compliance in the thesis (0.11 cm under a few newtons): rigid.
const RIGID_N_M: f64 = 1000.0;

/// What the thesis's own method, normals over twelve samples, says of the centre.
fn normals_sentence(by_normals: Option<Vec2>, center: Vec2) -> String {
    match by_normals {
        Some(found) => {
            format!("normals over twelve samples meet {:.2} mm from its centre", (found - center).norm() * 1e3)
        }
        None => "normals over twelve samples are too nearly parallel to meet".to_owned(),
    }
}

fn warnings(segmentation: &Segmentation, motions: &[Motion], constraint: &Constraint) -> Vec<String> {
    let mut warnings = segmentation.warnings.clone();
    let share = motions.iter().filter(|m| m.normal_force_n > 0.0).count() as f64 / motions.len().max(1) as f64;
    if !(0.05..=0.95).contains(&share) {
        let way = if share > 0.5 { "pulled outwards" } else { "pushed inwards" };
        warnings.push(format!(
            "the handle was only {way}: that the constraint holds both ways was not seen; push and pull to show it"
        ));
    }
    if constraint.coverage_rad.is_some_and(|a| a < std::f64::consts::PI) {
        warnings.push("less than half a turn was seen: centre and radius rest on a short arc".to_owned());
    }
    if !(motions.iter().any(|m| m.velocity > 0.0) && motions.iter().any(|m| m.velocity < 0.0)) {
        warnings
            .push("the crank was turned one way only: friction and constant errors cannot be told apart".to_owned());
    }
    warnings
}

/// Fit on the first 70 %, tested on the rest.
fn heldout_quality(recording: &Recording, rows: &Rows) -> Option<Quality> {
    const TRAIN: f64 = 0.7;
    let cut = (TRAIN * rows.len() as f64) as usize;
    let trained = friction(recording, &rows.head(cut)).ok()?;
    let rms = |from: usize, to: usize, model: bool| {
        let square = |i: usize| {
            let predicted: f64 = (0..LAWS.len()).map(|law| trained.value(law) * rows.columns[law][i]).sum();
            (rows.tangential[i] - if model { predicted } else { 0.0 }).powi(2)
        };
        ((from..to).map(square).sum::<f64>() / (to - from).max(1) as f64).sqrt()
    };
    let heldout_rms = rms(cut, rows.len(), true);
    Some(Quality {
        rms: rms(0, cut, true),
        heldout_rms,
        heldout_relative: heldout_rms / rms(cut, rows.len(), false).max(1e-12),
        heldout_share: 1.0 - TRAIN,
        unit: "N".to_owned(),
    })
}
