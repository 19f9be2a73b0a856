//! Haply 2DIY over USB serial (hAPI): an open planar two-joint device; two boards make a two-fingered hand.

mod board;
pub mod farewell;
mod fivebar;
mod gate;
#[cfg(test)]
mod phase_tests;
mod plug;
mod protocol;
mod tally;
#[cfg(all(test, unix))]
mod tests;
mod turns;

pub use board::{Answer, Board, BoardModel, GUARD};
pub use fivebar::FiveBar;
pub use protocol::{Axis, MAX_TORQUE_NM, Turn};
pub use tally::{Fault, Tally};
pub use turns::Line;

use super::interface::{Command, Device, DeviceSpec, Sample};
use crate::Vec2;
use plug::Connection;
use std::path::Path;
use std::time::Duration;

/// Placement of a device's plane in the world: its middle goes to the workspace's middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// A point of the device's workspace, m in the device's frame.
    pub device_m: Vec2,
    /// Position of that point in the world, m.
    pub world_m: Vec2,
    /// World motion per device motion.
    pub scale: f64,
}

/// Time constant of the velocity estimate, s: encoder steps of 0.1 mm at 1 kHz would be 0.1 m/s of noise.
const VELOCITY_SMOOTHING_S: f64 = 0.004;
/// Longest wait of a read before the answer counts as lost.
const READ_TIMEOUT: Duration = Duration::from_millis(5);

/// Why a board could not be used.
#[derive(Debug, thiserror::Error)]
pub enum HaplyError {
    /// The port did not open.
    #[error(
        "the port {port} could not be opened ({reason}); is the board plugged in, and may you use it (group dialout)?"
    )]
    Open {
        /// Its name.
        port: String,
        /// Reason that the operating system reports.
        reason: String,
    },
    /// It opened and did not take the set-up.
    #[error("the board at {port} did not take its set-up ({reason}); unplug it, plug it in and try again")]
    Setup {
        /// Its name.
        port: String,
        /// Reason that the operating system reports.
        reason: String,
    },
}

/// Serial ports that a board could be behind, by name.
pub fn ports() -> Vec<String> {
    let mut names: Vec<String> =
        serialport::available_ports().unwrap_or_default().into_iter().map(|port| port.port_name).collect();
    names.retain(|name| ["ttyACM", "ttyUSB", "usbmodem", "COM"].iter().any(|kind| name.contains(kind)));
    names.sort();
    names
}

/// Opens a port and sets a board up. `program` is the `touchstone` program: with it a process that outlives this one
/// stands by to end the torque ([`farewell`]). Without it, or if the process cannot be started, a killed program leaves
/// the last torque.
///
/// A board whose cable is pulled is found again at the same port after a person has confirmed the pose of rest
/// ([`Tally::arm_rests`]). Until its answers come again it counts as a board that does not answer.
pub fn open(port: &str, model: BoardModel, program: Option<&Path>) -> Result<Board, HaplyError> {
    let connection = connect(port, model, program)?;
    let (again, with) = (port.to_owned(), program.map(Path::to_path_buf));
    let connect = move || connect(&again, model, with.as_deref()).ok();
    let failed = |e: std::io::Error| HaplyError::Setup { port: port.to_owned(), reason: e.to_string() };
    Board::run(connection, model, Some(Box::new(connect))).map_err(failed)
}

fn connect(port: &str, model: BoardModel, program: Option<&Path>) -> Result<Connection, HaplyError> {
    let failed = |reason: String| HaplyError::Open { port: port.to_owned(), reason };
    // The rate does not matter on a USB port; it must be stated all the same.
    let builder = serialport::new(port, 115_200).timeout(READ_TIMEOUT);
    let line = builder.open_native().map_err(|e| failed(e.to_string()))?;
    #[cfg(unix)]
    let (line, guard) = outlived(line, port, model.id, program);
    #[cfg(not(unix))]
    let guard = program.and_then(|program| farewell::Outliving::start(program, port, model.id).ok());
    board::set_up(Box::new(line), model)
        .map(|line| Connection { line, guard })
        .map_err(|e| HaplyError::Setup { port: port.to_owned(), reason: e.to_string() })
}

