//! The course of the world while the recorded fingers move through it: what the 3-D view plays back.

use super::prepare::Prepared;
use haptics::Vec2;
use haptics::world::{BodyState, Contact, CrankState, Input, MembraneState, State, Surface, SwitchState, World, step};

/// Pictures a second.
const RATE_HZ: f64 = 60.0;
/// Longest step of the simulation, s.
const STEP_S: f64 = 1e-3;
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
        let [left, right] = prepared.tips.as_ref()?;
        let time = prepared.recording.time_s.as_ref()?;
        let (first, last) = prepared.span();
        if time.len() < 2 || last - first > LONGEST_S || world.mechanism.is_some() {
            return None;
        }
        let tips = |i: usize| [left.position[i], right.position[i]];
        let mut state = State::new(world, tips(0));
        let mut stills = vec![still(&state, first)];
        for i in 1..time.len() {
            let (from, to, span_s) = (tips(i - 1), tips(i), time[i] - time[i - 1]);
            let parts = (span_s / STEP_S).ceil().max(1.0);
            let measured = |series: &estimator::signal::task::TipSeries| series.velocity.as_ref().map(|v| v[i]);
            let velocity = [measured(left), measured(right)].map(Option::unwrap_or_default);
            for part in 1..=parts as usize {
                let share = part as f64 / parts;
                let tip_in_world = [0, 1].map(|f| from[f] + (to[f] - from[f]) * share);
                step(world, &mut state, &Input { tip_in_world, tip_velocity: velocity }, span_s / parts);
            }
            if time[i] - stills[stills.len() - 1].time_s >= 1.0 / RATE_HZ {
                stills.push(still(&state, time[i]));
            }
        }
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

/// What both fingers touch.
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
