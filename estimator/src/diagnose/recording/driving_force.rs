//! Is the recorded force the one that moves the mechanism?

use crate::diagnose::data::direction::blur;
use crate::diagnose::data::limits::{CERTAIN, HALF};
use crate::diagnose::data::plain_fit::PlainFit;
use crate::diagnose::data::regression_data::{Model, Row, Track};
use crate::diagnose::selection::dry_friction::is_resisting;
use estimation::identify::mechanism;
use foundation::estimate::EstimateError;
use haptics::law::Coordinate;
use haptics::recording::Recording;
use haptics::world::MechanismPath;

/// True if the laws of a model, all positive physically, are estimated with the wrong sign: none is certainly positive,
/// and the strongest and the friction's work are certainly negative.
pub fn drives(track: &Track, model: &Model) -> Result<bool, EstimateError> {
    let mut track = track.clone();
    blur(&mut track);
    let plain = PlainFit::of(&track, &Model::new());
    let mut columns = plain.laws(model);
    // Effects that may be confused with inertia: a spring, gravity, a constant pull.
    let beside: [&dyn Fn(&Row) -> f64; 4] =
        [&|_| 1.0, &|r| r.motion.position, &|r| r.angle_rad.sin(), &|r| r.angle_rad.cos()];
    let turns = track.coordinate == Coordinate::Angular;
    columns.extend(beside[..if turns { 4 } else { 2 }].iter().map(|of| plain.rows(of)));
    let fit = plain.fit_with_errors(&columns)?;
    let sizes: Vec<f64> = (0..model.len()).map(|k| fit.values[k] / fit.std_errors[k].max(1e-300)).collect();
    let friction: f64 = (0..track.rows.len())
        .map(|i| {
            let resists = model.iter().enumerate().filter(|(_, e)| is_resisting(e));
            resists.map(|(k, _)| fit.values[k] * columns[k][i]).sum::<f64>() * track.rows[i].motion.direction
        })
        .sum();
    let [mass, others @ ..] = sizes.as_slice() else { return Ok(false) };
    // A delayed force also drives the motion, but needs no negative dry friction for that.
    let negative = |s: &f64| *s < -CERTAIN;
    Ok(friction < 0.0 && sizes.iter().all(|s| *s < CERTAIN) && (negative(mass) || others.iter().all(negative)))
}

/// One sentence if a recording is nearly a free swing, in which causes in the force show at the reversals alone.
pub fn swing(track: &Track, recordings: &[Recording], paths: &[Option<MechanismPath>]) -> Option<String> {
    let acceleration: Vec<f64> = track.along().map(|i| track.rows[i].motion.acceleration).collect();
    let of_state = |of: &dyn Fn(&Row) -> f64| track.along().map(|i| of(&track.rows[i])).collect::<Vec<f64>>();
    let columns = [
        of_state(&|r| r.motion.velocity),
        of_state(&|r| r.motion.direction),
        of_state(&|_| 1.0),
        of_state(&|r| r.angle_rad.sin()),
        of_state(&|r| r.angle_rad.cos()),
    ];
    let fit = estimation::regression::linear::least_squares_values(&columns, &acceleration, None).ok()?;
    let power = |values: &[f64]| values.iter().map(|v| v * v).sum::<f64>();
    // The closer look takes time; slow rows add noise to a swing.
    if track.coordinate == Coordinate::Linear || power(&fit.residuals) > HALF * power(&acceleration) {
        return None;
    }
    mechanism::swing(recordings, paths).ok()?
}
