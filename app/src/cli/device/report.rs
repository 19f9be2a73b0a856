//! Result of a test, in plain words and as JSON.

mod board;
pub mod limits;
mod push;

use super::super::Output;
use crate::cli::device::report::limits::Limits;
use crate::cli::device::report::limits::limit_sentence;
use crate::cli::device::report::limits::limits;
use crate::text::format::short_time;
use haptics::Vec2;
use haptics::device::DeviceSpec;
use haptics::device::haply::Tally;
use haptics::device::udp::{Refused, UdpMonitor};
use haptics::servo::{Privileges, TickRecord, passivity, timing::Timing};
use limits::line_sentence;
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Minimum travel of a moved finger, m.
const STILL_M: f64 = 0.5e-3;
/// Time after which the watchdog has responded, s.
const WAIT_S: f64 = 0.1;

/// What `device test --json` prints.
#[derive(JsonSchema, Serialize)]
pub(crate) struct Said<'a> {
    /// Its name for people.
    device: &'a str,
    /// Its figures.
    spec: Spec,
    /// What it can render; null where no force is felt.
    limits: Option<Limits>,
    /// Stiffness of the coupling, N/m; null where the world is felt directly.
    #[serde(rename = "coupling_N_m")]
    coupling_n_m: Option<f64>,
    /// Stiffness of the line with waves that it is behind, N/m; null without one.
    #[serde(rename = "line_N_m")]
    line_n_m: Option<f64>,
    /// Ticks that were watched.
    ticks: usize,
    /// Those without force, because positions had stayed away for too long.
    stale_ticks: usize,
    /// Width and height of where the left and the right finger went, m.
    range_m: [[f64; 2]; 2],
    /// Largest force that was sent to a finger, N.
    #[serde(rename = "largest_force_N")]
    largest_force_n: f64,
    /// Of a remote device; null otherwise.
    packets: Option<Packets>,
    /// Answers of the left and the right board; null without boards.
    boards: Option<[board::Counts; 2]>,
    /// Timing of the servo.
    timing: &'a Timing,
    /// Privileges granted by the system.
    privileges: Privileges,
    /// Stiffness up to which the device is passive on its own, N/m.
    #[serde(rename = "passive_stiffness_N_m")]
    passive_stiffness_n_m: f64,
    /// What was looked at.
    checks: &'a [Check],
    /// What failed, else the first check that is not fine, or that nothing wrong was found.
    verdict: &'a str,
}

/// A device's figures.
#[derive(JsonSchema, Serialize)]
pub struct Spec {
    /// Its name for people.
    name: String,
    /// Whether forces are felt, not only shown.
    force_feedback: bool,
    /// Largest force of a finger, N.
    #[serde(rename = "max_force_N")]
    max_force_n: f64,
    /// Physical damping of a finger, N s/m.
    #[serde(rename = "damping_N_s_m")]
    damping_n_s_m: f64,
    /// Coulomb friction of a finger, N.
    #[serde(rename = "coulomb_N")]
    coulomb_n: f64,
    /// Smallest step of a position, m.
    resolution_m: f64,
}

impl From<&DeviceSpec> for Spec {
    fn from(spec: &DeviceSpec) -> Self {
        Self {
            name: spec.name.clone(),
            force_feedback: spec.force_feedback,
            max_force_n: spec.max_force_n,
            damping_n_s_m: spec.damping_n_s_m,
            coulomb_n: spec.coulomb_n,
            resolution_m: spec.resolution_m,
        }
    }
}

/// Packets of a remote device.
#[derive(JsonSchema, Serialize)]
struct Packets {
    /// Where it was listened.
    address: String,
    /// Those that were taken.
    accepted: u64,
    /// Those that were not, by reason.
    refused: BTreeMap<&'static str, u64>,
}

impl From<&UdpMonitor> for Packets {
    fn from(packets: &UdpMonitor) -> Self {
        Self {
            address: packets.address().to_string(),
            accepted: packets.accepted(),
            refused: Refused::ALL.iter().map(|why| (why.words(), packets.refused(*why))).collect(),
        }
    }
}

