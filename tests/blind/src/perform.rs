//! The operator does what an answer asks for: the same object, the same person, another motion.
//!
//! An answer names the motion and says how wide, how fast and how long; how it is done is the operator's own business: strokes of a
//! hand with an impedance, with its wandering and its tremor, that follows what it means to do as well as it can.

use super::chance::Chance;
use super::draw::{self, Spec};
use super::plan::Plan;
use super::plant::Hung;
use super::record::GRAVITY;
use super::simulate::Setup;
use estimator::diagnose::Experiment;

/// Nobody strikes to and fro faster, s a stroke.
const SHORTEST_S: f64 = 0.28;
/// The hand begins to move so long after it took hold, s.
const SETTLES_S: f64 = 0.4;

/// How `asked` is recorded on the object of `of`; `zero_m`: where a mechanism's coordinate begins. Nothing for a motion that nobody
/// knows, or one that the object does not allow.
pub fn perform(spec: &Spec, of: &Setup, asked: &Experiment, zero_m: f64, seed: u64) -> Option<Setup> {
    let crank = of.center_m.is_some();
    let sane = [asked.seconds, asked.half_range, asked.fast].iter().all(|v| v.is_finite() && *v > 0.0);
    if !sane || (!crank && asked.free_s > 0.0 && asked.added_weight_n == 0.0) {
        return None;
    }
    let mut setup = draw::setup(spec, &quiet(), &anywhere(), seed);
    (setup.plant, setup.center_m, setup.habits) = (of.plant, of.center_m, of.habits);
    setup.hidden.clone_from(&of.hidden);
    setup.effects_s = of.effects_s;
    // Coming and going take their time, too.
    let (before, after) = if crank { (asked.free_s.max(1.1), asked.free_s) } else { (0.1, 0.1) };
    setup.hold_s = [before, before + asked.seconds];
    setup.seconds = before + asked.seconds + after;
    let mut chance = Chance::new(seed, 8);
    if asked.added_weight_n > 0.0 {
        setup.plant.hung = if crank {
            Hung { force: asked.added_weight_n, inertia: asked.added_weight_n / GRAVITY, level: 0.0 }
        } else {
            let [weight, lever] = [asked.added_weight_n, asked.added_lever_m];
            let level = chance.between(-1.0, 1.0);
            Hung { force: weight * lever, inertia: weight * lever * lever / GRAVITY, level }
        };
    }
    // Angles of a crank are told from the horizontal; the hand counts from where it starts.
    let unit = of.plant.radius_m;
    let (middle, half, fast) = if crank {
        (asked.middle - setup.start_angle, asked.half_range, asked.fast)
    } else {
        ((asked.middle - zero_m) / unit, asked.half_range / unit, asked.fast / unit)
    };
    let mut going = Going { plan: Plan::starting(before + SETTLES_S), place: 0.0, middle, half, fast };
    let ends = setup.hold_s[1] - 0.5;
    going.follow(&asked.id, ends, asked.across_n, &mut chance)?;
    setup.plan = going.plan;
    Some(setup)
}

/// Instruments are those of the first recording; these only fill a place.
fn quiet() -> super::sensor::Sensor {
    super::sensor::Sensor {
        noise_n: 0.01,
        memory_s: 0.01,
        swing_hz: 0.0,
        step_n: 0.0,
        angle_noise: 1e-4,
        angle_step: 0.0,
        rate_noise: 0.01,
    }
}

fn anywhere() -> super::arm::Arm {
    super::arm::Arm { base_m: [0.0; 2], link_m: [draw::LINK_M; 2] }
}

/// A plan in the making, and where it has come to (rad since the beginning).
struct Going {
    plan: Plan,
    place: f64,
    middle: f64,
    half: f64,
    fast: f64,
}

impl Going {
    /// To a place, in half ranges from the middle, with a peak speed in those that were asked for.
    fn to(&mut self, share: f64, pace: f64) {
        let target = self.middle + share * self.half;
        let by = target - self.place;
        self.plan.stroke(by, (2.0 * by.abs() / (pace * self.fast)).max(SHORTEST_S));
        self.place = target;
    }

    fn rest(&mut self, seconds: f64) {
        self.plan.knot(seconds, 0.0);
    }

