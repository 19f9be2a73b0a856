//! Residual table: RMS of every channel in every state, beside the noise.

use crate::diagnose::contract::Residual;
use crate::diagnose::data::direction::STANDS;
use crate::diagnose::data::regression_data::{Place, Track};
use crate::diagnose::selection::comparison::Study;
use crate::segment::SystemState;
use crate::signal::noise::white_noise;

/// Residuals of a comparison in each state. `state`: channel and state of a row; `None` for a row of no channel.
pub fn residuals(
    study: &Study,
    (unit, floor): (&str, Option<f64>),
    state: &dyn Fn(usize) -> Option<(&'static str, SystemState)>,
) -> Vec<Residual> {
    let (before, after) = (study.residual(&[]), study.residual(&study.picks()));
    let mut found: Vec<((&str, SystemState), [f64; 2], usize)> = Vec::new();
    for i in 0..study.y.len() {
        let Some(state) = state(i) else { continue };
        let k = found.iter().position(|(s, ..)| *s == state).unwrap_or_else(|| {
            found.push((state, [0.0; 2], 0));
            found.len() - 1
        });
        let (_, squares, rows) = &mut found[k];
        squares[0] += (study.layout.weight[i] * before[i]).powi(2);
        squares[1] += (study.layout.weight[i] * after[i]).powi(2);
        *rows += 1;
    }
    let one = |((channel, state), squares, rows): ((&str, SystemState), [f64; 2], usize)| {
        let [rms_before, rms_after] = squares.map(|s| (s / rows as f64).sqrt());
        let noise_floor = floor.filter(|floor| *floor > 0.0);
        let (channel, unit) = (channel.to_owned(), unit.to_owned());
        Residual { channel, unit, state, rows, rms_before, rms_after, noise_floor }
    };
    found.into_iter().map(one).collect()
}

/// Residuals along one coordinate, and of the paths of cranks.
pub fn of_crank_or_mechanism(
    track: &Track,
    study: &Study,
    geometries: &[Study],
    (unit, floor): (&str, f64),
) -> Vec<Residual> {
    of_force(track, study, unit, floor).into_iter().chain(geometries.iter().flat_map(of_path)).collect()
}

/// Residuals of a force along one coordinate.
fn of_force(track: &Track, study: &Study, unit: &str, floor: f64) -> Vec<Residual> {
    let state = |i: usize| {
        let row = &track.rows[i];
        match row.place {
            // A free motion has no measured force.
            Place::Along if track.freely.is_some() => Some(("force that the motion needs", SystemState::FreeMotion)),
            Place::Along if row.open > STANDS => Some(("force along the motion", SystemState::Holding)),
            Place::Along => Some(("force along the motion", SystemState::Turning)),
            Place::FreeX => Some(("horizontal force", SystemState::FreeMotion)),
            Place::FreeY => Some(("vertical force", SystemState::FreeMotion)),
            // Displacements, in newtons of the same noise.
            Place::Stuck { .. } => None,
        }
    };
    residuals(study, (unit, Some(floor)), &state)
}

/// Residuals of the path of a crank's handle.
fn of_path(study: &Study) -> Vec<Residual> {
    let floor = white_noise(&study.y);
    residuals(study, ("m", Some(floor)), &|_| Some(("distance from the circle", SystemState::Turning)))
}
