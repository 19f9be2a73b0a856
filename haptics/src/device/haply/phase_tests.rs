//! Two boards whose answers fall into different ticks of the servo: boards have clocks of their own.

use super::tests::until;
use super::*;
use crate::servo::safety::{Limits, Safety, SafetyFlags};
use std::io::{Error, ErrorKind, Read, Result, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering};

/// State shared by a board and the test: answers are given when the test lets them go.
#[derive(Default)]
struct Bench {
    asked: AtomicU64,
    /// Answers that may have gone out.
    granted: AtomicU64,
    /// Angle of both cranks, degrees beyond the pose.
    turned: AtomicU32,
    closed: AtomicBool,
}

/// A line whose board answers on the bench's word.
struct Bound {
    bench: Arc<Bench>,
    answered: u64,
    coming: Vec<u8>,
}

impl Write for Bound {
    fn write(&mut self, frame: &[u8]) -> Result<usize> {
        // The set-up is no question.
        self.bench.asked.fetch_add(u64::from(frame.len() == 10), Ordering::SeqCst);
        Ok(frame.len())
    }

    fn flush(&mut self) -> Result<()> {
        Ok(())
    }
}

impl Read for Bound {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize> {
        let Bench { asked, granted, turned, closed } = &*self.bench;
        if self.coming.is_empty() {
            let waiting = self.answered < asked.load(Ordering::SeqCst);
            let may = || granted.load(Ordering::SeqCst) > self.answered;
            if !waiting || !until(|| may() || closed.load(Ordering::SeqCst)) || !may() {
                return Err(Error::from(ErrorKind::TimedOut));
            }
            let further = f32::from_bits(turned.load(Ordering::SeqCst));
            self.coming =
                [vec![5], pose(further)[0].to_le_bytes().into(), pose(further)[1].to_le_bytes().into()].concat();
            self.answered += 1;
        }
        let count = buffer.len().min(self.coming.len());
        buffer[..count].copy_from_slice(&self.coming[..count]);
        self.coming.drain(..count);
        Ok(count)
    }
}

/// Encoders in port order, degrees.
fn pose(further: f32) -> [f32; 2] {
    [60.0 + further, 120.0 + further]
}

/// Position of the tip then, m in the device's frame.
fn tip(further: f32) -> Vec2 {
    let [one, two] = pose(further).map(|degrees| f64::from(degrees).to_radians());
    FiveBar::V3.tip([two, one]).expect("within reach")
}

/// Two boards that are known, and now stand still until they are let go.
fn hand() -> (HaplyHand, [Arc<Bench>; 2]) {
    let benches = [Arc::new(Bench::default()), Arc::new(Bench::default())];
    let mut boards = benches.each_ref().map(|bench| {
        let line = Bound { bench: Arc::clone(bench), answered: 0, coming: Vec::new() };
        Board::start(Box::new(line), BoardModel::V3).expect("a thread")
    });
    for (board, bench) in boards.iter_mut().zip(&benches) {
        // One answer at a time from the first: whenever this thread continues, exactly one question is open.
        assert!(
            until(|| {
                answer(bench, 0.0);
                board.answer().number > 0
            }),
            "the board is known"
        );
    }
    let place = Placement { device_m: Vec2::zeros(), world_m: Vec2::zeros(), scale: 1.0 };
    (HaplyHand::new(boards, [place; 2]), benches)
}

/// One answer with the cranks turned so far, and it has come in: the next question follows it.
fn answer(bench: &Bench, further: f32) {
    bench.turned.store(further.to_bits(), Ordering::SeqCst);
    let open = bench.asked.load(Ordering::SeqCst);
    bench.granted.store(open, Ordering::SeqCst);
    assert!(until(|| bench.asked.load(Ordering::SeqCst) > open), "the answer came in");
}

/// Turned so far at a time, degrees: 20° a second, some 25 mm/s.
fn turned(time_s: f64) -> f32 {
    (20.0 * time_s) as f32
}

