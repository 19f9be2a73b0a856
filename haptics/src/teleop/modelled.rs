//! With a model: the operator touches a world of the same kind that answers at once; the far hand repeats the motion.
//!
//! The model runs in a servo's loop of its own, so that the operator's end has everything that a servo has: coupling,
//! safety stage, watchdog. No force of the far world reaches the operator. The only way back through the line is the
//! correction of the model, which moves things slowly and has no loop gain at the frequencies of a contact. The system
//! is therefore stable over any delay.

use super::album::Album;
use super::delay::{Delay, Ends};
use super::far_hand::{FarHand, Goal};
use super::model::Tutor;
use super::picture::Grasp;
use super::view::{Knock, ViewInput};
use crate::device::channel::ChannelError;
use crate::device::channel::line::Line;
use crate::device::{Command, Device, DeviceSpec, ForceGuard, HandImpedance, Sample};
use crate::servo::safety::Limits;
use crate::servo::{Loop, Swap};
use crate::world::{State, World};

/// Salt of the fate of the hand's messages.
const SALT: u64 = 0x9b05_688c_2b3e_6c1f;

/// Stamp of a picture: near-clock time of the message that the far hand followed, and of the picture itself, s.
type Stamp = (f64, f64);

/// An operator on a model, and the hand at the far end.
pub(super) struct ModelledHand {
    model: Loop,
    tutor: Tutor,
    guard: Option<ForceGuard>,
    spec: DeviceSpec,
    words: Line<Goal>,
    far: FarHand,
    pictures: Album<Stamp>,
    there: State,
    taken_s: f64,
    knock: Knock,
    view: ViewInput,
    now_s: f64,
    /// Since when the operator is done, s.
    done_s: Option<f64>,
    round_trip_s: f64,
}

impl ModelledHand {
    pub fn new(
        mut operator: Box<dyn Device>,
        ends: &Ends<'_>,
        delay: &Delay,
        view: ViewInput,
    ) -> Result<Self, ChannelError> {
        delay.check()?;
        let own = operator.spec();
        let limits = Limits { max_force_n: ends.limits.max_force_n.min(own.max_force_n), ..ends.limits };
        // The far servo drives the far hand.
        let spec = DeviceSpec {
            name: format!("{} over {:.0} ms and back, on a model", own.name, 1e3 * delay.round_trip_s),
            force_feedback: own.force_feedback,
            max_force_n: own.max_force_n,
            damping_n_s_m: HandImpedance::default().damping_n_s_m,
            coulomb_n: 0.0,
            resolution_m: 0.0,
        };
        let guard = operator.guard();
        let guess = ends.guess.unwrap_or(ends.world);
        let round_trip_s = delay.round_trip_s + 2.0 * delay.jitter_s;
        Ok(Self {
            tutor: Tutor::new(guess, ends.state, round_trip_s),
            model: Loop::new(Swap::at(guess.clone(), ends.state.clone()), operator, limits),
            guard,
            spec,
            words: Line::new(delay.one_way_s(), delay.jitter_s, delay.loss, ends.seed ^ SALT),
            far: FarHand::new(ends.state.input, delay, limits.max_force_n),
            pictures: Album::new(ends.state, delay, ends.seed),
            there: ends.state.clone(),
            taken_s: 0.0,
            knock: Knock::default(),
            view,
            now_s: 0.0,
            done_s: None,
            round_trip_s,
        })
    }

    /// Looks at the newest picture of the far world.
    fn look(&mut self) {
        let now = Grasp::of(self.model.state());
        if let Some((picture, (said_s, taken_s))) = self.pictures.receive(self.now_s) {
            picture.show_in(&mut self.there);
            self.taken_s = *taken_s;
            self.tutor.learn(picture, *said_s, now);
        }
    }

    fn publish(&mut self) {
        let view = self.view.input_buffer_mut();
        view.here.copy_from(self.model.state());
        view.there.copy_from(&self.there);
        view.age_s = self.now_s - self.taken_s;
        view.knock = self.knock;
        view.weighed = self.tutor.weighed();
        self.view.publish();
    }
}

impl Device for ModelledHand {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn exchange(&mut self, command: &Command, dt_s: f64) -> Sample {
        self.now_s += dt_s;
        self.look();
        let tick = self.model.tick(dt_s);
        if tick.impact_m_s > 0.0 {
            self.knock = self.knock.next(self.now_s, tick.impact_m_s, tick.impact_in_world);
        }
        self.tutor.correct(&mut self.model, self.now_s, dt_s);
        self.words.send(self.now_s, Goal { said_s: self.now_s, input: tick.input, force_n: tick.tip_force_n });
        if let Some(goal) = self.words.receive(self.now_s) {
            self.far.hear(goal);
        }
        let sample = self.far.advance(command, dt_s);
        self.done_s = self.done_s.or(self.model.finished().then_some(self.now_s));
        self.publish();
        sample
    }

    fn interrupted(&mut self) {
        self.model.interrupted();
    }

    fn make_safe(&mut self) {
        self.model.make_safe();
    }

    fn guard(&mut self) -> Option<ForceGuard> {
        self.guard.take()
    }

    fn see(&mut self, _: &World, state: &State) {
        // The operator sees the model, by its own loop.
        self.pictures.offer(self.now_s, state, (self.far.said_s(), self.now_s));
    }

    fn finished(&self) -> bool {
        // Actions under way are completed yet, and seen to be completed.
        self.done_s.is_some_and(|done_s| self.now_s > done_s + self.round_trip_s)
    }
}
