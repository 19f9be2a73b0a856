//! Any bytes as what a board answers: the hand goes on, and no torque is asked of a board that does not answer as one.

use haptics::Vec2;
use haptics::device::haply::{Board, BoardModel, MAX_TORQUE_NM};
use std::io::{Read, Result, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A line that says the fuzzer's bytes and then falls silent.
struct Line {
    says: std::io::Cursor<Vec<u8>>,
    over: Arc<AtomicBool>,
}

impl Read for Line {
    fn read(&mut self, into: &mut [u8]) -> Result<usize> {
        let count = self.says.read(into)?;
        self.over.fetch_or(count == 0, Ordering::Relaxed);
        Ok(count)
    }
}

impl Write for Line {
    fn write(&mut self, frame: &[u8]) -> Result<usize> {
        // Torques: a head of two bytes and two numbers.
        if frame.len() == 10 {
            for number in frame[2..].chunks_exact(4) {
                let torque_nm = f32::from_le_bytes([number[0], number[1], number[2], number[3]]);
                assert!(torque_nm.abs() <= MAX_TORQUE_NM + 1e-6, "{torque_nm} N m");
            }
        }
        Ok(frame.len())
    }

    fn flush(&mut self) -> Result<()> {
        Ok(())
    }
}

pub fn run(bytes: &[u8]) {
    let over = Arc::new(AtomicBool::new(false));
    let line = Line { says: std::io::Cursor::new(bytes.to_vec()), over: Arc::clone(&over) };
    let mut board = Board::start(Box::new(line), BoardModel::V3).expect("it takes its set-up");
    while !over.load(Ordering::Relaxed) {
        board.order(Vec2::new(2.0, -2.0));
        assert!(board.answer().tip_m.iter().all(|place| place.is_finite()));
    }
}
