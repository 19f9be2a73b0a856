//! Recordings laid over each other: which, and how far each is shifted in time.

use crate::ui::background::jobs::{JobKind, Jobs};
use crate::ui::calibrate::state::Calibration;
use crate::ui::document::prepared::{Prepared, Trace};
use crate::ui::document::state::Document;
use crate::ui::plots::choices::{Overlaid, PlotChoices};
use crate::ui::plots::shift::Likeliest;
use crate::ui::session::{Session, change};
use crate::ui::shell::message_list::Messages;
use estimator::segment::SystemState;
use estimator::signal::lag::lag;
use std::sync::Arc;

/// Finding the place of a recording on another one.
pub const ALIGN: JobKind = JobKind::new("align");

/// Quantities that tell best where two recordings match, the best first: forces rise and fall with every contact.
const TELLING: [&str; 5] = ["Task signals", "Force", "Torque", "Position", "Angle"];
/// Less alike than this is not alike.
const LEAST_LIKENESS: f64 = 0.3;

/// Lays a recording over the shown one, or takes it away.
pub fn toggle_overlay(plots: &mut PlotChoices, recording: usize) {
    let overlaid = &mut plots.overlaid;
    match overlaid.iter().position(|o| o.recording == recording) {
        Some(place) => drop(overlaid.remove(place)),
        None => overlaid.push(Overlaid { recording, offset_s: 0.0 }),
    }
}

/// Shifts a recording that lies over the shown one.
pub fn shift_overlay(plots: &mut PlotChoices, recording: usize, offset_s: f64) {
    if let Some(overlaid) = plots.overlaid.iter_mut().find(|o| o.recording == recording) {
        overlaid.offset_s = offset_s;
    }
}

/// Shifts a recording to where it is most like the shown one, in the background.
pub fn align(document: &Document, jobs: &mut Jobs<Session>, ctx: &egui::Context, recording: usize) {
    let (Some(fixed), Some(moved)) = (document.prepared().cloned(), document.recordings.get(recording).cloned()) else {
        return;
    };
    jobs.start(ctx, ALIGN, "Laying recordings over each other", move |_| {
        let found = most_alike(&fixed, &moved);
        change(move |session, _| aligned(&mut session.plots, &mut session.messages, recording, found))
    });
}

/// Looks in the background where a recording is most like the shown one, once: there it comes to rest when it is shifted by hand.
pub fn find_likeliest(
    document: &Document,
    jobs: &mut Jobs<Session>,
    ctx: &egui::Context,
    likeliest: &Likeliest,
    recording: usize,
) {
    let pair = (document.current, recording);
    let (Some(fixed), Some(moved)) = (document.prepared().cloned(), document.recordings.get(recording).cloned()) else {
        return;
    };
    if likeliest.contains_key(&pair) || jobs.is_running(ALIGN) {
        return;
    }
    // Known only once the answer is here: a search that was cancelled is begun again by the next hand on the curve.
    jobs.start(ctx, ALIGN, "Comparing recordings", move |_| {
        let found = most_alike(&fixed, &moved).ok();
        change(move |session, _| {
            session.plots.likeliest.insert(pair, found);
        })
    });
}

pub(crate) fn aligned(plots: &mut PlotChoices, messages: &mut Messages, recording: usize, found: Result<f64, String>) {
    match found {
        Ok(offset_s) => shift_overlay(plots, recording, offset_s),
        Err(problem) => messages.fail(problem),
    }
}

/// Time of the first contact in a recording, s; `None` where its states are not known.
pub fn first_contact_s(calibration: &Calibration, recording: usize) -> Option<f64> {
    let states = &calibration.analysis.as_ref()?.segmentations.get(recording)?.as_ref()?.states;
    let apart = |state| matches!(state, SystemState::FreeMotion | SystemState::NoState);
    states.iter().find(|i| !apart(i.state)).map(|i| i.t0)
}

/// Shifts a recording so that its first contact is at that of the shown one; false where one of them is not known.
pub fn align_by_contact(
    document: &Document,
    calibration: &Calibration,
    plots: &mut PlotChoices,
    recording: usize,
) -> bool {
    let both = first_contact_s(calibration, document.current).zip(first_contact_s(calibration, recording));
    if let Some((here, there)) = both {
        shift_overlay(plots, recording, here - there);
    }
    both.is_some()
}

/// Shift of the times of `moved`, s, by correlation of the most telling signal that both have.
fn most_alike(fixed: &Arc<Prepared>, moved: &Arc<Prepared>) -> Result<f64, String> {
    let values = |prepared: &Prepared, trace: &Trace| -> Vec<f64> {
        let samples = trace.levels.samples(&prepared.recording);
        (0..samples.len()).map(|i| samples.value(i)).collect()
    };
    for title in TELLING {
        for group in fixed.groups.iter().filter(|g| g.title == title) {
            let Some(same) = moved.groups.iter().find(|g| g.key() == group.key()) else { continue };
            for trace in &group.traces {
                let Some(other) = same.traces.iter().find(|t| t.name == trace.name) else { continue };
                let (a, b) = (values(fixed, trace), values(moved, other));
                if let Some(found) = lag((&fixed.times, &a), (&moved.times, &b)).filter(|l| l.likeness > LEAST_LIKENESS)
                {
                    return Ok(found.offset_s);
                }
            }
        }
    }
    Err(format!(
        "{} and {} have no signal in which they are alike; shift one of them by hand.",
        fixed.recording.name, moved.recording.name
    ))
}
