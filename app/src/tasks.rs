//! The tasks on offer: the built-in ones and those of the user, by name or from a file.

use anyhow::bail;
use estimator::segment::definition::{Definition, SIDECAR_KEY};
use estimator::segment::library;
use haptics::recording::{Recording, Task};
use std::path::{Path, PathBuf};

/// What a name or a file stands for.
#[derive(Clone, Debug)]
pub enum Chosen {
    /// A built-in task.
    BuiltIn(Task),
    /// A task of the user's.
    Own(Box<Definition>),
}

impl Chosen {
    /// Finds a task by name or file. A file in the user's folder comes before a built-in task of its name.
    pub fn find(text: &str) -> anyhow::Result<Self> {
        Self::find_in(text, library::folder())
    }

    fn find_in(text: &str, folder: Option<&Path>) -> anyhow::Result<Self> {
        let is_file = Path::new(text).extension().is_some_and(|e| e.eq_ignore_ascii_case("json"));
        if is_file {
            return Ok(Self::Own(Box::new(Definition::read(Path::new(text))?)));
        }
        if let Some(own) = folder.and_then(|folder| library::read(folder, text)) {
            return Ok(Self::Own(Box::new(own?)));
        }
        if let Some(task) = Task::from_name(text) {
            return Ok(Self::BuiltIn(task));
        }
        let known = Task::ALL.map(Task::name).join(", ");
        let own = folder.map(library::names).filter(|names| !names.is_empty());
        let own = own.map_or_else(String::new, |names| format!(" and yours ({})", names.join(", ")));
        let place = folder.map_or_else(String::new, |f| format!("; yours are in {}", f.display()));
        bail!(
            "there is no task `{text}` among {known}{own}; name one of these, or a file that ends in .json (docs/tasks.md){place}"
        )
    }

    /// Makes a recording one of this task.
    pub fn give_to(&self, recording: &mut Recording) {
        match self {
            Self::BuiltIn(task) => {
                // A task of its own that travels with the recording must not stand in for the one that was asked for.
                recording.meta.other.remove(SIDECAR_KEY);
                recording.meta.task = Some(*task);
            }
            Self::Own(task) => task.give_to(recording),
        }
    }

    /// The built-in task that it is or is like.
    pub fn like(&self) -> Task {
        match self {
            Self::BuiltIn(task) => *task,
            Self::Own(task) => task.like,
        }
    }

    /// Its name in files.
    pub fn name(&self) -> &str {
        match self {
            Self::BuiltIn(task) => task.name(),
            Self::Own(task) => &task.name,
        }
    }

    /// The user's own definition, where it is one.
    pub fn own(&self) -> Option<&Definition> {
        match self {
            Self::BuiltIn(_) => None,
            Self::Own(task) => Some(task),
        }
    }
}

/// Names the user's folder, in which tasks are looked for from now on; once, when the program starts.
pub fn use_own_folder() {
    if let Some(folder) = own_folder() {
        library::use_folder(folder);
    }
}

fn own_folder() -> Option<PathBuf> {
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
        assert!(found.own().is_some_and(|task| task.title == "Mine"));
        for text in ["no-such", "../crank", ""] {
            let Err(error) = Chosen::find_in(text, Some(folder.path())) else { panic!("{text} was found") };
            assert!(error.to_string().contains("there is no task"), "{error}");
            assert!(error.to_string().contains("yours (crank)"), "{error}");
        }
    }
}
