//! Blocks that never leave the ground. While a finger drags one along, noise and friction lift a little of its weight,
//! which looks like a carry to a threshold of a few hundredths of a newton.

use super::threshold::percentile;
use foundation::signal::task::TaskSignals;
use foundation::tasks::{SystemState, Thresholds};

/// Tips so far above the lowest ones have lifted the block, as a share of its size.
pub const LIFTED: f64 = 0.1;
/// Time of a lift from which it is a carry, s.
pub const LIFTED_S: f64 = 0.3;
/// Least travel of the tips back and forth, while they hold a block, for it to be slid, as a share of its size.
const SLID: f64 = 0.25;
/// Least share of the time for which it stands on the ground at that very height.
const GROUNDED_SHARE: f64 = 0.2;

/// Puts blocks that were never lifted back on the ground, in a recording in which a block is slid.
pub fn put_down(signals: &TaskSignals, thresholds: &Thresholds, states: &mut [SystemState]) {
    use SystemState::{HoldAboveGround, HoldOnGround, SlidingOnGround};
    let held: Vec<usize> =
        (0..states.len()).filter(|i| matches!(states[*i], HoldOnGround | HoldAboveGround | SlidingOnGround)).collect();
    let (Some(first), Some(last)) = (signals.time_s.first(), signals.time_s.last()) else { return };
    let grounded = held.iter().filter(|i| states[**i] != HoldAboveGround).count();
    if grounded == held.len() {
        return;
    }
    let step_s = (last - first) / signals.len().max(2) as f64;
    let mut heights: Vec<f64> = held.iter().map(|i| signals.position[*i].y).collect();
    let ground_m = percentile(&mut heights, 0.05);
    let mut places: Vec<f64> = held.iter().map(|i| signals.position[*i].x).collect();
    let way_m = percentile(&mut places, 0.95) - percentile(&mut places, 0.05);
    let object_m = signals.object_m();
    let above_m = ground_m + LIFTED * object_m;
    let lifted = held.iter().filter(|i| signals.position[**i].y > above_m).count();
    let stays = (lifted as f64) * step_s < LIFTED_S && grounded as f64 > GROUNDED_SHARE * held.len() as f64;
    if !stays || way_m < SLID * object_m {
        return;
    }
    for i in held.into_iter().filter(|i| signals.position[*i].y <= above_m) {
        if states[i] == HoldAboveGround {
            let slides = signals.velocity[i].x.abs() > thresholds.velocity_m_s;
            states[i] = if slides { SlidingOnGround } else { HoldOnGround };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::segment::segment_by;
    use crate::segment::segmentation::Method;
    use haptics::recording::{Channel, Recording, Task};

    /// Two fingers hold a block and slide it back and forth, lifting a little of its weight now and then. `lift_m`:
    /// height to which it is carried in the middle of the recording.
    fn slid(lift_m: f64) -> Recording {
        let time: Vec<f64> = (0..3000).map(|i| f64::from(i) * 5e-3).collect();
        let held = |t: f64| if (1.0..14.0).contains(&t) { 1.0 } else { 0.0 };
        let up = |t: f64| if (6.0..9.0).contains(&t) { ((t - 6.0).min(9.0 - t) / 0.5).min(1.0) } else { 0.0 };
        let hum = |t: f64, k: f64| 0.01 * (97.0 * k * t).sin();
        let lift = |t: f64| {
            let carried = if lift_m > 0.0 { up(t) } else { 0.0 };
            held(t) * (0.15 * (0.9 * t).sin() * (1.0 - carried) + 1.2 * carried)
        };
        let column = |of: &dyn Fn(f64) -> f64| time.iter().map(|t| of(*t)).collect::<Vec<f64>>();
        let middle = |t: f64| 0.02 * (1.5 * t).sin();
        let channels = [
            ("x1_m", column(&|t| middle(t) - 0.012 - 0.008 * (1.0 - held(t)))),
            ("x2_m", column(&|t| middle(t) + 0.012 + 0.008 * (1.0 - held(t)))),
            ("y1_m", column(&|t| 0.02 + lift_m * up(t))),
            ("y2_m", column(&|t| 0.02 + lift_m * up(t))),
            ("fx1_N", column(&|t| 2.0 * held(t) + hum(t, 1.0))),
            ("fx2_N", column(&|t| -2.0 * held(t) + hum(t, 1.3))),
            ("fy1_N", column(&|t| 0.5 * lift(t) + hum(t, 1.7))),
            ("fy2_N", column(&|t| 0.5 * lift(t) + hum(t, 2.1))),
        ];
        let channel = |(name, values): (&str, Vec<f64>)| Channel {
            name: name.to_owned(),
            unit: name.rsplit('_').next().unwrap_or_default().to_owned(),
            values,
        };
        Recording {
            name: "slid".to_owned(),
            time_s: Some(time),
            channels: channels.into_iter().map(channel).collect(),
            ..Recording::default()
        }
    }

    #[test]
    fn what_never_leaves_the_ground_is_not_carried_and_what_does_is() {
        for method in [Method::Threshold, Method::Hmm] {
            let above = |lift_m: f64| {
                let found = segment_by(method, &slid(lift_m), Some(Task::BlockStack), None).expect("segments");
                let above = found.states.iter().filter(|s| s.state == SystemState::HoldAboveGround);
                above.map(|s| s.t1 - s.t0).sum::<f64>()
            };
            assert!(above(0.0) == 0.0, "{method:?}: {} s in the air", above(0.0));
            assert!(above(0.03) > 2.0, "{method:?}: {} s in the air", above(0.03));
        }
    }

    #[test]
    fn a_block_that_is_slid_only_is_not_fitted_as_carried() {
        let said = crate::identify::block::fit(&slid(0.0), None).err().map(|e| e.to_string()).unwrap_or_default();
        assert!(said.contains("never lifted"), "{said}");
    }
}
