//! Corrections of the sidecar that a warning suggests.

use crate::text::sentence::sentence;
use crate::ui::background::jobs::Jobs;
use crate::ui::document::files::SAVE;
use crate::ui::document::opening;
use crate::ui::document::state::Document;
use crate::ui::session::{Session, change};
use estimator::log::{put_suggested, sidecar_path};
use haptics::recording::Suggested;
use std::path::Path;

/// Puts entries into the sidecar of the open log in the background; the log is opened with it afterwards.
pub fn correct(document: &Document, jobs: &mut Jobs<Session>, ctx: &egui::Context, entries: &Suggested) {
    let Some(log) = document.path.clone() else { return };
    let sidecar = document.meta.clone().unwrap_or_else(|| sidecar_path(&log));
    let entries = entries.clone();
    jobs.start(ctx, SAVE, "", move |_| {
        put_into(&sidecar, &entries)?;
        change(move |session, ctx| {
            session.messages.say_saved(&sidecar);
            opening::open_with(&mut session.document, &mut session.jobs, ctx, &log, Some(sidecar));
        })
    });
}

/// Joins entries with those of a sidecar, which need not exist; an entry of null takes its key out. An error is a sentence.
fn put_into(sidecar: &Path, entries: &Suggested) -> Result<(), String> {
    let failed = |error: String| sentence(&format!("the sidecar cannot be changed ({error}): {}", sidecar.display()));
    let mut whole: Suggested = match haptics::text_file::read(sidecar) {
        Ok(text) => serde_json::from_str(text.trim_start_matches('\u{feff}')).map_err(|e| failed(e.to_string()))?,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Suggested::new(),
        Err(error) => return Err(failed(error.to_string())),
    };
    put_suggested(entries, &mut whole);
    whole.retain(|key, value| !value.is_null() || !entries.contains_key(key));
    let text = serde_json::to_string_pretty(&whole).map_err(|e| failed(e.to_string()))?;
    haptics::text_file::write(sidecar, text + "\n").map_err(|e| failed(e.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_correction_keeps_the_sidecar_and_spares_a_broken_one() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let sidecar = folder.path().join("a.meta.json");
        let entries = json!({ "scale": { "t_s": 0.001 } }).as_object().cloned().expect("entries");
        put_into(&sidecar, &entries).expect("made");
        std::fs::write(&sidecar, r#"{"task": "crank", "scale": {"t_s": 2}}"#).expect("writable");
        put_into(&sidecar, &entries).expect("joined");
        let text = std::fs::read_to_string(&sidecar).expect("readable");
        let joined: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        assert_eq!(joined, json!({ "task": "crank", "scale": { "t_s": 0.002 } }));
        let none = json!({ "task": null }).as_object().cloned().expect("entries");
        put_into(&sidecar, &none).expect("taken out");
        let text = std::fs::read_to_string(&sidecar).expect("readable");
        assert!(!text.contains("task") && text.contains("scale"), "{text}");
        std::fs::write(&sidecar, "{").expect("writable");
        assert!(put_into(&sidecar, &entries).is_err_and(|why| why.contains("cannot be changed")));
        assert_eq!(std::fs::read_to_string(&sidecar).expect("readable"), "{");
    }
}
