//! Safety stage between the world and the operator's fingers: start ramp, clamp, slew limit, watchdog.

use crate::Vec2;
use crate::device::Sample;

/// Limits, from the device's spec and the servo's configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Largest force per finger, N.
    pub max_force_n: f64,
    /// Largest change of force, N/s.
    pub max_slew_n_s: f64,
    /// Time over which the force comes up after a start or a fault, s.
    pub ramp_s: f64,
    /// Without a fresh sample of either finger for this long the force goes to zero, s.
    pub watchdog_s: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { max_force_n: 4.0, max_slew_n_s: 2_000.0, ramp_s: 0.5, watchdog_s: 0.02 }
    }
}

/// Time over which the force of a world that was swapped out goes, s.
const FADE_S: f64 = 0.05;
/// A new world that presses harder than the old one by more than this comes up with the start ramp, N.
const JUMP_N: f64 = 1.0;
/// A finger that is not new keeps its velocity for so long, s: a device may answer less often than the servo ticks.
const COASTING_S: f64 = 0.005;
/// No hand is farther away than this, m, nor faster, m/s: such a sample is a fault.
const FARTHEST_M: f64 = 10.0;
const FASTEST_M_S: f64 = 100.0;

/// Reasons why the force differs from that of the world.
#[allow(clippy::struct_excessive_bools)] // four independent lights, shown as such
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SafetyFlags {
    /// A force was clamped to the maximum.
    pub saturated: bool,
    /// A force was slowed by the slew limit.
    pub slewing: bool,
    /// No fresh sample of a finger for longer than the watchdog allows, or the servo itself stood still as long: force is zero.
    pub stale: bool,
    /// A sample or force was not a possible number and was refused.
    pub not_finite: bool,
}

/// Transition of the force to a new world.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Swapping {
    /// No swap under way.
    #[default]
    Done,
    /// The new world has not said yet how hard it presses.
    Asked,
    /// The old force still counts with this share.
    Fading { old_n: [Vec2; 2], share: f64 },
}

/// The state of the safety stage.
#[derive(Clone, Debug)]
pub struct Safety {
    limits: Limits,
    ramp: f64,
    last_force_n: [Vec2; 2],
    last_good: Sample,
    /// Of each finger.
    sample_age_s: [f64; 2],
    /// Fingers that were ever seen.
    met: [bool; 2],
    interrupted: bool,
    swapping: Swapping,
}

impl Safety {
    /// Starts at zero force with the fingers at `start`.
    pub fn new(limits: Limits, start: [Vec2; 2]) -> Self {
        let last_good = Sample { tip_in_world: start, tip_velocity: [Vec2::zeros(); 2], fresh: [true; 2] };
        Self {
            limits,
            ramp: 0.0,
            last_force_n: [Vec2::zeros(); 2],
            last_good,
            sample_age_s: [0.0; 2],
            met: [false; 2],
            interrupted: false,
            swapping: Swapping::Done,
        }
    }

    /// Says that the world was swapped: the old force fades, and a new one that presses much harder comes up softly.
    pub fn swapped(&mut self) {
        self.swapping = Swapping::Asked;
    }

    /// Says that the servo stood still for longer than the watchdog allows: the next force is zero, then it comes back softly.
    pub fn interrupted(&mut self) {
        self.interrupted = true;
    }

    /// The sample to simulate with: of each finger the given one when it is fresh, else the last good one, which comes to rest
    /// after [`COASTING_S`]. A sample with anything impossible in it is refused as a whole, and both fingers rest.
    pub fn admit(&mut self, sample: &Sample, dt_s: f64, flags: &mut SafetyFlags) -> Sample {
        // Written so that not-a-number is impossible too.
        let possible = sample.tip_in_world.iter().all(|v| v.norm() <= FARTHEST_M)
            && sample.tip_velocity.iter().all(|v| v.norm() <= FASTEST_M_S);
        flags.not_finite |= !possible;
        for finger in 0..2 {
            if possible && sample.fresh[finger] {
                self.last_good.tip_in_world[finger] = sample.tip_in_world[finger];
                self.last_good.tip_velocity[finger] = sample.tip_velocity[finger];
                (self.sample_age_s[finger], self.met[finger]) = (0.0, true);
                continue;
            }
            self.sample_age_s[finger] += dt_s;
            if !possible || self.sample_age_s[finger] > COASTING_S {
                self.last_good.tip_velocity[finger] = Vec2::zeros();
            }
        }
        self.last_good
    }

