//! Any bytes as packets of a remote device, as they come and with a right seal: no panic, nothing out of bounds. `cargo +nightly fuzz run udp`.

#![no_main]

use haptics::Vec2;
use haptics::device::udp::{Force, Key, MAX_POSITION_M, MAX_VELOCITY_M_S, Motion, WaveDown, WaveUp};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let key = Key::new([7; 32]);
    look(bytes, &key);
    // An enemy has no key; a far end with a bug has one.
    let mut numbers = bytes.chunks_exact(8).map(|eight| eight.try_into().expect("eight bytes"));
    let mut whole = || numbers.next().map_or(0, u64::from_le_bytes);
    let (session, sequence, time_us) = (whole(), whole(), whole());
    let mut point = || Vec2::new(f64::from_bits(whole()), f64::from_bits(whole()));
    let (tip_in_world, tip_velocity) = ([point(), point()], [point(), point()]);
    let motion = Motion { flags: 0, session, sequence, time_us, tip_in_world, tip_velocity };
    look(&motion.encode(&key), &key);
});

fn look(packet: &[u8], key: &Key) {
    if let Ok(motion) = Motion::decode(packet, key) {
        assert!(motion.tip_in_world.iter().all(|tip| tip.amax() <= MAX_POSITION_M));
        assert!(motion.tip_velocity.iter().all(|velocity| velocity.amax() <= MAX_VELOCITY_M_S));
    }
    if let Ok(wave) = WaveUp::decode(packet, key) {
        assert!(wave.origin_in_world.iter().all(|tip| tip.amax() <= MAX_POSITION_M));
    }
    let _ = (Force::decode(packet, key), WaveDown::decode(packet, key));
}
