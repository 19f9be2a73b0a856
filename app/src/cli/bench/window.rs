//! How long the window takes from its start to its first picture: this program, started again, on the screen that there is or on one in memory.

use super::table::{Figure, Wanted};
use super::whole::WholeBench;
use crate::ui::first_picture::SAID;
use anyhow::Context as _;
use std::io::{BufRead as _, BufReader};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// The first picture should stand after so long, s.
const MOST_S: f64 = 0.5;
/// Starts of which the middle one counts, after one that fills the caches.
const STARTS: usize = 7;
/// A start that takes longer has failed.
const PATIENCE: Duration = Duration::from_mins(1);

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
    command.args(["app", "--until-first-picture"]);
    // Where it keeps things, and not HOME: the key to the screen may lie there.
    for kept in ["XDG_DATA_HOME", "XDG_CONFIG_HOME", "XDG_STATE_HOME", "XDG_CACHE_HOME"] {
        command.env(kept, home.path());
    }
    screen.lend(&mut command);
    let begun = Instant::now();
    let child = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn()?;
    let line =
        first_line(Ended(child)).context("the window did not open within a minute: is there a graphics driver?")?;
    let took_s = begun.elapsed().as_secs_f64();
    anyhow::ensure!(line.trim() == SAID, "the window could not be opened: is there a graphics driver?");
    Ok(took_s)
}

/// A program that ends with this.
struct Ended(Child);

impl Drop for Ended {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// The first line that a program says within [`PATIENCE`]; it is ended afterwards.
fn first_line(mut program: Ended) -> Option<String> {
    let said = program.0.stdout.take()?;
    let (sender, receiver) = std::sync::mpsc::channel();
    std::thread::spawn(move || {
        let mut line = String::new();
        // Whoever waited may have given up.
        let _ = BufReader::new(said).read_line(&mut line).map(|_| sender.send(line));
    });
    receiver.recv_timeout(PATIENCE).ok()
}

/// Where the window opens.
enum Screen {
    /// That of the person who asks.
    Theirs,
    /// One in memory.
    Own { _server: Ended, display: String },
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
            .map(Ended)
            .context("there is no display, and Xvfb could not be started")?;
        let mut number = String::new();
        if let Some(said) = server.0.stdout.take() {
            BufReader::new(said).read_line(&mut number)?;
        }
        Ok(Self::Own { _server: server, display: format!(":{}", number.trim()) })
    }

    fn lend(&self, command: &mut Command) {
        if let Self::Own { display, .. } = self {
            command.env("DISPLAY", display);
        }
    }
}
