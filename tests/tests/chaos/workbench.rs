//! The workbench without its window: spoiled logs and projects opened over each other, fits as jobs, cancelled and begun again, work kept
//! on the way. At the end the good log still opens and is fitted.

use crate::{Chaos, logs, must_be_a_sentence};
use app::ui::calibrate::fitting;
use app::ui::calibrate::refits::FIT;
use app::ui::document::autosave::{Autosave, State as Kept};
use app::ui::document::project_files::project_of;
use app::ui::document::{opening, project_files, undo_actions};
use app::ui::session::Session;
use app::ui::shell::dispatch;
use app::ui::shell::dock::arrangement::Dock;
use app::ui::shell::message_list::Tone;
use rand::RngExt as _;
use std::path::Path;
use std::time::{Duration, Instant};
use tests::workspace;

/// Things that a user does a lap.
const DEEDS: usize = 14;

/// A frame without a picture.
fn frame(ctx: &egui::Context, session: &mut Session) {
    ctx.begin_pass(egui::RawInput::default());
    dispatch::poll(session, ctx);
    // Nobody draws: what would go to a graphics card is let go.
    ctx.end_pass().textures_delta.clear();
}

/// Frames until nothing is being done any more.
fn settle(ctx: &egui::Context, session: &mut Session) {
    let begun = Instant::now();
    let mut quiet = 0;
    while quiet < 3 {
        assert!(begun.elapsed() < Duration::from_mins(2), "a job never ends: {:?}", session.jobs.progress());
        frame(ctx, session);
        quiet = if session.jobs.is_busy() { 0 } else { quiet + 1 };
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn take_messages(session: &mut Session, path: &Path) {
    for banner in session.messages.banners.drain(..) {
        if banner.tone == Tone::Error {
            must_be_a_sentence(&banner.text, path);
        }
    }
}

/// A workbench that keeps its work.
pub struct Bench {
    pub ctx: egui::Context,
    pub session: Session,
    dock: Dock,
    autosave: Autosave,
}

impl Bench {
    pub fn open(kept_in: &Path) -> Self {
        let (autosave, _) = Autosave::begin(kept_in).expect("a folder of its own");
        Self { ctx: egui::Context::default(), session: Session::new(), dock: Dock::default(), autosave }
    }

    /// One thing that a user does, with a log that somebody has spoiled.
    pub fn deed(&mut self, chaos: &mut Chaos, folder: &Path, number: usize) {
        let Self { ctx, session, dock, autosave } = self;
        let path = logs::spoil(folder, &format!("log-{number}"), &mut chaos.rng);
        match chaos.rng.random_range(0..6) {
            0 => project_files::add_log(session, ctx, &path),
            1 => undo_actions::undo(
                &mut session.document,
                &mut session.calibration,
                &mut session.plots,
                &mut session.messages,
            ),
            2 => fitting::refit(&session.document, &mut session.calibration, &mut session.jobs, ctx),
            3 => session.jobs.cancel(FIT),
            4 => spoiled_project(chaos, session, ctx, &path),
            _ => opening::open_any(
                &mut session.document,
                &mut session.wanted_pane,
                &mut session.messages,
                &mut session.jobs,
                ctx,
                &path,
            ),
        }
        // Some are still at work when the next comes.
        (0..chaos.rng.random_range(0..4)).for_each(|_| frame(ctx, session));
        let _ = autosave.follow(ctx, session, dock, true);
        if chaos.rng.random_range(0..3) == 0 {
            settle(ctx, session);
        }
        take_messages(session, &path);
        chaos.count("deeds at the workbench", 1);
    }

    /// After all that a good log is fitted.
    pub fn must_fit(&mut self, chaos: &mut Chaos) {
        let Self { ctx, session, .. } = self;
        settle(ctx, session);
        opening::open(&mut session.document, &mut session.jobs, ctx, &workspace().join("assets/recordings/crank.csv"));
        settle(ctx, session);
        assert!(
            session.calibration.analysis.is_some(),
            "after all that a good log is fitted: {:?}",
            session.calibration.fit_problem
        );
        chaos.count("fits that answered", 1);
    }
}

pub fn jobs(chaos: &mut Chaos) {
    let folder = chaos.scratch();
    let kept_in = folder.path().join("kept");
    let mut bench = Bench::open(&kept_in);
    for number in 0..DEEDS {
        bench.deed(chaos, folder.path(), number);
    }
    bench.must_fit(chaos);
    // Killed here: the lock goes, the file says what was open.
    let Bench { session, dock, mut autosave, .. } = bench;
    autosave.end(&session, &dock, true);
    drop(autosave);
    let (_, Kept { project, .. }) = Autosave::begin(&kept_in).expect("the next start");
    assert_eq!(
        project,
        project_of(session.workspace, &session.document, &session.calibration, &session.plots),
        "what was open is found"
    );
}

fn spoiled_project(chaos: &mut Chaos, session: &mut Session, ctx: &egui::Context, log: &Path) {
    let path = log.with_extension("touchstone.json");
    project_files::save_project_as(session, ctx, path.clone());
    if let Ok(text) = std::fs::read(&path) {
        std::fs::write(&path, tests::spoiled::bytes(&text, &mut chaos.rng)).expect("writes");
    }
    project_files::open_project(&mut session.document, &mut session.messages, &mut session.jobs, ctx, &path);
}
