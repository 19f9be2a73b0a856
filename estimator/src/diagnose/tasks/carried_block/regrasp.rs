//! Slip of a block in the grasp between pick-up and put-down, from the known heights of a world at the two ends of a
//! carry.

use super::signals::Seen;
use super::standing_height::Ground;
use super::stands::Stand;
use crate::diagnose::contract::{Cause, Gain, parameter};
use crate::diagnose::data::limits::{ASSUMED_ERROR, CERTAIN};
use crate::diagnose::free_run::windows::AT_ONCE;
use crate::diagnose::hypotheses::fingertip_slip;
use crate::diagnose::selection::held_out_gain::chi_square_tail;
use estimation::identify::block::signals::object;
use estimation::identify::block::slip_detection::LEAST;
use foundation::words::amount;
use haptics::law::Kind;
use haptics::world::World;

/// Slips between the two ends of each carry, largest first.
pub fn moved(ground: &Ground, seen: &[Seen<'_>], world: &World) -> Option<Cause> {
    let height = |number: usize| -> Option<(f64, f64)> {
        let block = world.blocks.get(number - 1)?;
        let stated = world.provenance.iter().find(|p| p.object == block.name && p.name == "height_m");
        Some((block.height_m, stated.and_then(|p| p.std_error).unwrap_or(ASSUMED_ERROR * block.height_m)))
    };
    let pairs = ground.stands.iter().filter(|s| s.placed).filter_map(|placed| {
        let same = |s: &&Stand| !s.placed && s.number == placed.number && s.recording == placed.recording;
        let picked = ground.stands.iter().find(same)?;
        let mut expected = 0.0;
        let mut variance = 0.0;
        // A surface that is below at both ends cancels, with its error.
        for (stand, sign) in [(placed, 1.0), (picked, -1.0)] {
            let other = if stand.placed { picked } else { placed };
            for number in stand.below.iter().filter(|n| !other.below.contains(n)) {
                let (value, error) = height(*number)?;
                expected += sign * value;
                variance += error * error;
            }
        }
        let ((after, a), (before, b)) = (ground.level(placed), ground.level(picked));
        // A block that rotates between the pads also moves their middle.
        let turns = seen[placed.recording].blocks.finger_disagreement(&picked.samples, &placed.samples);
        let error = (variance + a * a + b * b).sqrt().hypot(turns / 3.0_f64.sqrt());
        Some((after - before - expected, error, placed))
    });
    let object_m = |s: &Stand| seen[s.recording].blocks.signals.object_m();
    let (way, error, stand) = pairs
        .filter(|(way, error, stand)| way.abs() > (LEAST * object_m(stand)).max(CERTAIN * error))
        .max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()))?;
    let share = 1.0 - (error / way).powi(2);
    Some(Cause {
        id: fingertip_slip::ID.to_owned(),
        kind: Kind::Plant,
        parameters: vec![parameter("dy", way, error, "m")],
        p_value: chi_square_tail((way / error).powi(2), 1.0),
        posterior: 1.0,
        standing: None,
        gain: Gain {
            heldout_rms_before: way.abs(),
            heldout_rms_after: error,
            share_of_explainable: share,
            interval: [1.0 - (2.0 * error / way).powi(2), 1.0],
            unit: Some("m".to_owned()),
            no_rollout: Some(AT_ONCE.to_owned()),
            ..Gain::default()
        },
        evidence: format!(
            "{} was put down {} ({:.0} standard errors) from where the heights of the world have it: the fingers moved on it while \
             it was carried",
            object(stand.number),
            amount(way, "m"),
            (way / error).abs()
        ),
    })
}
