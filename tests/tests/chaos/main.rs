//! Chaos: what the world does to a program, drawn at random, for as long as one likes: devices that vanish and return, logs cut off
//! anywhere, a full disk, clocks that jump, SIGKILL and restart, documents that somebody has spoiled, files of 5 GB, 10⁵ columns, names
//! that nobody should choose. Nothing may be lost, nothing may panic, no force may come without fresh data, memory may not grow.
//!
//! A new seed every day, printed for replay: `TOUCHSTONE_SEED=20400`. Forty seconds by default; `TOUCHSTONE_CHAOS_SECONDS=600` is the
//! issue's ten minutes. The work goes in laps, each of which does everything once in an order of its own; `TOUCHSTONE_CHAOS_ONLY=udp` does
//! one part alone.

// Names are hostile on purpose: printed as they are, a failure would be unreadable.
#![allow(clippy::unnecessary_debug_formatting)]

mod boards;
mod child;
mod documents;
mod force;
mod full;
mod huge;
mod killed;
mod logs;
mod memory;
mod mutate;
mod names;
mod together;
mod udp;
mod workbench;

use memory::Memory;
use rand::rngs::StdRng;
use rand::seq::SliceRandom as _;
use rand::{RngExt as _, SeedableRng as _};
use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Instant, SystemTime, UNIX_EPOCH};

#[global_allocator]
static MEMORY: peak_alloc::PeakAlloc = peak_alloc::PeakAlloc;

/// What panicked so far, on any thread of this process.
static PANICS: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// So many laps at the least: one to fill pools and caches, and some to compare.
const FEWEST_LAPS: usize = 3;

/// What all parts share.
struct Chaos {
    rng: StdRng,
    folder: PathBuf,
    /// What was done, counted.
    counts: BTreeMap<&'static str, u64>,
    /// What programs that were killed have said to be kept and saved, in all laps.
    promised: killed::Promised,
}

impl Chaos {
    fn count(&mut self, what: &'static str, by: u64) {
        *self.counts.entry(what).or_default() += by;
    }

    /// A new folder for one part's files.
    fn scratch(&self) -> tempfile::TempDir {
        tempfile::tempdir_in(&self.folder).expect("a temporary folder")
    }
}

