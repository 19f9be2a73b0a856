//! Motion that each fit takes its number from: it shows a parameter if no information matrix tells the missing one.

use super::motion::Motion;
use foundation::estimate::Parameter;

/// Object, parameter and the motion that shows it; an empty object means any.
const SHOWN_BY: [(&str, &str, Motion); 46] = [
    ("needle", "stiffness_N_m", Motion::PushThroughAndBack),
    ("needle", "hardening_N_m3", Motion::PushThroughAndBack),
    ("needle", "puncture_force_N", Motion::PushThroughAndBack),
    ("needle", "shaft_friction_N", Motion::MoveInTheHole),
    ("needle", "weight_N", Motion::HoldInTheAir),
    ("switch", "peak_force_N", Motion::ThrowSlowlyBothWays),
    ("switch", "return_peak_force_N", Motion::ThrowSlowlyBothWays),
    ("switch", "friction_N", Motion::ThrowSlowlyBothWays),
    ("switch", "travel_m", Motion::PressOnBothStops),
    ("switch", "knob_width_m", Motion::TouchFromBothSides),
    ("switch", "trough_force_N", Motion::ThrowBetweenFingers),
    ("switch", "return_trough_force_N", Motion::ThrowBetweenFingers),
    ("switch", "mass_kg", Motion::ThrowBetweenFingers),
    ("switch", "damping_N_s_m", Motion::ThrowBetweenFingers),
    ("crank", "radius_m", Motion::FullTurn),
    ("crank", "center_x_m", Motion::FullTurn),
    ("crank", "center_y_m", Motion::FullTurn),
    ("crank", "weight_N", Motion::LetGo),
    ("crank", "friction_mu", Motion::PushAndPull),
    ("crank", "coulomb_N", Motion::PushAndPull),
    ("crank", "viscous_N_s_m", Motion::OtherSpeeds),
    ("crank", "inertia_kg_m2", Motion::Accelerate),
    ("barrel", "weight_N", Motion::LetGo),
    ("barrel", "mass_kg", Motion::LetGo),
    ("barrel", "width_m", Motion::SqueezeMoreAndLess),
    ("barrel", "friction", Motion::LoosenUntilItSlides),
    ("cable", "stiffness_N_m", Motion::PullTaut),
    ("cable", "length_m", Motion::PullOtherWays),
    ("surface", "friction", Motion::SlideAlong),
    ("surface", "friction_mu", Motion::SlideAlong),
    ("body", "friction", Motion::ThrowAgain),
    ("block", "weight_N", Motion::LetGo),
    ("block", "mass_kg", Motion::LetGo),
    ("block", "width_m", Motion::SqueezeMoreAndLess),
    ("block", "height_m", Motion::SetDownAgain),
    ("block", "friction", Motion::LoosenUntilItSlides),
    ("pad", "stiffness_N_m", Motion::SqueezeMoreAndLess),
    ("pad", "shear_stiffness_N_m", Motion::LiftAndLower),
    ("", "mass_kg", Motion::ChangeSpeed),
    ("", "inertia_kg_m2", Motion::ChangeSpeed),
    ("", "viscous_N_s_m", Motion::MoveAtOtherSpeeds),
    ("", "viscous_Nm_s", Motion::MoveAtOtherSpeeds),
    ("", "coulomb_N", Motion::Reverse),
    ("", "coulomb_Nm", Motion::Reverse),
    ("", "gravity_moment_Nm", Motion::SlowlyThroughAllAngles),
    ("", "friction", Motion::LoosenUntilItSlides),
];

/// The motion that shows a parameter; `None` where there is none that is known to.
pub(super) fn shows(parameter: &Parameter, all: &[Parameter]) -> Option<Motion> {
    // The pads' give at the stops of a switch is a share that is assumed: no motion splits it.
    if parameter.object == "pad" && all.iter().any(|p| p.object == "switch") {
        return Some(Motion::NoMotion);
    }
    let kind = parameter.object.trim_end_matches(|c: char| c.is_ascii_digit() || c == '-');
    let fits = |object: &str, name: &str| (object.is_empty() || object == kind) && name == parameter.name;
    SHOWN_BY.iter().find(|(object, name, _)| fits(object, name)).map(|(_, _, motion)| *motion)
}
