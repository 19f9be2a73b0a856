//! Time from the window's start to its first frame: this program, started again, on the existing screen or on a virtual
//! one.

use super::table::{Figure, Wanted};
use super::whole::WholeBench;
use crate::ui::headless::first_picture::SAID;
use anyhow::Context as _;
use std::io::{BufRead as _, BufReader};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Maximum time to the first frame, s.
const MOST_S: f64 = 0.5;
/// Number of starts whose median counts, after one that fills the caches.
const STARTS: usize = 7;
/// Time after which a start counts as failed.
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

/// Starts the window as for a new user, and waits until it reports its first frame. Returns the time, s.
fn first_picture_s(screen: &Screen) -> anyhow::Result<f64> {
    let home = tempfile::tempdir()?;
    let mut command = Command::new(std::env::current_exe()?);
    command.args(["app", "--until-first-picture"]);
    // Only the data folders, and not HOME: the key to the screen may be there.
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

/// Child process that ends with its owner.
struct Ended(Child);

impl Drop for Ended {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// First output line of a program within [`PATIENCE`]; the program is ended afterwards.
fn first_line(mut program: Ended) -> Option<String> {
    let said = program.0.stdout.take()?;
    let (sender, receiver) = std::sync::mpsc::channel();
    std::thread::spawn(move || {
        let mut line = String::new();
        // The receiver may have given up.
        let _ = BufReader::new(said).read_line(&mut line).map(|_| sender.send(line));
    });
    receiver.recv_timeout(PATIENCE).ok()
}

/// Screen of the window.
enum Screen {
    /// The user's screen.
    Theirs,
    /// Virtual screen in memory.
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
