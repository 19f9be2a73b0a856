//! Test result of the requested push.

use super::{Check, Measured};
use haptics::servo::TickRecord;
use haptics::servo::force_test::UP_N_S;

/// Duration of the start ramp after the first positions, and of the push command's way to the servo, s.
const START_S: f64 = 0.6;

impl Measured<'_> {
    /// The ticks of the second half, in which the push was on.
    fn pushed(&self) -> &[TickRecord] {
        &self.ticks[self.ticks.len() / 2..]
    }

    /// Checks that half of the push was reached on both fingers; otherwise gives the reason.
    pub(super) fn push(&self) -> Check {
        let (name, asked_n) = ("push", self.push_n);
        if !self.spec.force_feedback {
            let text = "Nobody feels a push with this device: its force is shown, not felt.";
            return Check::new(name, true, text.to_owned());
        }
        let upwards_n = |tick: &TickRecord| tick.sent_force_n.iter().map(|force| force.y).fold(f64::INFINITY, f64::min);
        let reached_n = self.pushed().iter().map(upwards_n).fold(0.0, f64::max);
        let wanted_n = 0.5 * asked_n.min(self.spec.max_force_n);
        if reached_n > wanted_n {
            let text = format!("Pushed both fingers upwards, softly, up to {reached_n:.2} N. Did you feel it on both?");
            return Check::new(name, true, text);
        }
        let fresh = self.pushed().iter().filter(|tick| !tick.flags.stale).count();
        let (had_s, needed_s) = (fresh as f64 * self.timing.period_s, START_S + wanted_n / UP_N_S);
        let short = format!("The push of {asked_n:.2} N did not come up (largest {reached_n:.2} N)");
        if fresh == 0 {
            // Not caused by the push: the check of the positions has failed, or reports their end.
            return Check::new(name, false, format!("{short}: no fresh positions, no force."));
        }
        if had_s < needed_s {
            let seconds = (2.0 * (START_S + asked_n / UP_N_S)).ceil();
            let text = format!(
                "{short}: it comes up by {UP_N_S} N a second and had {had_s:.1} s with fresh positions. Use --seconds {seconds:.0} \
                 or more, and have the device there from the start."
            );
            return Check::new(name, false, text);
        }
        Check::failed(name, format!("{short}, though fresh positions came for {had_s:.1} s of it."))
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{kilohertz, measured};
    use haptics::Vec2;
    use haptics::device::DeviceSpec;
    use haptics::device::haply::HaplyHand;
    use haptics::servo::TickRecord;
    use haptics::servo::safety::SafetyFlags;

    /// Result for a push of 1 N in the second half of `ticks`, with this force reached on each finger: ok, failed,
    /// text.
    fn said(spec: &DeviceSpec, ticks: usize, reached_n: [f64; 2], stale: bool) -> (bool, bool, String) {
        let flags = SafetyFlags { stale, ..SafetyFlags::default() };
        let quiet = TickRecord { sent_force_n: [Vec2::new(3.0, 3.0); 2], ..TickRecord::default() };
        let pushed = TickRecord { sent_force_n: reached_n.map(|n| Vec2::new(0.0, n)), flags, ..TickRecord::default() };
        let records = [vec![quiet; ticks / 2], vec![pushed; ticks - ticks / 2]].concat();
        let timing = kilohertz();
        let mut measured = measured(spec, &timing, &records);
        measured.push_n = 1.0;
        let check = measured.push();
        (check.ok, check.failed, check.text)
    }

    #[test]
    fn a_push_is_felt_or_the_reason_is_said() {
        let boards = HaplyHand::two_boards();
        let (ok, failed, text) = said(&boards, 6_000, [1.0, 0.98], false);
        assert!(ok && !failed && text.contains("0.98 N"), "{text}");
        let (ok, failed, text) = said(&boards, 6_000, [1.0, 0.0], false);
        assert!(
            !ok && failed && text.contains("though fresh positions came for 3.0 s"),
            "one finger is not enough: {text}"
        );
        let (ok, failed, text) = said(&boards, 1_000, [0.2, 0.2], false);
        assert!(!ok && !failed && text.contains("--seconds 4"), "the ramp had no time: {text}");
        let (ok, failed, text) = said(&boards, 6_000, [0.0, 0.0], true);
        assert!(!ok && !failed && text.contains("no fresh positions"), "{text}");
        let shown = DeviceSpec { force_feedback: false, ..boards };
        let (ok, failed, text) = said(&shown, 6_000, [0.0, 0.0], false);
        assert!(ok && !failed && text.contains("Nobody feels"), "{text}");
    }
}
