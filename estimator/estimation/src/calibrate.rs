//! From a fit to a world: measured numbers go in with their errors, all others are stated assumptions.

mod barrel;
mod switch;

use crate::constraint;
use crate::identify::block::width::{Hold, holds, width_under};
use crate::identify::mechanism;
use crate::identify::needle::sheet::HELD;
use crate::segment::Segmentation;
use foundation::estimate::{Fit, Parameter};
use foundation::signal::task::{Tip, is_two_fingered, task_signals};
use haptics::Vec2;
use haptics::law::object::MembraneLaw;
use haptics::law::{CoulombFriction, Effect, Inertia, LoadFriction, ViscousFriction, Weight};
use haptics::recording::{Recording, Task};
use haptics::world::{Block, Crank, Floor, Provenance, Source, World, presets};

/// Most blocks in one fit.
const MOST_BLOCKS: usize = 64;
/// Width of a block whose hold no recording shows, m.
const ASSUMED_WIDTH_M: f64 = 0.02;
/// Height of a block that no carry spanned, m.
const ASSUMED_HEIGHT_M: f64 = 0.015;
/// Friction where not even a lower bound was seen.
const ASSUMED_FRICTION: f64 = 0.8;
/// Spare above a lower bound of friction: the operator kept a margin (Johansson & Westling 1984 find 10 to 40 %).
const FRICTION_MARGIN: f64 = 1.3;
/// Height of the grip on a needle above its point, m: two thirds of the built-in one.
const NEEDLE_GRIP_M: f64 = 0.023;
/// Height of the cup that carries the sheet, m.
const CUP_HEIGHT_M: f64 = 0.022;
/// Handle mass where the turning was too even to show it, kg.
const ASSUMED_HANDLE_KG: f64 = 0.03;

/// The calibrated world of a fit.
pub fn world(task: Task, recordings: &[Recording], fit: &Fit, segmentations: &[Option<Segmentation>]) -> World {
    let Some(recording) = recordings.first() else { return World::empty("nothing") };
    let mut world = World::empty(&format!("calibrated from {}", recording.name));
    world.hand = recording.meta.hand();
    world.gravity_m_s2 = recording.meta.gravity();
    let mut builder = Builder { world, fit, from: recording.name.clone() };
    builder.pads();
    let segmentation = segmentations.first().and_then(Option::as_ref);
    match task {
        Task::BlockStack => builder.blocks(recordings, segmentations),
        Task::Barrel => builder.barrel(recording, segmentation),
        Task::Crank => builder.crank(recording, segmentation),
        Task::Needle => builder.needle(recording),
        Task::Switch => builder.switch(recording),
        Task::Payload => {
            builder.note_all("payload");
            builder.note_all("sensor");
        }
        Task::Mechanism => {
            builder.world.floor = None;
            builder.world.mechanism = Some(mechanism::world(fit, recording));
            builder.note_all("mechanism");
            builder.slider();
            builder.surface(recording);
        }
    }
    builder.world
}

/// Friction of a slider where the recording does not show it, N.
const ASSUMED_SLIDER_N: f64 = 0.1;

struct Builder<'a> {
    world: World,
    fit: &'a Fit,
    from: String,
}

