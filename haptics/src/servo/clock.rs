//! Absolute deadlines: sleep most of the way, spin the rest, never make up for lost ticks.

use std::time::{Duration, Instant};

/// Wake this long before the deadline and spin: the sleep of a loaded desktop is that inexact.
const SPIN: Duration = Duration::from_micros(120);

/// A schedule of evenly spaced deadlines.
#[derive(Debug)]
pub struct Deadlines {
    period: Duration,
    next: Instant,
}

impl Deadlines {
    /// The first deadline is one period from now.
    pub fn new(period: Duration) -> Self {
        Self { period, next: Instant::now() + period }
    }

    /// Waits for the next deadline. Returns the lateness of waking, s, and whether a deadline was missed by more than a
    /// period. The schedule then starts again at the present: no burst of ticks follows.
    pub fn wait(&mut self) -> (f64, bool) {
        let now = Instant::now();
        if let Some(left) = self.next.checked_duration_since(now) {
            if let Some(asleep) = left.checked_sub(SPIN) {
                // The servo's own schedule: the one place where sleeping is the job.
                std::thread::sleep(asleep);
            }
            while Instant::now() < self.next {
                std::hint::spin_loop();
            }
        }
        let now = Instant::now();
        let late = now.saturating_duration_since(self.next);
        let missed = late > self.period;
        self.next = if missed { now + self.period } else { self.next + self.period };
        (late.as_secs_f64(), missed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_overrun_is_counted_and_not_made_up_for() {
        let mut deadlines = Deadlines::new(Duration::from_millis(2));
        deadlines.wait();
        let stalled = Instant::now();
        while stalled.elapsed() < Duration::from_millis(15) {
            std::hint::spin_loop();
        }
        let (late, missed) = deadlines.wait();
        assert!(missed && late > 0.012, "{late}");
        // The next deadline is a full period away: no burst.
        let resumed = Instant::now();
        deadlines.wait();
        assert!(resumed.elapsed() >= Duration::from_micros(1_900));
    }
}
