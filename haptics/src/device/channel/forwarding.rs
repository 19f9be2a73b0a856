//! Tests of the calls that the channel forwards to and from the device behind it.

use super::*;
use crate::Vec2;
use crate::world::presets;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

const DT: f64 = 1e-3;

/// A device with a delay and a guard of its own, of which some ticks bring only one finger.
struct Inner {
    spec: DeviceSpec,
    safe: Arc<AtomicU32>,
    guarded: Arc<AtomicU32>,
    fresh: fn(u32) -> [bool; 2],
    tick: u32,
}

impl Device for Inner {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn exchange(&mut self, _: &Command, _: f64) -> Sample {
        self.tick += 1;
        let tip = Vec2::new(1e-3, 0.0);
        Sample { tip_in_world: [tip, -tip], fresh: (self.fresh)(self.tick), ..Sample::default() }
    }

    fn delay_s(&self) -> f64 {
        0.01
    }

    fn make_safe(&mut self) {
        self.safe.fetch_add(1, Ordering::Relaxed);
    }

    fn guard(&mut self) -> Option<ForceGuard> {
        let guarded = Arc::clone(&self.guarded);
        Some(Box::new(move || {
            guarded.fetch_add(1, Ordering::Relaxed);
        }))
    }
}

fn inner() -> Inner {
    let spec = DeviceSpec { damping_n_s_m: 5.0, ..crate::device::udp::UdpConfig::unstated() };
    Inner { spec, safe: Arc::default(), guarded: Arc::default(), fresh: |_| [true; 2], tick: 0 }
}

/// 20 ms each way and up to 5 ms more.
fn network(waves: bool) -> ChannelConfig {
    let waves = waves.then(|| Waves::new(&inner().spec, &presets::table(), DT));
    ChannelConfig { delay_s: 0.02, jitter_s: 0.005, waves, ..ChannelConfig::default() }
}

#[test]
fn the_delay_is_that_of_both_ways_and_of_the_device_and_waves_need_no_allowance_for_the_line() {
    let stated = |waves| ChannelDevice::new(Box::new(inner()), network(waves)).expect("possible").delay_s();
    assert!((stated(false) - (0.01 + 2.0 * 0.02 + 0.005)).abs() < 1e-12, "{} s", stated(false));
    assert!((stated(true) - 0.01).abs() < 1e-12, "{} s", stated(true));
}

#[test]
fn waves_state_the_spring_that_the_line_is_and_a_plain_line_is_none() {
    let stated = |waves| ChannelDevice::new(Box::new(inner()), network(waves)).expect("possible").line_stiffness_n_m();
    assert_eq!(stated(false), None);
    // b/d, with 5 ms of smoothing and 5 ms of jitter beside the delay: 5 N s/m over 30 ms.
    let line_n_m = stated(true).expect("waves");
    assert!((line_n_m - 5.0 / 0.03).abs() < 1e-9, "{line_n_m} N/m");
}

#[test]
fn the_device_is_made_safe_where_it_is_by_the_servo_and_by_its_guard() {
    for waves in [false, true] {
        let device = inner();
        let (safe, guarded) = (Arc::clone(&device.safe), Arc::clone(&device.guarded));
        let mut channel = ChannelDevice::new(Box::new(device), network(waves)).expect("possible");
        channel.make_safe();
        assert_eq!(safe.load(Ordering::Relaxed), 1, "at once, without a tick");
        let mut guard = channel.guard().expect("the device has one");
        guard();
        assert_eq!(guarded.load(Ordering::Relaxed), 1);
    }
}

#[test]
fn each_finger_keeps_its_own_age_behind_the_line() {
    for waves in [false, true] {
        // The right finger is seen every other tick, and never again after 300.
        let device = Inner { fresh: |tick| [tick % 2 == 0, tick % 2 == 1 && tick < 300], ..inner() };
        let mut channel = ChannelDevice::new(Box::new(device), network(waves)).expect("possible");
        let seen: Vec<[bool; 2]> = (0..500).map(|_| channel.exchange(&Command::default(), DT).fresh).collect();
        assert!(seen[40..300].iter().all(|fresh| *fresh == [true; 2]), "both come through");
        assert!(seen[420..].iter().all(|fresh| *fresh == [true, false]), "and the lost one is told, waves: {waves}");
    }
}
