//! Desired hand positions over time, for an experiment in a world: approach, grasp, move, release, retreat.

use estimator::diagnose::{Experiment, Strokes};
use haptics::Vec2;
use haptics::device::{HandGoal, HandImpedance, Route, Skill};
use haptics::law::{Effect, GravityTilt, Inertia, Law, Motion, Role, Weight};
use haptics::world::{Crank, State, World};
use std::f64::consts::TAU;

/// Interval between goals, s: the arm is a hundred times slower.
const PERIOD_S: f64 = 2e-3;
/// Spare opening of the fingers around an object, m on both sides together.
pub(super) const CLEARANCE_M: f64 = 0.006;
/// Minimum time without contact before and after, s: sensors show their zero.
pub(super) const LEAST_FREE_S: f64 = 1.0;
/// Duration of a reach through the air, of closing or opening, and of a rest between them, s.
pub(super) const REACH_S: f64 = 1.0;
pub(super) const CLOSE_S: f64 = 0.6;
const REST_S: f64 = 0.4;
/// Peak over mean speed of a movement from rest to rest.
const PEAK: f64 = 1.875;
/// Factor on the minimum pinch force, so that nothing slips.
const SPARE_PINCH: f64 = 1.6;
/// Distance by which the hand retreats after release, m.
const AWAY_M: f64 = 0.014;
/// Number of angles in the search for a crank's rest position.
const ANGLES: u32 = 1_440;

/// Step of an experiment, with text for the user.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// End of the step, s since the start.
    pub until_s: f64,
    /// Instruction.
    pub words: String,
    /// True if the object is held.
    pub holds: bool,
}

/// An experiment in a world.
#[derive(Clone, Debug)]
pub struct Timetable {
    /// World with the added weight and the object at rest.
    pub world: World,
    /// Desired hand positions.
    pub route: Route,
    /// Steps in order.
    pub steps: Vec<Step>,
}

impl Timetable {
    /// Experiment on the object of a world; an error gives the reason why it is not possible there. `motion`: as text.
    pub fn new(world: &World, asked: &Experiment, motion: &str) -> Result<Self, String> {
        let world = made_ready(world, asked)?;
        // The weight is already attached for the user.
        let motion = motion.split_once("; ").filter(|_| asked.added_weight_n > 0.0).map_or(motion, |(_, rest)| rest);
        // The release has steps of its own.
        let motion = motion.split(", and let go").next().unwrap_or(motion);
        let mut writer = Writer::at_rest(&world);
        if let Some(crank) = &world.crank {
            writer.turn(crank, &world, asked, motion)?;
        } else if let Some(membrane) = &world.membrane {
            writer.pierce(membrane, &world, asked)?;
        } else if let Some(switch) = &world.switch {
            writer.throw(switch, asked)?;
        } else if asked.id.starts_with("carry-") && !world.blocks.is_empty() {
            writer.carry(&world, asked, motion)?;
        } else {
            return Err(
                "The hand cannot hold this object here; do it on the real one and load the recording.".to_owned()
            );
        }
        let Writer { goals, steps, .. } = writer;
        let route = Route::new(PERIOD_S, goals).ok_or("The experiment has no length.")?;
        Ok(Self { world, route, steps })
    }

    /// The same with a leak that starts at the grasp: a diagnosis counts a leak from its first possible detection.
    #[must_use]
    pub fn leaking_once_held(mut self) -> Self {
        let held_from_s = self.steps.iter().find(|step| step.holds).map(|step| step.until_s);
        for content in self.world.blocks.iter_mut().filter_map(|block| block.content.as_mut()) {
            content.leaks_from_s = content.leaks_from_s.and(held_from_s);
        }
        self
    }

    /// Duration, s.
    pub fn duration_s(&self) -> f64 {
        self.route.duration_s()
    }

    /// Step at a time, and its remaining time, s.
    pub fn step_at(&self, time_s: f64) -> Option<(&Step, f64)> {
        let step = self.steps.iter().find(|step| time_s < step.until_s)?;
        Some((step, step.until_s - time_s))
    }
}

/// World with the added weight, and with the crank at its rest position.
fn made_ready(world: &World, asked: &Experiment) -> Result<World, String> {
    let mut world = world.clone();
    if let Some(crank) = &mut world.crank {
        if asked.added_weight_n > 0.0 {
            hang(&mut crank.effects, asked.added_weight_n, world.gravity_m_s2);
        }
        crank.start_rad = rest_rad(crank);
    } else if let Some(switch) = world.switch.as_mut().filter(|_| asked.added_weight_n <= 0.0) {
        switch.start_m = switch.curve.points.first().map_or(switch.start_m, |end| end.at_m);
    } else if asked.added_weight_n > 0.0 {
        return Err("Nothing can be hung on the object of this world.".to_owned());
    }
    world.check().map_err(|error| format!("This world cannot be simulated: {error}."))?;
    Ok(world)
}

