//! Stage 2: qualitative values and the rules that name the state (thesis, tables 3.1 and 5.2).

use super::threshold::Levels;
use foundation::signal::task::TaskSignals;
use foundation::tasks::definition::Rules;
use foundation::tasks::{Sign, SystemState, Thresholds};
use haptics::Vec2;

/// The qualitative values of one sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quality {
    /// Horizontal velocity.
    pub velocity_x: Sign,
    /// Vertical velocity.
    pub velocity_y: Sign,
    /// Net vertical force on the object.
    pub net_y: Sign,
    /// Grip normal force.
    pub grip: Sign,
    /// All four force components are zero.
    pub no_contact: bool,
}

impl Quality {
    /// The values in the order of [`foundation::tasks::definition::signals`].
    pub fn values(&self) -> [Option<Sign>; 5] {
        let contact = if self.no_contact { Sign::Zero } else { Sign::Plus };
        [contact, self.grip, self.net_y, self.velocity_x, self.velocity_y].map(Some)
    }
}

/// Thresholds every sample, with hysteresis, after removing the forces' bias. `leave`: share of the threshold that a signal must fall
/// below to count as zero again, so that a value at the threshold does not chatter.
pub fn qualify(signals: &TaskSignals, levels: &Levels, thresholds: &Thresholds, leave: f64) -> Vec<Quality> {
    let force = |finger: usize, i: usize| {
        signals.tips[finger].force.as_ref().map_or_else(Vec2::zeros, |f| f[i]) - levels.bias_n[finger]
    };
    let mut qualifier = Qualifier::default();
    let opened = levels.opened(signals, thresholds.force_n);
    let of = |(i, open): (usize, bool)| {
        let quality = qualifier.next([force(0, i), force(1, i)], signals.velocity[i], thresholds, leave);
        Quality { no_contact: open || quality.no_contact, ..quality }
    };
    opened.into_iter().enumerate().map(of).collect()
}

/// Tells the qualitative values of one sample after the other; remembers the ones before for the hysteresis.
#[derive(Clone, Debug)]
pub struct Qualifier {
    filters: [Sign; 4],
    touching: [bool; 4],
}

impl Default for Qualifier {
    fn default() -> Self {
        Self { filters: [Sign::Zero; 4], touching: [false; 4] }
    }
}

impl Qualifier {
    /// Values of the next sample: forces of both fingers without their bias, N, and the velocity of the grip, m/s. `leave` as in [`qualify`].
    pub fn next(&mut self, force: [Vec2; 2], velocity: Vec2, thresholds: &Thresholds, leave: f64) -> Quality {
        let (limit_f, limit_v) = (thresholds.force_n, thresholds.velocity_m_s);
        let [f1, f2] = force;
        let values = [velocity.x / limit_v, velocity.y / limit_v, (f1 + f2).y / limit_f, f1.x.min(-f2.x) / limit_f];
        for (filter, value) in self.filters.iter_mut().zip(values) {
            *filter = schmitt(*filter, value, leave);
        }
        for (touch, value) in self.touching.iter_mut().zip([f1.x, f1.y, f2.x, f2.y]) {
            let level = value.abs() / limit_f;
            *touch = level > if *touch { leave } else { 1.0 };
        }
        Quality {
            velocity_x: self.filters[0],
            velocity_y: self.filters[1],
            net_y: self.filters[2],
            grip: self.filters[3],
            no_contact: self.touching.iter().all(|t| !t),
        }
    }
}

/// Sign of a size relative to its limit, with hysteresis; for signals without a sign.
pub fn beyond(before: Sign, value: f64, limit: f64, leave: f64) -> Sign {
    if value > limit * if before == Sign::Plus { leave } else { 1.0 } { Sign::Plus } else { Sign::Zero }
}

fn schmitt(before: Sign, value: f64, leave: f64) -> Sign {
    match before {
        Sign::Plus if value > leave => Sign::Plus,
        Sign::Minus if value < -leave => Sign::Minus,
        _ if value > 1.0 => Sign::Plus,
        _ if value < -1.0 => Sign::Minus,
        _ => Sign::Zero,
    }
}

