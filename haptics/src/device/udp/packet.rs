//! The packets of a remote device, both ways. `docs/udp/README.md` is the description for authors of the other side.
//!
//! Little-endian, fixed size, the same header, a seal at the end:
//! `[magic 4][version 1][kind 1][flags 2][session 8][sequence 8][time 8][payload][seal 16]`.

use super::key::{Key, SEAL_BYTES};
use crate::Vec2;

/// First four bytes of every packet.
pub const MAGIC: [u8; 4] = *b"TSUD";
/// Version of the layout of packets with positions and forces; those with waves are another one's.
pub const VERSION: u8 = 1;
/// Bytes of a motion packet, device → Touchstone.
pub const MOTION_BYTES: usize = HEADER_BYTES + 64 + SEAL_BYTES;
/// Bytes of a force packet, Touchstone → device.
pub const FORCE_BYTES: usize = HEADER_BYTES + 40 + SEAL_BYTES;
/// Tips farther than this from the origin are refused, m.
pub const MAX_POSITION_M: f64 = 1.0;
/// Velocities beyond this are refused, m/s.
pub const MAX_VELOCITY_M_S: f64 = 20.0;
/// Flag of a motion packet: the device goes away.
pub const FLAG_BYE: u16 = 1;
/// Flag of a force packet: the session in it is new to the device, which must send it from now on; the force is zero.
pub const FLAG_GREETING: u16 = 1;

pub(super) const HEADER_BYTES: usize = 32;
const MOTION: u8 = 1;
const FORCE: u8 = 2;

/// Packet that a device sends.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// [`FLAG_BYE`].
    pub flags: u16,
    /// The number that Touchstone gave to this session; 0 asks for it.
    pub session: u64,
    /// Strictly increasing within a session.
    pub sequence: u64,
    /// The device's clock, µs; comes back in the force packet.
    pub time_us: u64,
    /// Left and right tip in the world, m.
    pub tip_in_world: [Vec2; 2],
    /// Their velocities, m/s.
    pub tip_velocity: [Vec2; 2],
}

/// Packet that a device receives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Force {
    /// [`FLAG_GREETING`].
    pub flags: u16,
    /// The session.
    pub session: u64,
    /// Strictly increasing within a session.
    pub sequence: u64,
    /// Touchstone's clock since it opened the port, µs.
    pub time_us: u64,
    /// Force on the operator's left and right finger, N.
    pub force_n: [Vec2; 2],
    /// `time_us` of the newest motion packet that was accepted: now minus this is the round trip.
    pub echo_us: u64,
}

/// Why a packet was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refused {
    /// Not as long as such a packet is.
    Size,
    /// Not ours.
    Magic,
    /// Another version or kind.
    Version,
    /// The seal is wrong: another key, or changed on the way.
    Seal,
    /// Not a number, or out of bounds.
    Value,
    /// Another session: a recording of an earlier one, or a device that has not been greeted.
    Session,
    /// Not newer than the newest: out of order, or sent again.
    Sequence,
}

impl Refused {
    /// Every reason.
    pub const ALL: [Self; 7] =
        [Self::Size, Self::Magic, Self::Version, Self::Seal, Self::Value, Self::Session, Self::Sequence];

    /// For people.
    pub fn words(self) -> &'static str {
        match self {
            Self::Size => "wrong size",
            Self::Magic => "no Touchstone packet",
            Self::Version => "another version of the protocol",
            Self::Seal => "sealed with another key",
            Self::Value => "a value that is no number or out of bounds",
            Self::Session => "of another session",
            Self::Sequence => "out of order or sent again",
        }
    }
}

pub(super) struct Writer<'a>(pub &'a mut [u8], pub usize);

impl Writer<'_> {
    pub fn put(&mut self, bytes: &[u8]) {
        self.0[self.1..self.1 + bytes.len()].copy_from_slice(bytes);
        self.1 += bytes.len();
    }

    pub fn header(&mut self, version_and_kind: [u8; 2], flags: u16, [session, sequence, time_us]: [u64; 3]) {
        self.put(&MAGIC);
        self.put(&version_and_kind);
        self.put(&flags.to_le_bytes());
        for number in [session, sequence, time_us] {
            self.put(&number.to_le_bytes());
        }
    }

    pub fn points(&mut self, points: &[Vec2]) {
        for point in points {
            self.put(&point.x.to_le_bytes());
            self.put(&point.y.to_le_bytes());
        }
    }
}