/// Measurement of a test.
pub struct Measured<'a> {
    /// Specification of the device.
    pub spec: &'a DeviceSpec,
    /// Latency stated by the device, s.
    pub delay_s: f64,
    /// The servo's punctuality.
    pub timing: &'a Timing,
    /// What the system granted.
    pub privileges: Privileges,
    /// Every tick.
    pub ticks: &'a [TickRecord],
    /// Advice on moving it.
    pub hint: &'a str,
    /// Packet counters of a remote device.
    pub packets: Option<&'a UdpMonitor>,
    /// Answers of the left and the right board.
    pub answers: Option<&'a [Tally; 2]>,
    /// Requested test force, N.
    pub push_n: f64,
    /// Stiffness of the link with wave variables in front of it, N/m.
    pub line_n_m: Option<f64>,
    /// Stiffness of the virtual coupling, N/m, if there is one.
    pub coupling_n_m: Option<f64>,
}

/// One thing that was looked at.
#[derive(JsonSchema, Serialize)]
struct Check {
    /// What.
    name: &'static str,
    /// Whether it is fine.
    ok: bool,
    /// Not only worth a look: the device does not work.
    failed: bool,
    /// What was seen, for people.
    text: String,
}

impl Check {
    /// Passed check, or a remark.
    fn new(name: &'static str, ok: bool, text: String) -> Self {
        Self { name, ok, failed: false, text }
    }

    fn failed(name: &'static str, text: String) -> Self {
        Self { name, ok: false, failed: true, text }
    }
}

/// A device that does not work is more informative than a machine that was busy meanwhile.
fn verdict(checks: &[Check]) -> &str {
    let failed = checks.iter().find(|check| check.failed);
    failed.or_else(|| checks.iter().find(|check| !check.ok)).map_or("Nothing wrong was found.", |check| &check.text)
}

