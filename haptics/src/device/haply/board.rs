//! One board on its own thread: serial ports wait, the servo must not.
//!
//! The thread writes the newest torques and reads the angles, as fast as the board answers. Without new data from the
//! servo for [`GUARD`], it writes zero torque by itself: the firmware keeps the last one for ever. A board whose cable
//! was pulled is found again after it is plugged in ([`super::open`]).

use super::fivebar::FiveBar;
use super::gate::{Gate, Verdict};
use super::plug::{Connect, Connection, Plug};
use super::protocol::{Axis, Turn, setup_frame};
use super::tally::{Fault, Tally};
use super::turns::{Line, Turns};
use crate::Vec2;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use triple_buffer::{Input, Output, triple_buffer};

/// Without a new command for this long the board gets zero torque.
pub const GUARD: Duration = Duration::from_millis(20);

/// A board that is only late is waited for longer than this.
const UNPLUGGED: Duration = Duration::from_micros(500);
/// Pause between two questions to a line with nothing at its other end.
const REST: Duration = Duration::from_millis(5);

/// Geometry and wiring of a board.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoardModel {
    /// Id in every frame.
    pub id: u8,
    /// Linkage.
    pub linkage: FiveBar,
    /// Motors and encoders in port order.
    pub ports: [Axis; 2],
}

impl BoardModel {
    /// Haply 2DIY, third version, id 5.
    pub const V3: Self = Self {
        id: 5,
        linkage: FiveBar::V3,
        ports: [
            Axis { turn: Turn::CounterClockwise, offset_degrees: 12.0, counts: 4880.0 },
            Axis { turn: Turn::CounterClockwise, offset_degrees: 168.0, counts: 4880.0 },
        ],
    };
}

/// The newest answer of a board.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Answer {
    /// Tip in the device's frame, m.
    pub tip_m: Vec2,
    /// Counts the good answers: an unchanged number is an old answer.
    pub number: u64,
    /// Answers that were late, cut short, another board's, or where no hand can be.
    pub faults: u64,
    /// Number of starting places of the hand: at each of them the hand has no known speed from before.
    pub beginnings: u64,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Order {
    force_n: Vec2,
    number: u64,
}

/// The servo's end of a board.
pub struct Board {
    answers: Output<Answer>,
    orders: Input<Order>,
    number: u64,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
    is_guarded: Arc<AtomicBool>,
    tally: Tally,
}

impl Board {
    /// Sets the board up and starts its thread. The line must have a read time-out of a few milliseconds. Once it is pulled it stays
    /// so: only a port can be opened again ([`super::open`]).
    pub fn start(line: Box<dyn Line>, model: BoardModel) -> std::io::Result<Self> {
        let line = set_up(line, model)?;
        Self::run(Connection { line, guard: None }, model, None)
    }

    /// Starts the thread of a board that has been set up.
    pub(super) fn run(connection: Connection, model: BoardModel, again: Option<Connect>) -> std::io::Result<Self> {
        let (answers_in, answers) = triple_buffer(&Answer::default());
        let (orders, orders_out) = triple_buffer(&Order::default());
        let stop = Arc::new(AtomicBool::new(false));
        let tally = Tally::default();
        let plug = Plug::new(connection.guard, again, tally.clone());
        let is_guarded = plug.is_guarded();
        let worker = Worker {
            turns: Turns::new(connection.line, model.id),
            plug,
            model,
            answers: answers_in,
            orders: orders_out,
            stop: Arc::clone(&stop),
            tally: tally.clone(),
        };
        let thread = std::thread::Builder::new().name("haply".to_owned()).spawn(move || worker.run())?;
        Ok(Self { answers, orders, number: 0, stop, thread: Some(thread), is_guarded, tally })
    }

    /// Counts its answers, from any thread.
    pub fn tally(&self) -> Tally {
        self.tally.clone()
    }

    /// True if a process stands by that ends the torque when this one is killed.
    pub fn is_outlived(&self) -> bool {
        self.is_guarded.load(Ordering::Relaxed)
    }

    /// Orders a force on the operator, N, in the device's frame. Never waits.
    pub fn order(&mut self, force_n: Vec2) {
        self.number += 1;
        self.orders.write(Order { force_n, number: self.number });
    }

    /// The newest answer. Never waits.
    pub fn answer(&mut self) -> Answer {
        *self.answers.read()
    }
}

impl Drop for Board {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Says to a board which motors and encoders it has.
pub(super) fn set_up(mut line: Box<dyn Line>, model: BoardModel) -> std::io::Result<Box<dyn Line>> {
    line.write_all(&setup_frame(model.id, model.ports))?;
    line.flush()?;
    Ok(line)
}

struct Worker {
    turns: Turns,
    plug: Plug,
    model: BoardModel,
    answers: Input<Answer>,
    orders: Output<Order>,
    stop: Arc<AtomicBool>,
    tally: Tally,
}

impl Worker {
    fn run(mut self) {
        let mut answer = Answer::default();
        let mut gate = Gate::default();
        // Only of answers that were believed: torques belong to a pose.
        let mut angles: Option<[f64; 2]> = None;
        let (mut last_number, mut last_order) = (0, Instant::now());
        while !self.stop.load(Ordering::Relaxed) {
            let order = *self.orders.read();
            if order.number != last_number {
                (last_number, last_order) = (order.number, Instant::now());
            }
            let fresh = last_order.elapsed() < GUARD;
            let torques = match angles {
                Some(angles) if fresh => self.model.linkage.torques(angles, order.force_n),
                _ => [0.0; 2],
            };
            let asked = Instant::now();
            let heard = self.exchange(torques);
            let refused = heard == Err(Fault::Late) && asked.elapsed() < UNPLUGGED;
            if refused {
                // A line without a device refuses at once, and would take a processor for itself.
                std::thread::sleep(REST);
            }
            let tip = heard.ok().and_then(|angles| self.model.linkage.tip(angles));
            let verdict = tip.map_or(Verdict::Refused, |tip_m| gate.judge(tip_m, Instant::now()));
            let believed = matches!(verdict, Verdict::Follows | Verdict::Begins);
            angles = heard.ok().filter(|_| believed);
            match tip.filter(|_| believed) {
                Some(tip_m) => {
                    let beginnings = answer.beginnings + u64::from(verdict == Verdict::Begins);
                    answer = Answer { tip_m, number: answer.number + 1, beginnings, ..answer };
                }
                None => answer.faults += u64::from(verdict == Verdict::Refused),
            }
            self.tally.add((verdict == Verdict::Refused).then(|| heard.err().unwrap_or(Fault::Impossible)));
            self.answers.write(answer);
            if let Some(line) = self.plug.turned(refused, Instant::now()) {
                // An earlier position of the hand does not hold for another line.
                (self.turns, gate, angles) = (Turns::new(line, self.model.id), Gate::default(), None);
            }
        }
        // The last word is zero torque in every case.
        self.turns.farewell();
    }

    /// Writes torques (actuators 1 and 2), reads the angles, rad; an error for anything but this turn's reply of this board.
    fn exchange(&mut self, [first, second]: [f64; 2]) -> Result<[f64; 2], Fault> {
        // Actuator 1 sits on port 2, actuator 2 on port 1.
        let degrees = self.turns.turn([second as f32, first as f32])?;
        Ok([f64::from(degrees[1]).to_radians(), f64::from(degrees[0]).to_radians()])
    }
}
