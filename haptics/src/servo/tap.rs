//! A second way out for ticks: a ring that the servo fills only during a recording.
//!
//! The ring that the window empties once a frame may overflow when no frame is drawn. A recording must not lose ticks to that, so a
//! thread of its own empties this one. The servo's side never waits: a tick that finds the ring full is counted and dropped.

use super::control_loop::TickRecord;
use rtrb::{Consumer, Producer, RingBuffer};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// State shared by both ends.
#[derive(Debug)]
struct Shared {
    /// True during a recording.
    open: AtomicBool,
    /// Ticks that found the ring full since it was opened.
    dropped: AtomicU64,
    /// The consumer while no recorder has it. The servo's side never touches it.
    home: Mutex<Option<Consumer<TickRecord>>>,
}

/// A closed tap: the end that a tick fills, and the one where it is opened. Room for `capacity` ticks is allocated
/// here.
pub fn tap(capacity: usize) -> (TapFiller, TapSource) {
    let (ticks, out) = RingBuffer::new(capacity);
    let shared = Shared { open: AtomicBool::new(false), dropped: AtomicU64::new(0), home: Mutex::new(Some(out)) };
    let shared = Arc::new(shared);
    (TapFiller { ticks, shared: Arc::clone(&shared) }, TapSource { shared })
}

/// The servo's end.
#[derive(Debug)]
pub struct TapFiller {
    ticks: Producer<TickRecord>,
    shared: Arc<Shared>,
}

impl TapFiller {
    /// Hands a tick to the recorder, if there is one. Allocates, locks and waits for nothing.
    pub fn offer(&mut self, tick: TickRecord) {
        // Relaxed is enough: a world that is swapped in after the tap was closed comes through a ring that orders the two.
        if self.shared.open.load(Ordering::Relaxed) && self.ticks.push(tick).is_err() {
            self.shared.dropped.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// True when the next tick would be dropped: for loops that have time to wait, unlike the servo.
    pub fn must_wait(&self) -> bool {
        self.shared.open.load(Ordering::Relaxed) && self.ticks.is_full()
    }
}

/// Handle by which a tap is opened.
#[derive(Clone, Debug)]
pub struct TapSource {
    shared: Arc<Shared>,
}

impl TapSource {
    /// Every tick from now on; `None` while another one has it.
    pub fn open(&self) -> Option<Tap> {
        let mut ticks = self.shared.home.lock().unwrap_or_else(PoisonError::into_inner).take()?;
        // Drops the ticks that came in while the last recorder closed it.
        while ticks.pop().is_ok() {}
        self.shared.dropped.store(0, Ordering::Relaxed);
        self.shared.open.store(true, Ordering::Relaxed);
        Some(Tap { ticks: Some(ticks), shared: Arc::clone(&self.shared) })
    }

    /// Lets no further tick in; ticks in the ring stay there for their reader. A world that is swapped in afterwards is
    /// never seen.
    pub fn close(&self) {
        self.shared.open.store(false, Ordering::Release);
    }
}

/// The recorder's end. Dropping it closes the tap.
#[derive(Debug)]
pub struct Tap {
    ticks: Option<Consumer<TickRecord>>,
    shared: Arc<Shared>,
}

impl Tap {
    /// The oldest tick that was not read yet; never waits.
    pub fn pop(&mut self) -> Option<TickRecord> {
        self.ticks.as_mut()?.pop().ok()
    }

    /// Ticks that were lost because the ring was full.
    pub fn dropped(&self) -> u64 {
        self.shared.dropped.load(Ordering::Relaxed)
    }

    /// True when no further tick will come: the tap was closed or the servo is gone. Ticks in the ring can still be
    /// read. All that was done before [`TapSource::close`] is seen from then on.
    pub fn is_over(&self) -> bool {
        !self.shared.open.load(Ordering::Acquire) || self.ticks.as_ref().is_none_or(Consumer::is_abandoned)
    }
}

impl Drop for Tap {
    fn drop(&mut self) {
        self.shared.open.store(false, Ordering::Relaxed);
        *self.shared.home.lock().unwrap_or_else(PoisonError::into_inner) = self.ticks.take();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(time_s: f64) -> TickRecord {
        TickRecord { time_s, ..TickRecord::default() }
    }

    #[test]
    fn only_ticks_of_the_open_tap_come_out_and_what_does_not_fit_is_counted() {
        let (mut filler, source) = tap(4);
        filler.offer(at(0.0));
        let mut first = source.open().expect("nobody has it");
        assert!(source.open().is_none(), "one at a time");
        for i in 1..=6 {
            filler.offer(at(f64::from(i)));
        }
        assert!(filler.must_wait() && !first.is_over());
        assert_eq!((first.dropped(), first.pop().map(|t| t.time_s)), (2, Some(1.0)));
        source.close();
        filler.offer(at(7.0));
        assert!(first.is_over() && !filler.must_wait());
        assert_eq!(first.pop().map(|t| t.time_s), Some(2.0), "what was in the ring stays");
        drop(first);
        let mut second = source.open().expect("given back");
        assert_eq!((second.dropped(), second.pop()), (0, None), "nothing of the first recording");
        filler.offer(at(8.0));
        drop(filler);
        assert!(second.is_over(), "the servo is gone");
        assert_eq!(second.pop().map(|t| t.time_s), Some(8.0));
    }
}
