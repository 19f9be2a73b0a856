//! The recorder end to end: killed with SIGKILL, on a disk that refuses, with a folder that goes, and as fast as it can.

use app::recorder::{FILE_BYTES, Order, Recorder, ServoFacts, Status, folder};
use estimator::log;
use haptics::device::{Device, ScriptedOperator, Skill};
use haptics::recording::{Meta, Recording};
use haptics::servo::rate::RateChoice;
use haptics::servo::recorder::SensorModel;
use haptics::servo::tap::{TapSource, tap};
use haptics::servo::{Servo, ServoConfig, Swap, TickRecord};
use haptics::world::{State, World, presets};
use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::time::{Duration, Instant};

const FOLDER: &str = "TOUCHSTONE_TEST_RECORDINGS";

fn order(folder: &Path, world: &World) -> Order {
    let device = ScriptedOperator::new(world, &State::resting(world), Skill::default(), 1).spec().clone();
    let (folder, world) = (folder.to_path_buf(), Arc::new(world.clone()));
    Order {
        folder,
        world,
        device: Some(device),
        sensors: SensorModel::TYPICAL,
        seed: 1,
        file_bytes: FILE_BYTES,
        servo: ServoFacts::default(),
        stated: Meta::default(),
    }
}

fn servo(rate_hz: f64) -> Servo {
    let world = presets::stacking();
    let device = ScriptedOperator::new(&world, &State::resting(&world), Skill::default(), 1);
    let config = ServoConfig { rate: RateChoice::Fixed(rate_hz), ..ServoConfig::default() };
    Servo::start(Swap::new(world), Box::new(device), config).expect("a thread")
}