impl Motion {
    /// The packet, sealed.
    pub fn encode(&self, key: &Key) -> [u8; MOTION_BYTES] {
        let mut packet = [0; MOTION_BYTES];
        let mut writer = Writer(&mut packet, 0);
        writer.header([VERSION, MOTION], self.flags, [self.session, self.sequence, self.time_us]);
        writer.points(&self.tip_in_world);
        writer.points(&self.tip_velocity);
        seal(&mut packet, key);
        packet
    }

    /// The content of a packet that is whole, ours, sealed with the key and within bounds. Checking its session and
    /// sequence is the receiver's business.
    pub fn decode(packet: &[u8], key: &Key) -> Result<Self, Refused> {
        check::<MOTION_BYTES>(packet, [VERSION, MOTION], key)?;
        let tip_in_world = [point(packet, 32), point(packet, 48)];
        let tip_velocity = [point(packet, 64), point(packet, 80)];
        // Not a number compares as false.
        let bounded = |points: &[Vec2; 2], most: f64| points.iter().all(|p| p.x.abs() <= most && p.y.abs() <= most);
        if !(bounded(&tip_in_world, MAX_POSITION_M) && bounded(&tip_velocity, MAX_VELOCITY_M_S)) {
            return Err(Refused::Value);
        }
        let [session, sequence, time_us] = numbers(packet);
        Ok(Self { flags: flags(packet), session, sequence, time_us, tip_in_world, tip_velocity })
    }
}

impl Force {
    /// The packet, sealed.
    pub fn encode(&self, key: &Key) -> [u8; FORCE_BYTES] {
        let mut packet = [0; FORCE_BYTES];
        let mut writer = Writer(&mut packet, 0);
        writer.header([VERSION, FORCE], self.flags, [self.session, self.sequence, self.time_us]);
        writer.points(&self.force_n);
        writer.put(&self.echo_us.to_le_bytes());
        seal(&mut packet, key);
        packet
    }

    /// The content of a packet that is whole, ours, sealed with the key and finite.
    pub fn decode(packet: &[u8], key: &Key) -> Result<Self, Refused> {
        check::<FORCE_BYTES>(packet, [VERSION, FORCE], key)?;
        let force_n = [point(packet, 32), point(packet, 48)];
        if !force_n.iter().all(|f| f.x.is_finite() && f.y.is_finite()) {
            return Err(Refused::Value);
        }
        let [session, sequence, time_us] = numbers(packet);
        Ok(Self { flags: flags(packet), session, sequence, time_us, force_n, echo_us: number(packet, 64) })
    }
}

pub(super) fn seal(packet: &mut [u8], key: &Key) {
    let (message, place) = packet.split_at_mut(packet.len() - SEAL_BYTES);
    place.copy_from_slice(&key.seal(message));
}

/// Cheap tests first; nothing behind the header is looked at before the seal is known to be right.
pub(super) fn check<const BYTES: usize>(packet: &[u8], version_and_kind: [u8; 2], key: &Key) -> Result<(), Refused> {
    if packet.len() != BYTES {
        return Err(Refused::Size);
    }
    if packet[..4] != MAGIC {
        return Err(Refused::Magic);
    }
    if packet[4..6] != version_and_kind {
        return Err(Refused::Version);
    }
    let (message, seal) = packet.split_at(BYTES - SEAL_BYTES);
    if key.is_sealed(message, seal) { Ok(()) } else { Err(Refused::Seal) }
}

// The readers are called on packets whose size has been checked.

pub(super) fn flags(packet: &[u8]) -> u16 {
    u16::from_le_bytes([packet[6], packet[7]])
}

pub(super) fn numbers(packet: &[u8]) -> [u64; 3] {
    [number(packet, 8), number(packet, 16), number(packet, 24)]
}

pub(super) fn number(packet: &[u8], at: usize) -> u64 {
    u64::from_le_bytes(std::array::from_fn(|i| packet[at + i]))
}

pub(super) fn real(packet: &[u8], at: usize) -> f64 {
    f64::from_bits(number(packet, at))
}

