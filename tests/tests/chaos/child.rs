//! This test again as a process of its own, to be killed or to meet a full disk.

use crate::documents::attempt;
use app::history::attempt::Attempt;
use app::history::store::{Query, Store};
use app::recorder::{FILE_BYTES, Order, Recorder, ServoFacts};
use app::ui::document::project::{Project, Source};
use haptics::device::{ScriptedOperator, Skill};
use haptics::recording::Meta;
use haptics::servo::recorder::SensorModel;
use haptics::servo::{Servo, ServoConfig, Swap};
use haptics::world::{State, presets};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::time::Duration;

/// What a child does.
pub const WHAT: &str = "TOUCHSTONE_CHAOS_CHILD";
/// How a process says that one of its threads panicked.
pub const PANIC: &str = "a thread panicked: ";
/// Where.
pub const FOLDER: &str = "TOUCHSTONE_CHAOS_FOLDER";

const TEST: &str = "nothing_is_lost_nothing_panics_no_force_without_fresh_data_and_memory_stays_flat";

/// A shell that runs `before` and becomes this test again.
pub fn command(what: &str, folder: &Path, before: &str) -> Command {
    let me = std::env::current_exe().expect("a test knows its own path");
    let mut command = Command::new("sh");
    let script = format!("{before} exec \"$0\" --exact {TEST} --nocapture --test-threads=1");
    command.arg("-c").arg(script).arg(me).env(WHAT, what).env(FOLDER, folder);
    command
}

pub fn run(what: &str) {
    let folder = PathBuf::from(std::env::var_os(FOLDER).expect("a folder"));
    match what {
        "work" => work(&folder),
        "full" => crate::full::child(&folder),
        other => panic!("nobody knows how to {other}"),
    }
    let panics = crate::take_panics();
    assert!(panics.is_empty(), "threads panicked: {panics:#?}");
}

/// What a process has said on its standard error names no panic, however it ended.
pub fn must_not_have_panicked(said: &str) {
    assert!(!said.contains(PANIC), "a child: {said}");
}

/// The attempt with this number, by a clock that is set back by a day now and then, and stands still in between.
pub fn by_a_bad_clock(number: u64) -> Attempt {
    let moment = match number % 5 {
        1 => number - 1,
        _ => number,
    };
    let day = jiff::SignedDuration::from_hours(if number % 5 == 4 { 24 } else { 0 });
    let began = attempt(moment).began.checked_sub(day).expect("a moment");
    Attempt { began, ..attempt(number) }
}

/// What is recorded, and where to.
pub fn order(folder: &Path) -> Order {
    Order {
        folder: folder.to_path_buf(),
        world: Arc::new(presets::stacking()),
        device: None,
        sensors: SensorModel::TYPICAL,
        seed: 1,
        file_bytes: FILE_BYTES,
        servo: ServoFacts::default(),
        stated: Meta::default(),
    }
}

/// A project with this number in it.
pub fn project(number: u64) -> Project {
    let log = PathBuf::from(format!("log-{number}.csv"));
    let sources = vec![Source { log, meta: None }; 50];
    Project { touchstone_project: 1, recordings: sources, cursor_s: number as f64, ..Project::default() }
}

/// Records, keeps attempts and saves a project, all at once, and says so of each; until it is killed.
fn work(folder: &Path) {
    let kept_in = folder.join("history.sqlite");
    std::thread::spawn(move || {
        let mut store = Store::open(&kept_in).expect("opens, however it was left");
        let first = store.attempts(&Query::default()).expect("readable").len() as u64;
        for number in first.. {
            store.keep(&by_a_bad_clock(number)).expect("kept");
            println!("kept {number}");
        }
    });
    let saved_in = folder.join("work.touchstone.json");
    std::thread::spawn(move || {
        let first = Project::read(&saved_in).map_or(0, |project| project.cursor_s as u64);
        for number in first.. {
            project(number).write(&saved_in).expect("saved");
            println!("saved {number}");
        }
    });
    let world = presets::stacking();
    let device = ScriptedOperator::new(&world, &State::resting(&world), Skill::default(), 1);
    let mut servo = Servo::start(Swap::new(world), Box::new(device), ServoConfig::at(1000.0)).expect("a thread");
    let recorder = Recorder::start(servo.tap(), order(&folder.join("recordings"))).expect("begins");
    let begun_s = servo.newest().tick.time_s;
    loop {
        let status = recorder.status();
        assert!(!status.ended, "{status:?}");
        println!("recorded {}", servo.newest().tick.time_s - begun_s);
        std::thread::sleep(Duration::from_millis(2));
    }
}
