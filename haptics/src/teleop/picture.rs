//! Picture of a world at one instant by cameras and sensors: everything that moves, sized once.

use crate::Vec2;
use crate::world::{BodyState, CrankState, Input, MembraneState, State, Surface, SwitchState};

/// One instant of a world.
#[derive(Clone, Debug)]
pub(super) struct Picture {
    /// Time of the picture, s on the clock of that world.
    pub time_s: f64,
    /// The fingers.
    pub input: Input,
    /// Forces that the fingers exert, N.
    pub tip_force_n: [Vec2; 2],
    /// The bodies.
    pub bodies: Vec<BodyState>,
    /// The crank.
    pub crank: CrankState,
    /// The membrane.
    pub membrane: MembraneState,
    /// The switch.
    pub switch: SwitchState,
    /// Objects that the fingers hold.
    pub grasp: Grasp,
}

/// Objects that both fingers hold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Grasp {
    /// The body between them.
    pub body: Option<usize>,
    /// Nothing else touches or holds that body.
    pub aloft: bool,
    /// They hold the crank's handle.
    pub handle: bool,
    /// A finger touches the knob.
    pub knob: bool,
}

impl Grasp {
    /// Objects held in a state.
    pub fn of(state: &State) -> Self {
        let by = |finger: u8| {
            state
                .contacts
                .iter()
                .filter(move |c| c.on == Surface::Finger(finger) && c.normal_force_n > 0.0)
                .map(|c| c.by)
        };
        let both = |what: Surface| by(0).any(|s| s == what) && by(1).any(|s| s == what);
        let body = by(0).find_map(|s| match s {
            Surface::Block(index) if both(s) => Some(usize::from(index)),
            _ => None,
        });
        let aloft = body.is_some_and(|index| is_aloft(state, index));
        Self { body, aloft, handle: both(Surface::Handle), knob: by(0).chain(by(1)).any(|s| s == Surface::Knob) }
    }
}

/// True when only fingers bear a body.
fn is_aloft(state: &State, index: usize) -> bool {
    let this = Surface::Block(index as u16);
    let borne = state
        .contacts
        .iter()
        .any(|c| c.normal_force_n > 0.0 && ((c.by == this && !matches!(c.on, Surface::Finger(_))) || c.on == this));
    let held = state.bodies.get(index).is_some_and(|body| body.cable_n > 0.0 || body.guided.force_n != Vec2::zeros());
    !borne && !held && state.membrane.force_n == 0.0
}

impl Picture {
    /// A picture with room for the bodies of a state.
    pub fn of(state: &State) -> Self {
        Self {
            time_s: state.time_s,
            input: state.input,
            tip_force_n: state.tip_force_n,
            bodies: state.bodies.clone(),
            crank: state.crank,
            membrane: state.membrane,
            switch: state.switch,
            grasp: Grasp::of(state),
        }
    }

    /// Takes another picture of the same world. Bodies that there is no room for are left out: nothing allocates.
    pub fn take(&mut self, state: &State) {
        self.time_s = state.time_s;
        self.input = state.input;
        self.tip_force_n = state.tip_force_n;
        for (kept, body) in self.bodies.iter_mut().zip(&state.bodies) {
            *kept = *body;
        }
        self.crank = state.crank;
        self.membrane = state.membrane;
        self.switch = state.switch;
        self.grasp = Grasp::of(state);
    }

    /// Puts everything where the picture has it; contacts are not in the picture.
    pub fn show_in(&self, state: &mut State) {
        state.time_s = self.time_s;
        state.input = self.input;
        state.tip_force_n = self.tip_force_n;
        for (body, kept) in state.bodies.iter_mut().zip(&self.bodies) {
            *body = *kept;
        }
        state.crank = self.crank;
        state.membrane = self.membrane;
        state.switch = self.switch;
        state.contacts.clear();
    }
}
