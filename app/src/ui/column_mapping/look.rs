//! Opening the mapping dialog on a log.

use crate::text::file_name::name_of;
use crate::ui::background::jobs::Jobs;
use crate::ui::column_mapping::state::{LOOK, look_now};
use crate::ui::session::{Session, change};
use std::path::{Path, PathBuf};

/// Inspects a log in the background; the dialog opens when that is done.
pub fn look(ctx: &egui::Context, jobs: &mut Jobs<Session>, path: &Path, sidecar: Option<PathBuf>, why: Option<String>) {
    let path = path.to_path_buf();
    jobs.start(ctx, LOOK, format!("Looking at {}", name_of(&path)), move |_| {
        let looked = look_now(path, sidecar, why)?;
        change(|session, _| session.mapping = Some(Box::new(looked.into())))
    });
}
