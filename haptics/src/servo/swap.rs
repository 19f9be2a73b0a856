//! A world and its state, ready to be put into the running servo.

use crate::law::{MAX_EFFECTS, Memory};
use crate::world::{State, World};

/// A world and its state, built elsewhere, ready to be swapped in.
#[derive(Debug)]
pub struct Swap {
    /// The new world.
    pub world: World,
    /// Its state; the fingers are taken over from the running one.
    pub state: State,
    /// True if the running state continues in the new world: see [`Swap::going_on`].
    goes_on: bool,
}

impl Swap {
    /// A world in its starting state.
    pub fn new(world: World) -> Box<Self> {
        let state = State::resting(&world);
        Self::at(world, state)
    }

    /// A world in a state of its own.
    pub fn at(world: World, state: State) -> Box<Self> {
        Box::new(Self { world, state, goes_on: false })
    }

    /// A world with the same things in it and other laws. Everything stays in place and keeps its motion, so that
    /// fingers that touch something feel the laws change and nothing else. A world with other things in it starts as
    /// with [`Swap::new`].
    pub fn going_on(world: World) -> Box<Self> {
        let mut swap = Self::new(world);
        swap.goes_on = true;
        swap
    }

    /// Takes the fingers over from the running world, and its whole state if that continues here. Allocates nothing.
    pub(super) fn follow(&mut self, running: &Self) {
        if !self.goes_on || !same_things(&self.world, &running.world) {
            self.state.input = running.state.input;
            return;
        }
        self.state.copy_from(&running.state);
        let law = |swap: &Self, k: usize| swap.world.crank.as_ref()?.effects.get(k).map(|effect| effect.law().id());
        for k in 0..MAX_EFFECTS {
            // Another law cannot use the memory of the one in its place.
            if law(self, k) != law(running, k)
                && let Some(memory) = self.state.crank.memories.get_mut(k)
            {
                *memory = Memory::default();
            }
        }
    }
}

/// True when a state of one world makes sense in the other.
fn same_things(a: &World, b: &World) -> bool {
    let blocks = a.blocks.len() == b.blocks.len()
        && a.blocks
            .iter()
            .zip(&b.blocks)
            .all(|(a, b)| (a.width_m, a.height_m) == (b.width_m, b.height_m) && a.guide.is_some() == b.guide.is_some());
    let crank = match (&a.crank, &b.crank) {
        (Some(a), Some(b)) => (a.center_m, a.radius_m, a.handle_width_m) == (b.center_m, b.radius_m, b.handle_width_m),
        (None, None) => true,
        _ => false,
    };
    blocks && crank && a.switch.is_some() == b.switch.is_some() && a.membrane.is_some() == b.membrane.is_some()
}
