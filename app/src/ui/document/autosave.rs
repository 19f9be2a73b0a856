//! Automatic saves of the open work as it changes: a killed program loses seconds, not work.
//!
//! One window at a time keeps the state (a locked file says which); the next start offers to go on where a killed program was.

use crate::ui::document::project::Project;
use crate::ui::document::project_files::project_of;
use crate::ui::document::recent::Recent;
use crate::ui::session::Session;
use crate::ui::shell::dock::arrangement::Dock;
use crate::ui::train::assistant::state::Assistant;
use crate::ui::train::comfort::Comfort;
use crate::write_whole::write_whole;
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Between two looks for changes.
const EVERY: Duration = Duration::from_secs(2);

/// Everything that the next start finds.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct State {
    /// Open project.
    pub project: Project,
    /// The project file that it belongs to.
    #[serde(with = "crate::path_bytes")]
    pub project_path: Option<PathBuf>,
    /// Positions of the panels.
    pub dock: Dock,
    /// Files that were open before.
    pub recent: Recent,
    /// False while the program runs: it was killed when the next start finds it so.
    pub ended: bool,
    /// Settings that make training comfortable.
    pub comfort: Comfort,
    /// True once the user has been shown around.
    pub toured: bool,
    /// Settings of the assistant.
    pub assistant: Assistant,
}

/// Keeps the state of one window.
pub struct Autosave {
    /// Who writes, and what went wrong there.
    writer: Option<Writer>,
    problems: Receiver<String>,
    path: PathBuf,
    /// State that was written last.
    last: State,
    next: Instant,
    /// Locked as long as the window is open.
    _lock: File,
}

/// The thread that writes, with work for it.
struct Writer {
    sender: Sender<String>,
    thread: JoinHandle<()>,
}

impl Autosave {
    /// Takes the folder for this window; what the last one left. `None` where another window has it, or the disk refuses.
    pub fn begin(folder: &Path) -> Option<(Self, State)> {
        std::fs::create_dir_all(folder).ok()?;
        let lock = File::create(folder.join("session.lock")).ok()?;
        lock.try_lock().ok()?;
        let path = folder.join("session.json");
        let before = read(&path).unwrap_or_else(|| State { ended: true, ..State::default() });
        let (sender, receiver) = channel::<String>();
        let (complain, problems) = channel();
        let to = path.clone();
        let writer = move || {
            for text in receiver {
                if let Err(problem) = write_whole(&to, &text) {
                    // The window goes on; the next change tries again.
                    let _ = complain.send(problem);
                }
            }
        };
        let thread = std::thread::Builder::new().name("autosave".to_owned()).spawn(writer).ok()?;
        let writer = Some(Writer { sender, thread });
        let last = State { ended: true, ..State::default() };
        Some((Self { writer, problems, path, last, next: Instant::now(), _lock: lock }, before))
    }

    /// Writes what has changed, now and then; call once a frame. What went wrong the last time comes back, in a sentence.
    pub fn follow(&mut self, ctx: &egui::Context, session: &Session, dock: &Dock, toured: bool) -> Option<String> {
        let now = Instant::now();
        if now < self.next {
            // A window that nobody moves any more draws no frame by itself: what this one changed would wait with it.
            ctx.request_repaint_after(self.next - now);
            return None;
        }
        self.next = now + EVERY;
        let state = State { ended: false, ..state(session, dock, toured) };
        if state != self.last
            && let Ok(text) = serde_json::to_string(&state)
        {
            // The thread lives as long as this; without it there is nothing to be done.
            let _ = self.writer.as_ref().map(|writer| writer.sender.send(text));
            self.last = state;
        }
        self.problems.try_recv().ok()
    }

    /// The window is closed by the user: written at once, after all that was still to be written. An older state would come last otherwise.
    pub fn end(&mut self, session: &Session, dock: &Dock, toured: bool) {
        self.finish();
        let state = State { ended: true, ..state(session, dock, toured) };
        if let Ok(text) = serde_json::to_string(&state) {
            let _ = write_whole(&self.path, &text);
        }
    }

