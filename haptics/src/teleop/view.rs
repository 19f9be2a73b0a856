//! View of the operator: here at once, there late. By triple buffer from the servo's thread to the window.

use super::model::Weighed;
use crate::Vec2;
use crate::world::State;
use triple_buffer::{Output, triple_buffer};

/// Both ends as the operator can know them now.
#[derive(Clone, Debug)]
pub struct View {
    /// World under the hand: the model; without one the late picture of the far world.
    pub here: State,
    /// The newest picture of the far world.
    pub there: State,
    /// Age of that picture, s.
    pub age_s: f64,
    /// True if a model answers.
    pub predicted: bool,
    /// The newest impact as the operator knows it: the model's at once, those of the far world late.
    pub knock: Knock,
    /// Estimated mass of the body that was carried last, as far as the model has learnt it.
    pub weighed: Option<Weighed>,
}

/// Slower impacts this soon after one belong to it, s: longer than a picture takes.
const RATTLE_S: f64 = 0.04;

/// Something struck something.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Knock {
    /// Counts them: another number is another impact.
    pub number: u64,
    /// Time of the impact, s on the clock of the end that it happened at.
    pub time_s: f64,
    /// Speed of the impact, m/s.
    pub speed_m_s: f64,
    /// Position of the impact, m in the world.
    pub at_in_world: Vec2,
}

impl Knock {
    /// The next impact; a slower one that follows at once, as when things rattle, is left out.
    pub(super) fn next(self, time_s: f64, speed_m_s: f64, at_in_world: Vec2) -> Self {
        if speed_m_s < self.speed_m_s && time_s < self.time_s + RATTLE_S {
            return self;
        }
        Self { number: self.number + 1, time_s, speed_m_s, at_in_world }
    }
}

/// The servo's end.
pub(super) type ViewInput = triple_buffer::Input<View>;

/// The window's end.
pub struct ViewSource(Output<View>);

impl ViewSource {
    /// The newest view.
    pub fn newest(&mut self) -> &View {
        self.0.read()
    }

    /// The view that was fetched last.
    pub fn last(&self) -> &View {
        self.0.output_buffer()
    }
}

/// Both ends; everything is where `state` has it.
pub(super) fn view(state: &State, predicted: bool) -> (ViewInput, ViewSource) {
    let first = View {
        here: state.clone(),
        there: state.clone(),
        age_s: 0.0,
        predicted,
        knock: Knock::default(),
        weighed: None,
    };
    let (input, output) = triple_buffer(&first);
    (input, ViewSource(output))
}