    /// The motion of that name until `end_s`; nothing for an unknown one.
    fn follow(&mut self, id: &str, end_s: f64, across_n: f64, chance: &mut Chance) -> Option<()> {
        let mut round = 0_usize;
        while self.plan.end() < end_s {
            let side = if round.is_multiple_of(2) { 1.0 } else { -1.0 };
            let pull = |plan: &mut Plan, share: f64| {
                if across_n > 0.0 {
                    plan.pull(share * across_n);
                }
            };
            match id {
                "sweep-across" => {
                    pull(&mut self.plan, if round % 6 < 3 { 1.0 } else { -1.0 });
                    self.to(side, [0.4, 1.0, 0.7, 0.2][round / 2 % 4]);
                }
                "sweep-let-go" => {
                    pull(&mut self.plan, [0.6, 1.2, -0.8][round % 3]);
                    self.to(side, [0.4, 1.0, 0.7, 0.2][round / 2 % 4]);
                }
                "short-strokes" => {
                    pull(&mut self.plan, [0.7, 0.7, 1.3][round % 3]);
                    self.to([-0.6, 0.2, 0.6, -0.2][round / 8 % 4] + 0.06 * side, 0.3);
                }
                "bursts" => {
                    pull(&mut self.plan, [0.8, 1.2][round % 2]);
                    self.to(0.3 * side, 1.2);
                    self.rest(0.15);
                }
                "one-way" => {
                    pull(&mut self.plan, [0.6, 1.2][round % 2]);
                    self.to(side, if round.is_multiple_of(3) { 1.0 } else { 0.12 });
                }
                "rests-and-squeezes" => {
                    pull(&mut self.plan, if round % 4 < 2 { 0.4 } else { 1.6 });
                    self.to(0.9 * side, 0.3);
                    self.rest(0.8);
                }
                "long-mixed" => {
                    pull(&mut self.plan, chance.between(-1.3, 1.3));
                    self.to(chance.between(-1.0, 1.0), chance.of_order(0.15, 1.0));
                }
                "hang-weight" => {
                    pull(&mut self.plan, if round % 4 < 2 { 0.3 } else { -0.3 });
                    self.to(side, [0.35, 0.5][round / 2 % 2]);
                    self.rest(0.2);
                }
                _ => return None,
            }
            round += 1;
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::case::make_with_object;
    use super::super::draw::Bench;
    use super::super::effect::Effect;
    use super::*;

    fn spec(bench: Bench, effect: Effect) -> Spec {
        Spec { seconds: 12.0, ..Spec::hiding(vec![(effect, 0)], 1.0, bench) }
    }

    fn asked(id: &str) -> Experiment {
        let (added_weight_n, added_lever_m) = (0.0, 0.0);
        Experiment {
            id: id.to_owned(),
            seconds: 14.0,
            free_s: 2.0,
            middle: -1.0,
            half_range: 3.0,
            fast: 5.0,
            across_n: 0.6,
            added_weight_n,
            added_lever_m,
        }
    }

    #[test]
    fn the_hand_goes_as_far_as_it_was_asked_to_and_lets_go() {
        let (_, _, object) = make_with_object(&spec(Bench::OneFinger, Effect::Inertia), &[], 5);
        for id in ["sweep-across", "sweep-let-go", "rests-and-squeezes", "long-mixed"] {
            let again = object.perform(&asked(id), 9).expect("it is known");
            let (setup, time_s) = (&again.meta, again.time_s.as_deref().expect("a clock"));
            assert!(setup.known.is_empty() && (time_s[time_s.len() - 1] - 18.0).abs() < 0.1);
            let force =
                |i: usize| again.channel("fx_N").expect("a force")[i].hypot(again.channel("fy_N").expect("a force")[i]);
            let mean = |from: f64, to: f64| {
                let of: Vec<f64> =
                    (0..time_s.len()).filter(|i| time_s[*i] > from && time_s[*i] < to).map(force).collect();
                of.iter().sum::<f64>() / of.len() as f64
            };
            assert!(mean(0.2, 1.5) < 0.2 * mean(3.0, 15.0) && mean(16.5, 18.0) < 0.2 * mean(3.0, 15.0), "{id}");
        }
        assert!(object.perform(&asked("juggle"), 9).is_none(), "nobody knows how");
    }

    #[test]
    fn a_mechanism_goes_where_it_was_asked_to_and_a_hung_weight_is_written_down() {
        let (case, _, object) = make_with_object(&spec(Bench::Angular, Effect::Eccentric), &[], 6);
        let first = case.recordings[0].channel("q_rad").expect("an angle");
        let middle =
            0.5 * (first.iter().copied().fold(f64::MAX, f64::min) + first.iter().copied().fold(f64::MIN, f64::max));
        let wanted =
            Experiment { middle, half_range: 1.0, fast: 2.0, free_s: 0.0, across_n: 0.0, ..asked("sweep-across") };
        let again = object.perform(&wanted, 3).expect("it is known");
        let angle = again.channel("q_rad").expect("an angle");
        let (low, high) =
            (angle.iter().copied().fold(f64::MAX, f64::min), angle.iter().copied().fold(f64::MIN, f64::max));
        assert!((high - middle - 1.0).abs() < 0.35 && (middle - low - 1.0).abs() < 0.35, "{low} {middle} {high}");
        let hung = Experiment { added_weight_n: 0.5, added_lever_m: 0.1, ..wanted };
        let known = object.perform(&Experiment { id: "hang-weight".to_owned(), ..hung }, 3).expect("known").meta.known;
        assert!((known["added_weight_N"] - 0.5).abs() < 1e-9 && (known["added_lever_m"] - 0.1).abs() < 1e-9);
        assert!(known["added_level_rad"].is_finite());
    }
}
