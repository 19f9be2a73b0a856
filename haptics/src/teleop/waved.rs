//! Without a model: forces and motions in wave variables, and a picture that comes late.
//!
//! Waves over a delay d feel like a spring of b/d in series with the world. With half a second of round trip that is 36
//! N/m for a relaxed finger: a pinched object turns out of the fingers. The far hand is therefore made stronger than
//! the near one: its forces are divided by a gain before they come back. This multiplies the impedance of the line at
//! the far end and leaves the near one alone. Both ends stay passive, the far one in units of the gain (power scaling:
//! Colgate 1993). The felt force is a share of the exerted one, and said to be one ([`gain`]).

use super::album::Album;
use super::delay::{Delay, Ends, hand_stiffness_n_m};
use super::view::{Knock, ViewInput};
use crate::device::channel::line::Line;
use crate::device::channel::{ChannelConfig, ChannelDevice, ChannelError, Waves};
use crate::device::{Command, Device, DeviceSpec, ForceGuard, Sample};
use crate::world::{State, World};

/// Salt of the impacts' fate.
const SALT: u64 = 0x5be0_cd19_137e_2179;

/// Ratio of the far forces to the felt ones, ≥ 1. It lends the far fingers a hand's stiffness over a line of `line_n_m`
/// (N/m).
fn gain(line_n_m: Option<f64>) -> f64 {
    line_n_m.map_or(1.0, |line_n_m| (hand_stiffness_n_m() / line_n_m).max(1.0))
}

/// An operator behind a line with waves, with delayed sight.
pub(super) struct WavedHand {
    channel: ChannelDevice,
    spec: DeviceSpec,
    gain: f64,
    pictures: Album<f64>,
    /// Impacts on their way to the operator's eye and ear.
    knocks: Line<Knock>,
    struck_m_s: Option<f64>,
    /// The newest at the far end, and as it is known here.
    knock: [Knock; 2],
    seen: State,
    view: ViewInput,
    now_s: f64,
    taken_s: f64,
}

impl WavedHand {
    pub fn new(
        operator: Box<dyn Device>,
        ends: &Ends<'_>,
        delay: &Delay,
        view: ViewInput,
    ) -> Result<Self, ChannelError> {
        let waves = Some(Waves::new(operator.spec(), ends.world, ends.period_s));
        let name = operator.spec().name.clone();
        let channel = ChannelDevice::new(operator, ChannelConfig { waves, ..delay.channel(ends.seed) })?;
        let gain = gain(channel.line_stiffness_n_m());
        let mut spec = channel.spec().clone();
        spec.name = format!("{name} over {:.0} ms and back", 1e3 * delay.round_trip_s);
        // The force that the servo may ask for is divided before it is felt.
        spec.max_force_n *= gain;
        spec.damping_n_s_m *= gain;
        Ok(Self {
            channel,
            spec,
            gain,
            pictures: Album::new(ends.state, delay, ends.seed),
            knocks: Line::new(delay.one_way_s(), delay.jitter_s, delay.loss, ends.seed ^ SALT),
            struck_m_s: None,
            knock: [Knock::default(); 2],
            seen: ends.state.clone(),
            view,
            now_s: 0.0,
            taken_s: 0.0,
        })
    }

    fn publish(&mut self) {
        let view = self.view.input_buffer_mut();
        view.here.copy_from(&self.seen);
        view.there.copy_from(&self.seen);
        view.age_s = self.now_s - self.taken_s;
        view.predicted = false;
        view.knock = self.knock[1];
        self.view.publish();
    }
}

impl Device for WavedHand {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn exchange(&mut self, command: &Command, dt_s: f64) -> Sample {
        self.now_s += dt_s;
        if let Some((picture, taken_s)) = self.pictures.receive(self.now_s) {
            picture.show_in(&mut self.seen);
            self.taken_s = *taken_s;
        }
        if let Some(knock) = self.knocks.receive(self.now_s) {
            self.knock[1] = knock;
        }
        let felt = Command { force_n: command.force_n.map(|force| force / self.gain) };
        let sample = self.channel.exchange(&felt, dt_s);
        self.publish();
        sample
    }

    fn delay_s(&self) -> f64 {
        self.channel.delay_s()
    }

    fn line_stiffness_n_m(&self) -> Option<f64> {
        // The felt stiffness; the far fingers are stiffer by the gain.
        self.channel.line_stiffness_n_m()
    }

    fn make_safe(&mut self) {
        self.channel.make_safe();
    }

    fn interrupted(&mut self) {
        self.channel.interrupted();
    }

    fn guard(&mut self) -> Option<ForceGuard> {
        self.channel.guard()
    }

    fn strike(&mut self, speed_m_s: f64) {
        self.struck_m_s = Some(speed_m_s);
        self.channel.strike(speed_m_s);
    }

    fn see(&mut self, world: &World, state: &State) {
        self.pictures.offer(self.now_s, state, self.now_s);
        if let Some(speed_m_s) = self.struck_m_s.take() {
            let next = self.knock[0].next(self.now_s, speed_m_s, state.impact_in_world);
            if next != self.knock[0] {
                self.knocks.send(self.now_s, next);
            }
            self.knock[0] = next;
        }
        self.channel.see(world, &self.seen);
    }

    fn finished(&self) -> bool {
        self.channel.finished()
    }
}
