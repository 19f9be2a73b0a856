//! The true contact state of a simulated world: a generator writes it into the `label` column. Never used to estimate.

use super::block::Shape;
use super::contact_point::Surface;
use super::model::World;
use super::state::State;
use crate::law::object::MembranePhase;

/// Speed above which a held block slides rather than rests, m/s.
const SLIDING_M_S: f64 = 0.01;

/// State name of `spec/command-line.md` from the contacts themselves.
pub fn true_label(world: &World, state: &State) -> &'static str {
    if world.crank.is_some() {
        let held = [0, 1].iter().all(|f| touches(state, Surface::Finger(*f), Surface::Handle));
        return if held { "turning" } else { "free-motion" };
    }
    let held = |index: usize| [0, 1].iter().all(|f| touches(state, Surface::Finger(*f), Surface::Block(index as u16)));
    let mut needles = world.blocks.iter().enumerate().filter(|(_, block)| block.shape == Shape::Needle);
    // A needle that stands on the sheet or in it by itself is no insertion: no hand moves it.
    if world.membrane.is_some() && needles.any(|(index, _)| held(index)) {
        return match state.membrane.phase {
            MembranePhase::Free => "free-motion",
            MembranePhase::Insertion => "insertion",
            MembranePhase::Penetration => "penetration",
            MembranePhase::Extraction => "extraction",
        };
    }
    if world.switch.is_some() {
        let pushed = [0, 1].iter().any(|f| touches(state, Surface::Finger(*f), Surface::Knob));
        return if pushed { "pushing" } else { "free-motion" };
    }
    for index in 0..world.blocks.len() {
        let block = Surface::Block(index as u16);
        if held(index) {
            let supported = state.contacts.iter().any(|c| {
                (c.on == block || c.by == block) && c.normal_force_n > 0.0 && !matches!(c.on, Surface::Finger(_))
            });
            let moving = state.bodies[index].velocity_m_s.x.abs() > SLIDING_M_S;
            return match (supported, moving) {
                (false, _) => "hold-above-ground",
                (true, false) => "hold-on-ground",
                (true, true) => "sliding-on-ground",
            };
        }
    }
    if state.contacts.iter().any(|c| matches!(c.on, Surface::Finger(_))) { "no-state" } else { "free-motion" }
}

fn touches(state: &State, on: Surface, by: Surface) -> bool {
    state.contacts.iter().any(|c| c.on == on && c.by == by && c.normal_force_n > 0.0)
}