    /// The force to send: ramped, clamped, slew-limited; zero at once when the samples are stale.
    pub fn limit(&mut self, wanted_n: [Vec2; 2], dt_s: f64, flags: &mut SafetyFlags) -> [Vec2; 2] {
        if self.sample_age_s() > self.limits.watchdog_s || self.interrupted {
            flags.stale = true;
            self.interrupted = false;
            self.ramp = 0.0;
            self.swapping = Swapping::Done;
            self.last_force_n = [Vec2::zeros(); 2];
            return self.last_force_n;
        }
        self.ramp = (self.ramp + dt_s / self.limits.ramp_s.max(dt_s)).min(1.0);
        let wanted_n = self.blend(wanted_n, dt_s);
        for (last, wanted) in self.last_force_n.iter_mut().zip(wanted_n) {
            let finite = wanted.x.is_finite() && wanted.y.is_finite();
            flags.not_finite |= !finite;
            let mut force = if finite { wanted } else { Vec2::zeros() };
            let size = force.norm();
            if size > self.limits.max_force_n {
                flags.saturated = true;
                force *= self.limits.max_force_n / size;
            }
            let change = force - *last;
            let most = self.limits.max_slew_n_s * dt_s;
            if change.norm() > most {
                flags.slewing = true;
                force = *last + change * (most / change.norm());
            }
            *last = force;
        }
        self.last_force_n
    }

    /// Lets the force go within [`FADE_S`] while the world is held still; afterwards it comes up with the start ramp.
    pub fn release(&mut self, dt_s: f64, flags: &mut SafetyFlags) -> [Vec2; 2] {
        self.ramp = 0.0;
        self.swapping = Swapping::Done;
        flags.stale = self.sample_age_s() > self.limits.watchdog_s || self.interrupted;
        self.interrupted = false;
        let most = if flags.stale { f64::INFINITY } else { self.limits.max_force_n / FADE_S * dt_s };
        for last in &mut self.last_force_n {
            let size = last.norm();
            *last = if size <= most { Vec2::zeros() } else { *last * (1.0 - most / size) };
        }
        self.last_force_n
    }

    /// Ramped force of the world, with the fading share of the previous one.
    fn blend(&mut self, wanted_n: [Vec2; 2], dt_s: f64) -> [Vec2; 2] {
        if self.swapping == Swapping::Asked {
            let old_n = self.last_force_n;
            let jumps = wanted_n.iter().zip(&old_n).any(|(new, old)| new.norm() > old.norm() + JUMP_N);
            if jumps {
                self.ramp = 0.0;
            }
            self.swapping = Swapping::Fading { old_n, share: 1.0 };
        }
        let mut blended = wanted_n.map(|force| force * self.ramp);
        if let Swapping::Fading { old_n, share } = self.swapping {
            for (force, old) in blended.iter_mut().zip(old_n) {
                *force = *force * (1.0 - share) + old * share;
            }
            let share = share - dt_s / FADE_S;
            self.swapping = if share > 0.0 { Swapping::Fading { old_n, share } } else { Swapping::Done };
        }
        blended
    }

    /// Age of the newest good sample of the finger that was not seen for longer, s.
    pub fn sample_age_s(&self) -> f64 {
        self.sample_age_s[0].max(self.sample_age_s[1])
    }

