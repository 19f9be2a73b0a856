//! Processor time of a picture: layout of a panel, and tessellation of its shapes. The work of the graphics card is not
//! included.

use crate::ui::calibrate::panels::{log, parameters, results, scene, segments};
use crate::ui::calibrate::refits;
use crate::ui::diagnose::state::{Answer, StartFrom, ask, extend};
use crate::ui::document::fit_choice::FitChoice;
use crate::ui::document::prepared::Prepared;
use crate::ui::headless::screenshot;
use crate::ui::headless::screenshot::contents;
use crate::ui::kit::theme;
use crate::ui::plots::choices::LogView;
use crate::ui::session::Session;
use crate::ui::shell::app::App;
use crate::ui::shell::panel::Picture;
use crate::ui::shell::workspace::Workspace;
use crate::ui::train::trainer::live::{Clock, Operator};
use cpu_time::ThreadTime;
use egui::{Context, RawInput, Rect, UiBuilder};
use estimator::diagnose::{Progress, Worlds};
use estimator::segment::Interval;
use haptics::recording::Recording;
use std::sync::Arc;

/// From picture to picture, s.
const PICTURE_S: f64 = 1.0 / 60.0;
/// Pictures before anything is measured: layouts settle, curves are computed.
const WARM_UP: usize = 6;

/// Content that a page shows beside the log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum With {
    /// Nothing more.
    Log,
    /// The answer of a diagnosis, its extended model and replays.
    Answer,
    /// The same with the atlas in place of the curves.
    Atlas,
    /// A running servo: the scripted operator at work.
    Servo,
}

/// Picture that is measured.
#[derive(Clone, Copy)]
pub struct Subject {
    /// In words.
    pub name: &'static str,
    picture: &'static Picture,
    view: LogView,
    workspace: Workspace,
    with: With,
}

impl Subject {
    /// True when the recording must be diagnosed first.
    pub fn needs_answer(&self) -> bool {
        matches!(self.with, With::Answer | With::Atlas)
    }
}

/// Every panel that shows a recording, and the pages with a running servo.
pub static SUBJECTS: [Subject; 12] = [
    subject("log", &log::LOG),
    Subject { view: LogView::Xy, ..subject("log, XY", &log::LOG) },
    subject("segments", &segments::SEGMENTS),
    subject("parameters", &parameters::PARAMETERS),
    subject("results", &results::RESULTS),
    subject("scene", &scene::SCENE_PICTURE),
    subject("Calibrate", &screenshot::WORKBENCH),
    Subject { workspace: Workspace::Diagnose, ..subject("Diagnose, before", &screenshot::DIAGNOSE) },
    Subject { workspace: Workspace::Diagnose, with: With::Answer, ..subject("Diagnose", &screenshot::DIAGNOSE) },
    Subject { workspace: Workspace::Diagnose, with: With::Atlas, ..subject("Diagnose, atlas", &screenshot::DIAGNOSE) },
    Subject { workspace: Workspace::Train, with: With::Servo, ..subject("Train", &screenshot::TRAIN) },
    Subject { workspace: Workspace::Devices, with: With::Servo, ..subject("Devices", &screenshot::DEVICES) },
];

const fn subject(name: &'static str, picture: &'static Picture) -> Subject {
    Subject { name, picture, view: LogView::Time, workspace: Workspace::Calibrate, with: With::Log }
}

/// Processor time of a picture, s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// Half of the pictures cost less.
    pub median_s: f64,
    /// One in twenty costs more.
    pub p95_s: f64,
    /// Share of the median that cutting into triangles takes.
    pub tessellation: f64,
    /// Triangles of the last picture.
    pub triangles: usize,
}

/// Processor time of a panel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Costs {
    /// While the cursor runs.
    pub playing: Cost,
    /// While the visible time changes with every picture.
    pub zooming: Cost,
}

/// A long log with its fit, to be shown in one panel after the other.
pub struct Loaded {
    recordings: Vec<Arc<Prepared>>,
    analysis: Option<Arc<estimator::pipeline::Analysis>>,
    replays: Vec<Option<crate::ui::calibrate::replayed::Replayed>>,
    answer: Option<Arc<Answer>>,
    worlds: Option<Arc<Worlds>>,
}

