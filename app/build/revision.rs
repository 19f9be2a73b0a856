//! The revision of the sources, as git tells it: for the build script, and for a test of it.

use std::path::{Path, PathBuf};
use std::process::Command;

/// A revision, and the file that changes with it.
#[derive(Debug)]
pub struct Revision {
    /// As `git describe --always --dirty` writes it.
    pub name: String,
    /// Where git notes every commit and checkout, also of a linked worktree.
    pub noted_in: Option<PathBuf>,
}

fn git(folder: &Path, arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").arg("-C").arg(folder).args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok().filter(|_| output.status.success())?;
    Some(text.trim_end().to_owned()).filter(|text| !text.is_empty())
}

/// Of the checkout whose top is `folder`; none where that is no checkout's top (an unpacked archive, also one within another project's
/// checkout), or where there is no git.
pub fn of(folder: &Path) -> Option<Revision> {
    let top = std::fs::canonicalize(git(folder, &["rev-parse", "--show-toplevel"])?).ok()?;
    if top != std::fs::canonicalize(folder).ok()? {
        return None;
    }
    let name = git(folder, &["describe", "--always", "--dirty"])?;
    let noted_in = git(folder, &["rev-parse", "--git-path", "logs/HEAD"]).map(|path| folder.join(path));
    Some(Revision { name, noted_in: noted_in.filter(|path| path.exists()) })
}
