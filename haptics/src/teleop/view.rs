//! What the operator is shown: here at once, there late. By triple buffer from the servo's thread to the window.

use super::model::Weighed;
use crate::world::State;
use triple_buffer::{Output, triple_buffer};

/// Both ends as the operator can know them now.
#[derive(Clone, Debug)]
pub struct View {
    /// What is under the hand: the model; without one the late picture of the far world.
    pub here: State,
    /// The newest picture of the far world.
    pub there: State,
    /// Age of that picture, s.
    pub age_s: f64,
    /// Whether a model answers.
    pub predicted: bool,
    /// What the body that was carried last weighs, as far as the model has learnt it.
    pub weighed: Option<Weighed>,
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
    let first = View { here: state.clone(), there: state.clone(), age_s: 0.0, predicted, weighed: None };
    let (input, output) = triple_buffer(&first);
    (input, ViewSource(output))
}
