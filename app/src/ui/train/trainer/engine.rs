//! The servo on its thread, or the same loop stepped manually for tests and screenshots.

use haptics::Vec2;
use haptics::device::Device;
use haptics::servo::rate::RateReport;
use haptics::servo::safety::Limits;
use haptics::servo::tap::{TapFiller, TapSource, tap};
use haptics::servo::{Loop, Privileges, Servo, ServoConfig, Snapshot, Swap, TickRecord};

/// Source of the ticks.
pub enum Engine {
    /// The real-time thread.
    Thread(Box<Servo>),
    /// The same loop, stepped on demand.
    Inline(Box<Inline>),
}

/// Capacity of the tap beside a manual loop, ticks; the loop waits for the recorder.
const TAP_TICKS: usize = 4096;

/// The servo's loop without a thread.
pub struct Inline {
    body: Loop,
    config: ServoConfig,
    ticks: Vec<TickRecord>,
    tap_in: TapFiller,
    tap: TapSource,
    snapshot: Snapshot,
    owed_s: f64,
}

impl Engine {
    /// Starts the thread.
    pub fn thread(swap: Box<Swap>, device: Box<dyn Device>, config: ServoConfig) -> Result<Self, String> {
        let servo = Servo::start(swap, device, config);
        servo.map(|s| Self::Thread(Box::new(s))).map_err(|e| crate::text::sentence::sentence(&e.to_string()))
    }

    /// Creates a loop that is stepped on demand.
    pub fn inline(swap: Box<Swap>, device: Box<dyn Device>, config: ServoConfig) -> Self {
        let limits = Limits { max_force_n: config.limits.max_force_n.min(device.spec().max_force_n), ..config.limits };
        // Without a clock of its own there is nothing to measure: always the nominal rate, so that runs are
        // reproducible.
        let rate = RateReport { rate_hz: config.rate.nominal_hz(), ..RateReport::default() };
        let snapshot = Snapshot::starting(&swap, rate);
        let body = Loop::new(swap, device, limits).with_passivity_control(config.passivity_control_n_s_m);
        let (tap_in, tap) = tap(TAP_TICKS);
        Self::Inline(Box::new(Inline { body, config, ticks: Vec::new(), tap_in, tap, snapshot, owed_s: 0.0 }))
    }

    /// The newest snapshot.
    pub fn newest(&mut self) -> &Snapshot {
        match self {
            Self::Thread(servo) => servo.newest(),
            Self::Inline(inline) => &inline.snapshot,
        }
    }

    /// All ticks since the last call.
    pub fn drain(&mut self, into: &mut Vec<TickRecord>) {
        match self {
            Self::Thread(servo) => servo.drain(into),
            Self::Inline(inline) => into.append(&mut inline.ticks),
        }
    }

    /// Tap through which a recorder gets every tick.
    pub fn tap(&self) -> &TapSource {
        match self {
            Self::Thread(servo) => servo.tap(),
            Self::Inline(inline) => &inline.tap,
        }
    }

    /// Swaps the world; false if the swap was not accepted.
    pub fn swap(&mut self, next: Box<Swap>) -> bool {
        match self {
            Self::Thread(servo) => servo.swap(next).is_ok(),
            Self::Inline(inline) => {
                inline.body.swap(next);
                inline.publish();
                true
            }
        }
    }

    /// Renders a small test force in place of the world's, N on the operator's fingers; `None` ends it.
    pub fn test_force(&mut self, wanted_n: Option<[Vec2; 2]>) {
        match self {
            Self::Thread(servo) => servo.test_force(wanted_n),
            Self::Inline(inline) => inline.body.test_force(wanted_n),
        }
    }

    /// Pauses or resumes the world; the force drops to zero and returns gradually.
    pub fn hold(&mut self, held: bool) {
        match self {
            Self::Thread(servo) => servo.hold(held),
            Self::Inline(inline) => inline.body.hold(held),
        }
    }

    /// Steps a manual loop by `seconds`; the thread needs no help.
    pub fn advance(&mut self, seconds: f64) {
        if let Self::Inline(inline) = self {
            inline.advance(seconds);
        }
    }

    /// Privileges granted by the system; `None` without a thread.
    pub fn privileges(&self) -> Option<Privileges> {
        match self {
            Self::Thread(servo) => Some(servo.privileges()),
            Self::Inline(_) => None,
        }
    }

    /// Its settings.
    pub fn config(&self) -> ServoConfig {
        match self {
            Self::Thread(servo) => servo.config(),
            Self::Inline(inline) => inline.config,
        }
    }
}

impl Inline {
    fn advance(&mut self, seconds: f64) {
        let period_s = self.snapshot.timing.period_s;
        self.owed_s += seconds;
        while self.owed_s >= period_s {
            self.owed_s -= period_s;
            let tick = self.body.tick(period_s);
            if self.body.is_held() {
                // The world is paused: nothing is recorded.
                self.snapshot.tick = tick;
                continue;
            }
            self.ticks.push(tick);
            while self.tap_in.must_wait() {
                // Many times real time, without a device: nobody can feel it.
                std::thread::sleep(std::time::Duration::from_millis(1));
            }
            self.tap_in.offer(tick);
            self.snapshot.tick = tick;
            self.snapshot.timing.ticks += 1;
        }
        self.publish();
    }

    fn publish(&mut self) {
        self.snapshot.state.copy_from(self.body.state());
        self.snapshot.generation = self.body.generation();
        self.snapshot.coupling = self.body.coupling();
        self.snapshot.delay_s = self.body.delay_s();
        self.snapshot.line_n_m = self.body.line_stiffness_n_m();
        self.snapshot.finished = self.body.finished();
        self.snapshot.timing.sample_age_s = self.body.sample_age_s();
    }
}