pub(super) fn point(packet: &[u8], at: usize) -> Vec2 {
    Vec2::new(real(packet, at), real(packet, at + 8))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn key() -> Key {
        Key::new([0x42; 32])
    }

    fn motion() -> Motion {
        Motion {
            flags: 0,
            session: 0x0102_0304_0506_0708,
            sequence: 9,
            time_us: 10,
            tip_in_world: [Vec2::new(-0.01, -0.1), Vec2::new(0.01, -0.1)],
            tip_velocity: [Vec2::new(0.5, 0.0), Vec2::new(0.0, -0.25)],
        }
    }

    #[test]
    fn the_layout_is_the_documented_one() {
        let packet = motion().encode(&key());
        assert_eq!((packet.len(), FORCE_BYTES), (112, 88));
        assert_eq!(packet[..8], *b"TSUD\x01\x01\x00\x00");
        assert_eq!(packet[8..16], [8, 7, 6, 5, 4, 3, 2, 1]);
        assert_eq!(packet[16..32], [9, 0, 0, 0, 0, 0, 0, 0, 10, 0, 0, 0, 0, 0, 0, 0]);
        assert_eq!(packet[32..40], (-0.01_f64).to_le_bytes());
        assert_eq!(packet[88..96], (-0.25_f64).to_le_bytes());
    }

    /// Changes bytes of a packet and seals it again, as someone with the key could.
    fn resealed(change: impl Fn(&mut [u8; MOTION_BYTES])) -> [u8; MOTION_BYTES] {
        let mut packet = motion().encode(&key());
        change(&mut packet);
        seal(&mut packet, &key());
        packet
    }

    #[test]
    fn each_fault_has_its_reason() {
        let good = motion().encode(&key());
        assert_eq!(Motion::decode(&good, &key()), Ok(motion()));
        assert_eq!(Motion::decode(&good, &Key::new([0x43; 32])), Err(Refused::Seal));
        assert_eq!(Motion::decode(&good[..111], &key()), Err(Refused::Size));
        assert_eq!(Motion::decode(&resealed(|p| p[0] = b'X'), &key()), Err(Refused::Magic));
        assert_eq!(Motion::decode(&resealed(|p| p[4] = 2), &key()), Err(Refused::Version));
        assert_eq!(Motion::decode(&resealed(|p| p[5] = FORCE), &key()), Err(Refused::Version));
        for bad in [f64::NAN, f64::INFINITY, -1.01, 1e300] {
            let packet = resealed(|p| p[48..56].copy_from_slice(&bad.to_le_bytes()));
            assert_eq!(Motion::decode(&packet, &key()), Err(Refused::Value), "{bad}");
        }
        assert_eq!(
            Motion::decode(&resealed(|p| p[80..88].copy_from_slice(&(-21.0_f64).to_le_bytes())), &key()),
            Err(Refused::Value)
        );
    }

    proptest! {
        #[test]
        fn any_bytes_are_refused_without_a_panic(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
            prop_assert!(Motion::decode(&bytes, &key()).is_err());
            prop_assert!(Force::decode(&bytes, &key()).is_err());
        }

        #[test]
        fn one_changed_bit_is_refused(at in 0..MOTION_BYTES, bit in 0..8_u8) {
            let mut packet = motion().encode(&key());
            packet[at] ^= 1 << bit;
            prop_assert!(Motion::decode(&packet, &key()).is_err());
        }

        #[test]
        fn sealed_nonsense_gives_bounded_values_or_none(payload in proptest::collection::vec(any::<u8>(), 64)) {
            let packet = resealed(|p| p[32..96].copy_from_slice(&payload));
            if let Ok(motion) = Motion::decode(&packet, &key()) {
                prop_assert!(motion.tip_in_world.iter().all(|p| p.amax() <= MAX_POSITION_M));
                prop_assert!(motion.tip_velocity.iter().all(|p| p.amax() <= MAX_VELOCITY_M_S));
            }
        }

        #[test]
        fn what_is_sent_is_what_arrives(
            numbers in any::<[u64; 4]>(), flags in any::<u16>(), values in proptest::array::uniform4(-1.0..1.0_f64),
        ) {
            let points = [Vec2::new(values[0], values[1]), Vec2::new(values[2], values[3])];
            let [session, sequence, time_us, echo_us] = numbers;
            let sent = Motion { flags, session, sequence, time_us, tip_in_world: points, tip_velocity: points };
            prop_assert_eq!(Motion::decode(&sent.encode(&key()), &key()), Ok(sent));
            let sent = Force { flags, session, sequence, time_us, force_n: points, echo_us };
            prop_assert_eq!(Force::decode(&sent.encode(&key()), &key()), Ok(sent));
        }
    }
}
