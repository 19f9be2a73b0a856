//! A word on standard error about what takes longer than a second: what it is, and how far or how long.

use std::io::Write as _;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Nothing is said about work that is done sooner, and again after as long.
const EVERY: Duration = Duration::from_secs(1);

/// How far a work has come, as far as it tells.
#[derive(Clone, Debug, Default)]
pub struct Share(Arc<AtomicU32>);

impl Share {
    /// Tells how much is done, 0 … 1.
    pub fn tell(&self, share: f64) {
        self.0.store((1e4 * share.clamp(0.0, 1.0)) as u32, Ordering::Relaxed);
    }

    fn text(&self, since: Duration) -> String {
        match self.0.load(Ordering::Relaxed) {
            0 => format!("{} s", since.as_secs()),
            done => format!("{} %", done / 100),
        }
    }
}

/// Does `work`, and says `what` is being done while it takes longer than a second.
pub fn during<T>(what: &str, work: impl FnOnce(&Share) -> T) -> T {
    watched(what, EVERY, &|line| drop(writeln!(std::io::stderr(), "{line}")), work)
}

fn watched<T>(what: &str, every: Duration, say: &(dyn Fn(&str) + Sync), work: impl FnOnce(&Share) -> T) -> T {
    let (share, done, over) = (Share::default(), Mutex::new(false), Condvar::new());
    let begun = Instant::now();
    std::thread::scope(|scope| {
        let tell = || {
            let mut finished = done.lock().unwrap_or_else(PoisonError::into_inner);
            loop {
                let waited = over.wait_timeout_while(finished, every, |finished| !*finished);
                finished = waited.unwrap_or_else(PoisonError::into_inner).0;
                if *finished {
                    return;
                }
                say(&format!("… {what}: {}", share.text(begun.elapsed())));
            }
        };
        // Without a thread there is no word, and the work is done all the same.
        let _ = std::thread::Builder::new().name("progress".to_owned()).spawn_scoped(scope, tell);
        let _end = End(&done, &over);
        work(&share)
    })
}

/// Lets the word end with the work, also when that panics.
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
        let said = Mutex::new(Vec::new());
        let say = |line: &str| said.lock().expect("one at a time").push(line.to_owned());
        let brief = watched("reading x.csv", Duration::from_mins(1), &say, |_| 7);
        assert!(brief == 7 && said.lock().expect("free").is_empty());
        watched("reading x.csv", Duration::from_millis(5), &say, |share| {
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
