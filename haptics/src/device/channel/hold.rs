//! Time for which the plain channel's far end holds a force when the line falls silent.

use super::*;
use crate::Vec2;
use std::sync::{Arc, Mutex};

const DT: f64 = 1e-3;

/// Writes down the forces that reach it, N along x of the left finger.
struct Ear(DeviceSpec, Arc<Mutex<Vec<f64>>>);

impl Device for Ear {
    fn spec(&self) -> &DeviceSpec {
        &self.0
    }

    fn exchange(&mut self, command: &Command, _: f64) -> Sample {
        self.1.lock().expect("one thread").push(command.force_n[0].x);
        Sample { fresh: [true; 2], ..Sample::default() }
    }

    fn make_safe(&mut self) {}
}

#[test]
fn a_force_is_held_for_fifty_milliseconds_beside_the_jitter_and_not_longer() {
    for (jitter_s, held) in [(0.0, 50), (0.03, 80)] {
        let heard = Arc::new(Mutex::new(Vec::new()));
        let ear = Ear(crate::device::udp::UdpConfig::unstated(), Arc::clone(&heard));
        let config = ChannelConfig { delay_s: 0.01, jitter_s, ..ChannelConfig::default() };
        let mut channel = ChannelDevice::new(Box::new(ear), config).expect("possible");
        let command = Command { force_n: [Vec2::new(1.0, 0.0); 2] };
        for _ in 0..200 {
            channel.exchange(&command, DT);
        }
        assert_eq!(heard.lock().expect("one thread").last(), Some(&1.0));
        // The cable is cut: nothing that is under way arrives either.
        channel.down = Line::new(0.01, 0.0, 1.0, 0);
        heard.lock().expect("one thread").clear();
        for _ in 0..300 {
            channel.exchange(&command, DT);
        }
        let heard = heard.lock().expect("one thread").clone();
        let last = heard.iter().filter(|force| **force != 0.0).count();
        assert!(heard[..last].iter().all(|force| *force == 1.0), "held, then zero at once");
        // The newest packet may have come up to a jitter before the cut.
        let least = held - 1 - (jitter_s / DT) as usize;
        assert!((least..=held + 1).contains(&last), "jitter {jitter_s} s: held for {last} ms");
    }
}
