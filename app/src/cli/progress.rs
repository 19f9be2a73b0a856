//! Progress messages on standard error for work that takes longer than a second: its name, and its share done or
//! running time. A terminal gets one every second; a file only gets changes, and the running time once a minute.

use std::io::{IsTerminal as _, Write as _};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Interval of the messages; shorter work is silent.
const EVERY: Duration = Duration::from_secs(1);
/// Interval of the running time in a file.
const EVERY_KEPT: Duration = Duration::from_mins(1);

/// Completed share of the work, if it reports one.
#[derive(Clone, Debug, Default)]
pub struct Share(Arc<AtomicU32>);

impl Share {
    /// Reports the completed share, 0 … 1.
    pub fn tell(&self, share: f64) {
        self.0.store((1e4 * share.clamp(0.0, 1.0)) as u32, Ordering::Relaxed);
    }

    fn far(&self, since: Duration) -> Far {
        match self.0.load(Ordering::Relaxed) {
            0 => Far::Time(since),
            done => Far::Percent(done / 100),
        }
    }
}

/// Completed share, or running time if the work does not report one.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Far {
    Time(Duration),
    Percent(u32),
}

impl Far {
    fn text(self) -> String {
        match self {
            Self::Time(since) => format!("{} s", since.as_secs()),
            Self::Percent(done) => format!("{done} %"),
        }
    }

    /// True if a file needs another line after `before`.
    fn is_news_after(self, before: Option<Self>) -> bool {
        match (before, self) {
            (Some(Self::Time(before)), Self::Time(now)) => now.saturating_sub(before) >= EVERY_KEPT,
            (before, now) => before != Some(now),
        }
    }
}

/// Runs `work`, and reports `what` is being done while it takes longer than a second.
pub fn during<T>(what: &str, work: impl FnOnce(&Share) -> T) -> T {
    let is_kept = !std::io::stderr().is_terminal();
    watched(what, (EVERY, is_kept), &|line| drop(writeln!(std::io::stderr(), "{line}")), work)
}

/// Checks at the interval `every`; `is_kept`: reports only changes.
fn watched<T>(
    what: &str,
    (every, is_kept): (Duration, bool),
    say: &(dyn Fn(&str) + Sync),
    work: impl FnOnce(&Share) -> T,
) -> T {
    let (share, done, over) = (Share::default(), Mutex::new(false), Condvar::new());
    let begun = Instant::now();
    std::thread::scope(|scope| {
        let tell = || {
            let mut finished = done.lock().unwrap_or_else(PoisonError::into_inner);
            let mut said = None;
            loop {
                let waited = over.wait_timeout_while(finished, every, |finished| !*finished);
                finished = waited.unwrap_or_else(PoisonError::into_inner).0;
                if *finished {
                    return;
                }
                let far = share.far(begun.elapsed());
                if !is_kept || far.is_news_after(said) {
                    say(&format!("… {what}: {}", far.text()));
                    said = Some(far);
                }
            }
        };
        // Without a thread there is no message, and the work is done all the same.
        let _ = std::thread::Builder::new().name("progress".to_owned()).spawn_scoped(scope, tell);
        let _end = End(&done, &over);
        work(&share)
    })
}

/// Ends the messages with the work, also on a panic.
struct End<'a>(&'a Mutex<bool>, &'a Condvar);

impl Drop for End<'_> {
    fn drop(&mut self) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = true;
        self.1.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_work_is_told_about_and_short_work_is_not() {
        for is_kept in [false, true] {
            let said = Mutex::new(Vec::new());
            let say = |line: &str| said.lock().expect("one at a time").push(line.to_owned());
            let brief = watched("reading x.csv", (Duration::from_mins(1), is_kept), &say, |_| 7);
            assert!(brief == 7 && said.lock().expect("free").is_empty());
            watched("reading x.csv", (Duration::from_millis(5), is_kept), &say, |share| {
                while said.lock().expect("free").is_empty() {
                    std::thread::yield_now();
                }
                share.tell(0.423);
                while !said.lock().expect("free").iter().any(|line| line == "… reading x.csv: 42 %") {
                    std::thread::yield_now();
                }
            });
            assert_eq!(said.lock().expect("free")[0], "… reading x.csv: 0 s");
        }
    }

    #[test]
    fn a_file_gets_what_changed_and_the_time_once_a_minute() {
        let seconds = |s: u64| Far::Time(Duration::from_secs(s));
        let mut said: Option<Far> = None;
        let mut lines = Vec::new();
        let course = (1..=200).map(seconds).chain((0..100).map(|k| Far::Percent(10 + k / 50)));
        for far in course {
            if far.is_news_after(said) {
                lines.push(far.text());
                said = Some(far);
            }
        }
        assert_eq!(lines, ["1 s", "61 s", "121 s", "181 s", "10 %", "11 %"]);
    }
}