/// All times in quarters of a millisecond: a servo's tick, the boards' period, and how much later the second one answers.
fn run([tick, period, phase]: [u32; 3]) {
    let case = format!("tick {tick}, period {period}, phase {phase} quarters of a ms");
    let seconds = |quarters: u32| 0.25e-3 * f64::from(quarters);
    let (mut hand, benches) = hand();
    let limits = Limits { ramp_s: 1e-3, ..Limits::default() };
    let mut safety = Safety::new(limits, [Vec2::zeros(); 2]);
    let (mut oldest_s, mut newest) = (0.0_f64, [0.0; 2]);
    for now in 1..=800_u32 {
        for (finger, bench) in benches.iter().enumerate() {
            if (now + finger as u32 * (period - phase)).is_multiple_of(period) {
                newest[finger] = seconds(now);
                answer(bench, turned(newest[finger]));
            }
        }
        if !now.is_multiple_of(tick) {
            continue;
        }
        let mut flags = SafetyFlags::default();
        let sample = safety.admit(&hand.exchange(&Command::default(), seconds(tick)), seconds(tick), &mut flags);
        let force_n = safety.limit([Vec2::new(1.0, 0.0); 2], seconds(tick), &mut flags);
        oldest_s = oldest_s.max(safety.sample_age_s());
        assert!(!flags.stale && !flags.not_finite, "{case}: stale at {now}");
        // 100 ms: the smoothing of the velocity has long settled.
        if now < 400 {
            continue;
        }
        assert!(safety.has_met_both() && (force_n[0].x - 1.0).abs() < 1e-9, "{case}: {force_n:?}");
        for (finger, at_s) in newest.into_iter().enumerate() {
            assert!(
                (sample.tip_in_world[finger] - tip(turned(at_s))).norm() < 1e-7,
                "{case}: finger {finger} at {now}"
            );
            let wanted = (tip(turned(at_s)) - tip(turned(at_s - 0.008))) / 0.008;
            let off = (sample.tip_velocity[finger] - wanted).norm();
            assert!(
                wanted.norm() > 0.01 && off < 0.03 * wanted.norm(),
                "{case}: finger {finger} at {now}: {off} m/s off"
            );
        }
    }
    assert!(oldest_s <= seconds(period + tick) + 1e-12, "{case}: {oldest_s} s old");
    for bench in &benches {
        bench.closed.store(true, Ordering::SeqCst);
    }
}

#[test]
fn boards_that_answer_in_different_ticks_keep_the_hand_fresh_and_its_velocities_right() {
    for tick in [1, 4] {
        for period in [4, 8] {
            for quarters in [0, 1, 2] {
                run([tick, period, quarters * period / 4]);
            }
        }
    }
}

#[test]
fn one_board_that_falls_silent_ends_the_force_of_both_within_the_watchdog_time() {
    let (mut hand, benches) = hand();
    let limits = Limits { ramp_s: 1e-3, ..Limits::default() };
    let mut safety = Safety::new(limits, [Vec2::zeros(); 2]);
    let mut forces = Vec::new();
    for tick in 0..60_u32 {
        answer(&benches[0], turned(1e-3 * f64::from(tick)));
        if tick < 30 {
            answer(&benches[1], 0.0);
        }
        let mut flags = SafetyFlags::default();
        safety.admit(&hand.exchange(&Command::default(), 1e-3), 1e-3, &mut flags);
        forces.push(safety.limit([Vec2::new(1.0, 0.0); 2], 1e-3, &mut flags));
        assert_eq!(flags.stale, forces[tick as usize] == [Vec2::zeros(); 2], "tick {tick}");
    }
    assert!(forces[45][0].x > 0.99, "the watchdog still waits");
    assert!(forces[51..].iter().all(|force| *force == [Vec2::zeros(); 2]), "{:?}", &forces[45..]);
    for bench in &benches {
        bench.closed.store(true, Ordering::SeqCst);
    }
}
