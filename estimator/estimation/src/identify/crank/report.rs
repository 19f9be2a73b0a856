//! Parameters, constraint and warnings in the words of a fit.

use super::friction::Friction;
use super::geometry::{Drawn, Geometry};
use super::laws::Place;
use super::signals::{Held, Smooth};
use crate::constraint::existence::{Rows, existence, sentence};
use crate::constraint::yielding::{Manipulator, judge};
use crate::constraint::{THESIS_SAMPLES, normals_center};
use crate::identify::limits::SIGNIFICANT;
use crate::identify::pads::HAND_N_M;
use crate::identify::pads::{Grip, width_over_force};
use crate::regression::long_run_variance::HALF_INTERVAL;
use crate::segment::Segmentation;
use crate::segment::threshold::Levels;
use foundation::estimate::{Constraint, ConstraintKind, EstimateError, Parameter, Screw, Yielding};
use foundation::signal::task::{CUBIC_HALF, Smoothed, half_width, smooth, task_signals};
use haptics::Vec2;
use haptics::law::Motion;
use haptics::recording::Recording;
use std::collections::BTreeMap;

pub(super) fn geometry_parameters(held: &Held, geometry: &Geometry) -> Vec<Parameter> {
    let samples = held.turning.len();
    let how = "circle through the handle's positions, the give of the pads taken out";
    let with_resolution = |error: f64| error.hypot(held.resolution_m);
    let place = |name: &str, value: f64, k: usize| {
        let drawn = geometry.resampled.map(|drawn| with_resolution(drawn.errors_m[k]));
        Parameter::identified("crank", name, value, with_resolution(geometry.errors_m[k]), samples, how)
            .with_bootstrap(drawn)
    };
    let mut parameters = vec![
        place("radius_m", geometry.radius_m, 2),
        place("center_x_m", geometry.center_m.x, 0),
        place("center_y_m", geometry.center_m.y, 1),
    ];
    parameters.push(match geometry.stiffness {
        Some(found) => Parameter::identified(
            "crank",
            "constraint_stiffness_N_m",
            found.n_m,
            found.error,
            samples,
            "growth of the radius with the outward force: arm, bearing and pads in series",
        )
        .with_bootstrap(found.resampled),
        None => Parameter::unidentified(
            "crank",
            "constraint_stiffness_N_m",
            samples,
            "the radius does not grow with the outward force: stiffer than this recording can show",
        ),
    });
    parameters
}

/// Squeeze of two fingers on the handle, all channels through one filter. One entry a sample.
pub(super) struct GripSignals {
    /// Distance of the tips, m, and its rate.
    width: Smoothed,
    /// Mean of the two normal forces, N: their difference moves the handle, not the tips apart.
    force_n: Vec<f64>,
}

impl GripSignals {
    pub(super) fn of(recording: &Recording, smoothed: &Smooth) -> Result<Self, EstimateError> {
        let signals = task_signals(recording)?;
        let bias = Levels::of(&signals).bias_n;
        let normal =
            |finger: usize, i: usize| signals.tips[finger].force.as_ref().map_or(0.0, |f| f[i].x) - bias[finger].x;
        let grip: Vec<f64> = (0..signals.len()).map(|i| 0.5 * (normal(0, i) - normal(1, i))).collect();
        let width = smooth(&smoothed.time_s, &signals.grip_width_m);
        Ok(Self { width, force_n: smooth(&smoothed.time_s, &grip).value })
    }
}