fn wait_for(recorder: &Recorder, done: impl Fn(&Status) -> bool) -> Status {
    let begun = Instant::now();
    loop {
        let status = recorder.status();
        if done(&status) {
            return status;
        }
        assert!(begun.elapsed() < Duration::from_secs(30), "{status:?}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Starts this test again as a process of its own that only records; what it says is a line a moment.
fn child(test: &str, folder: &Path, before: &str) -> Command {
    let me = std::env::current_exe().expect("a test knows its own path");
    let mut command = Command::new("sh");
    let script = format!("{before} exec \"$0\" --exact {test} --nocapture --test-threads=1");
    command.arg("-c").arg(script).arg(me).env(FOLDER, folder).stdout(Stdio::piped()).stderr(Stdio::null());
    command
}

fn only_recording(folder: &Path) -> PathBuf {
    let files = std::fs::read_dir(folder).expect("there").flatten().map(|entry| entry.path());
    let mut found: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|e| e == "mcap")).collect();
    assert_eq!(found.len(), 1, "{found:?}");
    found.remove(0)
}

fn open(path: &Path) -> Recording {
    log::load(path, None).unwrap_or_else(|error| panic!("{error}")).remove(0)
}

fn end_s(recording: &Recording) -> f64 {
    recording.time_s.as_ref().and_then(|time| time.last().copied()).expect("a clock")
}

#[test]
fn a_killed_program_leaves_a_recording_up_to_its_last_second_and_it_is_found() {
    if let Some(folder) = std::env::var_os(FOLDER) {
        let servo = servo(1000.0);
        let recorder = Recorder::start(servo.tap(), order(Path::new(&folder), &presets::stacking())).expect("begins");
        let begun = Instant::now();
        loop {
            // Nobody looks at the window: the servo's other ring is not emptied. Said: how long it has been recording.
            let _ = recorder.status();
            println!("{}", begun.elapsed().as_secs_f64());
            std::thread::sleep(Duration::from_millis(2));
        }
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let name = "a_killed_program_leaves_a_recording_up_to_its_last_second_and_it_is_found";
    let mut child = child(name, folder.path(), "").spawn().expect("starts");
    let mut last_s = 0.0;
    for line in BufReader::new(child.stdout.take().expect("piped")).lines() {
        last_s = line.expect("readable").trim().parse().unwrap_or(last_s);
        if last_s >= 3.2 {
            break;
        }
        assert_eq!(folder::unfinished(folder.path()), Vec::<PathBuf>::new(), "a living program writes it");
    }
    child.kill().expect("SIGKILL");
    child.wait().expect("ends");
    assert!(last_s >= 3.2, "it recorded until {last_s} s");
    let path = only_recording(folder.path());
    assert_eq!(folder::unfinished(folder.path()), std::slice::from_ref(&path));
    let found = open(&path);
    println!("recorded for {last_s:.3} s, read {:.3} s", end_s(&found));
    assert!(end_s(&found) >= last_s - 1.0, "recorded for {last_s} s, read {} s", end_s(&found));
    assert!(found.warnings.iter().any(|w| w.kind == "cut-off"), "{:?}", found.warnings);
    let time = found.time_s.as_ref().expect("a clock");
    assert!(time.windows(2).all(|w| (w[1] - w[0] - 1e-3).abs() < 1e-9), "no tick is missing");
    assert!(found.labels.is_some() && found.channel("fy2_N").is_some());
    let servo = found.meta.other.get("servo").expect("how the servo kept its time, until then");
    assert!(servo["why"].is_string());
    folder::forget(&path);
    assert!(folder::unfinished(folder.path()).is_empty() && path.exists());
}

/// A disk that is full, as far as a process can tell: the largest size of a file is limited.
#[cfg(unix)]
#[test]
fn a_disk_that_refuses_is_one_sentence_and_what_was_written_opens() {
    if let Some(folder) = std::env::var_os(FOLDER) {
        let (mut filler, source) = tap(4096);
        let world = presets::stacking();
        let recorder = Recorder::start(&source, order(Path::new(&folder), &world)).expect("begins");
        for i in 0..2_000_000_u32 {
            // Faster than any hand, and slow enough for several blocks before the limit.
            if i % 40 == 0 || filler.must_wait() {
                std::thread::sleep(Duration::from_millis(1));
            }
            if recorder.has_ended() {
                break;
            }
            filler.offer(tick(i));
        }
        let status = wait_for(&recorder, |status| status.ended);
        println!("told: {}", status.problem.expect("a sentence"));
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let name = "a_disk_that_refuses_is_one_sentence_and_what_was_written_opens";
    let output = child(name, folder.path(), "trap '' XFSZ; ulimit -f 4000;").output().expect("runs");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let told = said.lines().find_map(|line| line.split("told: ").nth(1)).unwrap_or_else(|| panic!("{said}"));
    assert!(told.starts_with("The recording ended after ") && told.contains("the disk refused it"), "{told}");
    let path = only_recording(folder.path());
    assert!(told.contains(&path.display().to_string()) && told.ends_with('.'), "{told}");
    let found = open(&path);
    assert!(found.len() > 1000, "{}", found.len());
    assert!(found.warnings.iter().any(|w| w.kind == "cut-off"), "{:?}", found.warnings);
    assert!(folder::unfinished(folder.path()).is_empty(), "it was said");
}

#[test]
fn a_folder_that_is_removed_ends_the_recording_with_a_sentence() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let inner = folder.path().join("recordings");
    let mut servo = servo(1000.0);
    let recorder = Recorder::start(servo.tap(), order(&inner, &presets::stacking())).expect("begins");
    wait_for(&recorder, |status| status.ticks > 200);
    std::fs::remove_dir_all(&inner).expect("it is there");
    let status = wait_for(&recorder, |status| status.ended);
    let problem = status.problem.expect("a sentence");
    assert!(problem.contains("moved or removed") && problem.ends_with('.'), "{problem}");
    let before = servo.newest().state.tick;
    let begun = Instant::now();
    while servo.newest().state.tick < before + 100 {
        assert!(begun.elapsed() < Duration::from_secs(20), "training goes on");
        std::thread::yield_now();
    }
    // The next one begins as if nothing had been.
    let next = Recorder::start(servo.tap(), order(&inner, &presets::stacking())).expect("begins");
    wait_for(&next, |status| status.ticks > 200);
    let finished = next.stop().wait().expect("written");
    assert_eq!(open(&finished.path).len() as u64, finished.status.ticks);
}

#[test]
fn a_recording_carries_its_world_its_device_and_how_the_servo_kept_its_time() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let world = presets::stacking();
    let mut servo = servo(1000.0);
    let recorder = Recorder::start(servo.tap(), order(folder.path(), &world)).expect("begins");
    assert!(Recorder::start(servo.tap(), order(folder.path(), &world)).is_err(), "one at a time");
    wait_for(&recorder, |status| status.ticks > 700 && status.bytes > 0);
    recorder.tell(ServoFacts { timing: servo.newest().timing, privileges: Some(servo.privileges()) });
    let finished = recorder.stop().wait().expect("written");
    let bytes = std::fs::read(&finished.path).expect("there");
    assert_eq!((finished.status.bytes, finished.status.dropped), (bytes.len() as u64, 0));
    let text = String::from_utf8_lossy(&bytes);
    let there = |part: &str| text.contains(part);
    assert!(there("world.json") && there("device.json") && there("\"max_force_n\""));
    let found = open(&finished.path);
    assert_eq!(found.len() as u64, finished.status.ticks);
    assert!(found.warnings.iter().all(|w| w.kind != "cut-off"));
    let (servo, recorder) = (&found.meta.other["servo"], &found.meta.other["recorder"]);
    assert!(servo["timing"]["ticks"].as_u64().is_some_and(|ticks| ticks > 0), "{servo}");
    assert_eq!(recorder["ticks"].as_u64(), Some(finished.status.ticks));
    // A servo that ends takes nothing with it.
    let source: TapSource = self::servo(1000.0).tap().clone();
    let orphan = Recorder::start(&source, order(folder.path(), &world)).expect("begins");
    wait_for(&orphan, |status| status.ended);
    assert!(orphan.stop().wait().is_err_and(|problem| problem.contains("too short")));
}

#[test]
fn a_recording_that_grows_too_large_for_one_file_goes_on_in_the_next() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (mut filler, source) = tap(4096);
    let order = Order { file_bytes: 100_000, ..order(folder.path(), &presets::stacking()) };
    let recorder = Recorder::start(&source, order).expect("begins");
    let mut offered = 0_u32;
    while recorder.status().files < 3 {
        if offered.is_multiple_of(40) || filler.must_wait() {
            std::thread::sleep(Duration::from_millis(1));
        }
        if !filler.must_wait() {
            filler.offer(tick(offered));
            offered += 1;
        }
        assert!(offered < 2_000_000);
    }
    let finished = recorder.stop().wait().expect("written");
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(folder.path()).expect("there").flatten().map(|e| e.path()).collect();
    files.sort();
    assert_eq!(files.last(), Some(&finished.path), "nothing but recordings, the newest is told");
    let size: u64 = files.iter().map(|path| std::fs::metadata(path).expect("there").len()).sum();
    assert_eq!((finished.status.bytes, finished.status.ticks), (size, u64::from(offered)));
    let times: Vec<f64> = files.iter().flat_map(|path| open(path).time_s.expect("a clock")).collect();
    assert_eq!(times.len(), offered as usize);
    assert!(times.windows(2).all(|w| (w[1] - w[0] - 1e-3).abs() < 1e-9), "no tick between the files is missing");
}

/// A tick of a hand that moves and presses.
fn tick(i: u32) -> TickRecord {
    let time_s = f64::from(i) * 1e-3;
    let mut tick = TickRecord { time_s, label: "free-motion", ..TickRecord::default() };
    tick.input.tip_in_world[0].x = 0.02 * (1.7 * time_s).sin();
    tick.tip_force_n[0].y = (0.9 * time_s).cos();
    tick
}