/// Adds a weight on the handle, in the direction of the object's own weight.
fn hang(effects: &mut Vec<Effect>, weight_n: f64, gravity_m_s2: f64) {
    let add = |effects: &mut Vec<Effect>, law: &'static dyn Law, value: f64| match effects
        .iter_mut()
        .find(|e| e.law().id() == law.id())
    {
        Some(effect) => effect.values[0] += value,
        None => effects.push(Effect::new(law, &[value])),
    };
    add(effects, &Weight, weight_n);
    add(effects, &Inertia, weight_n / gravity_m_s2.max(1e-9));
    if effects.iter().any(|e| e.law().id() == GravityTilt.id()) {
        add(effects, &GravityTilt, weight_n);
    }
}

/// Rest position of the crank, rad: without friction, the minimum of its potential energy.
fn rest_rad(crank: &Crank) -> f64 {
    let step = TAU / f64::from(ANGLES);
    let pull = |angle: f64| -> f64 {
        let motion = Motion { position: crank.radius_m * angle, up_along: angle.cos(), ..Motion::default() };
        let conserves = |e: &&Effect| !e.law().is_dry() && !e.remembers() && e.role() != Role::Inertia;
        crank.effects.iter().filter(conserves).map(|e| e.force(&motion)).sum()
    };
    // From straight down: a crank without any force stays there.
    let (mut energy, mut lowest) = (0.0, (0.0, -0.25 * TAU));
    for k in 0..ANGLES {
        let angle = -0.25 * TAU + step * f64::from(k);
        if energy < lowest.0 - 1e-12 {
            lowest = (energy, angle);
        }
        energy += pull(angle + 0.5 * step) * step;
    }
    let angle = lowest.1;
    if angle > 0.5 * TAU { angle - TAU } else { angle }
}

/// Writer of consecutive goals.
pub(super) struct Writer {
    pub(super) goals: Vec<HandGoal>,
    steps: Vec<Step>,
    pub(super) at: HandGoal,
    pub(super) away: HandGoal,
}

impl Writer {
    fn at_rest(world: &World) -> Self {
        let at = HandGoal::from_tips(State::resting(world).input.tip_in_world);
        Self { goals: vec![at], steps: Vec::new(), at, away: at }
    }

    pub(super) fn now_s(&self) -> f64 {
        PERIOD_S * (self.goals.len() - 1) as f64
    }

    pub(super) fn wait(&mut self, seconds: f64) {
        self.go(seconds, self.at);
    }

    /// Moves with minimum jerk.
    pub(super) fn go(&mut self, seconds: f64, to: HandGoal) {
        let (from, count) = (self.at, (seconds / PERIOD_S).round().max(1.0) as usize);
        for k in 1..=count {
            let u = k as f64 / count as f64;
            let share = u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
            self.goals.push(HandGoal {
                center_m: from.center_m + (to.center_m - from.center_m) * share,
                aperture_m: from.aperture_m + (to.aperture_m - from.aperture_m) * share,
                pinch_n: from.pinch_n + (to.pinch_n - from.pinch_n) * share,
            });
        }
        self.at = to;
    }

    pub(super) fn say(&mut self, words: impl Into<String>, holds: bool) {
        let until_s = self.now_s();
        self.steps.push(Step { until_s, words: words.into(), holds });
    }

    /// Waits, approaches and closes on an object of `width_m` at `at`. `over_m`: height from which it is approached.
    pub(super) fn take(&mut self, free_s: f64, (at, over_m): (Vec2, f64), width_m: f64, pinch_n: f64) {
        self.wait(free_s.max(LEAST_FREE_S));
        self.say("Touch nothing.", false);
        let open = HandGoal { center_m: at, aperture_m: width_m + CLEARANCE_M, pinch_n: 0.0 };
        if over_m > 0.0 {
            // On the direct path a finger would come down on top of it.
            self.go(REACH_S, HandGoal { center_m: at + Vec2::new(0.0, over_m), ..open });
        }
        self.go(REACH_S, open);
        let words = if over_m > 0.0 { "Go down over it with open fingers." } else { "Go there with open fingers." };
        self.say(words, false);
        self.go(CLOSE_S, HandGoal { aperture_m: width_m, pinch_n, ..open });
        self.wait(REST_S);
        self.say("Take hold.", true);
    }

