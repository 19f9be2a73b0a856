//! Questions and answers on a board's line: assigns each answer to its question.
//!
//! The protocol numbers nothing. A reply that comes after its question was given up would be taken for that of the next
//! question, and so on for ever: every position one turn old. The turns are therefore put in step again after every
//! fault: unanswered questions are counted, and the next turn reads until all of them have been answered or the line
//! falls silent. Its own answer is the last one.

use super::protocol::{REPLY_BYTES, read_reply, torque_frame};
use super::tally::Fault;
use std::io::{Read, Write};

/// A serial line with a read time-out: a real port, or one end of a pseudo-terminal.
pub trait Line: Read + Write + Send {}
impl<T: Read + Write + Send> Line for T {}

/// From here on the questions are no longer counted: everything up to a silence is read.
const MOST_OWED: usize = 256;
/// No turn listens to more than this: a line that never falls silent is no board.
const MOST_BYTES: usize = 2 * MOST_OWED * REPLY_BYTES;
/// Number of turns in a row that may end with fewer replies than owed before the missing ones count as lost.
const PATIENCE: u32 = 2;

/// Bytes that a turn has read, and their interpretation.
#[derive(Clone, Copy, Debug, Default)]
struct Heard {
    /// The last bytes on the line.
    last: [u8; REPLY_BYTES],
    bytes: usize,
    /// Nothing more came.
    silent: bool,
    /// True if exactly the owed bytes came, and the last of them look like a reply.
    settled: bool,
}

/// One side of the conversation with a board.
pub(super) struct Turns {
    line: Box<dyn Line>,
    id: u8,
    /// Questions of before whose answers have not been seen and may still come.
    owed: usize,
    doubts: u32,
}

impl Turns {
    /// A conversation that has not begun. The line must have a read time-out of a few milliseconds.
    pub fn new(line: Box<dyn Line>, id: u8) -> Self {
        // Answers to an earlier user of the port may lie in it, and their number is unknown.
        Self { line, id, owed: MOST_OWED, doubts: 0 }
    }

    /// Sends torques in port order, N m, and returns the encoder angles of the reply, degrees in port order. Anything
    /// but a whole reply of this board to this very frame is an error.
    pub fn turn(&mut self, torques_nm: [f32; 2]) -> Result<[f32; 2], Fault> {
        self.line.write_all(&torque_frame(self.id, torques_nm)).map_err(|_| Fault::Late)?;
        let in_step = self.owed == 0;
        self.owed = MOST_OWED.min(self.owed + 1);
        let heard = self.listen();
        if heard.settled {
            (self.owed, self.doubts) = (0, 0);
        } else if heard.silent {
            self.forgive(heard.bytes / REPLY_BYTES);
        } else {
            self.owed = MOST_OWED;
        }
        // Between good turns a reply that does not come whole and alone is not believed; while the turns are being put in step,
        // the last one is the newest.
        if heard.bytes < REPLY_BYTES {
            return Err(Fault::Late);
        }
        let believed = heard.settled || (heard.silent && !in_step);
        read_reply(self.id, &heard.last).filter(|_| believed).ok_or(Fault::Foreign)
    }

    /// Reads the owed replies, or until the line is silent.
    fn listen(&mut self) -> Heard {
        let mut heard = Heard::default();
        let mut some = [0; 64];
        let expected = self.owed * REPLY_BYTES;
        while heard.bytes < MOST_BYTES {
            // Never beyond the owed bytes, as long as they are known: later ones belong to a later turn.
            let most = expected.saturating_sub(heard.bytes).clamp(1, some.len());
            let Some(count) = self.line.read(&mut some[..most]).ok().filter(|count| *count > 0) else {
                heard.silent = true;
                break;
            };
            for byte in &some[..count] {
                heard.last.rotate_left(1);
                heard.last[REPLY_BYTES - 1] = *byte;
            }
            heard.bytes += count;
            heard.settled =
                self.owed < MOST_OWED && heard.bytes == expected && read_reply(self.id, &heard.last).is_some();
            if heard.settled {
                break;
            }
        }
        heard
    }

    /// Counts the replies still owed after a silence.
    fn forgive(&mut self, replies: usize) {
        if replies == 0 {
            return;
        }
        let counted = self.owed < MOST_OWED;
        self.owed = self.owed.saturating_sub(replies);
        self.doubts += 1;
        if !counted || self.doubts >= PATIENCE {
            (self.owed, self.doubts) = (0, 0);
        }
    }

