//! Opening the mapping dialog, and saving its sidecar.

use crate::text::file_name::name_of;
use crate::text::sentence::sentence;
use crate::ui::files::SAVE;
use crate::ui::jobs::Jobs;
use crate::ui::mapping::state::{LOOK, Mapping, look_now};
use crate::ui::opening;
use crate::ui::session::{Session, change};
use estimator::log::write_sidecar;
use std::path::{Path, PathBuf};

/// Inspects a log in the background; the dialog opens when that is done.
pub fn look(ctx: &egui::Context, jobs: &mut Jobs<Session>, path: &Path, sidecar: Option<PathBuf>, why: Option<String>) {
    let path = path.to_path_buf();
    jobs.start(ctx, LOOK, format!("Looking at {}", name_of(&path)), move |_| {
        let looked = look_now(path, sidecar, why)?;
        change(|session, _| session.mapping = Some(Box::new(looked.into())))
    });
}

/// Writes the sidecar in the background; the log is opened with it afterwards.
pub fn save(ctx: &egui::Context, jobs: &mut Jobs<Session>, mapping: &Mapping) {
    let (meta, path, sidecar) = (mapping.draft.sidecar(), mapping.path.clone(), mapping.sidecar.clone());
    jobs.start(ctx, SAVE, "", move |_| {
        write_sidecar(&meta, &sidecar).map_err(|error| sentence(&error.to_string()))?;
        change(move |session, ctx| {
            session.mapping = None;
            session.messages.say_saved(&sidecar);
            opening::open_with(&mut session.document, &mut session.jobs, ctx, &path, Some(sidecar));
        })
    });
}
