//! The packets that carry wave variables, version 2 of the protocol: accounts of the waves in place of positions and forces.

use super::key::{Key, SEAL_BYTES};
use super::packet::{HEADER_BYTES, MAX_POSITION_M, Refused, Writer, check, flags, number, numbers, point, real, seal};
use crate::Vec2;
use crate::device::waves::Account;

/// Version of the layout of packets with waves.
pub const WAVE_VERSION: u8 = 2;
/// Bytes of a wave packet, device → Touchstone.
pub const WAVE_UP_BYTES: usize = HEADER_BYTES + 80 + SEAL_BYTES;
/// Bytes of a wave packet, Touchstone → device.
pub const WAVE_DOWN_BYTES: usize = HEADER_BYTES + 64 + SEAL_BYTES;
/// Flag of a wave packet to the device: zero force, whatever the waves say.
pub const FLAG_STOP: u16 = 2;
/// Integrals beyond this are refused, √W s: a full force held for days.
const MAX_INTEGRAL: f64 = 1e7;
/// Energies beyond this are refused, J.
const MAX_ENERGY_J: f64 = 1e7;

const UP: u8 = 3;
const DOWN: u8 = 4;

/// Packet that a device sends.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WaveUp {
    /// [`super::FLAG_BYE`].
    pub flags: u16,
    /// The number that Touchstone gave to this session; 0 asks for it.
    pub session: u64,
    /// Strictly increasing within a session.
    pub sequence: u64,
    /// The device's clock, µs; comes back.
    pub time_us: u64,
    /// Position of the left and the right tip at the start of this session's waves, m in the world: the same in every
    /// packet.
    pub origin_in_world: [Vec2; 2],
    /// Integral and energy of each finger's wave u = (b v + F)/√(2b) since then.
    pub accounts: [Account; 2],
}

/// Packet that a device receives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WaveDown {
    /// [`super::FLAG_GREETING`], [`FLAG_STOP`].
    pub flags: u16,
    /// The session.
    pub session: u64,
    /// Strictly increasing within a session.
    pub sequence: u64,
    /// Touchstone's clock since it opened the port, µs.
    pub time_us: u64,
    /// Integral and energy of each finger's wave w = (b v − F)/√(2b) since the session began.
    pub accounts: [Account; 2],
    /// Wave impedance b that both ends compute with, N s/m.
    pub impedance_n_s_m: f64,
    /// `time_us` of the newest packet that was accepted.
    pub echo_us: u64,
}

fn put(writer: &mut Writer<'_>, accounts: &[Account; 2]) {
    for account in accounts {
        writer.points(&[account.integral]);
        writer.put(&account.energy_j.to_le_bytes());
    }
}

/// Both fingers' accounts; `None` when one is no number, out of bounds or an energy below zero.
fn accounts(packet: &[u8], at: usize) -> Option<[Account; 2]> {
    let accounts = [at, at + 24].map(|at| Account { integral: point(packet, at), energy_j: real(packet, at + 16) });
    // Not a number compares as false.
    let possible =
        |a: &Account| a.integral.iter().all(|x| x.abs() <= MAX_INTEGRAL) && (0.0..=MAX_ENERGY_J).contains(&a.energy_j);
    accounts.iter().all(possible).then_some(accounts)
}

impl WaveUp {
    /// The packet, sealed.
    pub fn encode(&self, key: &Key) -> [u8; WAVE_UP_BYTES] {
        let mut packet = [0; WAVE_UP_BYTES];
        let mut writer = Writer(&mut packet, 0);
        writer.header([WAVE_VERSION, UP], self.flags, [self.session, self.sequence, self.time_us]);
        writer.points(&self.origin_in_world);
        put(&mut writer, &self.accounts);
        seal(&mut packet, key);
        packet
    }

    /// The content of a packet that is whole, ours, sealed with the key and within bounds.
    pub fn decode(packet: &[u8], key: &Key) -> Result<Self, Refused> {
        check::<WAVE_UP_BYTES>(packet, [WAVE_VERSION, UP], key)?;
        let origin_in_world = [point(packet, 32), point(packet, 48)];
        if !origin_in_world.iter().all(|p| p.x.abs() <= MAX_POSITION_M && p.y.abs() <= MAX_POSITION_M) {
            return Err(Refused::Value);
        }
        let accounts = accounts(packet, 64).ok_or(Refused::Value)?;
        let [session, sequence, time_us] = numbers(packet);
        Ok(Self { flags: flags(packet), session, sequence, time_us, origin_in_world, accounts })
    }
}

