//! Estimates of a carried object, as parameters of a fit.

use super::super::leak::{LeakAnswer, Verdict};
use super::super::state_tracker::StateTracker;
use super::grasp_record::GraspRecord;
use foundation::estimate::Parameter;

/// The grip must vary by this share of its mean for the pads' give to show.
const LEAST_GRIP_VARIATION: f64 = 0.05;
/// Relative error of a width whose pad compression is not known (thesis).
const UNKNOWN_COMPRESSION: f64 = 0.07;
/// Standard errors from zero from which a give is told.
const SIGNIFICANT: f64 = 3.0;

/// `leak_kg_s` as a parameter of a fit.
pub(crate) fn leak_parameter(object: &str, answer: &LeakAnswer, samples: usize) -> Parameter {
    let how = match &answer.motion {
        Some(motion) => format!("{}; {motion}", answer.why),
        None => answer.why.clone(),
    };
    match (answer.verdict, answer.leak_kg_s) {
        (Verdict::Leak | Verdict::Both | Verdict::SensorDrift, Some(leak)) => {
            Parameter::identified(object, "leak_kg_s", leak.value, leak.std_error, samples, &how)
        }
        _ => Parameter::unidentified(object, "leak_kg_s", samples, &how),
    }
}

/// Mean distance of the tips, m.
pub(super) fn mean_width(object: &GraspRecord) -> f64 {
    let [width, slope, _] = object.width.values();
    width + slope * object.grip[0]
}

pub(super) fn width(name: &str, object: &GraspRecord) -> Parameter {
    let samples = object.held_rows as usize;
    let (mean_grip, spread) = object.grip_and_spread();
    let error = object.width.std_errors()[0];
    if error.is_finite() && spread > LEAST_GRIP_VARIATION * mean_grip {
        let [value, slope, _] = object.width.values();
        let give = -0.5 * slope;
        let how = if give > SIGNIFICANT * 0.5 * object.width.std_errors()[1] {
            format!("distance of the tips while held, extrapolated to no grip (pads give {:.0} N/m each)", 1.0 / give)
        } else {
            "distance of the tips while held, extrapolated to no grip".to_owned()
        };
        return Parameter::identified(name, "width_m", value, error, samples, &how);
    }
    if object.held_rows < 8 {
        return Parameter::unidentified(name, "width_m", samples, "it was not held for long enough yet");
    }
    let value = mean_width(object);
    let how = "mean distance of the tips; the grip was too even to tell the pads' give, so 7 % is added to the error";
    Parameter::identified(name, "width_m", value, UNKNOWN_COMPRESSION * value, samples, how)
}

/// Pad and wall of one side together.
pub(super) fn grip_stiffness(name: &str, object: &GraspRecord) -> Parameter {
    const NAME: &str = "grip_stiffness_N_m";
    let samples = object.held_rows as usize;
    let (mean_grip, spread) = object.grip_and_spread();
    let [_, slope, _] = object.width.values();
    let (give, error) = (-0.5 * slope, 0.5 * object.width.std_errors()[1]);
    if !(error.is_finite() && spread > LEAST_GRIP_VARIATION * mean_grip && give > SIGNIFICANT * error) {
        let why = "the grip varied too little to tell how the sides give; squeeze harder for a moment";
        return Parameter::unidentified(name, NAME, samples, why);
    }
    let how = "give of one pad and the wall behind it together, from the distance of the tips over the grip";
    Parameter::identified(name, NAME, 1.0 / give, error / (give * give), samples, how)
}

pub(super) fn friction(name: &str, object: &GraspRecord) -> Parameter {
    let samples = object.held_rows as usize;
    match object.bound {
        Some((ratio, error)) => {
            let how = "largest ratio of vertical to horizontal tip force while grasped; true friction is at least this";
            Parameter::identified(name, "friction_lower_bound", (ratio - error).max(0.0), error, samples, how)
        }
        None => {
            Parameter::unidentified(name, "friction_lower_bound", samples, "the grip was never firm enough to tell")
        }
    }
}

/// Weight and mass while it is carried.
pub(super) fn weight(name: &str, object: &GraspRecord, sense: &StateTracker, gravity: f64) -> Vec<Parameter> {
    let samples = object.carried_rows as usize;
    let error = object.weight.std_errors()[0];
    let why = match sense.lift_bias() {
        None => {
            "the hand was not seen free yet: a bias of the force sensors would pass for weight; let go for a second"
        }
        Some(_) if !error.is_finite() => "it was not carried for long enough yet",
        Some((bias, bias_error)) => {
            let (value, error) = (object.weight.values()[0] - bias, error.hypot(bias_error));
            let how = "mean of the summed vertical forces while carried, accelerations and bias taken out";
            let mass = "weight divided by gravity";
            return vec![
                Parameter::identified(name, "weight_N", value, error, samples, how),
                Parameter::identified(name, "mass_kg", value / gravity, error / gravity, samples, mass),
            ];
        }
    };
    vec![
        Parameter::unidentified(name, "weight_N", samples, why),
        Parameter::unidentified(name, "mass_kg", samples, why),
    ]
}
