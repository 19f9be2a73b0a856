//! The hAPI wire format: commands to a board and its replies.
//!
//! Host → board `[command][device id][bytes…][f32 little endian…]`, no checksum, no length. Board → host only after a write:
//! `[device id][f32 analog…][f32 encoder degrees in port order]`.

/// Torque that the firmware allows, N m; both motors are scaled together beyond it.
pub const MAX_TORQUE_NM: f32 = 0.156;

/// Bytes of a reply with two encoders and no analog pin.
pub const REPLY_BYTES: usize = 9;

const SETUP: u8 = 1;
const WRITE: u8 = 2;
/// Motors and encoders sit on ports 1 and 2: mask bit = port − 1.
const PORTS_1_AND_2: u8 = 0b11;

/// Direction of rotation that counts positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// 0 on the wire.
    Clockwise,
    /// 1 on the wire.
    CounterClockwise,
}

/// One motor with its encoder, as the board must know it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// Direction of motor and encoder.
    pub turn: Turn,
    /// Encoder angle in the resting pose, degrees.
    pub offset_degrees: f32,
    /// Encoder counts a revolution.
    pub counts: f32,
}

/// Set-up frame of a board with two motors on ports 1 and 2 (24 + 2 bytes).
pub fn setup_frame(id: u8, ports: [Axis; 2]) -> [u8; 26] {
    let mut frame = [0; 26];
    let directions = ports.map(|axis| u8::from(axis.turn == Turn::CounterClockwise));
    frame[..10].copy_from_slice(&[
        SETUP,
        id,
        PORTS_1_AND_2,
        directions[0],
        directions[1],
        PORTS_1_AND_2,
        directions[0],
        directions[1],
        0, // analog pins
        0, // PWM pins
    ]);
    for (axis, place) in ports.iter().zip([10, 18]) {
        frame[place..place + 4].copy_from_slice(&axis.offset_degrees.to_le_bytes());
        frame[place + 4..place + 8].copy_from_slice(&axis.counts.to_le_bytes());
    }
    frame
}

/// Torques in port order, N m, limited as the firmware does: when one exceeds the limit, both are scaled together. Not a
/// number counts as zero.
pub fn torque_frame(id: u8, torques_nm: [f32; 2]) -> [u8; 10] {
    let finite = torques_nm.map(|t| if t.is_finite() { t } else { 0.0 });
    let largest = finite[0].abs().max(finite[1].abs());
    let scale = if largest > MAX_TORQUE_NM { MAX_TORQUE_NM / largest } else { 1.0 };
    let mut frame = [0; 10];
    frame[..2].copy_from_slice(&[WRITE, id]);
    for (torque, place) in finite.iter().zip([2, 6]) {
        frame[place..place + 4].copy_from_slice(&(torque * scale).to_le_bytes());
    }
    frame
}

/// Encoder angles in port order, degrees; `None` when the reply is another board's or not a number.
pub fn read_reply(id: u8, reply: &[u8; REPLY_BYTES]) -> Option<[f32; 2]> {
    let angle = |at: usize| f32::from_le_bytes([reply[at], reply[at + 1], reply[at + 2], reply[at + 3]]);
    let angles = [angle(1), angle(5)];
    (reply[0] == id && angles.iter().all(|a| a.is_finite() && a.abs() < 1e4)).then_some(angles)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes(hex: &str) -> Vec<u8> {
        let digits: Vec<u8> = hex.bytes().filter(u8::is_ascii_hexdigit).collect();
        digits
            .chunks(2)
            .map(|pair| u8::from_str_radix(std::str::from_utf8(pair).expect("ascii"), 16).expect("hex"))
            .collect()
    }

    #[test]
    fn golden_setup_frames() {
        let axis = |turn, offset_degrees, counts| Axis { turn, offset_degrees, counts };
        let v3 =
            setup_frame(5, [axis(Turn::CounterClockwise, 12.0, 4880.0), axis(Turn::CounterClockwise, 168.0, 4880.0)]);
        assert_eq!(v3.to_vec(), bytes("01 05 03 01 01 03 01 01 00 00 00004041 00809845 00002843 00809845"));
        let v2 = setup_frame(5, [axis(Turn::Clockwise, -61.0, 10752.0), axis(Turn::CounterClockwise, 241.0, 10752.0)]);
        assert_eq!(v2.to_vec(), bytes("01 05 03 00 01 03 00 01 00 00 000074c2 00002846 00007143 00002846"));
    }

    #[test]
    fn torques_are_limited_together_and_never_nan() {
        let frame = torque_frame(5, [0.312, -0.078]);
        let torque = |at: usize| f32::from_le_bytes(frame[at..at + 4].try_into().expect("four bytes"));
        assert!((torque(2) - 0.156).abs() < 1e-6 && (torque(6) + 0.039).abs() < 1e-6);
        assert_eq!(torque_frame(5, [f32::NAN, 0.0])[2..6], [0; 4]);
    }

    #[test]
    fn replies_of_others_and_nonsense_are_refused() {
        let mut reply = [0; REPLY_BYTES];
        reply[0] = 5;
        reply[1..5].copy_from_slice(&60.0_f32.to_le_bytes());
        reply[5..9].copy_from_slice(&120.0_f32.to_le_bytes());
        assert_eq!(read_reply(5, &reply), Some([60.0, 120.0]));
        assert_eq!(read_reply(4, &reply), None);
        reply[5..9].copy_from_slice(&f32::NAN.to_le_bytes());
        assert_eq!(read_reply(5, &reply), None);
    }
}
