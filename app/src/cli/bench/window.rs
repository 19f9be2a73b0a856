//! How long the window takes from its start to its first picture: this program, started again, on the screen that there is or on one in memory.

use super::table::{Figure, Wanted};
use super::whole::WholeBench;
use crate::ui::first_picture::SAID;
use anyhow::Context as _;
use std::io::{BufRead as _, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Instant;

/// The first picture should stand after so long, s.
const MOST_S: f64 = 0.5;
/// Starts of which the middle one counts, after one that fills the caches.
const STARTS: usize = 7;

pub(super) fn first_pictures(wish: WholeBench) -> anyhow::Result<Vec<Figure>> {
    anyhow::ensure!(!cfg!(test), "only the program itself can be started again");
    let screen = Screen::find()?;
    let mut seconds = Vec::new();
    for _ in 0..=if wish.quick { 1 } else { STARTS } {
        seconds.push(first_picture_s(&screen)?);
    }
    seconds.remove(0);
    seconds.sort_by(f64::total_cmp);
    let middle = seconds.get(seconds.len() / 2).copied().context("the window was not started")?;
    Ok(vec![
        Figure::new("first picture of the window, from the program's start", middle, "s")
            .wanted(Wanted::AtMost(MOST_S)),
    ])
}

/// Starts the window as somebody who has never opened it, and waits until it says that its first picture stands.
fn first_picture_s(screen: &Screen) -> anyhow::Result<f64> {
    let home = tempfile::tempdir()?;
    let mut command = Command::new(std::env::current_exe()?);
    command.args(["app", "--until-first-picture"]).env("HOME", home.path());
    for kept in ["XDG_DATA_HOME", "XDG_CONFIG_HOME", "XDG_STATE_HOME"] {
        command.env_remove(kept);
    }
    screen.lend(&mut command);
    let begun = Instant::now();
    let mut child = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn()?;
    let mut line = String::new();
    if let Some(said) = child.stdout.take() {
        BufReader::new(said).read_line(&mut line)?;
    }
    let took_s = begun.elapsed().as_secs_f64();
    child.wait()?;
    anyhow::ensure!(line.trim() == SAID, "the window could not be opened: is there a graphics driver?");
    Ok(took_s)
}

/// Where the window opens.
enum Screen {
    /// That of the person who asks.
    Theirs,
    /// One in memory.
    Own { server: Child, display: String },
}

impl Screen {
    fn find() -> anyhow::Result<Self> {
        if ["DISPLAY", "WAYLAND_DISPLAY"]
            .iter()
            .any(|name| std::env::var_os(name).is_some_and(|value| !value.is_empty()))
        {
            return Ok(Self::Theirs);
        }
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "1920x1080x24"])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .context("there is no display, and Xvfb could not be started")?;
        let mut number = String::new();
        if let Some(said) = server.stdout.take() {
            BufReader::new(said).read_line(&mut number)?;
        }
        Ok(Self::Own { server, display: format!(":{}", number.trim()) })
    }

    fn lend(&self, command: &mut Command) {
        if let Self::Own { display, .. } = self {
            command.env("DISPLAY", Path::new(display));
        }
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        if let Self::Own { server, .. } = self {
            // It may be gone already.
            let _ = server.kill();
            let _ = server.wait();
        }
    }
}
