//! The estimator beside the servo: a thread of its own takes the ticks fetched by the window and reports estimates of
//! the touched object.
//!
//! The servo is not involved: ticks come from the ring that it fills anyway. The window never waits. Ticks that the
//! thread cannot take are dropped, and the estimator restarts its windows after the gap. With a manual clock everything
//! happens at once, on one thread.

use estimator::online::information::Wanted;
use estimator::online::{Online, Report, Settings};
use haptics::recording::Task;
use haptics::servo::TickRecord;
use haptics::servo::recorder::{Rows, SensorModel};
use haptics::world::{Shape, World};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Maximum number of parcels that wait for the thread.
const PARCELS: usize = 32;
/// Interval between reports.
const TOLD_EVERY: Duration = Duration::from_millis(250);
/// Seed of the sensor noise, as in a recording.
const SEED: u64 = 1;
/// Number of ticks from which the rate is measured.
const FOR_RATE: usize = 8;
/// Relative change of the period from which the rate counts as another one.
const OTHER_RATE: f64 = 0.3;

/// Ticks of one world.
struct Parcel {
    /// Counter of the worlds: another number restarts the estimator.
    world: u64,
    task: Task,
    gravity_m_s2: f64,
    coarser: f64,
    ticks: Vec<TickRecord>,
}

/// Window side of the estimator.
pub struct Watch {
    /// True if ticks are processed.
    pub on: bool,
    /// Factor on the target accuracies; above 1 they are coarser than the default.
    pub coarser: f64,
    seen: Arc<Mutex<Option<Arc<Report>>>>,
    to: Option<SyncSender<Parcel>>,
    /// Estimator of a manual clock.
    inline: Work,
    world: Option<(Arc<World>, u64)>,
    last_s: f64,
}

impl Default for Watch {
    fn default() -> Self {
        Self {
            on: true,
            coarser: 1.0,
            seen: Arc::default(),
            to: None,
            inline: Work::default(),
            world: None,
            last_s: f64::NEG_INFINITY,
        }
    }
}

/// Task whose parameters can be estimated while a world is touched.
pub fn task_of(world: &World) -> Option<Task> {
    if world.crank.is_some() {
        Some(Task::Crank)
    } else if world.blocks.iter().any(|b| b.shape == Shape::Barrel) {
        Some(Task::Barrel)
    } else if world.blocks.is_empty() {
        None
    } else {
        Some(Task::BlockStack)
    }
}

impl Watch {
    /// Processes ticks of a world; with `at_once` without a thread.
    pub fn take(&mut self, ticks: &[TickRecord], world: &Arc<World>, at_once: bool) {
        let (Some(first), Some(last)) = (ticks.first(), ticks.last()) else { return };
        let number = self.world.as_ref().map_or(0, |(_, n)| *n);
        let same =
            self.world.as_ref().is_some_and(|(known, _)| Arc::ptr_eq(known, world)) && first.time_s > self.last_s;
        if !same {
            self.world = Some((Arc::clone(world), number + 1));
            *self.seen() = None;
        }
        self.last_s = last.time_s;
        let Some(task) = task_of(world).filter(|_| self.on) else { return };
        let number = self.world.as_ref().map_or(0, |(_, n)| *n);
        let parcel = Parcel {
            world: number,
            task,
            gravity_m_s2: world.gravity_m_s2,
            coarser: self.coarser,
            ticks: ticks.to_vec(),
        };
        if at_once {
            self.inline.take(parcel);
            let report = self.inline.report();
            *self.seen() = report.map(Arc::new);
        } else {
            self.send(parcel);
        }
    }

    fn seen(&self) -> std::sync::MutexGuard<'_, Option<Arc<Report>>> {
        // The value is replaced as a whole.
        self.seen.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn send(&mut self, parcel: Parcel) {
        let to = if let Some(to) = &self.to {
            to
        } else {
            let (to, from) = sync_channel(PARCELS);
            let seen = Arc::clone(&self.seen);
            let begun = std::thread::Builder::new().name("estimator".to_owned()).spawn(move || run(&from, &seen));
            if begun.is_err() {
                // Without a thread there are no estimates; training continues.
                self.on = false;
                return;
            }
            self.to.insert(to)
        };
        if let Err(TrySendError::Disconnected(_)) = to.try_send(parcel) {
            self.to = None;
        }
    }