impl Measured<'_> {
    /// Report as text and JSON.
    pub fn report(&self) -> serde_json::Result<Output> {
        let checks = self.checks();
        let verdict = verdict(&checks);
        let period_s = self.timing.period_s;
        let mut text = format!("{}\n", self.spec.name);
        let _ =
            writeln!(text, "  {} ticks at {:.0} Hz; {}", self.ticks.len(), 1.0 / period_s, self.privileges.sentence());
        for (what, p) in [("late by", self.timing.lateness), ("working for", self.timing.compute)] {
            let [p50, p99, p999, max] = [p.p50_s, p.p99_s, p.p999_s, p.max_s].map(short_time);
            let _ = writeln!(text, "  {what:<12} p50 {p50:>9}   p99 {p99:>9}   p99.9 {p999:>9}   max {max:>9}");
        }
        let limit = match self.line_n_m.filter(|_| self.spec.force_feedback) {
            Some(line_n_m) => line_sentence(self.spec, line_n_m),
            None => limit_sentence(self.spec, period_s, self.delay_s),
        };
        let _ = writeln!(text, "  {limit}");
        for check in &checks {
            let _ = writeln!(text, "  {} {}", if check.ok { "ok  " } else { "look" }, check.text);
        }
        let _ = writeln!(text, "  {verdict}");
        Ok(Output { text, json: serde_json::to_value(self.said(&checks, verdict))? })
    }

    /// True if a check failed outright.
    pub fn has_failed(&self) -> bool {
        self.checks().iter().any(|check| check.failed)
    }

    fn said<'a>(&'a self, checks: &'a [Check], verdict: &'a str) -> Said<'a> {
        let period_s = self.timing.period_s;
        Said {
            device: &self.spec.name,
            spec: self.spec.into(),
            limits: limits(self.spec, period_s, self.delay_s),
            coupling_n_m: self.coupling_n_m,
            line_n_m: self.line_n_m,
            ticks: self.ticks.len(),
            stale_ticks: self.stale(),
            range_m: self.ranges().map(|range| [range.x, range.y]),
            largest_force_n: self.largest_force_n(),
            packets: self.packets.map(Packets::from),
            boards: self.answers.map(|tallies| tallies.each_ref().map(board::Counts::from)),
            timing: self.timing,
            privileges: self.privileges,
            passive_stiffness_n_m: passivity::passive_stiffness(self.spec, 0.0, period_s, self.delay_s),
            checks,
            verdict,
        }
    }

    fn checks(&self) -> Vec<Check> {
        let mut checks = vec![self.rate(), self.freshness(), self.motion()];
        checks.extend(self.packets.map(Self::seals));
        checks.extend(self.answers.into_iter().flat_map(board::checks));
        if self.push_n > 0.0 {
            checks.push(self.push());
        }
        checks
    }

    fn rate(&self) -> Check {
        let ok = self.timing.lateness.p99_s <= 0.5 * self.timing.period_s;
        let text = if ok {
            format!("The servo holds this rate; {} deadlines were missed.", self.timing.missed)
        } else {
            "The machine does not hold this rate; choose a lower one with --rate.".to_owned()
        };
        Check::new("rate", ok, text)
    }

    fn stale(&self) -> usize {
        self.ticks.iter().filter(|tick| tick.flags.stale).count()
    }

    /// First tick with positions after the wait for the device, and one past the last; `None` if there never were any.
    fn present(&self) -> Option<(usize, usize)> {
        let stale = |tick: &TickRecord| tick.flags.stale;
        // The watchdog responds with a delay: initial silence is reported a little later.
        let said = (WAIT_S / self.timing.period_s) as usize;
        let first = match self.ticks.iter().position(stale) {
            Some(at) if at <= said => at + self.ticks[at..].iter().position(|tick| !stale(tick))?,
            _ => 0,
        };
        let end = self.ticks.iter().rposition(|tick| !stale(tick))? + 1;
        Some((first, end))
    }

    fn freshness(&self) -> Check {
        let name = "positions";
        let Some((first, end)) = self.present() else {
            return Check::failed(name, format!("No positions came, so the force was zero. {}", self.hint));
        };
        let seconds = |ticks: usize| ticks as f64 * self.timing.period_s;
        let gaps = self.ticks[first..end].iter().filter(|tick| tick.flags.stale).count();
        let left = self.ticks.len() - end;
        let mut text = if gaps == 0 {
            format!("Positions came for {:.1} s without a gap.", seconds(end - first))
        } else {
            format!(
                "The force was zero for {} in between, because positions stayed away for longer than the watchdog waits. \
                 Check cable and program.",
                duration(seconds(gaps))
            )
        };
        if left > 0 {
            let _ = write!(text, " They ended {} before the test did.", duration(seconds(left)));
        }
        // A remote program may end at any time; a wired device may not.
        Check::new(name, gaps == 0 && (left == 0 || self.packets.is_some()), text)
    }

    /// Width and height of each finger's range of motion, m.
    fn ranges(&self) -> [Vec2; 2] {
        [0, 1].map(|finger| {
            let far = Vec2::repeat(f64::INFINITY);
            let (low, high) = self.ticks.iter().fold((far, -far), |(low, high), tick| {
                let tip = tick.input.tip_in_world[finger];
                (low.inf(&tip), high.sup(&tip))
            });
            if self.ticks.is_empty() { Vec2::zeros() } else { high - low }
        })
    }

    fn motion(&self) -> Check {
        let ranges = self.ranges();
        let words = |finger: usize| {
            let range = 1e3 * ranges[finger];
            if ranges[finger].norm() < STILL_M {
                "did not move".to_owned()
            } else {
                format!("moved over {:.0} mm across and {:.0} mm up", range.x, range.y)
            }
        };
        let still = ranges.iter().any(|range| range.norm() < STILL_M);
        let hint = if still { self.hint } else { "" };
        let text = format!("The left finger {}, the right one {}. {hint}", words(0), words(1));
        // Nothing moves by itself: the person must judge a standstill.
        Check::new("motion", true, text.trim_end().to_owned())
    }

    fn seals(packets: &UdpMonitor) -> Check {
        let refused: Vec<String> = Refused::ALL
            .iter()
            .filter(|why| packets.refused(**why) > 0)
            .map(|why| format!("{} {}", packets.refused(*why), why.words()))
            .collect();
        let tail =
            if refused.is_empty() { "none refused".to_owned() } else { format!("refused: {}", refused.join(", ")) };
        let text = format!("At {}: {} packets accepted, {tail}.", packets.address(), packets.accepted());
        Check::new("packets", packets.refused(Refused::Seal) == 0, text)
    }

    fn largest_force_n(&self) -> f64 {
        self.ticks.iter().flat_map(|tick| tick.sent_force_n).map(|force| force.norm()).fold(0.0, f64::max)
    }
}

