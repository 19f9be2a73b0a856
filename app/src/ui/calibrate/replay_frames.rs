//! The course of the world while the recorded fingers move through it: what the 3-D view plays back.

use crate::ui::document::prepared::Prepared;
use estimator::simulate::walk_tips;
use haptics::Vec2;
use haptics::world::{BodyState, Contact, CrankState, MembraneState, State, Surface, SwitchState, World};

/// Pictures a second.
const RATE_HZ: f64 = 60.0;
/// Longest recording that is played through a world, s: an hour of simulation is minutes of computing.
const LONGEST_S: f64 = 900.0;

/// One picture's worth of state, without the spare room of a running [`State`].
#[derive(Clone, Debug)]
struct Still {
    time_s: f64,
    bodies: Vec<BodyState>,
    crank: CrankState,
    membrane: MembraneState,
    switch: SwitchState,
    contacts: Vec<Contact>,
}

/// Sixty stills a second.
#[derive(Clone, Debug)]
pub struct Film {
    stills: Vec<Still>,
}

impl Film {
    /// Moves the recorded fingers through `world`. `None` without two fingers and a clock.
    pub fn shoot(world: &World, prepared: &Prepared) -> Option<Self> {
        let (tips, time_s) = prepared.tips.as_ref().zip(prepared.recording.time_s.as_ref())?;
        let (first, last) = prepared.span();
        if time_s.len() < 2 || last - first > LONGEST_S || world.mechanism.is_some() {
            return None;
        }
        let mut stills: Vec<Still> = Vec::new();
        walk_tips(world, time_s, tips, |now_s, state| {
            if stills.last().is_none_or(|before| now_s - before.time_s >= 1.0 / RATE_HZ) {
                stills.push(still(state, now_s));
            }
        });
        Some(Self { stills })
    }

    /// Puts bodies, crank, membrane, switch and contacts at a time into `state`, which must be of the film's world.
    pub fn pose(&self, time_s: f64, state: &mut State) {
        let index = self.stills.partition_point(|s| s.time_s <= time_s).saturating_sub(1);
        let Some(still) = self.stills.get(index) else { return };
        state.bodies.clone_from(&still.bodies);
        state.crank = still.crank;
        state.membrane = still.membrane;
        state.switch = still.switch;
        state.contacts.clone_from(&still.contacts);
    }

    /// Times at which both fingers hold something, with its number (a body's, or one past them for the crank's handle) and where the
    /// virtual one is, m.
    pub fn held(&self, world: &World) -> impl Iterator<Item = (f64, usize, Vec2)> {
        let handle = self.stills.first().map(|first| first.bodies.len());
        self.stills.iter().filter_map(move |still| match held_by_both(&still.contacts)? {
            Surface::Block(index) => {
                let index = usize::from(index);
                Some((still.time_s, index, still.bodies.get(index)?.center_m))
            }
            Surface::Handle => {
                let crank = world.crank.as_ref()?;
                let (sin, cos) = still.crank.angle_rad.sin_cos();
                Some((
                    still.time_s,
                    handle?,
                    crank.center_m + (crank.radius_m + still.crank.radial_m) * Vec2::new(cos, sin),
                ))
            }
            _ => None,
        })
    }

    /// Position of a body at a time, m: for tests.
    pub fn body_at(&self, index: usize, time_s: f64) -> Option<Vec2> {
        let still = self.stills.partition_point(|s| s.time_s <= time_s).saturating_sub(1);
        Some(self.stills.get(still)?.bodies.get(index)?.center_m)
    }
}

/// Surface that both fingers touch.
fn held_by_both(contacts: &[Contact]) -> Option<Surface> {
    let touched = |finger: u8| {
        contacts.iter().filter_map(move |c| match (c.on, c.by) {
            (other, Surface::Finger(f)) | (Surface::Finger(f), other) if f == finger => Some(other),
            _ => None,
        })
    };
    touched(0).find(|thing| touched(1).any(|other| other == *thing))
}

fn still(state: &State, time_s: f64) -> Still {
    Still {
        time_s,
        bodies: state.bodies.clone(),
        crank: state.crank,
        membrane: state.membrane,
        switch: state.switch,
        contacts: state.contacts.clone(),
    }
}