    /// Current estimates; `None` before the first.
    pub fn report(&self) -> Option<Arc<Report>> {
        self.seen().clone()
    }

    /// Restarts the estimation in the same world.
    pub fn forget(&mut self) {
        self.world = None;
        *self.seen() = None;
    }
}

/// Ends when the window's end of the channel is dropped.
fn run(from: &Receiver<Parcel>, seen: &Mutex<Option<Arc<Report>>>) {
    let mut work = Work::default();
    let mut told = Instant::now();
    while let Ok(parcel) = from.recv() {
        let begun = work.world != parcel.world;
        work.take(parcel);
        if begun || told.elapsed() >= TOLD_EVERY {
            told = Instant::now();
            let report = work.report().map(Arc::new);
            *seen.lock().unwrap_or_else(PoisonError::into_inner) = report;
        }
    }
}

/// The estimator, with the sensor model that it applies to the ticks.
#[derive(Default)]
struct Work {
    world: u64,
    online: Option<Online>,
    period_s: f64,
    coarser: f64,
    rows: Option<Rows>,
}

impl Work {
    fn take(&mut self, parcel: Parcel) {
        let Parcel { world, task, gravity_m_s2, coarser, ticks } = parcel;
        if world != self.world {
            (self.world, self.online) = (world, None);
        }
        let n = ticks.len();
        if n >= FOR_RATE {
            let period_s = (ticks[n - 1].time_s - ticks[0].time_s) / (n - 1) as f64;
            if (period_s - self.period_s).abs() > OTHER_RATE * self.period_s {
                (self.period_s, self.online) = (period_s, None);
            }
        }
        if self.coarser != coarser {
            self.coarser = coarser;
            if let Some(online) = &mut self.online {
                online.want(Wanted { coarser, ..Wanted::default() });
            }
        }
        if self.online.is_none() && self.period_s > 0.0 {
            let wanted = Wanted { coarser, ..Wanted::default() };
            let settings = Settings { gravity_m_s2, wanted, ..Settings::default() };
            self.online = Online::new(task, self.period_s, settings).ok();
        }
        let rows = self.rows.get_or_insert_with(|| Rows::new(SensorModel::TYPICAL, SEED));
        if let Some(online) = &mut self.online {
            for tick in &ticks {
                online.push(tick.time_s, &rows.row(tick));
            }
        }
    }

    fn report(&self) -> Option<Report> {
        self.online.as_ref().map(Online::report)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::world::presets;

    fn ticks(from: usize, to: usize) -> Vec<TickRecord> {
        (from..to).map(|i| TickRecord { time_s: 1e-3 * i as f64, ..TickRecord::default() }).collect()
    }

    #[test]
    fn another_world_begins_anew_and_the_thread_says_what_it_sees() {
        let (blocks, crank) = (Arc::new(presets::stacking()), Arc::new(presets::crank()));
        let mut watch = Watch::default();
        watch.take(&ticks(0, 500), &blocks, true);
        assert_eq!(watch.report().expect("seen").state, "free-motion");
        let mut beside = Watch::default();
        let begun = Instant::now();
        let mut at = 0;
        while beside.report().is_none_or(|r| r.state != "free-motion") {
            beside.take(&ticks(at, at + 100), &crank, false);
            at += 100;
            std::thread::sleep(Duration::from_millis(2));
            assert!(begun.elapsed() < Duration::from_secs(20), "the thread says nothing");
        }
        beside.take(&ticks(at, at + 1), &blocks, false);
        assert!(beside.world.as_ref().is_some_and(|(w, _)| Arc::ptr_eq(w, &blocks)));
    }

    #[test]
    fn switched_off_it_looks_at_nothing() {
        let mut watch = Watch { on: false, ..Watch::default() };
        watch.take(&ticks(0, 500), &Arc::new(presets::stacking()), true);
        assert!(watch.report().is_none());
        watch.on = true;
        watch.take(&ticks(500, 1000), &Arc::new(presets::table()), true);
        assert!(watch.report().is_none(), "nothing to measure on an empty table");
    }
}