impl Builder<'_> {
    /// A parameter's value with its origin noted, or an assumption with its reason.
    fn take(&mut self, object: &str, name: &str, assumed: f64) -> f64 {
        match self.fit.parameter(object, name) {
            Some(Parameter { value: Some(value), std_error, .. }) => {
                self.note(object, name, *value, *std_error, Source::Measured, &self.from.clone());
                *value
            }
            other => {
                let why = other.map_or("the recording does not show it", |p| p.how.as_str()).to_owned();
                self.note(object, name, assumed, None, Source::Assumed, &why);
                assumed
            }
        }
    }

    fn note(&mut self, object: &str, name: &str, value: f64, std_error: Option<f64>, source: Source, from: &str) {
        self.world.provenance.push(Provenance {
            object: object.to_owned(),
            name: name.to_owned(),
            value,
            std_error,
            source,
            from: from.to_owned(),
        });
    }

    fn note_all(&mut self, object: &str) {
        let measured: Vec<Parameter> = self.fit.parameters.iter().filter(|p| p.object == object).cloned().collect();
        for parameter in measured {
            if let Some(value) = parameter.value {
                let from = self.from.clone();
                self.note(object, &parameter.name, value, parameter.std_error, Source::Measured, &from);
            }
        }
    }

    /// A slider on the path of the first constraint that has one, so that it can be felt.
    fn slider(&mut self) {
        let friction_n = self.fit.value("mechanism", "coulomb_N").unwrap_or(ASSUMED_SLIDER_N);
        let felt = self.fit.constraints.iter().find_map(|c| constraint::felt::add(&mut self.world, c, friction_n));
        if let Some(scale) = felt {
            let why = "size of the path in the hand's workspace beside the recorded one";
            self.note("slider", "scale", scale, None, Source::Assumed, why);
        }
    }

    /// The first surface that was found, so that it can be felt.
    fn surface(&mut self, recording: &Recording) {
        let up = mechanism::path::up(recording).unwrap_or_else(nalgebra::Vector3::zeros);
        let felt = self.fit.constraints.iter().any(|c| constraint::felt::add_surface(&mut self.world, c, up));
        if felt {
            self.note_all("surface");
        }
    }

    fn pads(&mut self) {
        let default = self.world.pad;
        if self.fit.parameter("pad", "stiffness_N_m").is_some() {
            self.world.pad.stiffness_n_m = self.take("pad", "stiffness_N_m", default.stiffness_n_m);
            self.world.pad.shear_stiffness_n_m = self.take("pad", "shear_stiffness_N_m", default.shear_stiffness_n_m);
        } else if let Some((stiffness, std_error)) =
            self.fit.parameter("crank", "constraint_stiffness_N_m").and_then(|p| Some((p.value?, p.std_error)))
        {
            // Two pads side by side carry the handle: each has half of the observed stiffness.
            let from = format!("half of the crank's radial stiffness, {}", self.from);
            self.world.pad.stiffness_n_m = 0.5 * stiffness;
            self.world.pad.shear_stiffness_n_m = 0.5 * stiffness;
            self.note("pad", "stiffness_N_m", 0.5 * stiffness, std_error.map(|e| 0.5 * e), Source::Measured, &from);
        }
    }

    fn blocks(&mut self, recordings: &[Recording], segmentations: &[Option<Segmentation>]) {
        let count =
            (1..=MOST_BLOCKS).take_while(|n| self.fit.parameter(&format!("block-{n}"), "weight_N").is_some()).count();
        let first = recordings.first().zip(segmentations.first().and_then(Option::as_ref));
        let spots = first.and_then(|(recording, segmentation)| picked_and_placed(recording, segmentation, count));
        let seen = recordings.iter().zip(segmentations);
        let holds: Vec<Vec<Hold>> = seen.filter_map(|(r, s)| holds(r, s.as_ref()?, count)).collect();
        for number in 1..=count {
            let name = format!("block-{number}");
            let mass = self.take(&name, "mass_kg", 0.03).max(1e-4);
            let hold: Hold = holds.iter().filter_map(|h| h.get(number - 1)).flatten().copied().collect();
            let width = self.width(&name, &hold).max(1e-3);
            let height = self.take(&name, "height_m", ASSUMED_HEIGHT_M).max(1e-3);
            let mut block = Block::upright(&name, mass, width, height, 0.0, 0.0);
            block.finger_friction = self.friction(&name);
            self.world.blocks.push(block);
        }
        self.place(spots.as_deref().unwrap_or(&[]));
    }

    /// Width of a block between this world's pads, m: that at which they press on average as hard as the fingers did. Pads give by F/k, so that a
    /// width which goes with other pads, or with no give at all, would leave nothing to press on. A width that is stated stands as it is.
    fn width(&mut self, name: &str, hold: &[(f64, f64)]) -> f64 {
        let found = self.fit.parameter(name, "width_m").cloned();
        let is_stated = found.as_ref().is_some_and(|p| p.value.is_some() && p.std_error.unwrap_or(0.0) <= 0.0);
        let pressed = width_under(&self.world.pad.elastic(), hold).filter(|_| !is_stated);
        let Some(width) = pressed else { return self.take(name, "width_m", ASSUMED_WIDTH_M) };
        let from = format!("{}: distance of the tips while held, and what these pads give under that grip", self.from);
        // It differs from the fit's where the fit knew the pads worse, or otherwise.
        let error = found.and_then(|p| Some(p.std_error?.max((p.value? - width).abs())));
        self.note(name, "width_m", width, error, Source::Measured, &from);
        width
    }

    fn friction(&mut self, name: &str) -> f64 {
        if let Some(friction) = self.fit.value(name, "friction") {
            return self.take(name, "friction", friction);
        }
        let Some(bound) = self.fit.value(name, "friction_lower_bound") else {
            return self.take(name, "friction", ASSUMED_FRICTION);
        };
        let friction = (FRICTION_MARGIN * bound).max(0.3);
        let why = format!("no slip was seen: the lower bound {bound:.2} with a margin of 30 %");
        self.note(name, "friction", friction, None, Source::Assumed, &why);
        friction
    }

    /// Puts the blocks where they were picked up and the floor under them, taking them as gripped at mid-height.
    fn place(&mut self, spots: &[Spot]) {
        // The block put down last in the thesis's task: block 1. It shows the floor best.
        let floor =
            spots.first().zip(self.world.blocks.first()).map(|(spot, block)| spot.placed.y - 0.5 * block.height_m);
        let height = floor.unwrap_or(Floor::default().height_m);
        self.world.floor = Some(Floor { height_m: height, ..Floor::default() });
        let why = "where block 1 was put down, gripped at mid-height";
        self.note("floor", "height_m", height, None, Source::Assumed, why);
        let mut base = height;
        for index in (0..self.world.blocks.len()).rev() {
            let block = &mut self.world.blocks[index];
            let x = spots.get(index).map_or(-0.014, |spot| spot.picked.x);
            block.start.center_m = Vec2::new(x, base + 0.5 * block.height_m);
            base += block.height_m;
        }
    }

    fn crank(&mut self, recording: &Recording, segmentation: Option<&Segmentation>) {
        self.world.floor = None;
        let center_m = Vec2::new(self.take("crank", "center_x_m", 0.0), self.take("crank", "center_y_m", -0.1));
        let radius_m = self.take("crank", "radius_m", 0.02).max(1e-3);
        let inertia = self.take("crank", "inertia_kg_m2", ASSUMED_HANDLE_KG * radius_m.powi(2));
        let (width, start) = handle(recording, segmentation, center_m, self.world.pad.stiffness_n_m);
        let width = self.take("crank", "handle_width_m", width).max(1e-3);
        let friction = self.take("crank", "finger_friction", 1.0);
        let mut effect = |law, name: &str| Effect::new(law, &[self.take("crank", name, 0.0).max(0.0)]);
        let effects = vec![
            effect(&Weight, "weight_N"),
            effect(&LoadFriction, "friction_mu"),
            effect(&ViscousFriction, "viscous_N_s_m"),
            effect(&CoulombFriction, "coulomb_N"),
            Effect::new(&Inertia, &[(inertia / radius_m.powi(2)).max(1e-3)]),
        ];
        self.world.crank = Some(Crank {
            center_m,
            radius_m,
            handle_width_m: width,
            finger_friction: friction,
            constraint_stiffness_n_m: None,
            effects,
            start_rad: start,
        });
    }

    /// The sheet as measured, under a needle like the built-in one: how long it is and where it was gripped, no log says.
    fn needle(&mut self, recording: &Recording) {
        let usual = presets::needle();
        let (Some(mut membrane), Some(mut needle)) = (usual.membrane, usual.blocks.into_iter().next()) else { return };
        let stiffness_n_m = self.take("needle", "stiffness_N_m", membrane.law.stiffness_n_m).max(1.0);
        let puncture_n = self.take("needle", "puncture_force_N", membrane.law.puncture_n).max(0.05);
        let friction_n = self.take("needle", "shaft_friction_N", membrane.law.friction_n);
        membrane.law = MembraneLaw {
            stiffness_n_m,
            cubic_n_m3: self.take("needle", "hardening_N_m3", 0.0).max(0.0),
            puncture_n,
            friction_n: friction_n.clamp(0.0, 0.9 * puncture_n),
            ..membrane.law
        };
        // A bias that pulls up is no weight.
        let usual_n = needle.mass_kg * self.world.gravity_m_s2;
        let held_n = self.fit.value("needle", HELD).map(|_| self.take("needle", HELD, usual_n));
        let weight_n = self.take("needle", "weight_N", held_n.filter(|held| *held > 0.0).unwrap_or(usual_n));
        if self.world.gravity_m_s2 > 0.0 {
            needle.mass_kg = (weight_n / self.world.gravity_m_s2).max(1e-3);
        }
        // The log knows where the fingers were when the point met the sheet, or where the tool was.
        let above_m = if is_two_fingered(recording) { NEEDLE_GRIP_M } else { 0.0 };
        let met_m = self.take("needle", "surface_position_m", membrane.center_m.y + above_m);
        let along = self.fit.constraints.iter().find_map(|c| c.direction.clone()).unwrap_or_default();
        if along.get(1).is_some_and(|y| y.abs() > 0.9) {
            membrane.center_m.y = met_m - above_m;
        }
        let why = format!("gripped {:.0} mm above its point", 1e3 * above_m);
        self.note("needle", "sheet_y_m", membrane.center_m.y, None, Source::Assumed, &why);
        needle.start.center_m = membrane.center_m + Vec2::new(0.0, 0.5 * needle.height_m);
        self.world.blocks = vec![needle];
        self.world.floor = Some(Floor { height_m: membrane.center_m.y - CUP_HEIGHT_M, ..Floor::default() });
        self.world.membrane = Some(membrane);
    }
}

