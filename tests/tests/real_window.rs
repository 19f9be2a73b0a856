//! One real window under Xvfb, driven by a pointer and a keyboard that it does not know from a person's: a log is opened, a boundary
//! dragged and put back, a diagnosis asked for by its name; the program is killed and goes on where it was.

use app::ui::theme;
use estimator::segment::SystemState;
use serde_json::Value;
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tests::touchstone;

/// The screen, pixels; the window opens in this size.
const SCREEN: [usize; 2] = [1480, 920];
/// What is as high, pixels, is a bar.
const BAR: usize = 12;
/// Software rendering on a busy machine takes its time.
const PATIENCE: Duration = Duration::from_mins(3);

/// A screen that is written to a file.
struct Screen {
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

    fn xdotool(&self, arguments: &[&str]) {
        // What it waits for may never come.
        let status =
            Command::new("timeout").args(["120", "xdotool"]).args(arguments).env("DISPLAY", &self.display).status();
        assert!(status.is_ok_and(|s| s.success()), "xdotool {arguments:?}");
    }

    /// The picture as rows of red, green and blue. The file is an X window dump: numbers of 32 bits, the first one the length of
    /// the header, the twentieth that of the colour map, the thirteenth the bytes of a row.
    fn picture(&self) -> Vec<Vec<[u8; 3]>> {
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
    fn keep(&self, name: &str) {
        let rows = self.picture();
        let size = [rows[0].len() as u32, rows.len() as u32];
        let bytes = rows.into_iter().flatten().flatten().collect();
        let Some(picture) = image::RgbImage::from_raw(size[0], size[1], bytes) else { return };
        let folder = std::env::temp_dir().join("touchstone-real-window");
        if fs::create_dir_all(&folder).is_ok() {
            let _ = picture.save(folder.join(format!("{name}.png")));
        }
    }

    /// The longest bar of a state's colour in the lower half: left, right and top. A curve of that colour is no bar.
    fn run_of(&self, state: SystemState) -> Option<(usize, usize, usize)> {
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

/// The program, killed when the test ends.
struct Program(Child);

impl Drop for Program {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn start(screen: &Screen, home: &Path) -> Program {
    let mut program = Command::new(touchstone());
    program.env("DISPLAY", &screen.display).env_remove("WAYLAND_DISPLAY");
    program.env("HOME", home).env("XDG_DATA_HOME", home.join("data")).env("XDG_CONFIG_HOME", home.join("config"));
    program.stdout(Stdio::null()).stderr(Stdio::null());
    let program = Program(program.spawn().expect("the program starts"));
    // No window manager gives it the keyboard.
    screen.xdotool(&["search", "--sync", "--onlyvisible", "--name", "Touchstone", "windowfocus", "--sync", "%1"]);
    program
}

fn until<T>(what: &str, screen: &Screen, mut found: impl FnMut() -> Option<T>) -> T {
    let begun = Instant::now();
    loop {
        if let Some(found) = found() {
            return found;
        }
        if begun.elapsed() > PATIENCE {
            screen.keep("too-late");
            panic!("{what} did not come");
        }
        std::thread::sleep(Duration::from_millis(100));
    }
}

fn kept(home: &Path) -> Value {
    let text = fs::read_to_string(home.join("data/touchstone/session.json")).unwrap_or_default();
    serde_json::from_str(&text).unwrap_or_default()
}

/// More than one colour is on the screen.
fn drawn(screen: &Screen) -> bool {
    let rows = screen.picture();
    rows.iter().flatten().any(|p| *p != rows[0][0])
}

/// True once a state was set by hand.
fn by_hand(home: &Path) -> bool {
    kept(home)["project"]["choice"]["segments"].as_object().is_some_and(|s| !s.is_empty())
}

/// Drags the right boundary of a bar a third of its length to the left.
fn drag(screen: &Screen, home: &Path, (left, right, y): (usize, usize, usize)) {
    // A boundary is dragged as a hand does it: down, on its way, up.
    let at = |x: usize| [x.to_string(), (y + 8).to_string()];
    let move_to = |x: usize| screen.xdotool(&["mousemove", &at(x)[0], &at(x)[1]]);
    // The grip's line stands out above the band, where no pointer covers it.
    let grip = |screen: &Screen| screen.picture()[y - 2][right - 3..right + 4].to_vec();
    let free = grip(screen);
    move_to(right);
    until("the grip", screen, || (grip(screen) != free).then_some(()));
    let offered = grip(screen);
    screen.xdotool(&["mousedown", "1"]);
    until("the grip in the hand", screen, || (grip(screen) != offered).then_some(()));
    let goal = right - (right - left) / 3;
    for part in 1..=10 {
        move_to(right - (right - goal) * part / 10);
    }
    // The colour of the next state has come where the first one was.
    let behind = |screen: &Screen| screen.picture()[y + 2][goal + 20];
    let was = behind(screen);
    let follows = || (behind(screen) != was || by_hand(home)).then_some(());
    until("the boundary under the pointer", screen, follows);
    screen.xdotool(&["mouseup", "1"]);
    until("the boundary", screen, || by_hand(home).then_some(()));
}

#[test]
fn a_person_opens_drags_takes_back_diagnoses_and_survives_a_kill() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    if let Err(error) = render::Headless::new() {
        let _ = writeln!(std::io::stderr(), "skipped: {error}");
        return;
    }
    let Some(screen) = Screen::new(folder.path()) else {
        let _ = writeln!(std::io::stderr(), "skipped: Xvfb and xdotool are needed for a real window");
        return;
    };
    let home = folder.path().join("home");
    let log = folder.path().join("blocks.csv");
    let recorded = Command::new(touchstone())
        .args(["record", "--task", "block-stack", "--every", "5", "--out"])
        .arg(&log)
        .output()
        .expect("the program starts");
    assert!(recorded.status.success(), "{}", String::from_utf8_lossy(&recorded.stderr));

    let begun = Instant::now();
    let program = start(&screen, &home);
    until("the first picture", &screen, || drawn(&screen).then_some(()));
    println!("first picture after {:.2} s (software driver, this build)", begun.elapsed().as_secs_f64());
    // The first start shows around.
    until("the tour", &screen, || kept(&home).get("toured").cloned());
    screen.keep("1-tour");
    screen.xdotool(&["key", "Escape"]);
    until("the end of the tour", &screen, || (kept(&home)["toured"] == true).then_some(()));
    screen.xdotool(&["key", "ctrl+2"]);
    until("Calibrate", &screen, || (kept(&home)["project"]["workspace"] == "calibrate").then_some(()));

    // The path is typed: a portal for file dialogs is not there.
    screen.xdotool(&["mousemove", "120", "114", "click", "1"]);
    screen.xdotool(&["type", "--delay", "15", &log.to_string_lossy()]);
    screen.xdotool(&["key", "Return"]);
    let recordings = |home: &Path| kept(home)["project"]["recordings"].as_array().map_or(0, Vec::len);
    until("the recording", &screen, || (recordings(&home) == 1).then_some(()));
    let states = until("the states", &screen, || screen.run_of(SystemState::HoldAboveGround));
    screen.keep("2-states");

    drag(&screen, &home, states);
    screen.keep("3-boundary");
    screen.xdotool(&["key", "ctrl+z"]);
    until("the way back", &screen, || (!by_hand(&home)).then_some(()));

    // Behind the list everything is darker.
    let logo = |screen: &Screen| screen.picture()[24][80..140].to_vec();
    let bright = logo(&screen);
    screen.xdotool(&["key", "ctrl+p"]);
    until("the commands", &screen, || (logo(&screen) != bright).then_some(()));
    screen.keep("4-commands");
    screen.xdotool(&["type", "--delay", "60", "diagnose"]);
    screen.xdotool(&["key", "Return"]);
    until("Diagnose", &screen, || (kept(&home)["project"]["workspace"] == "diagnose").then_some(()));
    screen.keep("5-diagnose");

    // `kill` sends SIGKILL: nothing is told, nothing can be tidied.
    drop(program);
    assert_eq!(kept(&home)["ended"], false);
    let _program = start(&screen, &home);
    // Its frame is of the colour of what is fine.
    let fine = [false, true].map(|dark| theme::Palette::of(dark).good.to_array());
    let is_fine = |p: &[u8; 3]| fine.iter().any(|w| p.iter().zip(w).all(|(a, b)| a.abs_diff(*b) <= 3));
    let framed =
        |screen: &Screen| screen.picture()[..120].iter().any(|row| row.iter().filter(|p| is_fine(p)).count() > 600);
    until("the offer", &screen, || framed(&screen).then_some(()));
    screen.keep("6-offer");
    screen.xdotool(&["mousemove", "1368", "79", "click", "1"]);
    // It goes on in Diagnose as soon as the recording is there; a person then looks at Calibrate.
    until("the states again", &screen, || {
        screen.xdotool(&["key", "ctrl+2"]);
        screen.run_of(SystemState::HoldAboveGround)
    });
    screen.keep("7-again");
}
