//! The finger that holds the handle: two links whose angles are absolute.

/// A finger.
#[derive(Clone, Copy, Debug)]
pub struct Arm {
    /// Where it is fixed, m.
    pub base_m: [f64; 2],
    /// Lengths of the bottom and the top link, m.
    pub link_m: [f64; 2],
}

impl Arm {
    /// The tip for the angles of the bottom and the top link, rad.
    pub fn tip(&self, angles: [f64; 2]) -> [f64; 2] {
        let [lower, upper] = self.link_m;
        [
            self.base_m[0] + lower * angles[0].cos() + upper * angles[1].cos(),
            self.base_m[1] + lower * angles[0].sin() + upper * angles[1].sin(),
        ]
    }

    /// The angles for a tip, with the elbow on the side `elbow` (1 or −1); a tip out of reach is drawn into reach.
    pub fn angles(&self, tip: [f64; 2], elbow: f64) -> [f64; 2] {
        let [lower, upper] = self.link_m;
        let (x, y) = (tip[0] - self.base_m[0], tip[1] - self.base_m[1]);
        let distance = x.hypot(y).max(1e-9);
        let inner = ((distance * distance + lower * lower - upper * upper) / (2.0 * distance * lower)).clamp(-1.0, 1.0);
        let bottom = y.atan2(x) + elbow * inner.acos();
        let top = (y - lower * bottom.sin()).atan2(x - lower * bottom.cos());
        [bottom, top]
    }

    /// Angular speeds for a speed of the tip; the arm is never stretched or folded where it works.
    pub fn rates(&self, angles: [f64; 2], speed: [f64; 2]) -> [f64; 2] {
        let [(s0, c0), (s1, c1)] = angles.map(f64::sin_cos);
        let (a, b) = (-self.link_m[0] * s0, -self.link_m[1] * s1);
        let (c, d) = (self.link_m[0] * c0, self.link_m[1] * c1);
        let area = a * d - b * c;
        [(d * speed[0] - b * speed[1]) / area, (a * speed[1] - c * speed[0]) / area]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_lead_back_to_the_tip_and_rates_to_its_speed() {
        let arm = Arm { base_m: [-0.01, 0.002], link_m: [0.08, 0.0807] };
        for elbow in [-1.0, 1.0] {
            let (tip, speed, step) = ([0.031, 0.104], [0.07, -0.11], 1e-6);
            let angles = arm.angles(tip, elbow);
            let back = arm.tip(angles);
            assert!((back[0] - tip[0]).hypot(back[1] - tip[1]) < 1e-12);
            let later = arm.angles([tip[0] + speed[0] * step, tip[1] + speed[1] * step], elbow);
            let rates = arm.rates(angles, speed);
            for joint in 0..2 {
                assert!(((later[joint] - angles[joint]) / step - rates[joint]).abs() < 1e-3);
            }
        }
    }
}
