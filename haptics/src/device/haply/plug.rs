//! A board whose cable is pulled and plugged in again.
//!
//! All of it happens on the board's own thread. A line that refuses every question at once has no board at its other
//! end. It is closed, and so is the process that stands by: the system gives the port's name to the returning board
//! only when no process holds it any more. A board that was without power has lost the position of its arm and takes it
//! from the pose in which it is set up. The board therefore stays without torque until a person confirms that the arm
//! lies in its pose of rest ([`Tally::arm_rests`]). From then on the port is tried a few times a second for as long as
//! the hand exists. The gate starts again with a new line: until its answers agree on the position of the hand, the
//! board gets zero torque.

use super::farewell::Outliving;
use super::tally::Tally;
use super::turns::Line;
use std::io::{Error, ErrorKind, Read, Result, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Number of questions, refused at once in a row, that count as a pulled cable. With the rests between them that is
/// some 50 ms, long after the watchdog has set the force to zero.
const REFUSED: u32 = 10;
/// Between two tries to open the port again.
const AGAIN: Duration = Duration::from_millis(200);

/// An open line to a board that has been set up.
pub(super) struct Connection {
    pub line: Box<dyn Line>,
    /// The process that ends the torque when this one dies.
    pub guard: Option<Outliving>,
}

/// Opens a port again; `None` while no board is there.
pub(super) type Connect = Box<dyn FnMut() -> Option<Connection> + Send>;

/// Knows whether the cable is in.
pub(super) struct Plug {
    guard: Option<Outliving>,
    is_guarded: Arc<AtomicBool>,
    /// Nothing for lines that cannot be opened again.
    connect: Option<Connect>,
    refused: u32,
    /// Time of the next try of the port; `None` while the cable is in.
    next_try: Option<Instant>,
    /// Shared counters in which a person confirms that the arm rests.
    tally: Tally,
}

impl Plug {
    /// Of a line that is in.
    pub fn new(guard: Option<Outliving>, connect: Option<Connect>, tally: Tally) -> Self {
        let is_guarded = Arc::new(AtomicBool::new(guard.is_some()));
        Self { guard, is_guarded, connect, refused: 0, next_try: None, tally }
    }

    /// True if a process stands by that ends the torque when this one is killed; read from any thread.
    pub fn is_guarded(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.is_guarded)
    }

    /// Told after every turn whether the line refused it at once. A line to go on with in place of the one before, when the cable was
    /// pulled or is in again.
    pub fn turned(&mut self, refused: bool, now: Instant) -> Option<Box<dyn Line>> {
        let connect = self.connect.as_mut()?;
        let Some(next_try) = self.next_try else {
            self.refused = if refused { self.refused + 1 } else { 0 };
            return (self.refused >= REFUSED).then(|| self.pulled(now));
        };
        if now < next_try || !self.tally.is_looked_for() {
            return None;
        }
        let Some(Connection { line, guard }) = connect() else {
            self.next_try = Some(now + AGAIN);
            return None;
        };
        self.is_guarded.store(guard.is_some(), Ordering::Relaxed);
        (self.guard, self.next_try, self.refused) = (guard, None, 0);
        self.tally.note_unplugged(false);
        Some(line)
    }

    fn pulled(&mut self, now: Instant) -> Box<dyn Line> {
        // It holds the port, too, and has no board to say farewell to.
        self.guard = None;
        self.is_guarded.store(false, Ordering::Relaxed);
        self.next_try = Some(now + AGAIN);
        self.tally.note_unplugged(true);
        Box::new(Nobody)
    }
}

/// The line while the cable is out.
struct Nobody;

impl Read for Nobody {
    fn read(&mut self, _: &mut [u8]) -> Result<usize> {
        Err(Error::from(ErrorKind::NotConnected))
    }
}

impl Write for Nobody {
    fn write(&mut self, _: &[u8]) -> Result<usize> {
        Err(Error::from(ErrorKind::NotConnected))
    }

    fn flush(&mut self) -> Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicU32;

    fn counting(after: u32) -> (Arc<AtomicU32>, Connect) {
        let tries = Arc::new(AtomicU32::new(0));
        let theirs = Arc::clone(&tries);
        let connect = move || {
            let known = theirs.fetch_add(1, Ordering::Relaxed);
            (known >= after).then(|| Connection { line: Box::new(Nobody), guard: None })
        };
        (tries, Box::new(connect))
    }

    #[test]
    fn a_line_that_refuses_for_long_is_let_go_and_opened_again_when_a_person_says_so() {
        let (tries, connect) = counting(2);
        let tally = Tally::default();
        let mut plug = Plug::new(None, Some(connect), tally.clone());
        // Said too early: of an arm that moves.
        tally.arm_rests();
        let mut now = Instant::now();
        for _ in 0..5 {
            assert!((1..REFUSED).all(|_| plug.turned(true, now).is_none()), "a few refusals are no pulled cable");
            assert!(plug.turned(false, now).is_none());
        }
        let pulled = (0..REFUSED).filter_map(|_| plug.turned(true, now)).count();
        assert_eq!((pulled, tries.load(Ordering::Relaxed)), (1, 0));
        assert!(tally.is_unplugged());
        now += 2 * AGAIN;
        assert!(plug.turned(true, now).is_none());
        assert_eq!(tries.load(Ordering::Relaxed), 0, "nobody has said that the arm rests");
        tally.arm_rests();
        for number in 1..=2 {
            assert!(plug.turned(true, now).is_none() && plug.turned(true, now + AGAIN / 2).is_none());
            assert_eq!(tries.load(Ordering::Relaxed), number, "one try in this time");
            now += AGAIN;
        }
        assert!(plug.turned(true, now).is_some(), "the third one finds it");
        assert!(!tally.is_unplugged());
        assert!(plug.turned(true, now).is_none(), "a new line has its own patience");
    }

    #[test]
    fn a_line_without_a_port_stays_what_it_is() {
        let mut plug = Plug::new(None, None, Tally::default());
        let now = Instant::now();
        assert!((0..100).all(|_| plug.turned(true, now).is_none()));
    }
}
