//! Axis signs: mirrored channels and swapped axes, corrected before the model is fitted.

use super::path;
use super::path::{Arm, Geometry};
use super::rows::{Axes, Signals, with_axes};
use crate::diagnose::contract::Cause;
use crate::diagnose::data::limits::HALF;
use crate::diagnose::data::regression_data;
use crate::diagnose::data::regression_data::Track;
use crate::diagnose::recording::grip_axis_signs::is_plausible;
use crate::diagnose::recording::rate_signs::{mirrored, with_rates_of_motion};
use crate::diagnose::recording::sample_faults;
use crate::diagnose::selection::rules::{MUCH, MUCH_UNSEEN, Rules};
use crate::diagnose::tasks::baseline_models::plain_crank;
use crate::diagnose::tasks::one_coordinate;
use foundation::estimate::EstimateError;
use haptics::law::{EccentricMass, Effect};
use haptics::recording::Recording;
use std::borrow::Cow;

/// Channels that may each be mirrored alone if a recording is implausible: a finger's axis, a joint.
const ALONE: [&[&str]; 14] = [
    &["fx1_N"],
    &["fy1_N"],
    &["fx2_N"],
    &["fy2_N"],
    &["fx1_N", "fy1_N"],
    &["fx2_N", "fy2_N"],
    &["qb_rad", "dqb_rad_s"],
    &["qt_rad", "dqt_rad_s"],
    &["qb1_rad", "dqb1_rad_s"],
    &["qt1_rad", "dqt1_rad_s"],
    &["qb2_rad", "dqb2_rad_s"],
    &["qt2_rad", "dqt2_rad_s"],
    &["x1_m", "vx1_m_s"],
    &["y1_m", "vy1_m_s"],
];

/// A crank's recording, prepared for the diagnosis.
pub struct Looked {
    pub signals: Signals,
    /// The path of the handle.
    pub circle: Geometry,
    /// Rows along the circle, with the force's axes corrected.
    pub rows: Track,
    /// Mirrored axis that was corrected for that.
    pub axis: Option<Cause>,
}

impl Looked {
    /// `bad`: samples that no sensor measured.
    ///
    /// # Errors
    /// Missing channels, too little data while held, a path that is no circle: in a sentence.
    pub fn at(recording: &Recording, bad: &[bool]) -> Result<Self, EstimateError> {
        let signals = Signals::of(recording, bad)?;
        let path = signals.path(recording);
        let circle = path::geometry(&path, signals.time_s.len(), Rules::of_path(signals.period_s))?;
        let (rows, axis) = upright(&signals, recording, &circle.arm)?;
        Ok(Self { signals, circle, rows, axis })
    }

    /// Residual RMS of a crank's model, N, and true if friction dissipates work.
    fn left(&self) -> Result<(f64, bool), EstimateError> {
        one_coordinate::plain_rms(&mut self.rows.clone(), &model_of(&self.circle.arm))
    }
}

/// A crank's recording with its channels corrected one by one, and its signals after that. [`upright`] corrects whole
/// axes of the force.
///
/// # Errors
/// As [`Looked::at`].
pub fn of_crank<'a>(
    recording: &'a Recording,
    bad: &[bool],
) -> Result<(Cow<'a, Recording>, Option<Cause>, Looked), EstimateError> {
    let (straight, rate) = with_rates_of_motion(recording);
    let fault = rate.map(sample_faults::against_motion);
    let looked = Looked::at(&straight, bad)?;
    let (before, _) = looked.left()?;
    if before < MUCH_UNSEEN * looked.rows.force_noise {
        return Ok((straight, fault, looked));
    }
    let mut best: Option<(f64, Looked, Recording, &[&str])> = None;
    for names in ALONE.iter().filter(|names| names.iter().any(|name| recording.channel(name).is_some())) {
        let other = mirrored(&straight, names);
        if !is_plausible(&other) {
            continue;
        }
        let Ok(looked) = Looked::at(&other, bad) else { continue };
        let Ok((after, resists)) = looked.left() else { continue };
        // One mirrored channel is likelier than that and an axis of the force.
        let better = |(least, held): (f64, &Looked)| (looked.axis.is_some(), after) < (held.axis.is_some(), least);
        let sound = resists && after < HALF * before && makes_sense((before, after), &looked.rows);
        if sound && best.as_ref().is_none_or(|(least, held, ..)| better((*least, held))) {
            best = Some((after, looked, other, names));
        }
    }
    Ok(match best {
        Some((after, looked, other, names)) => {
            // If a joint's rate agrees with its angle afterwards, only the angle was mirrored.
            let name = if names[0].starts_with('f') { names.join(" and ") } else { names[0].to_owned() };
            (Cow::Owned(other), Some(sample_faults::mirrored(&name, after / before)), looked)
        }
        None => (straight, fault, looked),
    })
}

/// The thesis's crank with gravity at any phase. In few strokes, an eccentric mass or a weight on a tilted plane can
/// look like driving friction, and leaves as large a residual as a mirrored axis does.
fn model_of(arm: &Arm) -> regression_data::Model {
    let mut model = plain_crank();
    model.push(Effect::new(&EccentricMass, &[1.0, 0.0, arm.radius_m]));
    model
}

/// Largest residual of a mirrored axis, as a share of the residual before, if it is much larger than a measured noise.
/// Many a change of sign reduces an effect that is large beside the noise.
/// Choice: no case of the ablation reads it.
const MIRRORED_RESIDUAL_SHARE: f64 = 0.1;

fn makes_sense((before, after): (f64, f64), track: &Track) -> bool {
    !track.noise_is_measured || after < MUCH_UNSEEN * track.force_noise || after < MIRRORED_RESIDUAL_SHARE * before
}

/// The rows, with an axis of the force mirrored back if only that makes them plausible.
pub fn upright(signals: &Signals, recording: &Recording, arm: &Arm) -> Result<(Track, Option<Cause>), EstimateError> {
    let as_recorded = signals.rows(recording, arm)?;
    let model = model_of(arm);
    // The motion does not depend on the axes of the force.
    let mut blurred = as_recorded.clone();
    let (before, resists) = one_coordinate::plain_rms(&mut blurred, &model)?;
    if resists && before < MUCH * as_recorded.force_noise {
        return Ok((as_recorded, None));
    }
    let mut best: Option<(f64, Axes, &str)> = None;
    let mirrored = |signs| Axes { swapped: false, signs };
    let crossed = [
        (mirrored([-1.0, 1.0]), "fx"),
        (mirrored([1.0, -1.0]), "fy"),
        (mirrored([-1.0, -1.0]), "fx and fy"),
        (Axes { swapped: true, signs: [1.0; 2] }, "fx with fy"),
    ];
    for (axes, name) in crossed {
        let track = with_axes(&blurred, axes);
        let (after, resists_then) = one_coordinate::blurred_rms(&track, &model)?;
        let both = name == "fx and fy";
        // Both at once change every sign and no magnitude: only driving friction shows it.
        let better = if both {
            resists_then && !resists
        } else {
            resists_then && after < HALF * before && makes_sense((before, after), &track)
        };
        if better && best.as_ref().is_none_or(|(least, ..)| after < *least) {
            best = Some((after, axes, name));
        }
    }
    Ok(match best {
        Some((after, axes, name)) => {
            (with_axes(&as_recorded, axes), Some(sample_faults::mirrored(name, after / before)))
        }
        None => (as_recorded, None),
    })
}