impl WaveDown {
    /// The packet, sealed.
    pub fn encode(&self, key: &Key) -> [u8; WAVE_DOWN_BYTES] {
        let mut packet = [0; WAVE_DOWN_BYTES];
        let mut writer = Writer(&mut packet, 0);
        writer.header([WAVE_VERSION, DOWN], self.flags, [self.session, self.sequence, self.time_us]);
        put(&mut writer, &self.accounts);
        writer.put(&self.impedance_n_s_m.to_le_bytes());
        writer.put(&self.echo_us.to_le_bytes());
        seal(&mut packet, key);
        packet
    }

    /// The content of a packet that is whole, ours, sealed with the key and within bounds.
    pub fn decode(packet: &[u8], key: &Key) -> Result<Self, Refused> {
        check::<WAVE_DOWN_BYTES>(packet, [WAVE_VERSION, DOWN], key)?;
        let accounts = accounts(packet, 32).ok_or(Refused::Value)?;
        let impedance_n_s_m = real(packet, 80);
        if !(impedance_n_s_m > 0.0 && impedance_n_s_m < 1e4) {
            return Err(Refused::Value);
        }
        let [session, sequence, time_us] = numbers(packet);
        let echo_us = number(packet, 88);
        Ok(Self { flags: flags(packet), session, sequence, time_us, accounts, impedance_n_s_m, echo_us })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn key() -> Key {
        Key::new([0x42; 32])
    }

    fn up() -> WaveUp {
        WaveUp {
            flags: 1,
            session: 0x0102_0304_0506_0708,
            sequence: 9,
            time_us: 10,
            origin_in_world: [Vec2::new(-0.01, -0.1), Vec2::new(0.01, -0.1)],
            accounts: [
                Account { integral: Vec2::new(0.5, -1.5), energy_j: 0.25 },
                Account { integral: Vec2::new(2.5, 0.0), energy_j: 4.0 },
            ],
        }
    }

    #[test]
    fn the_layout_is_the_documented_one() {
        let packet = up().encode(&key());
        assert_eq!((packet.len(), WAVE_DOWN_BYTES), (128, 112));
        assert_eq!(packet[..8], *b"TSUD\x02\x03\x01\x00");
        assert_eq!(packet[32..40], (-0.01_f64).to_le_bytes());
        assert_eq!(packet[64..72], 0.5_f64.to_le_bytes());
        assert_eq!(packet[80..88], 0.25_f64.to_le_bytes());
        assert_eq!(packet[104..112], 4.0_f64.to_le_bytes());
        assert_eq!(WaveUp::decode(&packet, &key()), Ok(up()));
        let down = WaveDown { accounts: up().accounts, impedance_n_s_m: 9.0, echo_us: 77, ..WaveDown::default() };
        let packet = down.encode(&key());
        assert_eq!(packet[..6], *b"TSUD\x02\x04");
        assert_eq!((&packet[48..56], &packet[80..88]), (&0.25_f64.to_le_bytes()[..], &9.0_f64.to_le_bytes()[..]));
        assert_eq!(packet[88..96], 77_u64.to_le_bytes());
        assert_eq!(WaveDown::decode(&packet, &key()), Ok(down));
    }

    #[test]
    fn impossible_waves_are_refused() {
        for (at, bad) in [(32, 1.5), (64, f64::NAN), (72, 1e9), (80, -1e-9), (80, f64::INFINITY), (104, f64::NAN)] {
            let mut packet = up().encode(&key());
            packet[at..at + 8].copy_from_slice(&f64::to_le_bytes(bad));
            seal(&mut packet, &key());
            assert_eq!(WaveUp::decode(&packet, &key()), Err(Refused::Value), "{bad} at {at}");
        }
        let down = WaveDown { impedance_n_s_m: 0.0, ..WaveDown::default() };
        assert_eq!(WaveDown::decode(&down.encode(&key()), &key()), Err(Refused::Value));
        assert_eq!(WaveUp::decode(&up().encode(&Key::new([1; 32])), &key()), Err(Refused::Seal));
    }

    proptest! {
        #[test]
        fn any_bytes_are_refused_without_a_panic(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
            prop_assert!(WaveUp::decode(&bytes, &key()).is_err());
            prop_assert!(WaveDown::decode(&bytes, &key()).is_err());
        }

        #[test]
        fn sealed_nonsense_gives_bounded_values_or_none(payload in proptest::collection::vec(any::<u8>(), 80)) {
            let mut packet = up().encode(&key());
            packet[32..112].copy_from_slice(&payload);
            seal(&mut packet, &key());
            if let Ok(wave) = WaveUp::decode(&packet, &key()) {
                prop_assert!(wave.origin_in_world.iter().all(|p| p.amax() <= MAX_POSITION_M));
                prop_assert!(wave.accounts.iter().all(|a| a.energy_j >= 0.0 && a.integral.amax() <= MAX_INTEGRAL));
            }
        }
    }
}