/// Places where a block was picked up and put down, by the middle of the grip, m.
struct Spot {
    picked: Vec2,
    placed: Vec2,
}

fn picked_and_placed(recording: &Recording, segmentation: &Segmentation, count: usize) -> Option<Vec<Spot>> {
    let signals = task_signals(recording).ok()?;
    let mean = |subtasks: &[String]| {
        let samples: Vec<usize> = subtasks.iter().flat_map(|name| segmentation.samples_of(name)).collect();
        (!samples.is_empty()).then(|| samples.iter().map(|i| signals.position[*i]).sum::<Vec2>() / samples.len() as f64)
    };
    let task = segmentation.definition.as_ref()?;
    (1..=count)
        .map(|n| {
            let [before, after] = task.showing_around("height_m", "weight_N", n);
            let picked = mean(&before)?;
            let placed = mean(&after).unwrap_or(picked);
            Some(Spot { picked, placed })
        })
        .collect()
}

/// Width of the handle between the pads, m, and the angle at which it was grasped, rad.
fn handle(recording: &Recording, segmentation: Option<&Segmentation>, center_m: Vec2, pad_n_m: f64) -> (f64, f64) {
    let fallback = (0.010, -std::f64::consts::FRAC_PI_2);
    if !is_two_fingered(recording) {
        return fallback;
    }
    let fingers = || Some([Tip::of(recording, "1").ok()?, Tip::of(recording, "2").ok()?]);
    let normal = || Some([recording.channel("fx1_N")?, recording.channel("fx2_N")?]);
    let (Some([left, right]), Some([fx1, fx2]), Some(segmentation)) = (fingers(), normal(), segmentation) else {
        return fallback;
    };
    let held: Vec<usize> = segmentation
        .states
        .iter()
        .filter(|i| i.state != foundation::tasks::SystemState::FreeMotion)
        .flat_map(|i| i.first..i.end)
        .collect();
    let Some(first) = held.first() else { return fallback };
    let n = held.len() as f64;
    let width = held.iter().map(|i| right.position(*i).x - left.position(*i).x).sum::<f64>() / n;
    let grip = held.iter().map(|i| fx1[*i].min(-fx2[*i])).sum::<f64>() / n;
    let outward = 0.5 * (left.position(*first) + right.position(*first)) - center_m;
    ((width + 2.0 * grip / pad_n_m).max(1e-3), outward.y.atan2(outward.x))
}
