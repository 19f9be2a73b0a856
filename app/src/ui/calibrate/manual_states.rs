//! States that the user sets by hand: boundaries are moved, stretches get another state, are split and joined.
//!
//! The band shows what was set at once; the fit follows when it is made again. What is set stands in the sidecar of a saved recording.

use crate::ui::background::jobs::Jobs;
use crate::ui::calibrate::fitting;
use crate::ui::calibrate::state::Calibration;
use crate::ui::document::state::Document;
use crate::ui::session::Session;
use estimator::segment::{Interval, Segmentation, SystemState, by_hand};
use haptics::recording::{Recording, Segment, Task};
use std::sync::Arc;

/// Samples that a stretch keeps at least.
const LEAST_SAMPLES: usize = 2;

/// A change of the states of one recording.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// The boundary after an interval goes to another time, s.
    Move {
        /// The interval before it.
        interval: usize,
        /// New time of the boundary, s.
        to_s: f64,
    },
    /// An interval is of another state.
    State {
        /// Index of the interval.
        interval: usize,
        /// New state.
        state: SystemState,
    },
    /// An interval belongs to another subtask, or to none.
    Subtask {
        /// Index of the interval.
        interval: usize,
        /// The subtask.
        subtask: Option<String>,
    },
    /// An interval becomes two.
    Split {
        /// Index of the interval.
        interval: usize,
        /// Time of the split, s.
        at_s: f64,
    },
    /// An interval and the next one become one, like the first.
    Join {
        /// Index of the first of the two.
        interval: usize,
    },
}

/// True when states decide which samples a fit of this task takes.
pub fn decides(task: Task) -> bool {
    matches!(task, Task::BlockStack | Task::Barrel | Task::Crank)
}

/// The intervals after a change; `None` where it makes no sense.
pub fn changed(found: &Segmentation, times: &[f64], change: &Change) -> Option<Vec<Segment>> {
    let mut segments = by_hand::stated(found);
    let intervals = &found.states;
    match change {
        Change::Move { interval, to_s } => {
            let (before, after) = (intervals.get(*interval)?, intervals.get(interval + 1)?);
            let to = boundary(before, after, times, *to_s)?;
            segments[*interval].t1 = times[to];
            segments[interval + 1].t0 = times[to];
        }
        Change::State { interval, state } => {
            let segment = segments.get_mut(*interval)?;
            state.name().clone_into(&mut segment.state);
            // A subtask is in one state: it does not hold any more.
            segment.subtask = None;
        }
        Change::Subtask { interval, subtask } => segments.get_mut(*interval)?.subtask.clone_from(subtask),
        Change::Split { interval, at_s } => {
            let whole = intervals.get(*interval)?;
            let at = times.partition_point(|t| *t < *at_s);
            if at < whole.first + LEAST_SAMPLES || at + LEAST_SAMPLES > whole.end {
                return None;
            }
            let mut second = segments[*interval].clone();
            segments[*interval].t1 = times[at];
            second.t0 = times[at];
            segments.insert(interval + 1, second);
        }
        Change::Join { interval } => {
            let next = segments.get(interval + 1)?.t1;
            segments[*interval].t1 = next;
            segments.remove(interval + 1);
        }
    }
    Some(segments)
}

/// The sample at which the second of two intervals begins, as near to `to_s` as both keep something.
fn boundary(before: &Interval, after: &Interval, times: &[f64], to_s: f64) -> Option<usize> {
    let (least, most) = (before.first + LEAST_SAMPLES, after.end.checked_sub(LEAST_SAMPLES)?);
    (least <= most && most < times.len()).then(|| times.partition_point(|t| *t < to_s).clamp(least, most))
}

/// True when the states of the shown recording can be set by hand, and the fit then follows.
pub fn states_can_be_set(calibration: &Calibration) -> bool {
    calibration.analysis.as_ref().is_some_and(|a| decides(a.task)) && calibration.rules.is_none()
}

/// True when the fit of the shown recording does not ask for its states; it can still be of a part.
pub fn fits_without_states(document: &Document, calibration: &Calibration) -> bool {
    let clocked = document.prepared().is_some_and(|p| !p.clockless());
    clocked && calibration.analysis.as_ref().is_some_and(|a| !decides(a.task)) && calibration.rules.is_none()
}

/// Sets states of the shown recording by hand.
pub fn set_states(document: &Document, calibration: &mut Calibration, change: &Change) {
    let (Some(found), Some(prepared)) = (calibration.segmentation(document.current), document.prepared()) else {
        return;
    };
    if let Some(segments) = changed(found, &prepared.times, change) {
        calibration.choice.segments.insert(document.current, Arc::new(segments));
        show_segments(document, calibration);
    }
}

