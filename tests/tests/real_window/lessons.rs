//! Lessons in a real window: opened and begun by their names, done with a pointer that goes where a person's would, graded from their files.

use crate::screen::{Hand, SCREEN, Screen, command, drawn, kept, start, try_command, until};
use app::ui::headless::screenshot::trainer_place;
use app::ui::kit::theme;
use app::ui::scene::view::Place;
use app::ui::train::lessons::pointer::{Pointed, pointer_through};
use estimator::training::lesson::Lesson;
use estimator::training::lesson::goal::Kind;
use haptics::Vec2;
use serde_json::Value;
use std::fs::DirEntry;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant, SystemTime};
use tests::touchstone;

/// Between two places of the pointer.
const EVERY: Duration = Duration::from_millis(33);
/// What a key changes of the strength, and what the mouse begins with, N.
const KEY_N: f64 = 0.2;
const BEGINS_N: f64 = 1.5;
/// A look at the picture, and how long one waits for it at most.
const GLANCE: Duration = Duration::from_millis(250);
const NEVER_STILL: Duration = Duration::from_secs(6);
/// So many looks in a row with so few changed pixels in the scene are stillness.
const STILL_PICTURES: usize = 2;
const STILL_PIXELS: usize = 60;
/// Columns and rows of the screen that show the scene.
const SCENE: [std::ops::Range<usize>; 2] = [20..1140, 110..860];
/// One step deeper into what shall give, m, and how many of them.
const DEEPER_M: f64 = 0.5e-3;
const DEEPER_STEPS: u32 = 16;
/// A lesson is tried so often at most.
const ATTEMPTS: usize = 3;
/// Those that are done unless `TOUCHSTONE_LESSONS` names others, or `all`: together they press, carry, turn and answer.
const USUAL: [&str; 3] = ["stack-two", "crank-even", "barrel"];

fn wanted() -> Vec<Lesson> {
    let named = std::env::var("TOUCHSTONE_LESSONS").unwrap_or_default();
    let is_wanted = |lesson: &Lesson| match named.as_str() {
        "" => USUAL.contains(&lesson.id.as_str()),
        "all" => true,
        names => names.split(',').any(|name| name == lesson.id),
    };
    let (lessons, problems) = app::lessons::all(None);
    assert!(problems.is_empty(), "{problems:?}");
    lessons.into_iter().filter(is_wanted).collect()
}

/// The recording that was written to since then; what is left of an attempt that was not over goes, and its name is free again.
fn recorded(home: &Path, since: SystemTime) -> Option<PathBuf> {
    let folder = home.join("data/touchstone/recordings");
    let mut all = std::fs::read_dir(folder).ok()?.flatten();
    let is_new = |entry: &DirEntry| entry.metadata().and_then(|m| m.modified()).is_ok_and(|at| at > since);
    let is_log = |entry: &DirEntry| entry.path().extension().is_some_and(|e| e == "mcap");
    all.find(|entry| is_log(entry) && is_new(entry)).map(|entry| entry.path())
}

/// A hand on the mouse that has its eyes on the picture: it closes, opens and presses only where nothing moves any more, as people wait
/// for a program that is slow.
struct Eyed<'a> {
    screen: &'a Screen,
    place: &'a Place,
    hand: Hand,
    down: bool,
    strength_n: f64,
}

impl<'a> Eyed<'a> {
    fn on(screen: &'a Screen, place: &'a Place, strength_n: f64) -> Self {
        Self { screen, place, hand: screen.hand(), down: false, strength_n }
    }

    fn say(&mut self, words: &str) {
        writeln!(self.hand.commands(), "{words}").expect("the pointer moves");
    }

    fn go_to(&mut self, at_m: Vec2) {
        let at = self.place.at(at_m);
        self.say(&format!("mousemove {:.0} {:.0}", at.x, at.y));
    }

    fn strengthen_to(&mut self, strength_n: f64) {
        while (strength_n - self.strength_n).abs() > 0.5 * KEY_N + 1e-9 {
            let way = (strength_n - self.strength_n).signum();
            self.strength_n += way * KEY_N;
            self.say(&format!("key {}", if way > 0.0 { "equal" } else { "minus" }));
        }
    }

    /// Waits until the picture stands still, or is thought to, as far as a hand that trembles with its forces does.
    fn wait_until_still(&self) {
        let (mut before, mut still) = (self.screen.picture(), 0);
        let begun = Instant::now();
        while still < STILL_PICTURES && begun.elapsed() < NEVER_STILL {
            std::thread::sleep(GLANCE);
            let now = self.screen.picture();
            let differs = |(a, b): &(&[u8; 3], &[u8; 3])| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 24);
            let moved = before[SCENE[1].clone()]
                .iter()
                .zip(&now[SCENE[1].clone()])
                .map(|(a, b)| a[SCENE[0].clone()].iter().zip(&b[SCENE[0].clone()]).filter(differs).count())
                .sum::<usize>();
            still = if moved < STILL_PIXELS { still + 1 } else { 0 };
            before = now;
        }
    }

    /// The pointer's place and button at one moment of the way; true where it stopped to look.
    fn follow(&mut self, pointed: &Pointed, pressed: bool) -> bool {
        self.go_to(pointed.at_m);
        let changes = pointed.pinches != self.down;
        let gives = pointed.presses && !pressed;
        if changes || gives {
            self.wait_until_still();
        }
        if changes {
            self.down = pointed.pinches;
            self.say(if self.down { "mousedown 1" } else { "mouseup 1" });
        }
        if self.down {
            self.strengthen_to(pointed.strength_n);
        }
        if changes {
            self.wait_until_still();
        }
        if gives {
            self.press(pointed.at_m);
        }
        changes || gives
    }

    /// Presses deeper, little by little, until the picture says that the goals are reached.
    fn press(&mut self, from_m: Vec2) {
        for step in 1..=DEEPER_STEPS {
            if !is_recorded(self.screen) {
                return;
            }
            self.go_to(from_m - Vec2::new(0.0, DEEPER_M * f64::from(step)));
            self.wait_until_still();
        }
    }
}

