//! Agreement of the replay with the recording, in numbers (thesis, figures 5.18 to 5.22). It compares the forces, and
//! the position of the virtual object while the measured fingers held it.

use crate::ui::calibrate::replayed::Replayed;
use crate::ui::document::prepared::Prepared;
use haptics::Vec2;
use haptics::world::World;

/// RMS differences between one replay and its recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Likeness {
    /// Difference between predicted and measured force over both fingers, N; absent without forces.
    pub force_n: Option<f64>,
    /// RMS of the measured force itself, N.
    pub of_force_n: f64,
    /// Difference between the grasp and the held virtual object, minus its mean (the grasp is rarely at the object's
    /// centre), m.
    pub place_m: Option<f64>,
    /// RMS deviation of the grasp from its mean position meanwhile, m.
    pub of_way_m: f64,
}

impl Likeness {
    /// Compares a replay with its recording.
    pub fn of(replay: &Replayed, world: &World, prepared: &Prepared) -> Self {
        let (force_n, of_force_n) = force(replay, prepared);
        let (place_m, of_way_m) = place(replay, world, prepared);
        Self { force_n, of_force_n, place_m, of_way_m }
    }
}

fn force(replay: &Replayed, prepared: &Prepared) -> (Option<f64>, f64) {
    let Some(simulation) = &replay.simulation else { return (None, 0.0) };
    let rms = &simulation.residual_rms;
    let all: f64 = rms.iter().map(|(_, r)| r * r).sum();
    let square = |name: &str| {
        let values = prepared.recording.channel(name).unwrap_or_default();
        values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64
    };
    let of: f64 = rms.iter().map(|(name, _)| square(name)).sum();
    // Torques have another unit and their own picture.
    let forces = !rms.is_empty() && rms.iter().all(|(name, _)| name.ends_with("_N"));
    (forces.then(|| all.sqrt()), of.sqrt())
}

fn place(replay: &Replayed, world: &World, prepared: &Prepared) -> (Option<f64>, f64) {
    let Some(film) = &replay.film else { return (None, 0.0) };
    let held: Vec<(Vec2, Vec2, usize)> = film
        .held(world)
        .filter_map(|(time_s, object, at)| Some((prepared.point_at(prepared.sample_at(time_s))?, at, object)))
        .collect();
    let mut square = 0.0;
    let mut way = 0.0_f64;
    let objects: std::collections::BTreeSet<usize> = held.iter().map(|(_, _, object)| *object).collect();
    for object in objects {
        let of_it: Vec<(Vec2, Vec2)> = held.iter().filter(|h| h.2 == object).map(|h| (h.0, h.1)).collect();
        let mean = |pick: &dyn Fn(&(Vec2, Vec2)) -> Vec2| of_it.iter().map(pick).sum::<Vec2>() / of_it.len() as f64;
        let (apart, middle) = (mean(&|(grasp, at)| at - grasp), mean(&|(grasp, _)| *grasp));
        square += of_it.iter().map(|(grasp, at)| (at - grasp - apart).norm_squared()).sum::<f64>();
        way += of_it.iter().map(|(grasp, _)| (grasp - middle).norm_squared()).sum::<f64>();
    }
    let n = held.len() as f64;
    (!held.is_empty()).then(|| ((square / n).sqrt(), (way / n).sqrt())).map_or((None, 0.0), |(p, w)| (Some(p), w))
}