    /// True after both fingers have been seen.
    pub fn has_met_both(&self) -> bool {
        self.met == [true; 2]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT: f64 = 1e-3;

    #[test]
    fn a_held_force_goes_within_a_twentieth_of_a_second_and_comes_back_with_the_start_ramp() {
        let mut safety = Safety::new(Limits::default(), [Vec2::zeros(); 2]);
        let (wanted, mut flags) = ([Vec2::new(3.0, 0.0), Vec2::new(-3.0, 0.0)], SafetyFlags::default());
        for _ in 0..1_000 {
            safety.admit(&fresh(), DT, &mut flags);
            safety.limit(wanted, DT, &mut flags);
        }
        assert_eq!(safety.last_force_n, wanted);
        let mut before_n = 3.0;
        for k in 0..50 {
            safety.admit(&fresh(), DT, &mut flags);
            let now_n = safety.release(DT, &mut flags)[0].x;
            assert!(now_n <= before_n && before_n - now_n < 0.1, "{before_n} N to {now_n} N in tick {k}");
            before_n = now_n;
        }
        assert_eq!(safety.last_force_n, [Vec2::zeros(); 2]);
        safety.admit(&fresh(), DT, &mut flags);
        let first = safety.limit(wanted, DT, &mut flags);
        assert!(first[0].norm() < 0.01, "it comes back softly: {first:?}");
    }

    fn safety() -> Safety {
        Safety::new(Limits { max_slew_n_s: 100.0, ..Limits::default() }, [Vec2::zeros(); 2])
    }

    fn fresh() -> Sample {
        Sample { fresh: [true; 2], ..Sample::default() }
    }

    #[test]
    fn ramps_clamps_and_limits_the_slew() {
        let mut safety = safety();
        let wanted = [Vec2::new(10.0, 0.0), Vec2::new(0.5, 0.0)];
        let mut last = [Vec2::zeros(); 2];
        let mut flags = SafetyFlags::default();
        for tick in 0..2_000 {
            flags = SafetyFlags::default();
            safety.admit(&fresh(), DT, &mut flags);
            let force = safety.limit(wanted, DT, &mut flags);
            assert!((force[0] - last[0]).norm() <= 0.1 + 1e-12, "slew at tick {tick}");
            assert!(force[0].norm() <= 4.0 + 1e-12);
            last = force;
        }
        assert!(flags.saturated && (last[0].x - 4.0).abs() < 1e-9 && (last[1].x - 0.5).abs() < 1e-12);
    }

    #[test]
    fn stale_samples_end_in_zero_force_within_the_watchdog_time() {
        let mut safety = safety();
        let wanted = [Vec2::new(1.0, 0.0); 2];
        let mut flags = SafetyFlags::default();
        for _ in 0..1_000 {
            safety.admit(&fresh(), DT, &mut flags);
            safety.limit(wanted, DT, &mut flags);
        }
        assert!(!flags.stale);
        let lost = Sample::default();
        let mut force = wanted;
        for _ in 0..22 {
            safety.admit(&lost, DT, &mut flags);
            force = safety.limit(wanted, DT, &mut flags);
        }
        assert!(flags.stale);
        assert_eq!(force, [Vec2::zeros(); 2]);
        // And it comes back softly.
        safety.admit(&fresh(), DT, &mut flags);
        assert!(safety.limit(wanted, DT, &mut flags)[0].x < 0.01);
    }

    #[test]
    fn each_finger_has_its_own_age_and_the_older_one_counts() {
        let (mut safety, mut flags) = (safety(), SafetyFlags::default());
        let seen = |left: bool, right: bool| Sample {
            tip_in_world: [Vec2::new(0.01, 0.0), Vec2::new(0.02, 0.0)],
            fresh: [left, right],
            ..Sample::default()
        };
        let admitted = safety.admit(&seen(true, false), DT, &mut flags);
        assert_eq!(admitted.tip_in_world, [Vec2::new(0.01, 0.0), Vec2::zeros()], "only what is new is taken");
        assert!(!safety.has_met_both() && (safety.sample_age_s() - DT).abs() < 1e-12);
        safety.admit(&seen(false, true), DT, &mut flags);
        assert!(safety.has_met_both() && (safety.sample_age_s() - DT).abs() < 1e-12);
        for _ in 0..22 {
            safety.admit(&seen(true, false), DT, &mut flags);
        }
        assert!((safety.sample_age_s() - 0.022).abs() < 1e-12, "{}", safety.sample_age_s());
        assert_eq!(safety.limit([Vec2::new(1.0, 0.0); 2], DT, &mut flags), [Vec2::zeros(); 2]);
        assert!(flags.stale);
    }

    #[test]
    fn a_finger_that_is_not_seen_coasts_for_a_moment_and_then_rests() {
        let (mut safety, mut flags) = (safety(), SafetyFlags::default());
        let velocity = Vec2::new(0.1, -0.2);
        safety.admit(&Sample { tip_velocity: [velocity; 2], ..fresh() }, DT, &mut flags);
        let lost = Sample { tip_velocity: [velocity; 2], ..Sample::default() };
        let seen: Vec<Vec2> = (0..10).map(|_| safety.admit(&lost, DT, &mut flags).tip_velocity[1]).collect();
        assert!(seen[..4].iter().all(|v| *v == velocity), "between two answers it moves on: {seen:?}");
        assert!(seen[6..].iter().all(|v| *v == Vec2::zeros()), "a damper must not push it for ever: {seen:?}");
        // An impossible sample is no answer that may still come.
        safety.admit(&Sample { tip_velocity: [velocity; 2], ..fresh() }, DT, &mut flags);
        let broken = Sample { tip_in_world: [Vec2::repeat(f64::NAN); 2], ..fresh() };
        assert_eq!(safety.admit(&broken, DT, &mut flags).tip_velocity, [Vec2::zeros(); 2]);
    }

    #[test]
    fn not_a_number_is_refused() {
        let mut safety = safety();
        let mut flags = SafetyFlags::default();
        let mut broken = fresh();
        broken.tip_in_world[1].y = f64::NAN;
        assert!(safety.admit(&broken, DT, &mut flags).tip_in_world[1].y.is_finite());
        assert!(flags.not_finite);
        let force = safety.limit([Vec2::new(f64::INFINITY, 0.0), Vec2::zeros()], DT, &mut flags);
        assert!(force[0].x.is_finite());
    }

    /// The forces after a swap from a world that presses with `old_n` to one that presses with `new_n`.
    fn after_swap(old_n: f64, new_n: f64) -> Vec<f64> {
        let mut safety = Safety::new(Limits::default(), [Vec2::zeros(); 2]);
        let mut flags = SafetyFlags::default();
        let along = |n: f64| [Vec2::new(n, 0.0), Vec2::zeros()];
        for _ in 0..1_000 {
            safety.admit(&fresh(), DT, &mut flags);
            safety.limit(along(old_n), DT, &mut flags);
        }
        safety.swapped();
        (0..1_000)
            .map(|_| {
                safety.admit(&fresh(), DT, &mut flags);
                safety.limit(along(new_n), DT, &mut flags)[0].x
            })
            .collect()
    }

    #[test]
    fn a_swap_fades_the_old_force_and_brings_a_much_harder_one_up_softly() {
        let softer = after_swap(2.5, 0.5);
        assert!((softer[0] - 2.5).abs() < 0.1, "no jump: {}", softer[0]);
        assert!((softer[60] - 0.5).abs() < 1e-9, "and soon there: {}", softer[60]);
        let harder = after_swap(0.2, 3.0);
        let steepest = harder.windows(2).map(|w| (w[1] - w[0]).abs()).fold(0.0, f64::max);
        assert!(steepest < 3.0 * DT / 0.5 + 0.2 * DT / FADE_S + 1e-3, "ramped: {steepest} N a tick");
        assert!((harder[999] - 3.0).abs() < 1e-9);
    }

    #[test]
    fn an_interruption_is_zero_at_once_and_said() {
        let mut safety = safety();
        let mut flags = SafetyFlags::default();
        for _ in 0..1_000 {
            safety.admit(&fresh(), DT, &mut flags);
            safety.limit([Vec2::new(1.0, 0.0); 2], DT, &mut flags);
        }
        safety.interrupted();
        safety.admit(&fresh(), DT, &mut flags);
        assert_eq!(safety.limit([Vec2::new(1.0, 0.0); 2], DT, &mut flags), [Vec2::zeros(); 2]);
        assert!(flags.stale);
        let mut flags = SafetyFlags::default();
        safety.admit(&fresh(), DT, &mut flags);
        let next = safety.limit([Vec2::new(1.0, 0.0); 2], DT, &mut flags)[0].x;
        assert!(!flags.stale && next > 0.0 && next < 0.01, "{next}");
    }

    #[test]
    fn impossible_places_and_speeds_are_refused_like_what_is_not_a_number() {
        for (place, speed) in [(f64::INFINITY, 0.0), (1e6, 0.0), (0.0, 1e4), (0.0, f64::NEG_INFINITY)] {
            let mut safety = safety();
            let mut flags = SafetyFlags::default();
            let mut broken = fresh();
            (broken.tip_in_world[0].x, broken.tip_velocity[1].y) = (place, speed);
            let admitted = safety.admit(&broken, DT, &mut flags);
            assert!(flags.not_finite, "{place} m, {speed} m/s");
            assert_eq!(admitted.tip_in_world, [Vec2::zeros(); 2]);
        }
    }
}