/// Restores the detected states.
pub fn forget_states(
    document: &Document,
    calibration: &mut Calibration,
    jobs: &mut Jobs<Session>,
    ctx: &egui::Context,
) {
    calibration.choice.segments.remove(&document.current);
    fitting::resegment(document, calibration, jobs, ctx);
}

/// Shows what was set by hand, before the fit has followed.
pub(crate) fn show_segments(document: &Document, calibration: &mut Calibration) {
    let (Some(prepared), Some(found)) =
        (document.prepared().cloned(), calibration.segmentation(document.current).cloned())
    else {
        return;
    };
    let Some(segments) = calibration.choice.segments.get(&document.current) else { return };
    let mut stand_in = Recording::default();
    stand_in.meta.segments.clone_from(segments);
    let mut shown = by_hand::put(found, &stand_in, &prepared.times);
    shown.score = None;
    fitting::segmented(calibration, document.current, shown);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::tests::{STACK, session};

    fn place(document: &Document, calibration: &Calibration, interval: usize) -> (f64, f64, SystemState) {
        let found = &calibration.segmentation(document.current).expect("segmented").states[interval];
        (found.t0, found.t1, found.state)
    }

    #[test]
    fn a_boundary_moves_and_the_fit_follows_it() {
        let mut session = session(STACK.clone());
        let lifted = SystemState::HoldAboveGround;
        let states = &session.calibration.segmentation(session.document.current).expect("segmented").states;
        let carry = states.iter().position(|i| i.state == lifted).expect("carried");
        let (t0, t1, _) = place(&session.document, &session.calibration, carry);
        let before =
            session.calibration.analysis.as_ref().expect("fitted").fit.parameter("block-1", "weight_N").cloned();
        set_states(
            &session.document,
            &mut session.calibration,
            &Change::Move { interval: carry, to_s: t0 + 0.5 * (t1 - t0) },
        );
        let (_, now, _) = place(&session.document, &session.calibration, carry);
        assert!(
            (now - t0 - 0.5 * (t1 - t0)).abs() < 0.02
                && session.calibration.segmentation(session.document.current).is_some_and(|s| s.by_hand)
        );
        assert_eq!(place(&session.document, &session.calibration, carry + 1).0, now, "no hole");
        let after = crate::ui::calibrate::refits::analyse(&session.document.recordings, &session.calibration.choice)
            .expect("fits");
        let (before, after) = (before.expect("weighed"), after.fit.parameter("block-1", "weight_N").cloned());
        let after = after.expect("weighed");
        assert!(after.samples < before.samples * 3 / 4, "{} of {} samples", after.samples, before.samples);
        let apart = (after.value.expect("a value") - before.value.expect("a value")).abs();
        assert!(apart < 5.0 * after.std_error.expect("an error"), "half a carry weighs the same");
    }

    #[test]
    fn a_boundary_stops_at_its_neighbours() {
        let mut session = session(STACK.clone());
        let (t0, ..) = place(&session.document, &session.calibration, 1);
        set_states(&session.document, &mut session.calibration, &Change::Move { interval: 1, to_s: -100.0 });
        let (first, end, _) = place(&session.document, &session.calibration, 1);
        assert!(first == t0 && end > t0, "{first} to {end}");
        set_states(&session.document, &mut session.calibration, &Change::Move { interval: 1, to_s: 1e9 });
        assert!(
            place(&session.document, &session.calibration, 2).1 > place(&session.document, &session.calibration, 2).0
        );
    }

    #[test]
    fn stretches_are_split_renamed_and_joined() {
        let mut session = session(STACK.clone());
        let count = session.calibration.segmentation(session.document.current).expect("segmented").states.len();
        let (t0, t1, state) = place(&session.document, &session.calibration, 0);
        set_states(&session.document, &mut session.calibration, &Change::Split { interval: 0, at_s: 0.5 * (t0 + t1) });
        set_states(
            &session.document,
            &mut session.calibration,
            &Change::State { interval: 1, state: SystemState::NoState },
        );
        assert_eq!(
            (place(&session.document, &session.calibration, 0).2, place(&session.document, &session.calibration, 1).2),
            (state, SystemState::NoState)
        );
        assert_eq!(
            session.calibration.segmentation(session.document.current).expect("segmented").states.len(),
            count + 1
        );
        set_states(&session.document, &mut session.calibration, &Change::Join { interval: 0 });
        assert_eq!(place(&session.document, &session.calibration, 0), (t0, t1, state));
        set_states(&session.document, &mut session.calibration, &Change::Split { interval: 0, at_s: t1 + 100.0 });
        assert_eq!(
            session.calibration.segmentation(session.document.current).expect("segmented").states.len(),
            count,
            "outside: nothing happens"
        );
    }
}