/// Text of a nonzero duration: `0.4 ms`, `50 ms`, `0.7 s`.
fn duration(seconds: f64) -> String {
    let ms = 1e3 * seconds;
    match seconds {
        _ if ms < 0.95 => format!("{ms:.1} ms"),
        _ if seconds < 0.1 => format!("{ms:.0} ms"),
        _ => format!("{seconds:.1} s"),
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use haptics::device::haply::HaplyHand;
    use haptics::servo::safety::SafetyFlags;

    fn ticks(parts: &[(usize, bool)]) -> Vec<TickRecord> {
        let tick =
            |stale| TickRecord { flags: SafetyFlags { stale, ..SafetyFlags::default() }, ..TickRecord::default() };
        parts.iter().flat_map(|(count, stale)| vec![tick(*stale); *count]).collect()
    }

    /// Measurement of a device that was monitored for some ticks of 1 ms, with nothing else known.
    pub(super) fn measured<'a>(spec: &'a DeviceSpec, timing: &'a Timing, ticks: &'a [TickRecord]) -> Measured<'a> {
        Measured {
            spec,
            delay_s: 0.0,
            timing,
            privileges: Privileges::default(),
            ticks,
            hint: "Plug it in.",
            packets: None,
            answers: None,
            push_n: 0.0,
            line_n_m: None,
            coupling_n_m: None,
        }
    }

    /// Timing of a servo of 1 kHz.
    pub(super) fn kilohertz() -> Timing {
        Timing { period_s: 1e-3, ..Timing::default() }
    }

    fn freshness(parts: &[(usize, bool)]) -> (bool, String) {
        let (spec, timing, ticks) = (HaplyHand::two_boards(), kilohertz(), ticks(parts));
        let measured = measured(&spec, &timing, &ticks);
        let check = measured.freshness();
        assert_eq!(check.failed, check.text.contains("No positions came"));
        assert_eq!(measured.has_failed(), check.failed);
        (check.ok, check.text)
    }

    #[test]
    fn waiting_gaps_and_an_end_are_told_apart() {
        let (fine, stale) = (false, true);
        assert_eq!(freshness(&[(1_000, fine)]), (true, "Positions came for 1.0 s without a gap.".to_owned()));
        assert!(freshness(&[(20, fine), (500, stale), (1_000, fine)]).0, "it came late");
        let (ok, text) = freshness(&[(300, fine), (50, stale), (300, fine)]);
        assert!(!ok && text.contains("zero for 50 ms"), "{text}");
        let (ok, text) = freshness(&[(300, fine), (1, stale), (300, fine)]);
        assert!(!ok && text.contains("zero for 1 ms"), "{text}");
        let (ok, text) = freshness(&[(300, fine), (700, stale)]);
        assert!(!ok && text.contains("ended 0.7 s before"), "{text}");
        let (ok, text) = freshness(&[(20, fine), (700, stale)]);
        assert!(!ok && text.contains("No positions came") && text.contains("Plug it in."), "{text}");
        assert!(!freshness(&[]).0);
    }

    #[test]
    fn what_does_not_work_is_said_before_that_the_machine_was_busy() {
        let busy = Check::new("rate", false, "The machine is busy.".to_owned());
        let silent = Check::failed("positions", "No positions came.".to_owned());
        let fine = Check::new("motion", true, "It moved.".to_owned());
        assert_eq!(verdict(&[busy, fine, silent]), "No positions came.");
        let busy = Check::new("rate", false, "The machine is busy.".to_owned());
        assert_eq!(verdict(&[Check::new("motion", true, "It moved.".to_owned()), busy]), "The machine is busy.");
        assert_eq!(verdict(&[]), "Nothing wrong was found.");
    }
}
