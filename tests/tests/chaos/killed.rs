//! SIGKILL in the middle of recording, keeping and saving, and a restart in the same folder, again and again.

use crate::{Chaos, child};
use app::history::store::{Query, Store};
use app::recorder::folder;
use app::ui::document::project::Project;
use estimator::log;
use rand::RngExt as _;
use std::fs::File;
use std::io::{BufRead as _, BufReader};
use std::path::Path;
use std::process::Stdio;

/// What was recorded before this is on the disk, whenever the program is killed, s. The issue asks for 5; a block is written every half second.
const LOST_AT_MOST_S: f64 = 1.5;
/// Kills a lap.
const KILLS: usize = 2;

/// What all children have promised so far: it holds whatever comes afterwards.
#[derive(Debug, Default)]
pub struct Promised {
    /// So many attempts are in the history: those with the numbers below.
    kept: u64,
    /// Number of the newest project.
    saved: Option<u64>,
}

/// What a child said until it was killed.
#[derive(Debug, Default)]
struct Said {
    recorded_s: f64,
    kept: Option<u64>,
    saved: Option<u64>,
}

impl Said {
    fn take(&mut self, line: &str) {
        let Some((what, number)) = line.split_once(' ') else { return };
        match what {
            "recorded" => self.recorded_s = number.parse().unwrap_or(self.recorded_s),
            "kept" => self.kept = number.parse().ok().or(self.kept),
            "saved" => self.saved = number.parse().ok().or(self.saved),
            _ => {}
        }
    }
}

pub fn and_restarted(chaos: &mut Chaos) {
    // One folder for the whole of the chaos: what was kept laps ago must still be there.
    let place = chaos.folder.join("killed");
    std::fs::create_dir_all(&place).expect("a folder");
    for _ in 0..KILLS {
        let until_s = chaos.rng.random_range(0.2..2.4);
        let said = killed_after(&place, until_s);
        chaos.count("kills", 1);
        // A child may have been killed before it said anything of these; over the whole of the chaos that would be a fault.
        chaos.count(
            "attempts said to be kept",
            said.kept.map_or(0, |last| (last + 1).saturating_sub(chaos.promised.kept)),
        );
        chaos.count("projects said to be saved", u64::from(said.saved.is_some()));
        chaos.promised.kept = chaos.promised.kept.max(said.kept.map_or(0, |last| last + 1));
        chaos.promised.saved = chaos.promised.saved.max(said.saved);
        check_history(&place, &chaos.promised);
        check_project(&place, &chaos.promised);
        check_recording(&place, &said);
    }
}

fn killed_after(place: &Path, until_s: f64) -> Said {
    let complaints = place.join("standard-error");
    let heard = File::create(&complaints).expect("a file");
    let mut child = child::command("work", place, "").stdout(Stdio::piped()).stderr(heard).spawn().expect("starts");
    let mut said = Said::default();
    // It is read from until the child is gone: printing into a closed pipe panics.
    let mut lines = BufReader::new(child.stdout.take().expect("piped")).lines();
    for line in &mut lines {
        said.take(&line.expect("readable"));
        if said.recorded_s >= until_s {
            break;
        }
    }
    child.kill().expect("SIGKILL");
    child.wait().expect("gone");
    drop(lines);
    let heard = std::fs::read(&complaints).expect("there");
    child::must_not_have_panicked(&String::from_utf8_lossy(&heard));
    assert!(said.recorded_s >= until_s, "it ended by itself: {said:?}");
    said
}

fn check_history(place: &Path, promised: &Promised) {
    let store = Store::open(&place.join("history.sqlite")).expect("opens after a kill");
    let all = store.attempts(&Query::default()).expect("readable");
    assert!(all.len() as u64 >= promised.kept, "{} attempts, {} were said to be kept", all.len(), promised.kept);
    // From all laps, in their order, whatever their clock said.
    for (number, kept) in all.iter().enumerate() {
        assert_eq!(*kept, child::by_a_bad_clock(number as u64), "attempt {number}");
    }
}

fn check_project(place: &Path, promised: &Promised) {
    let Some(saved) = promised.saved else { return };
    let found = Project::read(&place.join("work.touchstone.json")).expect("whole, whenever it was killed");
    assert!(found.cursor_s >= saved as f64, "{} is there, {saved} was said to be saved", found.cursor_s);
    assert_eq!(found.recordings.len(), child::project(0).recordings.len());
}

/// The recording that was cut off is found and goes on until just before the kill; those of before are as they were.
fn check_recording(place: &Path, said: &Said) {
    let place = place.join("recordings");
    let found = folder::unfinished(&place);
    assert!(found.len() <= 1, "one was being written: {found:?}");
    let end_s = found.first().and_then(|path| {
        let recording = log::load(path, None).ok()?.remove(0);
        let steps = recording.time_s.as_deref().unwrap_or(&[]).windows(2).map(|w| w[1] - w[0]);
        assert!(steps.into_iter().all(|step| (step - 1e-3).abs() < 1e-9), "a tick is missing in {path:?}");
        recording.time_s.and_then(|time| time.last().copied())
    });
    let lost_s = said.recorded_s - end_s.unwrap_or(0.0);
    assert!(lost_s < LOST_AT_MOST_S, "recorded for {} s, {end_s:?} s are there", said.recorded_s);
    for path in &found {
        folder::forget(path);
        assert!(path.exists(), "it is only not offered again");
        // Room for the next laps.
        std::fs::remove_file(path).expect("there");
    }
}
