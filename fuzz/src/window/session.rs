//! Any bytes as the kept state of a window, and as a project: read, or put aside and said.

use app::ui::document::autosave::{Autosave, State};
use app::ui::document::project::Project;

pub fn run(bytes: &[u8]) {
    let path = crate::targets::file("session.json");
    std::fs::write(&path, bytes).expect("the temporary folder is writable");
    let folder = path.parent().expect("it stands in a folder");
    let aside = path.with_extension("broken.json");
    let _ = std::fs::remove_file(&aside);
    let (_, state) = Autosave::begin(folder).expect("no other window has this folder");
    // Work is never written over: it stands where it stood, or aside where it cannot be read.
    assert!(path.exists() != aside.exists(), "{} or aside", path.display());
    let kept = serde_json::to_string(&state).expect("a state can be written");
    serde_json::from_str::<State>(&kept).expect("what was written is read");

    let path = crate::targets::file("open.touchstone.json");
    std::fs::write(&path, bytes).expect("the temporary folder is writable");
    match Project::read(&path) {
        Ok(project) => project.write(&path).expect("what was read can be written"),
        Err(problem) => assert!(!problem.is_empty() && !problem.contains('\n'), "{problem:?}"),
    }
}
