//! Recent impacts: a flash at each contact point, larger for faster impacts.

use haptics::Vec2;
use haptics::servo::TickRecord;

/// Duration of a flash, s.
const LIFE_S: f64 = 0.3;
/// Minimum speed of a shown impact, m/s.
const FAINTEST_M_S: f64 = 0.02;
/// Impact speed of a flash of maximum size, m/s.
const FULL_M_S: f64 = 0.5;
/// Distance within which an impact is merged into a flash that has just begun, m.
const SAME_M: f64 = 0.004;
/// Maximum number of simultaneous flashes.
const MOST: usize = 16;

/// One flash.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flash {
    /// Position, m in the world.
    pub at_in_world: Vec2,
    /// Speed of the impact, m/s.
    pub speed_m_s: f64,
    age_s: f64,
}

impl Flash {
    /// Strength, 0 … 1: by the square root of the speed, so that a gentle touch is still visible.
    pub fn strength(&self) -> f64 {
        (self.speed_m_s / FULL_M_S).min(1.0).sqrt()
    }

    /// Fading, 0 … 1.
    pub fn faded(&self) -> f64 {
        (self.age_s / LIFE_S).min(1.0)
    }
}

/// Visible flashes.
#[derive(Clone, Debug, Default)]
pub struct Impacts {
    flashes: Vec<Flash>,
}

impl Impacts {
    /// Takes in new ticks and fades the old flashes by a frame. Returns the fastest new impact, m/s.
    pub fn update(&mut self, ticks: &[TickRecord], frame_s: f64) -> Option<f64> {
        for flash in &mut self.flashes {
            flash.age_s += frame_s;
        }
        self.flashes.retain(|flash| flash.age_s < LIFE_S);
        let mut fastest = None;
        for tick in ticks.iter().filter(|t| t.impact_m_s > FAINTEST_M_S) {
            fastest = Some(tick.impact_m_s.max(fastest.unwrap_or(0.0)));
            let near = |f: &&mut Flash| (f.at_in_world - tick.impact_in_world).norm() < SAME_M && f.age_s < 0.1;
            if let Some(flash) = self.flashes.iter_mut().find(near) {
                flash.speed_m_s = flash.speed_m_s.max(tick.impact_m_s);
            } else if self.flashes.len() < MOST {
                let (at_in_world, speed_m_s) = (tick.impact_in_world, tick.impact_m_s);
                self.flashes.push(Flash { at_in_world, speed_m_s, age_s: 0.0 });
            }
        }
        fastest
    }

    /// The flashes, oldest first.
    pub fn flashes(&self) -> &[Flash] {
        &self.flashes
    }

    /// True while a flash is visible.
    pub fn any(&self) -> bool {
        !self.flashes.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn impact(x: f64, speed: f64) -> TickRecord {
        TickRecord { impact_m_s: speed, impact_in_world: Vec2::new(x, 0.0), ..TickRecord::default() }
    }

    #[test]
    fn an_impact_flashes_by_its_speed_and_fades() {
        let mut impacts = Impacts::default();
        let ticks = [impact(0.0, 0.1), impact(0.001, 0.4), impact(0.05, 0.05), impact(0.1, 0.001)];
        assert_eq!(impacts.update(&ticks, 0.016), Some(0.4));
        assert_eq!(impacts.flashes().len(), 2, "one place flashes once, a mere touch not at all");
        assert!(impacts.flashes()[0].strength() > 2.0 * impacts.flashes()[1].strength());
        assert_eq!(impacts.update(&[], 0.1), None);
        assert!(impacts.any() && impacts.flashes()[0].faded() > 0.3);
        impacts.update(&[], 0.3);
        assert!(!impacts.any());
    }
}
