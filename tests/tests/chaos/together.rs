//! Everything at the same time: a real servo with a hand that comes and goes, its recorder, worlds that are swapped, spoiled ones among
//! them; a workbench at which logs are opened and fitted while attempts are kept; another program at the same history; histories that a
//! disk spoils. Nothing panics, the servo lives, every tick's force is judged, every attempt is kept, every recording is complete.

mod histories;
mod servo;

use crate::Chaos;
use crate::workbench::Bench;
use app::ui::train::trainees;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// What must have happened.
pub const MUST: &[&str] = &[
    servo::FORCES[0],
    servo::FORCES[1],
    servo::FORCES[2],
    servo::STALE,
    "together: whole recordings",
    "together: worlds swapped",
    "together: attempts kept",
    "together: spoiled histories",
    "together: histories that could not be opened",
];

/// It goes on for so long, and then until the workbench has done this.
const LEAST: Duration = Duration::from_millis(2_500);
const DEEDS: usize = 6;

/// What was done, counted on another thread.
pub type Counts = BTreeMap<&'static str, u64>;

/// Tells the other threads to end, also when this one fails.
struct Ending<'a>(&'a AtomicBool);

impl Drop for Ending<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

pub fn at_the_same_time(chaos: &mut Chaos) {
    use rand::RngExt as _;
    let folder = chaos.scratch();
    let at = |name: &str| folder.path().join(name);
    let database = at("history.sqlite");
    let (recordings, spoiled) = (at("recordings"), at("spoiled"));
    let [first, second]: [u64; 2] = [chaos.rng.random(), chaos.rng.random()];
    let over = AtomicBool::new(false);
    // Another hand in each lap: the fewest laps have them all.
    chaos.count("together: laps", 1);
    let number = chaos.counts["together: laps"];
    std::thread::scope(|scope| {
        let ending = Ending(&over);
        let others = [
            scope.spawn(|| servo::trained(&recordings, number, first, &over)),
            scope.spawn(|| histories::of_another_program(&database, &over)),
            scope.spawn(|| histories::on_a_bad_disk(&spoiled, second, &over)),
        ];
        let mut bench = Bench::open(&at("kept"));
        trainees::open_history(
            &mut bench.session.training.learning,
            &mut bench.session.messages,
            &bench.ctx,
            database.clone(),
        );
        let (begun, mut deeds) = (Instant::now(), 0);
        while deeds < DEEDS || begun.elapsed() < LEAST {
            assert!(
                trainees::keep_attempt(
                    &bench.session.training.learning,
                    histories::attempt(histories::HERE, deeds as u64)
                ),
                "it has a history"
            );
            bench.deed(chaos, folder.path(), deeds);
            deeds += 1;
        }
        bench.must_fit(chaos);
        // What was asked of the history is done before it is closed.
        drop(bench);
        drop(ending);
        for other in others {
            match other.join() {
                Ok(counts) => counts.into_iter().for_each(|(what, count)| chaos.count(what, count)),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        chaos.count("together: attempts kept", histories::must_be_whole(&database, deeds as u64));
    });
}