    /// Opens, retreats and waits.
    pub(super) fn let_go(&mut self, free_s: f64, over_m: f64, width_m: f64) {
        self.wait(REST_S);
        self.go(CLOSE_S, HandGoal { aperture_m: width_m + 2.0 * CLEARANCE_M, pinch_n: 0.0, ..self.at });
        let up = self.at.center_m + Vec2::new(0.0, over_m.max(AWAY_M));
        self.go(CLOSE_S, HandGoal { center_m: up, ..self.at });
        self.go(REACH_S, self.away);
        self.say("Let go and take the hand away.", false);
        self.wait(free_s.max(LEAST_FREE_S));
        self.say("Touch nothing.", false);
    }

    fn turn(&mut self, crank: &Crank, world: &World, asked: &Experiment, motion: &str) -> Result<(), String> {
        let strokes = Strokes::of(asked).ok_or_else(|| unknown(asked))?;
        // Positions count from the turn in which the handle points down.
        let rest = crank.start_rad;
        let turns = TAU * ((asked.middle - rest) / TAU).round();
        let hangs = world.gravity_m_s2
            * crank.effects.iter().filter(|e| e.role() == Role::Inertia).map(|e| e.values[0]).sum::<f64>();
        let needed =
            (asked.across_n.hypot(hangs) + usual_drag_n(crank, asked)) / (2.0 * crank.finger_friction.max(0.05));
        let pinch_n = (2.0 * Skill::default().pinch_n).max(SPARE_PINCH * needed);
        let width_m = crank.handle_width_m;
        let held = |angle: f64, across_n: f64| {
            // Both fingers' springs pull where the desired position is beside the circle.
            let beside_m = across_n / (2.0 * HandImpedance::default().stiffness_n_m);
            let (sin, cos) = angle.sin_cos();
            let center_m = crank.center_m + Vec2::new(cos, sin) * (crank.radius_m + beside_m);
            HandGoal { center_m, aperture_m: width_m, pinch_n }
        };
        self.take(asked.free_s, (held(rest, 0.0).center_m, 0.0), width_m, pinch_n);
        let first = strokes.at(0.0).coordinate - turns;
        let fast = 0.5 * asked.fast;
        self.along(rest, first, fast, &|angle| held(angle, 0.0));
        self.say("Go to where the motion begins.", true);
        let begun_s = self.now_s();
        let mut last = first;
        while self.now_s() - begun_s < asked.seconds {
            let wanted = strokes.at(self.now_s() - begun_s);
            last = wanted.coordinate - turns;
            self.at = held(last, wanted.across_n);
            self.goals.push(self.at);
        }
        self.say(motion, true);
        let turn = TAU * ((last - rest) / TAU).round();
        self.along(last, rest + turn, fast, &|angle| held(angle, 0.0));
        self.say("Go to where it rests.", true);
        self.let_go(asked.free_s, 0.0, width_m);
        Ok(())
    }

    /// Moves from one coordinate to another, no faster than `fast` per second.
    fn along(&mut self, from: f64, to: f64, fast: f64, held: &dyn Fn(f64) -> HandGoal) {
        let seconds = (PEAK * (to - from).abs() / fast.max(1e-6)).max(REST_S);
        let count = (seconds / PERIOD_S).round().max(1.0) as usize;
        for k in 1..=count {
            let u = k as f64 / count as f64;
            let share = u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
            self.at = held(from + (to - from) * share);
            self.goals.push(self.at);
        }
    }

    fn carry(&mut self, world: &World, asked: &Experiment, motion: &str) -> Result<(), String> {
        let sane =
            [asked.seconds, asked.half_range, asked.fast, asked.across_n].iter().all(|v| v.is_finite() && *v > 0.0);
        let block = world.blocks.first().filter(|_| sane).ok_or_else(|| unknown(asked))?;
        let at = block.start.center_m;
        // The arm deflects under the weight.
        let sag_m = 0.5 * block.mass_kg * world.gravity_m_s2 / HandImpedance::default().stiffness_n_m;
        let lifted = at + Vec2::new(0.0, 2.0 * asked.half_range + sag_m);
        let takes_s = (PEAK * (lifted - at).norm() / asked.fast).max(REST_S);
        let over_m = 0.5 * block.height_m + AWAY_M;
        self.take(asked.free_s, (at, over_m), block.width_m, asked.across_n);
        self.go(takes_s, HandGoal { center_m: lifted, ..self.at });
        self.wait(asked.seconds);
        self.say(motion, true);
        if asked.free_s > 0.0 {
            self.go(takes_s, HandGoal { center_m: at, ..self.at });
            self.say("Put it down.", true);
            self.let_go(asked.free_s, over_m, block.width_m);
        }
        Ok(())
    }
}