/// A part, its name, and what must have been counted over the whole run: without it the part had nothing to lose.
type Part = (&'static str, fn(&mut Chaos), &'static [&'static str]);

const PARTS: [Part; 12] = [
    ("logs", logs::cut_and_spoiled, &["spoiled logs that load", "fits that answered"]),
    ("documents", documents::spoiled, &["spoiled worlds that run", "spoiled lessons that open"]),
    ("history", documents::spoiled_history, &["spoiled histories"]),
    ("workbench", workbench::jobs, &["fits that answered", "deeds at the workbench"]),
    ("force", force::vanishing_and_jumping, &["ticks with force", "ticks without fresh data"]),
    ("udp", udp::attacked, &["sealed packets taken", "packets refused", "ticks without fresh data"]),
    ("boards", boards::unplugged, boards::MUST),
    ("killed", killed::and_restarted, &["kills", "attempts said to be kept", "projects said to be saved"]),
    // Skipped where there are no mount namespaces.
    ("full disk", full::refuses, &[]),
    ("huge", huge::refused_or_bounded, &[]),
    ("names", names::hostile, &["hostile names"]),
    ("together", together::at_the_same_time, together::MUST),
];

fn number(name: &str) -> Option<u64> {
    std::env::var(name).ok().and_then(|text| text.parse().ok())
}

fn seed() -> u64 {
    let today = || SystemTime::now().duration_since(UNIX_EPOCH).map_or(1, |time| time.as_secs() / 86_400);
    number("TOUCHSTONE_SEED").unwrap_or_else(today)
}

/// Notes every panic, also those that somebody catches, and says it at once: what a killed process has said is read by its parent.
fn note_panics() {
    std::panic::set_hook(Box::new(|info| {
        let said = format!("{}{info}\n", child::PANIC);
        let _ = std::io::stderr().write_all(said.as_bytes());
        PANICS.lock().unwrap_or_else(PoisonError::into_inner).push(info.to_string());
    }));
}

/// What panicked since the last call.
fn take_panics() -> Vec<String> {
    std::mem::take(&mut *PANICS.lock().unwrap_or_else(PoisonError::into_inner))
}

#[test]
fn nothing_is_lost_nothing_panics_no_force_without_fresh_data_and_memory_stays_flat() {
    note_panics();
    if let Some(what) = std::env::var_os(child::WHAT) {
        child::run(&what.to_string_lossy());
        return;
    }
    let (seed, seconds) = (seed(), number("TOUCHSTONE_CHAOS_SECONDS").unwrap_or(40));
    println!("chaos: TOUCHSTONE_SEED={seed} repeats it, for {seconds} s");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let rng = StdRng::seed_from_u64(seed);
    let (folder_path, counts, mut happened) = (folder.path().to_path_buf(), BTreeMap::new(), BTreeMap::new());
    let mut chaos = Chaos { rng, folder: folder_path, counts, promised: killed::Promised::default() };
    let (begun, mut laps, mut took_s) = (Instant::now(), Vec::new(), BTreeMap::new());
    while laps.len() < FEWEST_LAPS || begun.elapsed().as_secs() < seconds {
        lap(&mut chaos, seed, &mut took_s, &mut happened);
        laps.push(Memory::now());
    }
    println!("{} laps in {:.0} s", laps.len(), begun.elapsed().as_secs_f64());
    for (what, count) in &chaos.counts {
        println!("  {count:>9} {what}");
    }
    for (part, seconds) in &took_s {
        println!("  {seconds:>9.1} s {part}");
    }
    memory::must_be_flat(&laps);
    for (name, _, must) in parts() {
        for what in must {
            let count = happened.get(&(name, *what)).copied().unwrap_or(0_u64);
            assert!(count > 0, "{name} had something to lose: {what}");
        }
    }
}

/// All parts, or the one that was asked for.
fn parts() -> Vec<Part> {
    let only = std::env::var("TOUCHSTONE_CHAOS_ONLY").ok();
    PARTS.into_iter().filter(|(name, ..)| only.as_ref().is_none_or(|one| one == name)).collect()
}

/// How often what must have happened in a part did, by the part and what it was.
type Happened = BTreeMap<(&'static str, &'static str), u64>;

/// Every part once; the part that fails is named with what repeats it.
fn lap(chaos: &mut Chaos, seed: u64, took_s: &mut BTreeMap<&'static str, f64>, happened: &mut Happened) {
    let mut all = PARTS;
    all.shuffle(&mut chaos.rng);
    let asked = parts();
    for (name, part, must) in all {
        let begun = Instant::now();
        // Of its own, so that a part draws the same whatever the ones before it drew, also when it is done alone.
        let own: u64 = chaos.rng.random();
        if asked.iter().all(|(one, ..)| *one != name) {
            continue;
        }
        let kept = std::mem::replace(&mut chaos.rng, StdRng::seed_from_u64(own));
        let counted = |chaos: &Chaos, what: &str| chaos.counts.get(what).copied().unwrap_or(0);
        let before: Vec<u64> = must.iter().map(|what| counted(chaos, what)).collect();
        part(chaos);
        chaos.rng = kept;
        for (what, before) in must.iter().zip(before) {
            *happened.entry((name, *what)).or_default() += counted(chaos, what) - before;
        }
        *took_s.entry(name).or_default() += begun.elapsed().as_secs_f64();
        let panics = take_panics();
        assert!(panics.is_empty(), "{name}, TOUCHSTONE_SEED={seed}: {panics:#?}");
    }
}

/// An error of ours: something to read on one line that names the file.
fn must_be_a_sentence(error: &str, path: &Path) {
    assert!(!error.trim().is_empty(), "nothing was said of {path:?}");
    assert!(!error.contains(['\n', '\r', '\u{1b}', '\0']), "more than a line of text about {path:?}: {error:?}");
}
