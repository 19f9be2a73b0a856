//! Starting this program anew in another environment: a window system can be opened once in a process.

use anyhow::Context as _;
use std::process::Command;

/// This program with the same arguments.
fn itself() -> anyhow::Result<Command> {
    let mut again = Command::new(std::env::current_exe().context("this program cannot find its own file")?);
    again.args(std::env::args_os().skip(1));
    Ok(again)
}

/// Starts again without these variables, and with those. Returns only if it could not be started.
pub fn start(without: &[&str], with: &[(&str, &str)]) -> anyhow::Result<()> {
    let mut again = itself()?;
    for name in without {
        again.env_remove(name);
    }
    for (name, value) in with {
        again.env(name, value);
    }
    replace(again).context("the program could not be started again; is its file still there?")
}

#[cfg(unix)]
fn replace(mut again: Command) -> anyhow::Result<()> {
    use std::os::unix::process::CommandExt as _;
    Err(again.exec().into())
}

#[cfg(not(unix))]
fn replace(mut again: Command) -> anyhow::Result<()> {
    // It has printed its own error.
    std::process::exit(again.status()?.code().unwrap_or(1))
}