    /// Waits until everything is written that the thread was given.
    fn finish(&mut self) {
        if let Some(Writer { sender, thread }) = self.writer.take() {
            drop(sender);
            let _ = thread.join();
        }
    }
}

impl Drop for Autosave {
    /// Writes the last state to the disk before another window may have the folder.
    fn drop(&mut self) {
        self.finish();
    }
}

/// Reads the state from the file. An unreadable file counts as none; it is put aside, because this window writes its
/// own there.
fn read(path: &Path) -> Option<State> {
    let text = match haptics::text_file::read(path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return None,
        read => read.ok(),
    };
    let state = text.and_then(|text| serde_json::from_str(&text).ok());
    if state.is_none() {
        // A file that cannot be renamed is overwritten: the window has to go on.
        let _ = std::fs::rename(path, path.with_extension("broken.json"));
    }
    state
}

fn state(session: &Session, dock: &Dock, toured: bool) -> State {
    State {
        project: project_of(session.workspace, &session.document, &session.calibration, &session.plots),
        project_path: session.document.project_path.clone(),
        dock: dock.clone(),
        comfort: session.training.comfort,
        recent: session.document.recent.clone(),
        ended: false,
        toured,
        assistant: session.training.assistant,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::document::project::Source;
    use crate::ui::shell::workspace::Workspace;

    fn wait_for(path: &Path) -> State {
        let begun = Instant::now();
        while begun.elapsed() < Duration::from_secs(20) {
            let text = std::fs::read_to_string(path).unwrap_or_default();
            if let Ok(state) = serde_json::from_str::<State>(&text) {
                return state;
            }
            std::thread::sleep(Duration::from_millis(5));
        }
        panic!("nothing was written");
    }

    #[test]
    fn a_killed_window_leaves_what_was_open_and_a_closed_one_says_so() {
        let folder = tempfile::tempdir().expect("a folder");
        let (mut autosave, before) = Autosave::begin(folder.path()).expect("begins");
        assert!(before.ended && before.project.recordings.is_empty(), "the first start");
        let mut session = Session::new();
        session.document.sources = vec![Source { log: PathBuf::from("/logs/a.csv"), meta: None }];
        session.workspace = Workspace::Calibrate;
        let dock = Dock::default();
        autosave.follow(&egui::Context::default(), &session, &dock, true);
        let found = wait_for(&folder.path().join("session.json"));
        assert!(!found.ended && found.toured && found.project.recordings == session.document.sources);
        assert!(Autosave::begin(folder.path()).is_none(), "a second window keeps out");
        // As after a kill: the lock is gone, the file says that the program still runs.
        drop(autosave);
        let (mut autosave, before) = Autosave::begin(folder.path()).expect("begins again");
        assert!(!before.ended && before.project == found.project);
        autosave.end(&session, &dock, true);
        drop(autosave);
        assert!(Autosave::begin(folder.path()).expect("begins").1.ended);
    }

    #[test]
    fn the_end_is_what_is_written_last_however_much_waits() {
        let folder = tempfile::tempdir().expect("a folder");
        let (mut autosave, _) = Autosave::begin(folder.path()).expect("begins");
        let (session, dock) = (Session::new(), Dock::default());
        let open = serde_json::to_string(&State { ended: false, ..state(&session, &dock, true) }).expect("a state");
        for _ in 0..200 {
            autosave.writer.as_ref().expect("it writes").sender.send(open.clone()).expect("it lives");
        }
        autosave.end(&session, &dock, true);
        drop(autosave);
        assert!(Autosave::begin(folder.path()).expect("begins").1.ended);
    }

    #[test]
    fn a_broken_file_is_as_good_as_none() {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("session.json"), "{ broken").expect("written");
        let (_, before) = Autosave::begin(folder.path()).expect("begins");
        assert_eq!(before, State { ended: true, ..State::default() });
        let aside = std::fs::read_to_string(folder.path().join("session.broken.json")).expect("put aside");
        assert_eq!(aside, "{ broken", "somebody may find in it what was open");
    }
}
