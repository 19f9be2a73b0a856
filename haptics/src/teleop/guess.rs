//! A first model of an unmeasured world: things are seen, so that their shapes and places are right; their weights and
//! resistances are guessed.

use crate::law::Enters;
use crate::world::World;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// Largest relative error of a guess: people's estimates from the look of a thing are of this order.
pub const GUESS_OFF: f64 = 0.4;

/// Salt of the guesses of walls: earlier guesses stay as they were before walls were guessed.
const WALLS: u64 = 0x3c6e_f372_fe94_f82b;

/// Guess of a world: masses, friction under the fingers, stiffness of walls and laws of the crank. Each gets a factor
/// of its own between 1 − [`GUESS_OFF`] and 1 + [`GUESS_OFF`], drawn by the seed. A guess that cannot be run is
/// replaced by the truth.
pub fn guess(world: &World, seed: u64) -> World {
    let mut rng = StdRng::seed_from_u64(seed);
    let mut off = || rng.random_range(1.0 - GUESS_OFF..1.0 + GUESS_OFF);
    let mut guessed = world.clone();
    for block in &mut guessed.blocks {
        let factor = off();
        block.mass_kg *= factor;
        if let Some(content) = &mut block.content {
            content.mass_kg *= factor;
        }
        block.finger_friction *= off();
    }
    for effect in guessed.crank.iter_mut().flat_map(|crank| &mut crank.effects) {
        let parameters = effect.law().parameters();
        for (value, spec) in effect.values.iter_mut().zip(parameters) {
            if spec.enters == Enters::Linear {
                *value *= off();
            }
        }
    }
    let mut rng = StdRng::seed_from_u64(seed ^ WALLS);
    for wall in guessed.blocks.iter_mut().filter_map(|block| block.wall.as_mut()) {
        wall.stiffness_n_m *= rng.random_range(1.0 - GUESS_OFF..1.0 + GUESS_OFF);
    }
    if guessed.check().is_ok() { guessed } else { world.clone() }
}
