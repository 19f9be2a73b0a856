//! Link latency between the operator and the world: its settings, and the view of the operator over the link.

use crate::text::sentence::sentence;
use crate::ui::train::trainer::live::{Operator, Trainer};
use haptics::device::Device;
use haptics::servo::rate::SAFE_HZ;
use haptics::servo::{ServoConfig, Swap, TickRecord};
use haptics::teleop::{self, Delay, Ends, View};
use haptics::world::State;

impl Trainer {
    /// Link between the operator and the world.
    pub fn delay(&self) -> Delay {
        self.delay
    }

    /// Sets the link between the operator and the world, or removes it. A running servo restarts; the world keeps its
    /// state, and the scripted operator starts over. An invalid link is rejected with a sentence, and the previous one
    /// stays.
    pub fn set_delay(&mut self, delay: Delay) -> Result<(), String> {
        delay.check().map_err(|error| sentence(&error.to_string()))?;
        if delay == self.delay {
            return Ok(());
        }
        self.delay = delay;
        match (self.engine.is_some(), self.operator) {
            (false, _) => Ok(()),
            (true, Operator::Scripted) => self.restart(),
            (true, Operator::You) => {
                self.pause();
                self.ensure_running()
            }
        }
    }

    /// Puts the link before a device, if there is one.
    pub(super) fn connect(&mut self, device: Box<dyn Device>, swap: &Swap) -> Result<Box<dyn Device>, String> {
        (self.view, self.knocked) = (None, 0);
        if self.delay.is_none() {
            return Ok(device);
        }
        let seed = self.performances + 1;
        let guess = teleop::guess(&swap.world, seed);
        let ends = Ends {
            world: &swap.world,
            state: &swap.state,
            guess: Some(&guess),
            limits: ServoConfig::default().limits,
            // For the slowest rate: a damper that is sufficient there is sufficient at every faster one.
            period_s: 1.0 / SAFE_HZ,
            seed,
        };
        let (device, view) = teleop::connect(device, &ends, &self.delay).map_err(|e| sentence(&e.to_string()))?;
        self.view = Some(view);
        Ok(device)
    }

    /// View of the operator over the link; `None` without a link.
    pub fn view(&self) -> Option<&View> {
        self.view.as_ref().map(teleop::ViewSource::last)
    }

    /// Updates the operator's knowledge: forces and impacts of every tick, or the delayed view over a link.
    pub(super) fn look(&mut self, frame_s: f64) {
        let Some(view) = &mut self.view else {
            self.struck_m_s = self.impacts.update(&self.scratch, frame_s);
            self.history.extend(&self.scratch);
            return;
        };
        view.newest();
        let knock = self.take_knock();
        self.struck_m_s = self.impacts.update(knock.as_slice(), frame_s);
        let seen = self.seen_tick();
        self.history.extend(seen.as_slice());
    }

    /// Tick of an impact that was not yet shown.
    fn take_knock(&mut self) -> Option<TickRecord> {
        let knock = self.view().map(|view| view.knock).filter(|knock| knock.number != self.knocked)?;
        self.knocked = knock.number;
        Some(TickRecord { impact_m_s: knock.speed_m_s, impact_in_world: knock.at_in_world, ..TickRecord::default() })
    }

    /// State of the world as the operator knows it: the world itself, its model, or the delayed view.
    pub fn seen(&self) -> Option<&State> {
        self.view().map(|view| &view.here).or(self.newest.as_ref().map(|newest| &newest.state))
    }

    /// Newest tick as the operator knows it.
    pub fn seen_tick(&self) -> Option<TickRecord> {
        let tick = self.newest.as_ref()?.tick;
        let Some(View { here, .. }) = self.view() else { return Some(tick) };
        let device_in_world = here.input.tip_in_world;
        Some(TickRecord { input: here.input, device_in_world, tip_force_n: here.tip_force_n, ..tick })
    }
}
