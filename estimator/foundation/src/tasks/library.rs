//! The tasks of the user: JSON files in one folder, which the program names when it starts.

use super::definition::Definition;
use crate::estimate::EstimateError;
use haptics::recording::Task;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

static FOLDER: OnceLock<PathBuf> = OnceLock::new();

/// Says where the user's tasks are. The first call counts; without one there are none.
pub fn use_folder(folder: PathBuf) {
    // Later calls change nothing: a log must not be read differently from one moment to the next.
    let _ = FOLDER.set(folder);
}

/// Folder of the user's tasks.
pub fn folder() -> Option<&'static Path> {
    FOLDER.get().map(PathBuf::as_path)
}

/// True if a text can be the name of a task: it cannot leave the folder.
pub fn is_name(text: &str) -> bool {
    !text.is_empty() && text.chars().all(|c| c.is_alphanumeric() || "-_".contains(c))
}

/// Reads the user's task of a name; nothing where there is no such file.
pub fn read(folder: &Path, name: &str) -> Option<Result<Definition, EstimateError>> {
    let path = is_name(name).then(|| folder.join(format!("{name}.json"))).filter(|path| path.is_file())?;
    Some(Definition::read(&path))
}

/// The names of the user's tasks, in order.
pub fn names(folder: &Path) -> Vec<String> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut names: Vec<String> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|e| e.eq_ignore_ascii_case("json")) && path.is_file())
        .filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned()))
        .filter(|name| is_name(name))
        .collect();
    names.sort();
    names
}

/// Writes a task of the user's under its name; where it went.
pub fn save(folder: &Path, task: &Definition) -> Result<PathBuf, EstimateError> {
    let task = task.clone().checked("of the editor")?;
    if Task::from_name(&task.name).is_some() {
        return Err(EstimateError::Other(format!(
            "{} is the name of a built-in task; give yours another name",
            task.name
        )));
    }
    let path = folder.join(format!("{}.json", task.name));
    let text = serde_json::to_string_pretty(&task).map_err(|error| EstimateError::Other(error.to_string()))?;
    let written = std::fs::create_dir_all(folder).and_then(|()| haptics::text_file::write(&path, text + "\n"));
    written.map_err(|error| {
        EstimateError::Other(format!("the task cannot be written to {}: {error}; check the folder", path.display()))
    })?;
    Ok(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_saved_task_is_listed_and_read_again() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let place = folder.path().join("tasks");
        assert!(names(&place).is_empty());
        let mut task = Definition::built_in(Task::BlockStack).expect("the built-in task");
        let refused = save(&place, &task).expect_err("a built-in name").to_string();
        assert!(refused.contains("another name"), "{refused}");
        "my-lifts".clone_into(&mut task.name);
        let path = save(&place, &task).expect("saved");
        std::fs::write(place.join("broken.json"), "{").expect("written");
        assert_eq!(names(&place), ["broken", "my-lifts"]);
        assert!(path.ends_with("my-lifts.json"));
        assert_eq!(read(&place, "my-lifts").expect("there").expect("readable"), task);
        assert!(read(&place, "broken").is_some_and(|task| task.is_err()));
        assert!(read(&place, "../my-lifts").is_none() && read(&place, "none").is_none());
        "a/b".clone_into(&mut task.name);
        assert!(save(&place, &task).expect_err("leaves the folder").to_string().contains("letters"));
    }
}
