//! Intervals that a person has set take the place of those that a method found (`segments` of the sidecar).

use super::segmentation::{Interval, Segmentation};
use foundation::tasks::SystemState;
use haptics::recording::{Recording, Segment};

/// Puts the intervals of the recording's sidecar in the place of the found ones. Holes between them are no state.
/// Without any, or with senseless ones, the found ones stay, in the latter case with a warning.
pub fn put(mut found: Segmentation, recording: &Recording, time_s: &[f64]) -> Segmentation {
    let stated = &recording.meta.segments;
    if stated.is_empty() {
        return found;
    }
    match intervals(stated, &found, time_s) {
        Ok(states) => {
            found.states = states;
            found.by_hand = true;
            found.posterior = None;
        }
        Err(problem) => found.warnings.push(format!("the segments of the sidecar were not used: {problem}")),
    }
    found
}

/// Segments of a segmentation as a sidecar states them.
pub fn stated(found: &Segmentation) -> Vec<Segment> {
    let of =
        |i: &Interval| Segment { t0: i.t0, t1: i.t1, state: i.state.name().to_owned(), subtask: i.subtask.clone() };
    found.states.iter().map(of).collect()
}

fn intervals(stated: &[Segment], found: &Segmentation, time_s: &[f64]) -> Result<Vec<Interval>, String> {
    let told = found.per_sample(time_s.len());
    let at = |t: f64| time_s.partition_point(|s| *s < t - 1e-9 * t.abs().max(1e-3));
    let mut states: Vec<Interval> = Vec::with_capacity(stated.len());
    let mut end = 0;
    for segment in stated {
        let state = SystemState::ALL
            .into_iter()
            .find(|s| s.name() == segment.state)
            .ok_or_else(|| format!("there is no state `{}`", segment.state))?;
        if !(segment.t0.is_finite() && segment.t1.is_finite() && segment.t0 <= segment.t1) {
            return Err(format!("one of them goes from {} to {} s", segment.t0, segment.t1));
        }
        // The last one goes up to the last sample.
        let last = time_s.last().is_some_and(|t| segment.t1 >= *t);
        let (first, until) = (at(segment.t0), if last { time_s.len() } else { at(segment.t1) });
        if first < end {
            return Err(format!("they overlap at {} s", segment.t0));
        }
        if first > end {
            states.push(interval(time_s, &told, end, first, SystemState::NoState, None));
        }
        if until > first {
            states.push(interval(time_s, &told, first, until, state, segment.subtask.clone()));
        }
        end = end.max(until);
    }
    if end == 0 {
        return Err("none of them lies in the recording".to_owned());
    }
    if end < time_s.len() {
        states.push(interval(time_s, &told, end, time_s.len(), SystemState::NoState, None));
    }
    Ok(states)
}

fn interval(
    time_s: &[f64],
    told: &[SystemState],
    first: usize,
    end: usize,
    state: SystemState,
    subtask: Option<String>,
) -> Interval {
    let agreeing = told[first..end].iter().filter(|s| **s == state).count();
    Interval {
        t0: time_s[first],
        t1: time_s.get(end).or(time_s.last()).copied().unwrap_or(0.0),
        state,
        subtask,
        probability: agreeing as f64 / (end - first).max(1) as f64,
        first,
        end,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::segment::subtasks;
    use foundation::tasks::Thresholds;
    use foundation::tasks::definition::Definition;
    use haptics::recording::Task;

    fn clock() -> Vec<f64> {
        (0..1_000).map(|i| 0.01 * f64::from(i)).collect()
    }

    fn found() -> Segmentation {
        let raw: Vec<SystemState> = (0..1_000)
            .map(|i| if (200..800).contains(&i) { SystemState::Turning } else { SystemState::FreeMotion })
            .collect();
        let task = Definition::built_in(Task::Crank).expect("built in");
        let thresholds = Thresholds { velocity_m_s: 0.01, force_n: 0.1 };
        subtasks::assemble(&clock(), &raw, &task, thresholds, Vec::new(), None)
    }

    fn given(segments: Vec<Segment>) -> Segmentation {
        let mut recording = Recording { time_s: Some(clock()), ..Recording::default() };
        recording.meta.segments = segments;
        put(found(), &recording, &clock())
    }

    fn segment(t0: f64, t1: f64, state: &str) -> Segment {
        Segment { t0, t1, state: state.to_owned(), subtask: None }
    }

    #[test]
    fn what_was_found_goes_out_and_comes_in_again_unchanged() {
        let before = found();
        let after = given(stated(&before));
        assert!(after.by_hand && after.warnings == before.warnings);
        let places = |s: &Segmentation| s.states.iter().map(|i| (i.first, i.end, i.state)).collect::<Vec<_>>();
        assert_eq!(places(&after), places(&before));
    }

    #[test]
    fn a_boundary_moves_and_holes_are_no_state() {
        let after = given(vec![segment(0.0, 3.0, "free-motion"), segment(4.0, 9.99, "turning")]);
        let places: Vec<_> = after.states.iter().map(|i| (i.first, i.end, i.state)).collect();
        let (free, hole, turning) = (SystemState::FreeMotion, SystemState::NoState, SystemState::Turning);
        assert_eq!(places, [(0, 300, free), (300, 400, hole), (400, 1_000, turning)]);
        assert!((after.states[0].probability - 2.0 / 3.0).abs() < 0.01, "a third of it was told otherwise");
    }

    #[test]
    fn nonsense_is_said_and_left_out() {
        for bad in [
            vec![segment(0.0, 3.0, "flying")],
            vec![segment(3.0, 1.0, "turning")],
            vec![segment(0.0, f64::NAN, "turning")],
            vec![segment(0.0, 3.0, "turning"), segment(2.0, 4.0, "turning")],
        ] {
            let after = given(bad.clone());
            assert!(!after.by_hand && after.states == found().states, "{bad:?}");
            assert!(after.warnings.iter().any(|w| w.contains("were not used")), "{bad:?}");
        }
    }
}