impl Loaded {
    /// Repeats the recording `once` until there are `samples` samples. The fit uses one repetition: no task repeats
    /// itself so often.
    pub fn over_and_over(once: Recording, samples: usize) -> Result<Self, String> {
        let period_s = once.len() as f64 * once.rate_hz().map_or(1.0, |rate| 1.0 / rate);
        let long = repeated(&once, samples, period_s);
        let mut analysis = refits::analyse(&[Arc::new(Prepared::new(once))], &FitChoice::default())?;
        let last_s = long.time_s.as_ref().and_then(|t| t.last().copied()).unwrap_or_default();
        for segmentation in analysis.segmentations.iter_mut().flatten() {
            let states = std::mem::take(&mut segmentation.states);
            let turns = (last_s / period_s).ceil() as usize;
            let later = |turn: usize| {
                let shift_s = turn as f64 * period_s;
                states.iter().map(move |i| Interval { t0: i.t0 + shift_s, t1: i.t1 + shift_s, ..i.clone() })
            };
            segmentation.states = (0..turns).flat_map(later).filter(|i| i.t0 < last_s).collect();
        }
        let recordings = vec![Arc::new(Prepared::new(long))];
        let replays = refits::replay_all(&analysis.world, &recordings);
        Ok(Self { recordings, analysis: Some(Arc::new(analysis)), replays, answer: None, worlds: None })
    }

    /// Without a fit: for logs of which only the plots matter.
    pub fn unfitted(once: &Recording, samples: usize) -> Self {
        let period_s = once.len() as f64 * once.rate_hz().map_or(1.0, |rate| 1.0 / rate);
        let recording = repeated(once, samples, period_s);
        let recordings = vec![Arc::new(Prepared::new(recording))];
        Self { recordings, analysis: None, replays: Vec::new(), answer: None, worlds: None }
    }

    /// Diagnosed, and the model extended by what was found.
    pub fn diagnosed(once: Recording, samples: usize) -> Result<Self, String> {
        let mut loaded = Self::over_and_over(once, samples)?;
        let (choice, from) = (FitChoice::default(), StartFrom::default());
        let answer = ask(&loaded.recordings, &choice, from, Progress::default())?;
        let worlds = extend(&loaded.recordings, &choice, from, &answer)?;
        loaded.answer = Some(Arc::new(answer));
        loaded.worlds = Some(Arc::new(worlds));
        Ok(loaded)
    }

    fn session(&self, subject: Subject) -> Session {
        let mut session = Session::new();
        session.training.trainer.clock = Clock::Manual;
        session.show(self.recordings.clone());
        session.workspace = subject.workspace;
        session.plots.view = subject.view;
        session.calibration.analysis.clone_from(&self.analysis);
        session.calibration.replays.clone_from(&self.replays);
        if subject.needs_answer() {
            session.diagnosing.answer.clone_from(&self.answer);
            session.diagnosing.worlds.clone_from(&self.worlds);
            session.diagnosing.shows_atlas = subject.with == With::Atlas;
        }
        if subject.with == With::Servo {
            session.training.trainer.operator = Operator::Scripted;
        }
        session
    }

    /// Draws a panel `pictures` times each way, in a window of `size` pixels.
    pub fn measure(&self, subject: Subject, size: [u32; 2], pictures: usize) -> Costs {
        let mut stage = Stage::new(App::new(self.session(subject)), subject, size);
        let (first, last) = stage.app.session.document.view_s;
        for _ in 0..WARM_UP {
            stage.picture();
        }
        let width = last - first;
        // The servo goes on between two pictures; it has a thread of its own, so its time is not the picture's.
        let runs = |session: &mut Session| {
            if subject.with == With::Servo {
                session.training.trainer.run_unseen(PICTURE_S);
            }
        };
        let playing = stage.measure(pictures, |session, k| {
            runs(session);
            session.document.seek(first + width * k as f64 / pictures as f64);
        });
        let zooming = stage.measure(pictures, |session, k| {
            runs(session);
            let share = k as f64 / pictures as f64;
            session.document.view_s = (first + 0.3 * share * width, last - 0.5 * share * width);
        });
        Costs { playing, zooming }
    }
}

