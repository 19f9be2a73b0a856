//! A barrel of unknown contents, lifted by two fingers: its weight, width and stiffness, a leak, and a cable that holds
//! it.
//!
//! All lifts of a recording are taken as lifts of one barrel. Fingers feel pad and wall in series: the wall's share shows where the
//! pads' own stiffness is stated. A leak and a drift of the sensors look alike while it hangs; the free phases before and after
//! tell them apart. The cable is searched for (`cable_force.rs`); where its pull turns as the barrel moves, it shows where it is tied.

mod cable;
mod cable_force;
mod grip_phases;
mod grip_rotation;
pub(crate) mod report;
mod sensor_zero;
mod signals;
mod slip;
mod wall_stiffness;

use crate::identify::limits::LEAST_FIT_ROWS;
use crate::segment::{Method, Segmentation};
use cable_force::{Pull, Rows};
use foundation::estimate::{EstimateError, Fit};
use foundation::tasks::Thresholds;
use grip_rotation::GripRotation;
use haptics::Vec2;
use haptics::recording::Recording;
use report::{Seen, Taken};
use sensor_zero::SensorZero;
use signals::Signals;
use wall_stiffness::Grip;

/// Fits one recording; the segmentation that was used comes with the fit.
pub fn fit_by(
    method: Method,
    recording: &Recording,
    thresholds: Option<Thresholds>,
) -> Result<(Fit, Segmentation), EstimateError> {
    let signals = Signals::of(method, recording, thresholds)?;
    let hanging: Vec<usize> = signals.hanging().iter().flat_map(|lift| signals.rows(lift)).collect();
    if hanging.len() < LEAST_FIT_ROWS {
        return Err(EstimateError::Other(format!(
            "no barrel was lifted off the floor in {}: there is nothing to weigh; check the task and the signs of the forces",
            recording.name
        )));
    }
    let known = |name: &str| recording.meta.known.get(name).copied().filter(|v| v.is_finite() && *v > 0.0);
    let grip = Grip::of(&signals, known("pad_stiffness_N_m"))?;
    let gravity = recording.meta.gravity();
    let give = grip.give_m_n();
    let [(give_x, error_x), (give_y, error_y)] = give;
    let zero = SensorZero::at(&signals, middle_s(&signals, &hanging))?;
    let usual = Vec2::new(give_x, give_y);
    let swing = GripRotation::of(&signals, &hanging, usual)?;
    let all = rows(&signals, &hanging, usual, &swing, &zero, gravity);
    let turned_m = hanging.iter().map(|i| swing.shift(*i).norm()).fold(0.0, f64::max);
    let pull = Pull::of(&all)?;
    let mut taken = Taken { pull, others: Vec::new(), turned_m, slipped_m: None, rows: hanging.len(), zero };
    if let Some(cable) = &taken.pull.cable {
        if let Some(way_m) = slip::slipped_m(&signals) {
            // The barrel was not at the fingers' place while the cable pulled: only the rows before count.
            let slack = |p: &Vec2| cable.stretch(*p).0 < -way_m.abs();
            let before = all.place_m.iter().position(|p| !slack(p)).unwrap_or(hanging.len());
            let hanging = &hanging[..before.clamp(LEAST_FIT_ROWS, hanging.len())];
            let zero = SensorZero::at(&signals, middle_s(&signals, hanging))?;
            let rows = rows(&signals, hanging, usual, &swing, &zero, gravity);
            let pull = Pull::without_cable(&rows)?;
            taken = Taken { pull, others: Vec::new(), turned_m, slipped_m: Some(way_m), rows: hanging.len(), zero };
        } else {
            // A different give of the pads changes the place of the barrel, and so the estimate of the cable.
            let pull_with = |give: Vec2, swing: &GripRotation| {
                Pull::of(&rows(&signals, &hanging, give, swing, &taken.zero, gravity))
            };
            taken.others = vec![
                pull_with(Vec2::new(give_x + error_x, give_y), &swing)?,
                pull_with(Vec2::new(give_x, give_y + error_y), &swing)?,
                pull_with(usual, &swing.higher())?,
            ];
        }
    }
    let seen = Seen {
        recording,
        signals: &signals,
        grip,
        taken,
        gravity,
        pad_n_m: known("pad_stiffness_N_m"),
        height_m: known("height_m"),
        empty_kg: known("empty_mass_kg"),
    };
    let fit = seen.report();
    Ok((fit, signals.segmentation))
}

fn middle_s(signals: &Signals, samples: &[usize]) -> f64 {
    samples.iter().map(|i| signals.time_s[*i]).sum::<f64>() / samples.len().max(1) as f64
}

/// The samples while it hangs, behind pads of this `give` along x and y, m/N for both fingers together.
fn rows(
    signals: &Signals,
    hanging: &[usize],
    give: Vec2,
    swing: &GripRotation,
    zero: &SensorZero,
    gravity: f64,
) -> Rows {
    let force = |i: &usize| signals.net_n[*i] - zero.net_n;
    Rows {
        time_s: hanging.iter().map(|i| signals.time_s[*i]).collect(),
        place_m: hanging
            .iter()
            .map(|i| signals.position[*i] - force(i).component_mul(&give) + swing.shift(*i))
            .collect(),
        velocity: hanging.iter().map(|i| signals.velocity[*i] - signals.net_rate[*i].component_mul(&give)).collect(),
        acceleration: hanging.iter().map(|i| signals.acceleration[*i]).collect(),
        force_n: hanging.iter().map(force).collect(),
        gravity,
        noise_n: signals.net_noise_n(),
        reach_s: signals.reach_s(),
    }
}