/// The red dot beside the clock of an attempt.
fn is_recorded(screen: &Screen) -> bool {
    let [dark, light] = [true, false].map(|dark| theme::Palette::of(dark).danger.to_array());
    let near = |p: &[u8; 3], of: [u8; 4]| p.iter().zip(of).all(|(a, b)| a.abs_diff(b) <= 12);
    let rows = screen.picture();
    rows[120..180].iter().flat_map(|row| &row[1160..1200]).any(|p| near(p, dark) || near(p, light))
}

/// Moves the pointer through a lesson in its own time, with a picture half-way; the strength that the mouse has in the end.
fn point(screen: &Screen, place: &Place, way: &[Pointed], half_way: &str, strength_n: f64) -> f64 {
    let mut eyed = Eyed::on(screen, place, strength_n);
    let (mut next, mut pressed) = (Instant::now(), false);
    for (k, pointed) in way.iter().enumerate() {
        // What is held stays held.
        if k == way.len() / 2 {
            screen.keep(half_way);
            next = Instant::now();
        }
        if eyed.follow(pointed, pressed) {
            next = Instant::now();
        }
        pressed = pointed.presses;
        next += EVERY;
        // A hand's own pace, not a wait for the program.
        std::thread::sleep(next.saturating_duration_since(Instant::now()));
    }
    if eyed.down {
        eyed.say("mouseup 1");
    }
    eyed.strength_n
}

fn graded(path: &Path) -> Option<Value> {
    let scored = Command::new(touchstone()).arg("score").arg(path).arg("--json").output().ok()?;
    let answer: Value = serde_json::from_slice(&scored.stdout).ok()?;
    answer["measures"].get(0)?.get("grade").cloned()
}

#[test]
fn lessons_are_done_with_a_pointer_as_a_person_does_them() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let Some(screen) = Screen::or_skip(folder.path()) else { return };
    let home = folder.path().join("home");
    let place = trainer_place(SCREEN.map(|pixels| pixels as f32)).expect("the trainer is drawn");
    let _program = start(&screen, &home);
    until("the first picture", &screen, || drawn(&screen).then_some(()));
    until("the tour", &screen, || kept(&home).get("toured").cloned());
    screen.xdotool(&["key", "Escape"]);
    until("the end of the tour", &screen, || (kept(&home)["toured"] == true).then_some(()));
    screen.xdotool(&["key", "ctrl+1"]);
    let mut strength_n = BEGINS_N;
    let mut missed = Vec::new();
    for lesson in wanted() {
        command(&screen, &format!("Lesson: {}", lesson.title));
        screen.keep(&format!("lesson-{}-1-brief", lesson.id));
        let mut way = pointer_through(&lesson, EVERY.as_secs_f64()).expect("a way");
        // What is only put down is not pressed on until it gives.
        let gives = lesson.goals.iter().any(|goal| matches!(goal.kind, Kind::Pierced { .. }));
        for pointed in &mut way {
            pointed.presses &= gives;
        }
        // A pointer that looks at nothing fails now and then, as people do.
        let mut grades = Vec::new();
        while grades.len() < ATTEMPTS && !grades.last().is_some_and(reached) {
            grades.push(attempt(&screen, (&home, &place), &lesson, (&way, grades.len() + 1), &mut strength_n));
        }
        println!("{}: {} attempts, {}", lesson.id, grades.len(), grades.last().unwrap_or(&Value::Null));
        if !grades.last().is_some_and(reached) {
            missed.push(format!("{}: {}", lesson.id, grades.last().unwrap_or(&Value::Null)["advice"]));
        }
    }
    assert!(missed.is_empty(), "{missed:#?}");
}

/// Nobody told the pointer what is in a barrel.
fn reached(grade: &Value) -> bool {
    grade["completed"] == true || grade["answered_rightly"] == false
}

/// Takes the test of the open lesson for the `nth` time; its grade, nothing when it was not over.
fn attempt(
    screen: &Screen,
    (home, place): (&Path, &Place),
    lesson: &Lesson,
    (way, nth): (&[Pointed], usize),
    strength_n: &mut f64,
) -> Value {
    let begun = SystemTime::now();
    command(screen, "Take the lesson's test");
    let path = until("the recording", screen, || recorded(home, begun));
    *strength_n = point(screen, place, way, &format!("lesson-{}-2-test", lesson.id), *strength_n);
    if let Some(question) = &lesson.question {
        screen.keep(&format!("lesson-{}-3-question", lesson.id));
        // Where a rule was broken (a barrel leaks on while a slow pointer looks) the test is over, and nothing is asked.
        let answer = format!("Answer: {}", question.answers[0]);
        let broken = |grade: Value| {
            grade["rules"].as_array().is_some_and(|rules| rules.iter().any(|rule| rule["reached"] == false))
        };
        until("the question, or the end", screen, || {
            (try_command(screen, &answer) || graded(&path).is_some_and(broken)).then_some(())
        });
    }
    Screen::keep_file(&path, &format!("lesson-{}-{nth}.mcap", lesson.id));
    let grade = graded(&path).unwrap_or_default();
    // By now the window has graded it, too.
    screen.keep(&format!("lesson-{}-4-debrief", lesson.id));
    grade
}
