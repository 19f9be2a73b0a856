//! Result of a mapping: loaded in the background, a moment after the last edit.

use crate::text::sentence::sentence;
use crate::ui::background::jobs::{JobKind, Jobs, Ticket, change};
use crate::ui::column_mapping::draft::Draft;
use crate::ui::document::prepared::Prepared;
use estimator::log::{LogError, Watch};
use estimator::segment::task_of;
use estimator::signal::task::{is_two_fingered, task_signals, tip_series};
use haptics::recording::{Meta, Recording, Task};
use std::path::Path;
use std::sync::Arc;

/// Reading a log for the preview of a mapping.
pub const PREVIEW: JobKind = JobKind::new("preview");

/// Delay after an edit before the file is read again, s.
const REST_S: f64 = 0.25;

/// Content of a log, read with a sidecar.
#[derive(Debug)]
pub struct Seen {
    /// The recordings.
    pub recordings: Vec<Arc<Prepared>>,
    /// Data missing for a fit, as one sentence; `None` if it is complete.
    pub missing: Option<String>,
    /// Warnings, one sentence each.
    pub warnings: Vec<String>,
}

/// The state of the preview.
#[derive(Debug, Default)]
pub struct Preview {
    /// Result of the last reading: recordings, or the reason why there are none.
    pub seen: Option<Result<Seen, String>>,
    /// Sidecar of the last request.
    asked: Option<Meta>,
    /// Sidecar of the last frame, and the time since which it is unchanged, s.
    edited: Option<(Meta, f64)>,
}

impl Preview {
    /// Once a picture: reads the file again when the mapping has changed and rests. The answer goes to the preview that is `open` then.
    pub fn follow<T: 'static>(
        &mut self,
        ctx: &egui::Context,
        jobs: &mut Jobs<T>,
        (path, draft): (&Path, &Draft),
        open: fn(&mut T) -> Option<&mut Self>,
    ) {
        if let Some(clash) = draft.clash() {
            jobs.cancel(PREVIEW);
            (self.seen, self.asked, self.edited) = (Some(Err(clash)), Some(draft.meta.clone()), None);
            return;
        }
        let (now, meta) = (ctx.input(|i| i.time), draft.sidecar());
        if self.asked.as_ref() == Some(&meta) {
            self.edited = None;
            return;
        }
        if self.edited.as_ref().is_none_or(|(edited, _)| *edited != meta) {
            self.edited = Some((meta.clone(), now));
        }
        let rested = self.edited.as_ref().map_or(0.0, |(_, since)| now - since);
        if self.asked.is_some() && rested < REST_S {
            ctx.request_repaint_after(std::time::Duration::from_secs_f64(REST_S - rested + 0.01));
            return;
        }
        self.asked = Some(meta.clone());
        let path = path.to_path_buf();
        jobs.start(ctx, PREVIEW, "Reading for the preview", move |ticket| {
            let seen = see(&path, &meta, ticket);
            change(move |window: &mut T, _| {
                if let Some(preview) = open(window) {
                    preview.seen = Some(seen);
                }
            })
        });
    }

    /// Reads the file synchronously, for screenshots.
    pub fn read_now(&mut self, path: &Path, meta: Meta) {
        self.seen = Some(see(path, &meta, &Ticket::default()));
        self.asked = Some(meta);
    }

    /// True while the preview is older than the mapping.
    pub fn is_stale<T: 'static>(&self, jobs: &Jobs<T>) -> bool {
        self.edited.is_some() || jobs.is_running(PREVIEW) || self.asked.is_none()
    }
}

/// Reads the log with this sidecar. Reports progress, and stops when it is cancelled.
pub fn see(path: &Path, meta: &Meta, ticket: &Ticket) -> Result<Seen, String> {
    let watch = Watch { progress: &|share| ticket.tell(share), cancelled: ticket.cancelled(), preview: None };
    let recordings = estimator::log::load_with(path, meta, &watch).map_err(|error| explained(&error))?;
    let missing = recordings.first().and_then(missing);
    let mut warnings: Vec<String> = Vec::new();
    for warning in recordings.iter().flat_map(|r| &r.warnings) {
        // The sentence about missing data says so already.
        if warning.kind == estimator::log::NO_KNOWN_COLUMN || (warning.kind == "no-clock" && missing.is_some()) {
            continue;
        }
        let text = sentence(&warning.text);
        if !warnings.contains(&text) {
            warnings.push(text);
        }
    }
    warnings.extend(recordings.first().and_then(free_motion));
    let recordings = recordings.into_iter().map(|r| Arc::new(Prepared::new(r))).collect();
    Ok(Seen { recordings, missing, warnings })
}

/// Text of an error, without mention of sidecars.
fn explained(error: &LogError) -> String {
    if let LogError::MissingColumn { column, why, .. } = error {
        return sentence(&format!("`{column}` is still missing: {why}"));
    }
    sentence(&error.to_string())
}

/// Explanation for a mechanism without a recorded force.
fn free_motion(recording: &Recording) -> Option<String> {
    let coordinate = ["q_m", "q_rad"].iter().any(|q| recording.channel(q).is_some());
    let pushed = ["f_N", "tau_Nm", "fx_N"].iter().any(|f| recording.channel(f).is_some());
    let text = "There is no force: what a free motion shows is found, relative to what is known.";
    (coordinate && !pushed).then(|| text.to_owned())
}

/// Data that a recording lacks before its task can be fitted, as a sentence.
pub fn missing(recording: &Recording) -> Option<String> {
    let has = |name: &str| recording.channel(name).is_some();
    let task = match task_of(recording, None) {
        Ok(task) => task,
        Err(_) if is_two_fingered(recording) => {
            return Some(
                "Choose the task above: two fingers stack blocks, turn a crank, or carry a barrel.".to_owned(),
            );
        }
        Err(_) => {
            let text = "No column says what moved: name a coordinate (q_m or q_rad), the tool's x_m and y_m, or the \
                        fingers' x1_m, y1_m, x2_m and y2_m.";
            return Some(text.to_owned());
        }
    };
    match task {
        Task::BlockStack | Task::Barrel => task_signals(recording).err().map(|e| sentence(&e.to_string())),
        Task::Crank if is_two_fingered(recording) => task_signals(recording).err().map(|e| sentence(&e.to_string())),
        Task::Crank => match tip_series(recording, "") {
            Err(error) => Some(sentence(&error.to_string())),
            Ok(series) if series.force.is_none() => {
                Some("The forces fx_N and fy_N are missing: without them only the circle can be found.".to_owned())
            }
            Ok(_) => None,
        },
        Task::Mechanism if !has("q_m") && !has("q_rad") && !has("x_m") => Some(
            "No column says how far it moved: name a coordinate (q_m or q_rad), or the tool's x_m and y_m.".to_owned(),
        ),
        Task::Mechanism if recording.time_s.is_none() && !has("x_m") => {
            Some("There is no clock: name the time t_s, or state the rate.".to_owned())
        }
        Task::Mechanism | Task::Payload => None,
        Task::Needle | Task::Switch => {
            Some(format!("Recordings of the task {} can be looked at, not fitted yet.", task.name()))
        }
    }
}
