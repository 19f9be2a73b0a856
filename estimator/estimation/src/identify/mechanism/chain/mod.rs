//! A chain of two links with a motor at each joint: the base parameters of masses, lengths and friction that its joints
//! feel.
//!
//! The model is linear in its parameters, but not in the motion, and its accelerations would be those of noisy angles.
//! Momenta are therefore formed from lightly filtered motion. Only then everything, the torque too, goes through one
//! low-pass, after which the momenta are differentiated: a filter far below the motion's own noise costs no bias,
//! whatever its cut-off.
//!
//! Effects of real chains outside the model (belts, gears, a table that shakes) grow with frequency and shrink
//! inertias. The chosen cut-off is the one about which the answers change least (minimal sensitivity), and the changes
//! join the errors. Leaving each recording out in turn shows their agreement (jackknife: Efron & Tibshirani 1993, §11).

mod joints;
mod report;
mod solve;

use crate::identify::limits::HELD_OUT;
use foundation::estimate::{EstimateError, Fit};
use haptics::recording::Recording;
use joints::{Joints, joints};
use solve::{Solution, solve, tried};

/// Share of its motion elsewhere below which a joint is held: its holding force is not its sliding friction.
/// Choice: no case of the ablation reads it.
const HELD_SHARE: f64 = 0.05;

/// Fits one chain to all `recordings` of it together.
pub fn fit(recordings: &[Recording]) -> Result<Fit, EstimateError> {
    let mut pieces: Vec<Joints> = Vec::new();
    for (index, recording) in recordings.iter().enumerate() {
        pieces.extend(joints(recording, index)?);
    }
    let (held, warnings) = held(&pieces, recordings);
    let tried = tried(&pieces, &held)?;
    let chosen = least_sensitive(&tried).ok_or_else(|| {
        let why = "the recordings are too short for their rate to be filtered in several ways; record longer, or faster motion";
        EstimateError::Other(format!("a chain of two links could not be fitted: {why}"))
    })?;
    let best = &tried[chosen];
    let kept = |of: &dyn Fn(&solve::Row) -> bool| solve(&pieces, &held, best.cutoff_hz, of).ok();
    let left_out: Vec<Solution> = if recordings.len() < report::LEAST_FOR_JACKKNIFE {
        Vec::new()
    } else {
        (0..recordings.len()).filter_map(|r| kept(&|row| row.recording != r)).collect()
    };
    let early = kept(&|row| row.place < 1.0 - HELD_OUT);
    let late = best.rows.clone();
    let seen = report::Seen { best, neighbours: [&tried[chosen - 1], &tried[chosen + 1]], left_out: &left_out };
    let mut result = Fit { task: "mechanism".to_owned(), parameters: seen.parameters(), warnings, ..Fit::default() };
    result.quality = early.map(|early| report::quality(&early, &late, best, HELD_OUT));
    result.warnings.push(seen.how_it_was_filtered());
    Ok(result)
}

/// Joints that were held, for each recording, with a sentence for each.
fn held(pieces: &[Joints], recordings: &[Recording]) -> (Vec<[bool; 2]>, Vec<String>) {
    let most = [0, 1].map(|j: usize| pieces.iter().map(|p| p.usual_rate(j)).fold(0.0, f64::max));
    let mut held = vec![[false; 2]; recordings.len()];
    let mut warnings = Vec::new();
    for (index, (flags, recording)) in held.iter_mut().zip(recordings).enumerate() {
        for joint in 0..2 {
            let rate = pieces.iter().filter(|p| p.recording == index).map(|p| p.usual_rate(joint)).fold(0.0, f64::max);
            flags[joint] = rate <= HELD_SHARE * most[joint];
            if flags[joint] {
                warnings.push(format!(
                    "joint {} hardly moves in {}: what holds it there is not known, so its torque takes no part",
                    joint + 1,
                    recording.name
                ));
            }
        }
    }
    (held, warnings)
}

/// The solution whose neighbours in cut-off differ least from it, measured in its own values, with its errors.
fn least_sensitive(tried: &[Solution]) -> Option<usize> {
    let score = |k: usize| tried[k].changes(&tried[k - 1]) + tried[k].changes(&tried[k + 1]) + tried[k].scatter();
    (1..tried.len().saturating_sub(1)).min_by(|a, b| score(*a).total_cmp(&score(*b)))
}
