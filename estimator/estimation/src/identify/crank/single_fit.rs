//! The fit of one recording of a crank: geometry, then the laws along the circle.

use super::friction::{Friction, Sensed, friction, geometry_errors, heldout_quality};
use super::geometry::Geometry;
use super::grasp_slip::{slip_warning, without_slips};
use super::path_coordinate::{Along, Rows, motions_at};
use super::report::{GripSignals, constraint, geometry_parameters, grip_parameters, warnings};
use super::signals::{Grasped, Held, Smooth, grasped, smooth};
use crate::segment::{Method, Segmentation, segment_by};
use foundation::estimate::{Constraint, EstimateError, Fit, Slip};
use foundation::signal::task::{half_width, is_two_fingered};
use foundation::tasks::Thresholds;
use haptics::recording::{Recording, Segment, Task};
use std::sync::{Arc, Mutex, PoisonError};

/// Largest distance of a crank's path from its best circle, as a share of the radius.
/// Choice: halved or doubled, none of 43 answers changes.
const LARGEST_RESIDUAL: f64 = 0.08;

/// Least number of turning samples: fewer cannot carry nine parameters.
/// Choice: halved or doubled, none of 43 answers changes.
const LEAST_TURNING_SAMPLES: usize = 40;

/// Fits one recording of a crank, with `thresholds` or those chosen from its noise. The segmentation that was used comes with
/// the fit.
pub fn fit(recording: &Recording, thresholds: Option<Thresholds>) -> Result<(Fit, Segmentation), EstimateError> {
    fit_by(Method::Threshold, recording, thresholds)
}

/// [`fit`] with the states of either method.
pub fn fit_by(
    method: Method,
    recording: &Recording,
    thresholds: Option<Thresholds>,
) -> Result<(Fit, Segmentation), EstimateError> {
    let prepared = Prepared::of(recording)?;
    let seen = see(method, recording, &prepared, thresholds)?;
    let fit = describe(recording, &prepared, &seen)?;
    Ok((fit, seen.segmentation))
}

/// A segmentation, the options it was made with, and the held samples.
struct Segmented {
    asked: (Method, Option<Thresholds>, Vec<Segment>),
    found: Segmentation,
    grasped: Arc<Grasped>,
}

/// Part of the analysis of a recording that does not depend on the options of the fit: refits share it.
pub struct Prepared {
    smooth: Arc<Smooth>,
    /// Two fingers squeeze the handle; one tool does not.
    grip: Option<GripSignals>,
    segmented: Mutex<Option<Segmented>>,
}

impl Prepared {
    /// Smooths and differentiates every channel.
    pub fn of(recording: &Recording) -> Result<Self, EstimateError> {
        let smooth = Arc::new(smooth(recording)?);
        let grip = if is_two_fingered(recording) { Some(GripSignals::of(recording, &smooth)?) } else { None };
        Ok(Self { smooth, grip, segmented: Mutex::new(None) })
    }

    /// Made again only when the thresholds, the method or a person's segments change.
    fn segmentation(
        &self,
        method: Method,
        recording: &Recording,
        thresholds: Option<Thresholds>,
    ) -> Result<(Segmentation, Arc<Grasped>), EstimateError> {
        let mut kept = self.segmented.lock().unwrap_or_else(PoisonError::into_inner);
        let asked = (method, thresholds, recording.meta.segments.clone());
        if let Some(kept) = kept.as_ref().filter(|kept| kept.asked == asked) {
            return Ok((kept.found.clone(), Arc::clone(&kept.grasped)));
        }
        let found = segment_by(method, recording, Some(Task::Crank), thresholds)?;
        let grasped = Arc::new(grasped(&self.smooth, &found));
        *kept = Some(Segmented { asked, found: found.clone(), grasped: Arc::clone(&grasped) });
        Ok((found, grasped))
    }
}

/// One recording, up to the laws fitted to it alone.
pub(super) struct Seen {
    pub(super) segmentation: Segmentation,
    pub(super) held: Held,
    pub(super) geometry: Geometry,
    pub(super) slips: Vec<Slip>,
    pub(super) rows: Rows,
    pub(super) friction: Friction,
}

pub(super) fn see(
    method: Method,
    recording: &Recording,
    prepared: &Prepared,
    thresholds: Option<Thresholds>,
) -> Result<Seen, EstimateError> {
    let (segmentation, grasped) = prepared.segmentation(method, recording, thresholds)?;
    let mut held = Held::new(&grasped);
    if held.turning.len() < LEAST_TURNING_SAMPLES {
        return Err(EstimateError::TooFewSamples {
            recording: recording.name.clone(),
            samples: held.turning.len(),
            what: " in which the crank turns".to_owned(),
            needed: LEAST_TURNING_SAMPLES,
        });
    }
    let (geometry, slips) = without_slips(&mut held)?;
    if geometry.rms_m > LARGEST_RESIDUAL * geometry.radius_m {
        return Err(EstimateError::Other(format!(
            "{} does not move on a circle: the best one, of radius {:.1} mm, is missed by {:.1} mm RMS; is it a crank?",
            recording.name,
            geometry.radius_m * 1e3,
            geometry.rms_m * 1e3
        )));
    }
    let rows = Rows::new(&Along::new(recording, &held, &geometry));
    let mut friction = friction(recording, &rows)?;
    friction.geometry_errors = geometry_errors(recording, &held, &geometry, &friction);
    Ok(Seen { segmentation, held, geometry, slips, rows, friction })
}

/// Fit of one recording: parameters, constraints and warnings.
pub(super) fn describe(recording: &Recording, prepared: &Prepared, seen: &Seen) -> Result<Fit, EstimateError> {
    let Seen { segmentation, held, geometry, slips, rows, friction } = seen;
    let mut parameters = geometry_parameters(held, geometry);
    let sensed = Sensed::of(held, geometry);
    parameters.extend(friction.parameters(&sensed, rows));
    if let Some(grip) = &prepared.grip {
        parameters.extend(grip_parameters(grip, held, geometry)?);
    }
    // Smoothed samples closer than half their window say nothing new.
    let apart = held.turning.iter().copied().step_by(half_width(&held.time_s));
    let (turning, _) = motions_at(recording, held, geometry, apart);
    let constraint = constraint(recording, held, geometry, &turning, friction, &parameters);
    let constraint = Constraint { slips: slips.clone(), ..constraint };
    let quality = heldout_quality(recording, rows);
    let mut warnings = warnings(segmentation, &turning, &constraint);
    warnings.extend(slip_warning(&constraint.slips));
    if held.bias_error_n.is_none() && !warnings.iter().any(|w| w.contains("let go")) {
        warnings.push(
            "the handle was never let go in this recording: a bias of the force sensor would pass for weight; start and \
             end with a second of free motion"
                .to_owned(),
        );
    }
    Ok(Fit {
        task: Task::Crank.name().to_owned(),
        parameters,
        constraints: vec![constraint],
        quality,
        correlated: vec![friction.correlated(&sensed, rows)],
        warnings,
    })
}
