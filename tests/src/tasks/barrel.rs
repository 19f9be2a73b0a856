//! A barrel with something hidden: the stepped world and the scripted operator weigh, pull and squeeze it, instruments of our own look.

use super::sensor::{Instruments, look};
use super::{Case, Truth};
use crate::generate::{Errors, act};
use crate::handling::barrel_world;
use blind::Chance;
use estimator::diagnose::Options;
use estimator::pipeline;
use haptics::Vec2;
use haptics::device::Skill;
use haptics::recording::{Recording, Task};
use haptics::world::{Cable, Content, Wall, World};

/// What is hidden.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Nothing, beside a world that was calibrated on another recording.
    Nothing,
    /// A wall and pads that give, beside a rigid width.
    Wall,
    /// A leak.
    Leak,
    /// A drift of the vertical force.
    Drift,
    /// A resting force.
    Bias,
    /// A gain of the forces; the weight is known.
    Gain,
    /// A cable that the world does not have.
    Cable,
    /// Positions are too large or small; the width is known.
    Scale,
}

impl Kind {
    /// All of them.
    pub const ALL: [(&'static str, Self); 8] = [
        ("barrel: nothing", Self::Nothing),
        ("barrel: wall", Self::Wall),
        ("barrel: leak", Self::Leak),
        ("barrel: drift", Self::Drift),
        ("barrel: bias", Self::Bias),
        ("barrel: gain", Self::Gain),
        ("barrel: cable", Self::Cable),
        ("barrel: scale", Self::Scale),
    ];
}

/// A case of a kind.
pub fn make(kind: Kind, seed: u64) -> (Case, Truth) {
    let (case, truth, _) = made(kind, seed, false);
    (case, truth)
}

/// The same with another recording of the same barrel by the same instruments.
pub fn twice(kind: Kind, seed: u64) -> (Case, Truth, Recording) {
    let (case, truth, again) = made(kind, seed, true);
    (case, truth, again.expect("it was asked for"))
}

fn made(kind: Kind, seed: u64, twice: bool) -> (Case, Truth, Option<Recording>) {
    let mut chance = Chance::new(seed, 97);
    let mut world = barrel_world(seed ^ 0x0ba4_4e15);
    let free = |world: &mut World| {
        let barrel = &mut world.blocks[0];
        (barrel.content, barrel.cable, barrel.finger_friction) = (None, None, 1.1);
    };
    free(&mut world);
    let before = world.clone();
    let (mut instruments, mut truth) = (Instruments::default(), Truth::default());
    hide(kind, &mut world, &mut instruments, &mut truth, &mut chance);
    let mut recording = perform(&world, seed, &instruments, &mut chance);
    let (weight_n, width_m) = (world.blocks[0].mass_kg * world.gravity_m_s2, world.blocks[0].width_m);
    let mut again = twice.then(|| perform(&world, seed ^ 0xa6a1, &instruments, &mut chance));
    for one in std::iter::once(&mut recording).chain(&mut again) {
        match kind {
            Kind::Gain => one.meta.known.insert("weight_N".to_owned(), weight_n),
            Kind::Scale => one.meta.known.insert("width_m".to_owned(), width_m),
            _ => None,
        };
    }
    let known = (kind != Kind::Wall).then(|| {
        let captured = perform(&before, seed ^ 0xca11, &Instruments::default(), &mut chance);
        let mut known =
            pipeline::analyse(&[captured], &pipeline::Options::default()).expect("the barrel was lifted").world;
        free(&mut known);
        known
    });
    (Case { recordings: vec![recording], options: Options { world: known, ..Options::default() } }, truth, again)
}

fn perform(world: &World, seed: u64, instruments: &Instruments, chance: &mut Chance) -> Recording {
    let skill = Skill {
        pace: chance.between(0.9, 1.4),
        wander: chance.between(0.2, 0.6),
        tremor_m: chance.between(0.04e-3, 0.1e-3),
        ..Skill::default()
    };
    let done = act(world, seed, skill, &Errors { mistakes: &[], fumbles: Vec::new(), looks: false }, 5);
    look(world, &done.ticks, chance.pick(&[1, 2, 4]), instruments, Task::Barrel, chance)
}

fn hide(kind: Kind, world: &mut World, instruments: &mut Instruments, truth: &mut Truth, chance: &mut Chance) {
    let gravity = world.gravity_m_s2;
    let barrel = &mut world.blocks[0];
    match kind {
        Kind::Nothing => {}
        Kind::Wall => {
            barrel.wall = Some(Wall { stiffness_n_m: chance.between(1500.0, 5000.0), strength_n: None });
            truth.hidden = vec!["pad-compliance"];
        }
        Kind::Leak => {
            let leak_kg_s = chance.of_order(1.0e-3, 4e-3);
            barrel.content = Some(Content { mass_kg: 0.7 * barrel.mass_kg, leak_kg_s, leaks_from_s: Some(0.0) });
            truth.hidden = vec!["mass-change"];
            truth.value = Some(("rate", -leak_kg_s * gravity));
        }
        Kind::Drift => {
            let (rate, finger) = (chance.of_order(3e-3, 20e-3) * chance.sign(), usize::from(chance.happens(0.5)));
            instruments.drift_n_s[finger].y = rate;
            truth.hidden = vec!["force-drift"];
            truth.value = Some((["ry1", "ry2"][finger], rate));
        }
        Kind::Bias => {
            let mut of = || chance.of_order(0.01, 0.05) * chance.sign();
            instruments.bias_n = [(); 2].map(|()| Vec2::new(of(), of()));
            truth.hidden = vec!["force-bias"];
            truth.value = Some(("by1", instruments.bias_n[0].y));
        }
        Kind::Gain => {
            instruments.gain = 1.0 + chance.of_order(0.03, 0.15) * chance.sign();
            truth.hidden = vec!["force-gain"];
            truth.value = Some(("g - 1", instruments.gain - 1.0));
        }
        Kind::Cable => {
            let start = barrel.start.center_m;
            let anchor_m = start + Vec2::new(-chance.between(0.03, 0.04), chance.between(-0.012, -0.004));
            let length_m = (anchor_m - start).norm() + chance.between(0.002, 0.006);
            let stiffness_n_m = chance.of_order(150.0, 600.0);
            barrel.cable = Some(Cable { anchor_m, length_m, stiffness_n_m, damping_n_s_m: 1.0 });
            truth.hidden = vec!["added-constraint"];
        }
        Kind::Scale => {
            instruments.scale = 1.0 + chance.of_order(0.01, 0.05) * chance.sign();
            truth.hidden = vec!["length-scale"];
            truth.value = Some(("epsilon", instruments.scale - 1.0));
        }
    }
}
