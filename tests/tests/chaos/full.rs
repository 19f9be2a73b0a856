//! A disk that is really full: a file system of 3 MiB in memory, which a child mounts where only it sees it.

use crate::documents::attempt;
use crate::{Chaos, child, must_be_a_sentence};
use app::history::keeper::{Answer, History};
use app::history::store::{Query, Store};
use app::recorder::{Recorder, Status};
use app::ui::document::project::Project;
use estimator::log;
use haptics::servo::TickRecord;
use haptics::servo::tap::tap;
use rand::RngExt as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Size of the disk, bytes.
const DISK: usize = 3 << 20;
/// Said by a child that has done all of it.
const DONE: &str = "the full disk was met";

pub fn refuses(chaos: &mut Chaos) {
    let folder = chaos.scratch();
    let can_mount = Command::new("unshare")
        .args(["-rm", "sh", "-c", "mount -t tmpfs -o size=64k none \"$0\""])
        .arg(folder.path())
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success());
    if !can_mount {
        tests::skipped("a disk of its own for the test needs `unshare` and user namespaces");
        return;
    }
    let before = format!("mount -t tmpfs -o size={DISK} none \"$TOUCHSTONE_CHAOS_FOLDER\" &&");
    let inner = child::command("full", folder.path(), &before);
    let mut command = Command::new("unshare");
    command.arg("-rm").arg(inner.get_program()).args(inner.get_args());
    command.envs(inner.get_envs().filter_map(|(name, value)| Some((name, value?))));
    command.env("TOUCHSTONE_CHAOS_DRAW", chaos.rng.random_range(0..1_000_u32).to_string());
    let output = command.output().expect("runs");
    let said = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    child::must_not_have_panicked(&said);
    assert!(output.status.success() && said.contains(DONE), "{said}");
    chaos.count("full disks", 1);
}

/// What the child does on its small disk.
pub fn child(folder: &Path) {
    let room: usize = std::env::var("TOUCHSTONE_CHAOS_DRAW").ok().and_then(|n| n.parse().ok()).unwrap_or(0);
    a_project_stays_whole(folder);
    an_attempt_is_kept_or_said_to_be_lost(folder, room * 8);
    a_recording_ends_in_a_sentence(folder);
    println!("{DONE}");
}

/// Fills the disk but for `room` bytes.
fn fill(folder: &Path, room: usize) -> PathBuf {
    let path = folder.join("filler");
    let mut file = std::fs::File::create(&path).expect("there is room for a name");
    let mut size = 0;
    while file.write_all(&[0; 4096]).is_ok() {
        size += 4096;
        assert!(size <= DISK, "this disk has no end");
    }
    let left = u64::try_from(size).expect("small").saturating_sub(room as u64);
    file.set_len(left).expect("shorter");
    path
}

fn a_project_stays_whole(folder: &Path) {
    let path = folder.join("work.touchstone.json");
    child::project(1).write(&path).expect("there is room");
    let filler = fill(folder, 0);
    let problem = child::project(2).write(&path).expect_err("the disk is full");
    must_be_a_sentence(&problem, &path);
    assert_eq!(Project::read(&path).expect("the old one").cursor_s, 1.0);
    std::fs::remove_file(filler).expect("there");
    let names: Vec<_> = std::fs::read_dir(folder).expect("there").flatten().map(|entry| entry.path()).collect();
    assert_eq!(names, [path], "nothing half-written is left");
}

fn an_attempt_is_kept_or_said_to_be_lost(folder: &Path, room: usize) {
    let path = folder.join("history.sqlite");
    Store::open(&path).and_then(|mut store| store.add(&attempt(0))).expect("there is room");
    let filler = fill(folder, room);
    let history = History::start(path.clone(), || {}).expect("a thread");
    (1..100).for_each(|number| history.add(attempt(number)));
    let (begun, mut kept, mut told) = (Instant::now(), vec![0], 0);
    while kept.len() + told < 100 {
        assert!(begun.elapsed() < Duration::from_mins(1), "{} kept, {told} told", kept.len());
        for answer in history.poll() {
            match answer {
                Answer::Kept(one) => kept.push(one.score.expect("its number") as u64),
                Answer::Problem(problem) => {
                    must_be_a_sentence(&problem, &path);
                    told += usize::from(problem.contains("could not be kept"));
                }
                _ => {}
            }
        }
        std::thread::yield_now();
    }
    drop(history);
    std::fs::remove_file(filler).expect("there");
    // The next start takes in what waits.
    drop(History::start(path.clone(), || {}).expect("a thread"));
    let all = Store::open(&path).and_then(|store| store.attempts(&Query::default())).expect("whole");
    for number in kept {
        assert!(all.contains(&attempt(number)), "attempt {number} was said to be kept");
    }
}

fn a_recording_ends_in_a_sentence(folder: &Path) {
    let (mut filler, source) = tap(4096);
    let place = folder.join("recordings");
    let recorder = Recorder::start(&source, child::order(&place)).expect("begins");
    let begun = Instant::now();
    let mut offered = 0_u32;
    while !recorder.has_ended() {
        assert!(begun.elapsed() < Duration::from_mins(1), "{:?}", recorder.status());
        // Faster than any hand, and slow enough for several blocks before the disk is full.
        if offered.is_multiple_of(40) || filler.must_wait() {
            std::thread::sleep(Duration::from_millis(1));
        }
        let mut tick = TickRecord { time_s: f64::from(offered) * 1e-3, label: "free-motion", ..TickRecord::default() };
        tick.input.tip_in_world[0].x = (1e-3 * f64::from(offered)).sin();
        filler.offer(tick);
        offered += 1;
    }
    let Status { problem, path, ticks, .. } = recorder.status();
    let (problem, path) = (problem.expect("a sentence"), path.expect("a file"));
    must_be_a_sentence(&problem, &path);
    let found = log::load(&path, None).expect("what was written opens").remove(0);
    assert!(found.len() > 1_000 && found.len() as u64 <= ticks, "{} of {ticks}", found.len());
}
