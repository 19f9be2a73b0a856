//! A needle pushed through a sheet (thesis, 5.3.2): the sheet's stiffness, its place, and the force at which it is
//! pierced.
//!
//! Only pushes into an untouched sheet follow the loading curve: a place that was pushed in before keeps a dent, a
//! pierced one a hole. Two fingers measure their tips, not the needle between their pads. The pads' give is read from
//! the dependence of the grip's width on its force, and its uncertainty joins the errors.

pub(crate) mod channels;
pub mod loading_curve;
mod phases;
mod puncture_and_drag;
pub mod sheet;
pub mod signals;
pub mod strokes;

use foundation::estimate::{EstimateError, Fit, Parameter};
use haptics::recording::Recording;
use sheet::{LEAST_LOADING, OBJECT, Sheet};

/// Fits one recording.
pub fn fit(recording: &Recording) -> Result<Fit, EstimateError> {
    let along = signals::along(recording)?;
    let pushes = strokes::pushes(&along);
    let mut result = Fit { task: "needle".to_owned(), ..Fit::default() };
    let used = pushes.iter().map(|p| p.samples.len()).sum();
    if used < LEAST_LOADING {
        let why = "no push into an untouched sheet was seen; push the held needle in from outside";
        result.parameters = ["stiffness_N_m", "puncture_force_N", "surface_position_m"]
            .map(|n| Parameter::unidentified(OBJECT, n, used, why))
            .to_vec();
        result.warnings.push(why.to_owned());
        return Ok(result);
    }
    let sheet = Sheet::of(&along, &pushes)?;
    result.parameters = sheet.parameters(&along, &pushes, recording);
    result.constraints.push(sheet.constraint(&along, &pushes, recording));
    if pushes.iter().any(|p| p.hold != pushes[0].hold) && along.two_fingered {
        let text = "the needle was gripped anew between pushes; the surface is where the first grip met it";
        result.warnings.push(text.to_owned());
    }
    Ok(result)
}
