//! `--task`: a built-in task, one of the user's, or a file.

use anyhow::bail;
use estimator::segment::definition::Definition;
use haptics::recording::{Recording, Task};
use std::path::{Path, PathBuf};

/// What `--task` names.
pub enum Chosen {
    /// A built-in task.
    BuiltIn(Task),
    /// A task of the user's.
    Own(Box<Definition>),
}

impl Chosen {
    /// Finds a task by name or file. A file in the user's folder comes before a built-in task of its name.
    pub fn find(text: &str) -> anyhow::Result<Self> {
        Self::find_in(text, folder().as_deref())
    }

    fn find_in(text: &str, folder: Option<&Path>) -> anyhow::Result<Self> {
        let is_file = Path::new(text).extension().is_some_and(|e| e.eq_ignore_ascii_case("json"));
        if is_file {
            return Ok(Self::Own(Box::new(Definition::read(Path::new(text))?)));
        }
        let plain = !text.is_empty() && text.chars().all(|c| c.is_alphanumeric() || "-_".contains(c));
        let own = folder.filter(|_| plain).map(|f| f.join(format!("{text}.json"))).filter(|path| path.is_file());
        if let Some(path) = own {
            return Ok(Self::Own(Box::new(Definition::read(&path)?)));
        }
        if let Some(task) = Task::from_name(text) {
            return Ok(Self::BuiltIn(task));
        }
        let known = Task::ALL.map(Task::name).join(", ");
        let place = folder.map_or_else(String::new, |f| format!(" or in {}", f.display()));
        bail!(
            "there is no task `{text}` among {known}{place}; name one of these, or a file that ends in .json (docs/tasks.md)"
        )
    }

    /// Makes a recording one of this task.
    pub fn give_to(&self, recording: &mut Recording) {
        match self {
            Self::BuiltIn(task) => recording.meta.task = Some(*task),
            Self::Own(task) => task.give_to(recording),
        }
    }
}

/// The folder of the user's tasks.
fn folder() -> Option<PathBuf> {
    eframe::storage_dir("touchstone").map(|folder| folder.join("tasks"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_users_file_comes_before_the_built_in_task_and_names_cannot_leave_the_folder() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        assert!(matches!(Chosen::find_in("crank", Some(folder.path())), Ok(Chosen::BuiltIn(Task::Crank))));
        let mut own = Definition::built_in(Task::Crank).expect("the built-in task");
        own.title = "Mine".to_owned();
        let file = folder.path().join("crank.json");
        std::fs::write(&file, serde_json::to_string(&own).expect("text")).expect("written");
        let found = Chosen::find_in("crank", Some(folder.path())).expect("found");
        assert!(matches!(found, Chosen::Own(task) if task.title == "Mine"));
        for text in ["no-such", "../crank", ""] {
            let Err(error) = Chosen::find_in(text, Some(folder.path())) else { panic!("{text} was found") };
            assert!(error.to_string().contains("there is no task"), "{error}");
        }
    }
}