/// The recording again and again, once a period, until it has so many samples.
fn repeated(once: &Recording, samples: usize, period_s: f64) -> Recording {
    let n = once.len().max(1);
    let mut long = once.clone();
    for channel in &mut long.channels {
        channel.values =
            once.channel(&channel.name).unwrap_or_default().iter().copied().cycle().take(samples).collect();
    }
    let of_once = estimator::signal::task::times(once);
    let time = |i: usize| of_once.get(i % n).copied().unwrap_or_default() + (i / n) as f64 * period_s;
    long.time_s = Some((0..samples).map(time).collect());
    long.labels = None;
    long
}

/// A window that is never shown.
struct Stage {
    ctx: Context,
    app: App,
    contents: screenshot::Contents,
    size: egui::Vec2,
    time_s: f64,
}

impl Stage {
    fn new(app: App, subject: Subject, [width, height]: [u32; 2]) -> Self {
        let ctx = Context::default();
        theme::install(&ctx);
        let size = egui::vec2(width as f32, height as f32);
        Self { ctx, app, contents: contents(subject.picture), size, time_s: 0.0 }
    }

    /// Lays one picture out and cuts it up: both times, s, and the triangles.
    fn picture(&mut self) -> (f64, f64, usize) {
        self.time_s += PICTURE_S;
        let screen_rect = Some(Rect::from_min_size(egui::Pos2::ZERO, self.size));
        let input = RawInput { screen_rect, time: Some(self.time_s), ..RawInput::default() };
        let Self { ctx, app, contents, .. } = self;
        let begun = ThreadTime::now();
        let mut output = ctx.run_ui(input, |ui| {
            let whole = ui.ctx().content_rect();
            ui.scope_builder(UiBuilder::new().max_rect(whole), |ui| contents(ui, app));
        });
        let laid_out_s = begun.elapsed().as_secs_f64();
        // There is no card to give the letters to.
        output.textures_delta.clear();
        let begun = ThreadTime::now();
        let cut = ctx.tessellate(output.shapes, output.pixels_per_point);
        let cut_s = begun.elapsed().as_secs_f64();
        let triangles = cut.iter().map(|primitive| match &primitive.primitive {
            egui::epaint::Primitive::Mesh(mesh) => mesh.indices.len() / 3,
            egui::epaint::Primitive::Callback(_) => 0,
        });
        (laid_out_s, cut_s, triangles.sum())
    }

    fn measure(&mut self, pictures: usize, mut change: impl FnMut(&mut Session, usize)) -> Cost {
        let mut costs: Vec<(f64, f64, usize)> = Vec::with_capacity(pictures);
        for k in 0..pictures {
            change(&mut self.app.session, k);
            costs.push(self.picture());
        }
        let triangles = costs.last().map_or(0, |c| c.2);
        costs.sort_by(|a, b| (a.0 + a.1).total_cmp(&(b.0 + b.1)));
        let at = |share: f64| costs.get(((costs.len() - 1) as f64 * share) as usize).copied().unwrap_or_default();
        let (median, late) = (at(0.5), at(0.95));
        let median_s = median.0 + median.1;
        Cost { median_s, p95_s: late.0 + late.1, tessellation: median.1 / median_s.max(1e-12), triangles }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::recording::Channel;

    fn waves(n: usize) -> Recording {
        let channel = |k: usize| Channel {
            name: format!("f{k}_N"),
            unit: "N".to_owned(),
            values: (0..n).map(|i| (i as f64 * 1e-2 * k as f64).sin() + 0.1 * (i as f64 * 1.7).sin()).collect(),
        };
        let time_s = Some((0..n).map(|i| i as f64 * 1e-3).collect());
        Recording { time_s, channels: (1..=4).map(channel).collect(), ..Recording::default() }
    }

    #[test]
    fn a_picture_of_a_hundred_times_as_many_samples_has_no_more_triangles() {
        let triangles = |n: usize| {
            let costs = Loaded::unfitted(&waves(20_000), n).measure(SUBJECTS[0], [1920, 1080], 3);
            costs.playing.triangles
        };
        let (short, long) = (triangles(20_000), triangles(2_000_000));
        assert!(short > 1_000, "{short}");
        assert!(long < short + short / 5, "{short} and {long} triangles");
    }
}