/// Starts the guard of an open port; others cannot open it before or after that.
#[cfg(unix)]
fn outlived(
    mut line: serialport::TTYPort,
    port: &str,
    id: u8,
    program: Option<&Path>,
) -> (serialport::TTYPort, Option<farewell::Outliving>) {
    let Some(program) = program else { return (line, None) };
    // A port that cannot be shared gets no guard; the board works all the same.
    let guard = line.set_exclusive(false).ok().and_then(|()| farewell::Outliving::start(program, port, id).ok());
    let _ = line.set_exclusive(true);
    (line, guard)
}

/// Two boards as the two fingers.
pub struct HaplyHand {
    spec: DeviceSpec,
    boards: [Board; 2],
    placements: [Placement; 2],
    seen: [Answer; 2],
    /// Time since the answer that was seen last, s.
    since_s: [f64; 2],
    position: [Vec2; 2],
    velocity: [Vec2; 2],
}

impl HaplyHand {
    /// Specification of two 2DIY boards.
    pub fn two_boards() -> DeviceSpec {
        DeviceSpec {
            name: "Two Haply 2DIY boards".to_owned(),
            force_feedback: true,
            max_force_n: 3.0,
            // Measured figures are not published; a free 2DIY moves with about this much (order of magnitude).
            damping_n_s_m: 0.1,
            coulomb_n: 0.05,
            resolution_m: 0.1e-3,
        }
    }

    /// Opens two third-version boards by their ports; the middle of each one's workspace lies a little left and right of
    /// `center_in_world`, the hand's. `program`: see [`open`].
    pub fn open(
        [left_port, right_port]: [&str; 2],
        center_in_world: Vec2,
        program: Option<&Path>,
    ) -> Result<Self, HaplyError> {
        let boards = [open(left_port, BoardModel::V3, program)?, open(right_port, BoardModel::V3, program)?];
        let place = |x: f64| Placement {
            // The middle of a 2DIY's workspace.
            device_m: Vec2::new(0.019, 0.12),
            world_m: center_in_world + Vec2::new(x, 0.0),
            scale: 1.0,
        };
        Ok(Self::new(boards, [place(-0.012), place(0.012)]))
    }

    /// The left and the right board.
    pub fn new(boards: [Board; 2], placements: [Placement; 2]) -> Self {
        Self {
            spec: Self::two_boards(),
            boards,
            placements,
            seen: [Answer::default(); 2],
            since_s: [0.0; 2],
            position: placements.map(|p| p.world_m),
            velocity: [Vec2::zeros(); 2],
        }
    }

    /// Counts the answers of the left and the right board, from any thread.
    pub fn tallies(&self) -> [Tally; 2] {
        [self.boards[0].tally(), self.boards[1].tally()]
    }
}

impl Device for HaplyHand {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn exchange(&mut self, command: &Command, dt_s: f64) -> Sample {
        let mut fresh = [false; 2];
        for (finger, board) in self.boards.iter_mut().enumerate() {
            board.order(command.force_n[finger]);
            let answer = board.answer();
            let place = &self.placements[finger];
            self.since_s[finger] += dt_s;
            // Each finger by itself: two boards with clocks of their own hardly ever answer in the same tick.
            if answer.number != self.seen[finger].number {
                fresh[finger] = true;
                let position = place.world_m + (answer.tip_m - place.device_m) * place.scale;
                if answer.beginnings == self.seen[finger].beginnings {
                    // The servo may tick faster than the board answers.
                    let way_s = self.since_s[finger].max(1e-6);
                    let blend = 1.0 - (-way_s / VELOCITY_SMOOTHING_S).exp();
                    let raw = (position - self.position[finger]) / way_s;
                    self.velocity[finger] += (raw - self.velocity[finger]) * blend;
                } else {
                    // A first answer says where the finger is, not how fast it came there.
                    self.velocity[finger] = Vec2::zeros();
                }
                self.position[finger] = position;
                self.since_s[finger] = 0.0;
            }
            self.seen[finger] = answer;
        }
        Sample { tip_in_world: self.position, tip_velocity: self.velocity, fresh }
    }

    fn make_safe(&mut self) {
        for board in &mut self.boards {
            board.order(Vec2::zeros());
        }
    }
}
