//! Replay of a recording: the fingers go where they went.

use super::{Command, Device, DeviceSpec, Sample};
use crate::Vec2;

/// A device that plays tip positions back on their own clock, linearly interpolated.
pub struct ReplayDevice {
    spec: DeviceSpec,
    time_s: Vec<f64>,
    tips: [Vec<Vec2>; 2],
    velocities: [Vec<Vec2>; 2],
    now_s: f64,
    next: usize,
}

impl ReplayDevice {
    /// `time_s` strictly increasing, tips and velocities one a sample; at least two samples.
    pub fn new(name: &str, time_s: Vec<f64>, tips: [Vec<Vec2>; 2], velocities: [Vec<Vec2>; 2]) -> Result<Self, String> {
        let n = time_s.len();
        if n < 2 || tips.iter().chain(&velocities).any(|c| c.len() != n) {
            return Err(format!("{name} cannot be replayed: it needs at least two samples of both fingers' positions"));
        }
        let spec = DeviceSpec {
            name: format!("Replay of {name}"),
            force_feedback: false,
            max_force_n: 20.0,
            damping_n_s_m: 0.0,
            coulomb_n: 0.0,
            resolution_m: 0.0,
        };
        let now_s = time_s[0];
        Ok(Self { spec, time_s, tips, velocities, now_s, next: 1 })
    }

    fn at(&self, series: &[Vec2]) -> Vec2 {
        let (i, j) = (self.next - 1, self.next);
        let share = ((self.now_s - self.time_s[i]) / (self.time_s[j] - self.time_s[i])).clamp(0.0, 1.0);
        series[i] + (series[j] - series[i]) * share
    }
}

impl Device for ReplayDevice {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn exchange(&mut self, _command: &Command, dt_s: f64) -> Sample {
        while self.next + 1 < self.time_s.len() && self.time_s[self.next] < self.now_s {
            self.next += 1;
        }
        let sample = Sample {
            tip_in_world: [self.at(&self.tips[0]), self.at(&self.tips[1])],
            tip_velocity: [self.at(&self.velocities[0]), self.at(&self.velocities[1])],
            fresh: true,
        };
        self.now_s += dt_s;
        sample
    }

    fn make_safe(&mut self) {}

    fn finished(&self) -> bool {
        self.time_s.last().is_none_or(|last| self.now_s > *last)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolates_on_its_own_clock_and_ends() {
        let path = |x: f64| vec![Vec2::new(x, 0.0), Vec2::new(x + 1.0, 0.0), Vec2::new(x + 3.0, 0.0)];
        let still = || vec![Vec2::zeros(); 3];
        let mut device = ReplayDevice::new("test", vec![0.0, 1.0, 2.0], [path(0.0), path(10.0)], [still(), still()])
            .expect("two fingers, three samples");
        let xs: Vec<f64> = (0..5).map(|_| device.exchange(&Command::default(), 0.5).tip_in_world[0].x).collect();
        assert_eq!(xs, vec![0.0, 0.5, 1.0, 2.0, 3.0]);
        assert!(device.finished());
        assert!(ReplayDevice::new("x", vec![0.0], [still(), still()], [still(), still()]).is_err());
    }
}