/// Friction of the crank at the maximum speed, N.
fn usual_drag_n(crank: &Crank, asked: &Experiment) -> f64 {
    let motion = Motion {
        velocity: crank.radius_m * asked.fast,
        direction: 1.0,
        normal_force_n: asked.across_n,
        ..Motion::default()
    };
    let resists = |e: &&Effect| !matches!(e.role(), Role::Inertia | Role::Gravity);
    crank.effects.iter().filter(resists).map(|e| e.force(&motion)).sum::<f64>().abs()
}

pub(super) fn unknown(asked: &Experiment) -> String {
    format!("Nobody here knows the motion `{}`; do it on the real object and load the recording.", asked.id)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use haptics::law::EccentricMass;
    use haptics::world::presets;

    pub fn asked(id: &str) -> Experiment {
        Experiment {
            id: id.to_owned(),
            seconds: 8.0,
            free_s: 1.2,
            middle: 12.0,
            half_range: 3.0,
            fast: 4.0,
            across_n: 0.4,
            added_weight_n: 0.0,
            added_lever_m: 0.0,
        }
    }

    #[test]
    fn a_crank_rests_where_its_laws_let_it() {
        let mut crank = presets::crank().crank.expect("a crank");
        assert!((rest_rad(&crank) + std::f64::consts::FRAC_PI_2).abs() < 0.01, "a handle hangs: {}", rest_rad(&crank));
        // W cos θ + a sin θ vanishes, and pulls back, where tan θ = −W / a, on the lower side.
        crank.effects.push(Effect::new(&EccentricMass, &[0.16, 0.0, crank.radius_m]));
        let rest = rest_rad(&crank);
        assert!((rest + 0.75 * std::f64::consts::PI + std::f64::consts::PI).rem_euclid(TAU) < 7.0);
        let pull = 0.16 * rest.cos() + 0.16 * rest.sin();
        let slope = -0.16 * rest.sin() + 0.16 * rest.cos();
        assert!(pull.abs() < 1e-3 && slope > 0.0, "rest {rest}: {pull} {slope}");
    }

    #[test]
    fn the_hand_comes_holds_and_goes_in_steps_that_follow_each_other() {
        let world = presets::crank();
        let table = Timetable::new(&world, &asked("sweep-let-go"), "turn to and fro").expect("it can be done");
        assert!(table.steps.windows(2).all(|w| w[0].until_s < w[1].until_s));
        let ends = table.steps.last().expect("steps").until_s;
        assert!((ends - table.duration_s()).abs() < 1e-9);
        let held: Vec<&Step> = table.steps.iter().filter(|s| s.holds).collect();
        assert!(held.iter().any(|s| s.words == "turn to and fro"));
        let crank = world.crank.as_ref().expect("a crank");
        let (mut least, mut most) = (f64::MAX, f64::MIN);
        let mut time_s = 0.0;
        while time_s < ends {
            let (goal, _) = table.route.at(time_s);
            if table.step_at(time_s).is_some_and(|(s, _)| s.words == "turn to and fro") {
                let arm = goal.center_m - crank.center_m;
                assert!((arm.norm() - crank.radius_m).abs() < 1e-3, "on the circle");
                assert!(goal.pinch_n > 1.0);
                least = least.min(arm.y);
                most = most.max(arm.y);
            }
            time_s += 0.01;
        }
        assert!(most - least > 1.9 * crank.radius_m, "all round: {least} {most}");
    }

    #[test]
    fn a_weight_is_hung_on_and_what_cannot_be_done_is_said() {
        let hung = Experiment { added_weight_n: 0.5, added_lever_m: 0.022, ..asked("hang-weight") };
        let table = Timetable::new(&presets::crank(), &hung, "slowly").expect("it can be done");
        let laws = &table.world.crank.as_ref().expect("a crank").effects;
        let value = |id: &str| laws.iter().find(|e| e.law().id() == id).map_or(0.0, |e| e.values[0]);
        assert!((value("weight") - 0.66).abs() < 1e-12 && (value("inertia") - 0.03 - 0.5 / 9.80665).abs() < 1e-3);
        for (world, id) in [(presets::crank(), "juggle"), (presets::table(), "sweep-across")] {
            let why = Timetable::new(&world, &asked(id), "so").expect_err("it cannot be done");
            assert!(why.ends_with('.') && why.contains("load the recording"), "{why}");
        }
    }
}