    /// The last word: zero torque.
    pub fn farewell(&mut self) {
        let _ = self.line.write_all(&torque_frame(self.id, [0.0; 2]));
        let _ = self.line.flush();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::VecDeque;
    use std::sync::{Arc, Mutex};

    const ID: u8 = 5;

    /// A reply whose angle is the number of the question that it answers.
    fn reply(question: usize) -> Vec<u8> {
        let mut reply = vec![ID];
        reply.extend((question as f32).to_le_bytes());
        reply.extend(90.0_f32.to_le_bytes());
        reply
    }

    /// A line in simulated time: a read that finds nothing waits for 5 ms. The board answers in order, after `late_ms` of each
    /// question, and never to those in `lost`.
    #[derive(Default)]
    struct Slow {
        now_ms: f64,
        asked: usize,
        free_ms: f64,
        late_ms: Vec<(usize, f64)>,
        lost: Vec<usize>,
        /// Bytes with the time when they are there.
        coming: VecDeque<(f64, u8)>,
    }

    #[derive(Clone)]
    struct Shared(Arc<Mutex<Slow>>);

    impl Write for Shared {
        fn write(&mut self, frame: &[u8]) -> std::io::Result<usize> {
            let mut line = self.0.lock().expect("one thread");
            line.asked += 1;
            let question = line.asked;
            let takes_ms = line.late_ms.iter().find(|(late, _)| *late == question).map_or(0.3, |(_, ms)| *ms);
            // In order: a board that hangs over one question answers the next after it.
            line.free_ms = line.free_ms.max(line.now_ms) + takes_ms;
            let at = line.free_ms;
            if !line.lost.contains(&question) {
                line.coming.extend(reply(question).into_iter().map(|byte| (at, byte)));
            }
            Ok(frame.len())
        }

        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }

    impl Read for Shared {
        fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
            let mut line = self.0.lock().expect("one thread");
            match line.coming.front() {
                Some((at, _)) if *at <= line.now_ms + 5.0 => line.now_ms = line.now_ms.max(*at),
                _ => {
                    line.now_ms += 5.0;
                    return Err(std::io::ErrorKind::TimedOut.into());
                }
            }
            let mut count = 0;
            while count < buffer.len() && line.coming.front().is_some_and(|(at, _)| *at <= line.now_ms) {
                buffer[count] = line.coming.pop_front().map_or(0, |(_, byte)| byte);
                count += 1;
            }
            Ok(count)
        }
    }

    /// The number of the question that each turn's answer belongs to; zero for none.
    fn converse(line: Slow, turns: usize) -> (Vec<usize>, f64) {
        let line = Shared(Arc::new(Mutex::new(line)));
        let mut conversation = Turns::new(Box::new(line.clone()), ID);
        let answers = (0..turns).map(|_| conversation.turn([0.0; 2]).map_or(0, |angles| angles[0] as usize)).collect();
        let took_ms = line.0.lock().expect("one thread").now_ms;
        (answers, took_ms)
    }

    #[test]
    fn after_a_late_reply_every_answer_is_that_of_its_own_turn() {
        for late_ms in [4.0, 6.0, 9.9, 11.0, 16.0, 27.0, 300.0, 3_000.0] {
            let (answers, _) = converse(Slow { late_ms: vec![(10, late_ms)], ..Slow::default() }, 700);
            let own = |turn: usize| answers[turn - 1] == turn;
            assert!((1..10).all(own), "{late_ms} ms: {answers:?}");
            assert!(
                answers.iter().enumerate().all(|(at, answer)| *answer == 0 || *answer == at + 1),
                "{late_ms} ms: {answers:?}"
            );
            let silent = (late_ms / 5.0).ceil() as usize;
            assert!((10 + silent..=700).all(own), "{late_ms} ms: {answers:?}");
        }
    }

    #[test]
    fn lost_replies_cost_a_few_turns_of_waiting_and_no_step() {
        let (answers, took_ms) = converse(Slow { lost: vec![10, 40, 41, 80], ..Slow::default() }, 200);
        let missing: Vec<usize> = (1..=200).filter(|turn| answers[turn - 1] != *turn).collect();
        assert_eq!(missing, [10, 40, 41, 80], "{answers:?}");
        // Five silences of 5 ms, up to two more after each loss: nothing is waited for after that.
        assert!(took_ms < 200.0 * 0.3 + 5.0 * 15.0, "{took_ms} ms");
    }

    #[test]
    fn a_second_hang_while_the_turns_are_put_in_step_is_waited_for_too() {
        // The answer to 10 comes late; that to 11, asked meanwhile, comes so late after it that the line is silent in between.
        let (answers, _) = converse(Slow { late_ms: vec![(10, 7.0), (11, 8.0)], ..Slow::default() }, 100);
        assert!((14..=100).all(|turn| answers[turn - 1] == turn), "{answers:?}");
    }

    #[test]
    fn what_lies_on_the_line_from_before_is_no_answer() {
        for before in [1, 2, 7] {
            let coming = (0..before).flat_map(|_| reply(999)).map(|byte| (0.0, byte)).collect();
            let (answers, _) = converse(Slow { coming, ..Slow::default() }, 20);
            assert_eq!(answers, (1..=20).collect::<Vec<_>>(), "{before} old replies");
        }
    }

    #[test]
    fn a_line_that_never_falls_silent_is_left_after_a_while() {
        struct Babble;
        impl Read for Babble {
            fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
                buffer.fill(9);
                Ok(buffer.len())
            }
        }
        impl Write for Babble {
            fn write(&mut self, frame: &[u8]) -> std::io::Result<usize> {
                Ok(frame.len())
            }

            fn flush(&mut self) -> std::io::Result<()> {
                Ok(())
            }
        }
        let mut conversation = Turns::new(Box::new(Babble), ID);
        assert!((0..10).all(|_| conversation.turn([0.1; 2]).is_err()));
    }
}
