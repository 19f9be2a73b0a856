//! A tool that presses on a surface: the content of the fit beside the constraint.

use crate::regression::long_run_variance::HALF_INTERVAL;
use foundation::estimate::{Constraint, ConstraintKind, Fit, Parameter};
use haptics::recording::Recording;

/// The object's name.
const SURFACE: &str = "surface";

/// The fit of recordings that all show a surface; `None` when one does not.
pub(super) fn fit(recordings: &[Recording], constraints: &[Constraint]) -> Option<Fit> {
    let all = !constraints.is_empty()
        && constraints.len() == recordings.len()
        && constraints.iter().all(|c| c.kind == ConstraintKind::Unilateral);
    if !all {
        return None;
    }
    let parameters = recordings.iter().zip(constraints).flat_map(|(r, c)| parameters(r, c)).collect();
    Some(Fit { task: "mechanism".to_owned(), parameters, constraints: constraints.to_vec(), ..Fit::default() })
}

fn parameters(recording: &Recording, found: &Constraint) -> Vec<Parameter> {
    let n = recording.len();
    let friction = match found.surface.as_ref().map(|s| (s.friction, s.friction_std_error)) {
        Some((Some(value), Some(error))) => {
            let how = "force along the surface over the push, where the tool slides";
            Parameter::identified(SURFACE, "friction", value, error, n, how)
        }
        _ => Parameter::unidentified(SURFACE, "friction", n, "the tool does not slide along the surface; let it slide"),
    };
    let seen = found.yielding.and_then(|y| Some((y, y.stiffness_n_m?)));
    let stiffness = match seen {
        // A 95 % interval of the give is the stiffness's in inverse.
        Some((interval, value)) => {
            let error = (1.0 / interval.interval_n_m.0 - 1.0 / value) / HALF_INTERVAL * value * value;
            let how = "depth over the push, hand and pad in series";
            Parameter::identified(SURFACE, "stiffness_N_m", value, error, n, how)
        }
        None => Parameter::unidentified(
            SURFACE,
            "stiffness_N_m",
            n,
            "it does not give way by more than the noise; press harder and softer to see it",
        ),
    };
    vec![friction, stiffness]
}
