//! A screen of its own for a real window, and the program on it.

use app::ui::kit::theme;
use estimator::segment::SystemState;
use serde_json::Value;
use std::fs;
use std::io::{BufRead, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::time::{Duration, Instant};
use tests::touchstone;

/// The screen, pixels; the window opens in this size.
pub const SCREEN: [usize; 2] = [1480, 920];
/// What is as high, pixels, is a bar.
const BAR: usize = 12;
/// Software rendering on a busy machine takes its time.
const PATIENCE: Duration = Duration::from_mins(3);

/// Where what a person looks at afterwards is kept.
fn looked_at() -> Option<PathBuf> {
    let folder = std::env::temp_dir().join("touchstone-real-window");
    fs::create_dir_all(&folder).ok()?;
    Some(folder)
}

/// A screen that is written to a file.
pub struct Screen {
    server: Child,
    display: String,
    folder: PathBuf,
}

impl Drop for Screen {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

impl Screen {
    /// `None` where the machine lacks what it needs.
    fn new(folder: &Path) -> Option<Self> {
        Command::new("xdotool").arg("version").stdout(Stdio::null()).stderr(Stdio::null()).status().ok()?;
        let size = format!("{}x{}x24", SCREEN[0], SCREEN[1]);
        let mut server = Command::new("Xvfb");
        server.args(["-displayfd", "1", "-screen", "0", &size, "-fbdir"]).arg(folder);
        let mut server = server.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().ok()?;
        let mut number = String::new();
        BufReader::new(server.stdout.take()?).read_line(&mut number).ok()?;
        Some(Self { server, display: format!(":{}", number.trim()), folder: folder.to_owned() })
    }

    /// The same, and a word about what is missing.
    pub fn or_skip(folder: &Path) -> Option<Self> {
        if let Err(error) = render::Headless::new() {
            let _ = writeln!(std::io::stderr(), "skipped: {error}");
            return None;
        }
        let screen = Self::new(folder);
        if screen.is_none() {
            let _ = writeln!(std::io::stderr(), "skipped: Xvfb and xdotool are needed for a real window");
        }
        screen
    }

    /// Its name, as programs on it know it.
    pub fn display(&self) -> &str {
        &self.display
    }

    pub fn xdotool(&self, arguments: &[&str]) {
        // What it waits for may never come.
        let status =
            Command::new("timeout").args(["120", "xdotool"]).args(arguments).env("DISPLAY", &self.display).status();
        assert!(status.is_ok_and(|s| s.success()), "xdotool {arguments:?}");
    }

    /// A pointer and keys that do one command a line.
    pub fn hand(&self) -> Hand {
        let child = Command::new("xdotool")
            .arg("-")
            .env("DISPLAY", &self.display)
            .stdin(Stdio::piped())
            .spawn()
            .expect("xdotool starts");
        Hand(child)
    }

    /// The picture as rows of red, green and blue. The file is an X window dump: numbers of 32 bits, the first one the length of
    /// the header, the twentieth that of the colour map, the thirteenth the bytes of a row.
    pub fn picture(&self) -> Vec<Vec<[u8; 3]>> {
        let dump = fs::read(self.folder.join("Xvfb_screen0")).expect("the screen's file");
        let word = |i: usize| u32::from_be_bytes(dump[4 * i..4 * i + 4].try_into().expect("four bytes")) as usize;
        let (start, row) = (word(0) + 12 * word(19), word(12));
        (0..word(5))
            .map(|y| {
                let line = &dump[start + y * row..][..4 * word(4)];
                line.chunks_exact(4).map(|p| [p[2], p[1], p[0]]).collect()
            })
            .collect()
    }

    /// Kept beside the test's binary, to be looked at.
    pub fn keep(&self, name: &str) {
        let rows = self.picture();
        let size = [rows[0].len() as u32, rows.len() as u32];
        let bytes = rows.into_iter().flatten().flatten().collect();
        let Some(picture) = image::RgbImage::from_raw(size[0], size[1], bytes) else { return };
        if let Some(folder) = looked_at() {
            let _ = picture.save(folder.join(format!("{name}.png")));
        }
    }

    /// What was recorded, beside the pictures.
    pub fn keep_file(path: &Path, name: &str) {
        if let Some(folder) = looked_at() {
            let _ = fs::copy(path, folder.join(name));
        }
    }

    /// The longest bar of a state's colour in the lower half: left, right and top. A curve of that colour is no bar.
    pub fn run_of(&self, state: SystemState) -> Option<(usize, usize, usize)> {
        let wanted = [false, true].map(|dark| theme::state_color(dark, state).to_array());
        let near = |p: &[u8; 3]| wanted.iter().any(|w| p.iter().zip(w).all(|(a, b)| a.abs_diff(*b) <= 3));
        let rows = self.picture();
        let thick = |x: usize, y: usize| (1..BAR).all(|k| rows.get(y + k).is_some_and(|row| near(&row[x])));
        let mut best: Option<(usize, usize, usize)> = None;
        for (y, row) in rows.iter().enumerate().skip(SCREEN[1] / 2) {
            let mut from = None;
            for (x, pixel) in row.iter().chain([&[0, 0, 0]]).enumerate() {
                match (near(pixel), from) {
                    (true, None) => from = Some(x),
                    (false, Some(left)) if x - left > 8 => {
                        if best.is_none_or(|(l, r, _)| x - left > r - l) && thick(left + 2, y) && thick(x - 3, y) {
                            best = Some((left, x, y));
                        }
                        from = None;
                    }
                    (false, _) => from = None,
                    _ => {}
                }
            }
        }
        best.filter(|(left, right, _)| right - left > 60)
    }
}

/// Does what it is told, line by line.
pub struct Hand(Child);

impl Hand {
    /// Where its commands go.
    pub fn commands(&mut self) -> &mut ChildStdin {
        self.0.stdin.as_mut().expect("its input is a pipe")
    }
}

impl Drop for Hand {
    fn drop(&mut self) {
        drop(self.0.stdin.take());
        let _ = self.0.wait();
    }
}

/// The program, killed when the test ends.
pub struct Program(Child);

impl Drop for Program {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A dialog program that always chooses the file named: what the window falls back to where no portal answers.
pub fn always_choose(home: &Path, file: &Path) {
    let dialog = dialogs(home).join("zenity");
    fs::create_dir_all(dialogs(home)).expect("a folder");
    fs::write(&dialog, format!("#!/bin/sh\necho '{}'\n", file.display())).expect("a script");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        fs::set_permissions(&dialog, fs::Permissions::from_mode(0o755)).expect("it may run");
    }
}

fn dialogs(home: &Path) -> PathBuf {
    home.join("dialogs")
}

pub fn start(screen: &Screen, home: &Path) -> Program {
    let mut program = Command::new(touchstone());
    let path = std::env::var_os("PATH").unwrap_or_default();
    let paths = std::iter::once(dialogs(home)).chain(std::env::split_paths(&path));
    program.env("PATH", std::env::join_paths(paths).expect("names without colons"));
    // No portal answers, whatever runs on this machine.
    program.env("DBUS_SESSION_BUS_ADDRESS", "unix:path=/nonexistent").env_remove("XDG_RUNTIME_DIR");
    program.env("DISPLAY", &screen.display).env_remove("WAYLAND_DISPLAY");
    program.env("HOME", home).env("XDG_DATA_HOME", home.join("data")).env("XDG_CONFIG_HOME", home.join("config"));
    program.stdout(Stdio::null()).stderr(Stdio::null());
    let program = Program(program.spawn().expect("the program starts"));
    // No window manager gives it the keyboard.
    screen.xdotool(&["search", "--sync", "--onlyvisible", "--name", "Touchstone", "windowfocus", "--sync", "%1"]);
    program
}

pub fn until<T>(what: &str, screen: &Screen, found: impl FnMut() -> Option<T>) -> T {
    within(PATIENCE, found).unwrap_or_else(|| {
        screen.keep("too-late");
        panic!("{what} did not come")
    })
}

/// What is found before the time is over.
pub fn within<T>(patience: Duration, mut found: impl FnMut() -> Option<T>) -> Option<T> {
    let begun = Instant::now();
    loop {
        if let Some(found) = found() {
            return Some(found);
        }
        if begun.elapsed() > patience {
            return None;
        }
        std::thread::sleep(Duration::from_millis(100));
    }
}

pub fn kept(home: &Path) -> Value {
    let text = fs::read_to_string(home.join("data/touchstone/session.json")).unwrap_or_default();
    serde_json::from_str(&text).unwrap_or_default()
}

/// More than one colour is on the screen.
pub fn drawn(screen: &Screen) -> bool {
    let rows = screen.picture();
    rows.iter().flatten().any(|p| *p != rows[0][0])
}

/// Behind a list of commands everything is darker, the program's name too.
fn dimmed(screen: &Screen) -> bool {
    /// A part of a colour as bright as words on the dark, or the paper around words on the light; behind a list it is half of that.
    const BRIGHT: u8 = 0xD0;
    !screen.picture()[18..30].iter().flat_map(|row| &row[40..140]).flatten().any(|v| *v >= BRIGHT)
}

/// Chooses a command by its name.
pub fn command(screen: &Screen, name: &str) {
    until(&format!("the command {name}"), screen, || try_command(screen, name).then_some(()));
}

/// The same if it can be had now.
pub fn try_command(screen: &Screen, name: &str) -> bool {
    /// A list that has done what it was told is gone by then.
    const LOOKS: u32 = 50;
    until("a window with nothing before it", screen, || (!dimmed(screen)).then_some(()));
    screen.xdotool(&["key", "ctrl+p"]);
    until("the commands", screen, || dimmed(screen).then_some(()));
    screen.keep("4-commands");
    screen.xdotool(&["type", "--delay", "25", name]);
    screen.xdotool(&["key", "Return"]);
    for _ in 0..LOOKS {
        if !dimmed(screen) {
            return true;
        }
        std::thread::sleep(Duration::from_millis(100));
    }
    screen.xdotool(&["key", "Escape"]);
    false
}