/// Width of the handle and stiffness of one pad: a virtual grip needs them to feel like the real one.
///
/// The tips' distance is the handle's width less the give of both pads, 2 F / k. Along y two pads side by side carry
/// the handle in shear, as the radius residual shows.
pub(super) fn grip_parameters(
    signals: &GripSignals,
    held: &Held,
    geometry: &Geometry,
) -> Result<Vec<Parameter>, EstimateError> {
    let stride = 2 * half_width(&held.time_s);
    let rows: Vec<usize> = held.turning.iter().copied().step_by(stride).collect();
    let column = |series: &[f64]| rows.iter().map(|i| series[*i]).collect::<Vec<f64>>();
    let (width, grip) = (&signals.width, &signals.force_n);
    let (widths, forces, rates) = (column(&width.value), column(grip), column(&width.slope));
    let pads = width_over_force(&Grip { width: &widths, force: &forces, rate: &rates })?;
    let samples = held.turning.len();
    let mut parameters = Vec::new();
    // Two pads side by side carry the handle.
    let by_radius = |name: &str, give: f64, error: f64, drawn: fn(&Drawn) -> f64| {
        let drawn = geometry.resampled.as_ref().map(|d| 2.0 * drawn(d) / (2.0 * give).powi(2));
        stiffness(name, 2.0 * give, 2.0 * error, samples).with_bootstrap(drawn)
    };
    if let Some(pads) = pads.filter(|p| p.give_m_per_n > SIGNIFICANT * p.give_error) {
        let how = "distance of the tips while turning, extrapolated to zero grip force";
        let error = pads.width_error_m.hypot(held.resolution_m);
        let resampled = pads.resampled.map(|(width, _)| width.hypot(held.resolution_m));
        let width = Parameter::identified("crank", "handle_width_m", pads.width_m, error, samples, how);
        parameters.push(width.with_bootstrap(resampled));
        let resampled = pads.resampled.map(|(_, give)| give / pads.give_m_per_n.powi(2));
        let pad = stiffness("stiffness_N_m", pads.give_m_per_n, pads.give_error, samples);
        parameters.push(pad.with_bootstrap(resampled));
    } else {
        let why = "the grip was too even to tell the handle's width from the pads' give";
        parameters.push(Parameter::unidentified("crank", "handle_width_m", samples, why));
        let (give, error) = (geometry.give_m_per_n.x, geometry.give_errors.x);
        parameters.push(by_radius("stiffness_N_m", give, error, |drawn| drawn.give_errors.x));
    }
    let (give, error) = (geometry.give_m_per_n.y, geometry.give_errors.y);
    parameters.push(by_radius("shear_stiffness_N_m", give, error, |drawn| drawn.give_errors.y));
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

pub(super) fn constraint(
    recording: &Recording,
    held: &Held,
    geometry: &Geometry,
    motions: &[Motion],
    friction: &Friction,
    parameters: &[Parameter],
) -> Constraint {
    let weight = friction.value(Place::Weight as usize);
    // Fc = Fn − (mg)n, the weight's part along the outward normal being mg sin θ (eq. 5.1).
    let angle = |m: &Motion| m.position / geometry.radius_m;
    let force = motions.iter().map(|m| m.normal_force_n - weight * angle(m).sin()).sum::<f64>() / motions.len() as f64;
    let (low, high) = motions.iter().map(angle).fold((f64::MAX, f64::MIN), |(low, high), a| (low.min(a), high.max(a)));
    let [ex, ey, er] = geometry.errors_m.map(|e| e.hypot(held.resolution_m));
    let points: Vec<Vec2> = held.turning.iter().map(|i| held.position()[*i]).collect();
    let by_normals = normals_center(&points, THESIS_SAMPLES);
    let (rigid, yielding) = rigidity(geometry, parameters);
    let tested = existence(&existence_rows(recording, held));
    let (existence, sided) = tested.map_or((None, None), |(e, s)| (Some(e), s));
    let held_by = existence.as_ref().map_or_else(String::new, |e| format!("; {}", sentence(e)));
    Constraint {
        kind: ConstraintKind::Revolute,
        existence,
        sided,
        center_m: Some(vec![geometry.center_m.x, geometry.center_m.y]),
        normals_center_m: by_normals.map(|center| vec![center.x, center.y]),
        radius_m: Some(geometry.radius_m),
        radius_interval_m: Some((geometry.radius_m - HALF_INTERVAL * er, Some(geometry.radius_m + HALF_INTERVAL * er))),
        rigid,
        yielding,
        std_error: BTreeMap::from([("center_m".to_owned(), ex.max(ey)), ("radius_m".to_owned(), er)]),
        coverage_rad: Some(high - low),
        residual_m: Some(geometry.rms_m),
        constraint_force_n: Some(force),
        screw: Some(Screw {
            point_m: [geometry.center_m.x, geometry.center_m.y, 0.0],
            axis: [0.0, 0.0, 1.0],
            pitch_m_rad: Some(0.0),
            pitch_std_error: None,
        }),
        evidence: format!(
            "the handle stays within {:.3} mm (RMS) of one circle over {:.1} turns; {}{held_by}",
            geometry.rms_m * 1e3,
            (high - low) / std::f64::consts::TAU,
            normals_sentence(by_normals, geometry.center_m)
        ),
        ..Constraint::blank(Some(recording.name.clone()), "")
    }
}

/// The handle's motion and force, for the test whether anything guides it.
fn existence_rows(recording: &Recording, held: &Held) -> Rows {
    /// Least speed of a row of the test of existence, as a share of the root mean square of the speed.
    /// Choice: halved or doubled, none of 43 answers changes.
    const EXISTENCE_SPEED_SHARE: f64 = 0.3;
    let square: f64 = held.turning.iter().map(|i| held.velocity[*i].norm_squared()).sum();
    let least = EXISTENCE_SPEED_SHARE * (square / held.turning.len().max(1) as f64).sqrt();
    let stride = (4 * half_width(&held.time_s)).max(2 * CUBIC_HALF) + 1;
    let picked: Vec<usize> =
        held.turning.iter().copied().step_by(stride).filter(|i| held.velocity[*i].norm() > least).collect();
    let pick = |series: &[Vec2]| picked.iter().map(|i| series[*i]).collect::<Vec<Vec2>>();
    Rows {
        velocity: pick(&held.velocity),
        acceleration: pick(&held.acceleration),
        force: pick(&held.force),
        up: match recording.meta.up.as_deref() {
            Some("-y") => -Vec2::y(),
            Some("none") => Vec2::zeros(),
            _ => Vec2::y(),
        },
        gravity: None,
        rubs: true,
        bias_error_n: held.bias_error_n.unwrap_or(0.0).hypot(held.resolution_n),
    }
}

/// The give along x, where the pads press and their stiffness is known from grip and width, against the hand's own there: two
/// pads side by side.
fn rigidity(geometry: &Geometry, parameters: &[Parameter]) -> (Option<bool>, Option<Yielding>) {
    let pad = parameters.iter().find(|p| p.object == "pad" && p.name == "stiffness_N_m" && p.how.starts_with("give"));
    let width = parameters.iter().any(|p| p.name == "handle_width_m" && p.identified);
    let known = pad.filter(|_| width).and_then(|p| Some((p.value?, p.std_error?)));
    let (give, error) = (geometry.give_m_per_n.x, geometry.give_errors.x);
    match known {
        Some((stiffness, stiffness_error)) => {
            let pads = 0.5 / stiffness;
            let hand =
                Manipulator { stiffness_n_m: 2.0 * stiffness, give_m_n: (pads, pads * stiffness_error / stiffness) };
            judge(give, error, &hand)
        }
        None => judge(give, error, &Manipulator { stiffness_n_m: HAND_N_M, give_m_n: (0.0, 0.0) }),
    }
}

/// Result of the thesis's own method for the centre, normals over twelve samples.
fn normals_sentence(by_normals: Option<Vec2>, center: Vec2) -> String {
    match by_normals {
        Some(found) => {
            format!("normals over twelve samples meet {:.2} mm from its centre", (found - center).norm() * 1e3)
        }
        None => "normals over twelve samples are too nearly parallel to meet".to_owned(),
    }
}

pub(super) fn warnings(segmentation: &Segmentation, motions: &[Motion], constraint: &Constraint) -> Vec<String> {
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
