//! Rendering limits of a device, as text and JSON.

use super::duration;
use haptics::device::DeviceSpec;
use haptics::servo::passivity;
use schemars::JsonSchema;
use serde::Serialize;

/// What a device can render.
#[derive(Debug, JsonSchema, PartialEq, Serialize)]
pub struct Limits {
    /// At this rate.
    rate_hz: f64,
    /// Behind this delay one way.
    delay_s: f64,
    /// Stiffness up to which it is passive on its own, N/m.
    #[serde(rename = "passive_stiffness_N_m")]
    passive_stiffness_n_m: f64,
    /// Damping up to which it is, N s/m.
    #[serde(rename = "passive_damping_N_s_m")]
    passive_damping_n_s_m: f64,
}

/// Rendering limits of a device at a period, s, and with its stated latency, s: computed from its specification, never
/// typed in. `None` without force output.
pub fn limits(spec: &DeviceSpec, period_s: f64, delay_s: f64) -> Option<Limits> {
    spec.force_feedback.then(|| Limits {
        rate_hz: 1.0 / period_s,
        delay_s,
        passive_stiffness_n_m: passivity::passive_stiffness(spec, 0.0, period_s, delay_s),
        passive_damping_n_s_m: passivity::passive_damping(spec, period_s),
    })
}

/// The same as one sentence.
pub fn limit_sentence(spec: &DeviceSpec, period_s: f64, delay_s: f64) -> String {
    if !spec.force_feedback {
        return "the force is shown, not felt: no limit".to_owned();
    }
    let stiffness = passivity::passive_stiffness(spec, 0.0, period_s, delay_s);
    if stiffness <= 0.0 {
        return "no damping of its own is known, so nothing is surely passive: the world is felt through a soft spring"
            .to_owned();
    }
    let behind = if delay_s > 0.0 { format!(" behind {} of delay", duration(delay_s)) } else { String::new() };
    format!(
        "passive up to {stiffness:.0} N/m and {:.2} N s/m at {:.0} Hz{behind}; up to {:.1} N a finger",
        passivity::passive_damping(spec, period_s),
        1.0 / period_s,
        spec.max_force_n
    )
}

/// Feel of a link with wave variables, as one sentence.
pub(super) fn line_sentence(spec: &DeviceSpec, line_n_m: f64) -> String {
    format!(
        "waves with an impedance of {:.1} N s/m: stable behind the delay, and soft; nothing is felt stiffer than the line's own \
         spring of {line_n_m:.0} N/m, in series with the world; up to {:.1} N a finger",
        spec.damping_n_s_m, spec.max_force_n
    )
}

#[cfg(test)]
mod tests {
    use super::super::Measured;
    use super::super::tests::{kilohertz, measured};
    use super::*;
    use haptics::device::haply::HaplyHand;

    #[test]
    fn limits_are_computed_and_absent_where_nothing_is_felt() {
        let boards = HaplyHand::two_boards();
        let stiffness_n_m =
            |period_s, delay_s| limits(&boards, period_s, delay_s).map_or(0.0, |l| l.passive_stiffness_n_m);
        assert!((stiffness_n_m(1e-3, 0.0) - 200.0).abs() < 1e-9);
        assert!((stiffness_n_m(0.25e-3, 0.0) - 800.0).abs() < 1e-9);
        // b/(T/2 + t_d): 0.1 N s/m over 10 ms.
        assert!((stiffness_n_m(1e-3, 9.5e-3) - 10.0).abs() < 1e-9);
        assert!(
            limit_sentence(&boards, 1e-3, 9.5e-3).contains("10 N/m and 0.10 N s/m at 1000 Hz behind 10 ms of delay")
        );
        let (timing, waved) = (kilohertz(), DeviceSpec { damping_n_s_m: 5.0, ..boards.clone() });
        let report = Measured { line_n_m: Some(20.0), ..measured(&waved, &timing, &[]) }.report().expect("JSON");
        assert!(report.text.contains("the line's own spring of 20 N/m") && !report.text.contains("passive up to"));
        assert_eq!(report.json["line_N_m"], 20.0);
        let shown = DeviceSpec { force_feedback: false, ..boards };
        assert_eq!(limits(&shown, 1e-3, 0.0), None);
    }
}
