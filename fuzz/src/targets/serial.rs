//! Any bytes as what a board answers: the hand goes on, its place is a place, and no torque is beyond what the motors take.

use haptics::Vec2;
use haptics::device::haply::{Board, BoardModel, MAX_TORQUE_NM};
use std::io::{Read, Result, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// What the board's thread has come to: a panic there would be nobody's.
#[derive(Default)]
struct Seen {
    over: AtomicBool,
    wrong: Mutex<Vec<f32>>,
}

/// A line that says the fuzzer's bytes and then falls silent.
struct Line {
    says: std::io::Cursor<Vec<u8>>,
    seen: Arc<Seen>,
}

impl Drop for Line {
    fn drop(&mut self) {
        self.seen.over.store(true, Ordering::Relaxed);
    }
}

impl Read for Line {
    fn read(&mut self, into: &mut [u8]) -> Result<usize> {
        let count = self.says.read(into)?;
        self.seen.over.fetch_or(count == 0, Ordering::Relaxed);
        Ok(count)
    }
}

impl Write for Line {
    fn write(&mut self, frame: &[u8]) -> Result<usize> {
        // Torques: a head of two bytes and two numbers.
        if frame.len() == 10 {
            for number in frame[2..].chunks_exact(4) {
                let torque_nm = f32::from_le_bytes([number[0], number[1], number[2], number[3]]);
                let is_bounded = torque_nm.abs() <= MAX_TORQUE_NM + 1e-6;
                if !is_bounded {
                    self.seen.wrong.lock().unwrap_or_else(PoisonError::into_inner).push(torque_nm);
                }
            }
        }
        Ok(frame.len())
    }

    fn flush(&mut self) -> Result<()> {
        Ok(())
    }
}

pub fn run(bytes: &[u8]) {
    let seen = Arc::new(Seen::default());
    let line = Line { says: std::io::Cursor::new(bytes.to_vec()), seen: Arc::clone(&seen) };
    let mut board = Board::start(Box::new(line), BoardModel::V3).expect("it takes its set-up");
    while !seen.over.load(Ordering::Relaxed) {
        board.order(Vec2::new(2.0, -2.0));
        assert!(board.answer().tip_m.iter().all(|place| place.is_finite()));
    }
    drop(board);
    let wrong = seen.wrong.lock().unwrap_or_else(PoisonError::into_inner);
    assert!(wrong.is_empty(), "{wrong:?} N m");
}
