//! One direction of a network: packets are delivered late, sometimes out of order, sometimes never.

use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Packets a second that the line has room for: one a tick at the fastest servo.
const MOST_HZ: f64 = 8_000.0;
const NANOSECOND: f64 = 1e-9;

/// A line that delays, scatters and loses. Its room is made once.
pub(crate) struct Line<T> {
    delay_s: f64,
    jitter_s: f64,
    loss: f64,
    rng: StdRng,
    under_way: BinaryHeap<Reverse<Packet<T>>>,
    sent: u64,
    newest: u64,
}

struct Packet<T> {
    due_ns: u64,
    sequence: u64,
    value: T,
}

impl<T> Packet<T> {
    fn order(&self) -> (u64, u64) {
        (self.due_ns, self.sequence)
    }
}

impl<T> PartialEq for Packet<T> {
    fn eq(&self, other: &Self) -> bool {
        self.order() == other.order()
    }
}

impl<T> Eq for Packet<T> {}

impl<T> PartialOrd for Packet<T> {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl<T> Ord for Packet<T> {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.order().cmp(&other.order())
    }
}

impl<T> Line<T> {
    pub fn new(delay_s: f64, jitter_s: f64, loss: f64, seed: u64) -> Self {
        let room = ((delay_s + jitter_s) * MOST_HZ) as usize + 16;
        Self {
            delay_s,
            jitter_s,
            loss,
            rng: StdRng::seed_from_u64(seed),
            under_way: BinaryHeap::with_capacity(room),
            sent: 0,
            newest: 0,
        }
    }

    /// Puts a value on its way. A full line loses it, as networks do.
    pub fn send(&mut self, now_s: f64, value: T) {
        self.sent += 1;
        // Drawn in any case, so that the packets after it fare the same whatever the loss.
        let (fate, late): (f64, f64) = (self.rng.random(), self.rng.random());
        if fate < self.loss || self.under_way.len() == self.under_way.capacity() {
            return;
        }
        let due_s = now_s + self.delay_s + self.jitter_s * late;
        self.under_way.push(Reverse(Packet { due_ns: nanoseconds(due_s), sequence: self.sent, value }));
    }

    /// The newest value that has arrived by now, if it is newer than all before; overtaken ones are dropped.
    pub fn receive(&mut self, now_s: f64) -> Option<T> {
        let mut newest = None;
        while self.under_way.peek().is_some_and(|Reverse(packet)| packet.due_ns <= nanoseconds(now_s)) {
            if let Some(Reverse(packet)) = self.under_way.pop()
                && packet.sequence > self.newest
            {
                self.newest = packet.sequence;
                newest = Some(packet.value);
            }
        }
        newest
    }
}

fn nanoseconds(time_s: f64) -> u64 {
    (time_s / NANOSECOND).round() as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn through(line: &mut Line<u32>, ticks: u32) -> Vec<(u32, u32)> {
        let mut arrived = Vec::new();
        for tick in 0..ticks {
            let now_s = f64::from(tick) * 1e-3;
            line.send(now_s, tick);
            if let Some(value) = line.receive(now_s) {
                arrived.push((tick, value));
            }
        }
        arrived
    }

    #[test]
    fn a_perfect_line_only_delays() {
        for delay in [0, 7, 250] {
            let arrived = through(&mut Line::new(f64::from(delay) * 1e-3, 0.0, 0.0, 1), 1_000);
            assert_eq!(arrived.len(), 1_000 - delay as usize);
            assert!(arrived.iter().all(|(at, sent)| at - sent == delay));
        }
    }

    #[test]
    fn jitter_and_loss_are_what_was_asked_for_and_nothing_goes_back_in_time() {
        let arrived = through(&mut Line::new(0.05, 0.0, 0.3, 5), 100_000);
        assert!((arrived.len() as f64 / 100_000.0 - 0.7).abs() < 0.01);
        let arrived = through(&mut Line::new(0.05, 0.02, 0.1, 5), 20_000);
        assert!(arrived.iter().all(|(at, sent)| (50..=70).contains(&(at - sent))));
        assert!(arrived.windows(2).all(|pair| pair[0].1 < pair[1].1));
        assert_eq!(arrived, through(&mut Line::new(0.05, 0.02, 0.1, 5), 20_000), "one seed, one fate");
    }
}