/// The state of every sample by the rules alone.
pub fn states(quality: &[Quality], rules: &Rules) -> Vec<SystemState> {
    quality.iter().map(|q| rules.state(&q.values())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use foundation::tasks::definition::Definition;
    use haptics::recording::Task;

    const REST: Quality = Quality {
        velocity_x: Sign::Zero,
        velocity_y: Sign::Zero,
        net_y: Sign::Zero,
        grip: Sign::Zero,
        no_contact: true,
    };

    #[test]
    fn the_rules_of_table_5_2() {
        let task = Definition::built_in(Task::BlockStack).expect("the built-in task");
        let rules = task.rules();
        let state = |q: Quality| rules.state(&q.values());
        let held = Quality { grip: Sign::Plus, no_contact: false, ..REST };
        assert_eq!(state(REST), SystemState::FreeMotion);
        assert_eq!(state(held), SystemState::HoldOnGround);
        assert_eq!(state(Quality { net_y: Sign::Minus, ..held }), SystemState::HoldOnGround);
        assert_eq!(state(Quality { velocity_x: Sign::Minus, ..held }), SystemState::SlidingOnGround);
        assert_eq!(state(Quality { net_y: Sign::Plus, velocity_y: Sign::Plus, ..held }), SystemState::HoldAboveGround);
        assert_eq!(state(Quality { velocity_y: Sign::Minus, ..held }), SystemState::NoState);
        assert_eq!(state(Quality { no_contact: false, ..REST }), SystemState::NoState);
    }

    #[test]
    fn the_files_say_what_table_5_2_and_the_crank_say_for_every_combination() {
        use Sign::{Minus, Plus, Zero};
        let blocks = Definition::built_in(Task::BlockStack).expect("the built-in task").rules();
        let barrel = Definition::built_in(Task::Barrel).expect("the built-in task").rules();
        let signs = [Plus, Zero, Minus];
        for number in 0..2 * 81 {
            let sign = |place: usize| signs[number / 2 / 3_usize.pow(place as u32) % 3];
            let (grip, net_y, x, y) = (sign(0), sign(1), sign(2), sign(3));
            let no_contact = number % 2 == 0;
            let expected = match (no_contact, grip, net_y, y, x) {
                (true, ..) => SystemState::FreeMotion,
                (_, Plus, Plus, ..) => SystemState::HoldAboveGround,
                (_, Plus, _, Zero, Zero) => SystemState::HoldOnGround,
                (_, Plus, _, Zero, _) => SystemState::SlidingOnGround,
                _ => SystemState::NoState,
            };
            let values = Quality { velocity_x: x, velocity_y: y, net_y, grip, no_contact }.values();
            assert_eq!((blocks.state(&values), barrel.state(&values)), (expected, expected), "{values:?}");
        }
        for task in [Task::Crank, Task::Mechanism] {
            let rules = Definition::built_in(task).expect("the built-in task").rules();
            for load in [None, Some(Plus), Some(Zero)] {
                for speed in [Plus, Zero] {
                    let expected = match (load, speed) {
                        (Some(Zero), _) => SystemState::FreeMotion,
                        (_, Plus) => SystemState::Turning,
                        _ => SystemState::Holding,
                    };
                    assert_eq!(rules.state(&[load, Some(speed)]), expected, "{load:?} {speed:?}");
                }
            }
        }
    }

    #[test]
    fn hysteresis_keeps_a_value_near_the_threshold() {
        use Sign::{Minus, Plus, Zero};
        let mut sign = Zero;
        let seen: Vec<_> = [0.9, 1.1, 0.8, 0.75, 0.6, 0.9, -1.2]
            .into_iter()
            .map(|v| {
                sign = schmitt(sign, v, 0.7);
                sign
            })
            .collect();
        assert_eq!(seen, [Zero, Plus, Plus, Plus, Zero, Zero, Minus]);
    }
}
