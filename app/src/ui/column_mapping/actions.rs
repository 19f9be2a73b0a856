//! Saving the sidecar that the mapping dialog made.

use crate::text::sentence::sentence;
use crate::ui::background::jobs::Jobs;
use crate::ui::column_mapping::state::Mapping;
use crate::ui::document::files::SAVE;
use crate::ui::document::opening;
use crate::ui::session::{Session, change};
use estimator::log::write_sidecar;

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
