//! Lessons by name or file: the built-in ones and those of the user.

use anyhow::Context as _;
use estimator::training::lesson::{Lesson, library};
use std::path::{Path, PathBuf};

/// Where a user's lessons are looked for.
pub fn own_folder() -> Option<PathBuf> {
    eframe::storage_dir("touchstone").map(|folder| folder.join("lessons"))
}

/// Every lesson in its order, and what is wrong with files of the user's. A user's lesson takes the place of a built-in one of its name.
pub fn all(folder: Option<&Path>) -> (Vec<Lesson>, Vec<String>) {
    let mut problems = Vec::new();
    let mut all = library::built_in().unwrap_or_else(|error| {
        problems.push(error.to_string());
        Vec::new()
    });
    if let Some(folder) = folder {
        let (own, wrong) = library::of_folder(folder);
        all.retain(|lesson| own.iter().all(|mine| mine.id != lesson.id));
        all.extend(own);
        problems.extend(wrong);
    }
    (library::in_order(all), problems)
}

/// The lesson of a file, or of a name.
pub fn find(text: &str) -> anyhow::Result<Lesson> {
    let path = Path::new(text);
    if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("json")) {
        return Ok(Lesson::load(path)?);
    }
    let (all, _) = all(own_folder().as_deref());
    let names: Vec<String> = all.iter().map(|lesson| lesson.id.clone()).collect();
    let found = all.into_iter().find(|lesson| lesson.id == text);
    found.with_context(|| {
        let names = names.join(", ");
        format!("there is no lesson `{text}`; name one of {names}, or a file that ends in .json (docs/lessons.md)")
    })
}
