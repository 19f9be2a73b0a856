//! Texts of the assistant: every number with its standard error.

use crate::text::format::{number, object, with_error};
use crate::ui::train::assistant::readings::Circle;
use crate::ui::train::assistant::state::Assistant;
use estimator::assistant::{Guess, Held, Known, Slip, Warning};
use estimator::online::Pull;

/// Urgency of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Urgency {
    /// Information.
    Note,
    /// Warning.
    Caution,
    /// Immediate danger.
    Danger,
}

/// Label and value of each line about the held object.
pub(super) fn held(held: &Held, parts: Assistant) -> Vec<(&'static str, String)> {
    let mut lines = Vec::new();
    let mut push = |label: &'static str, known: Option<Known>, factor: f64, unit: &str| {
        if let Some(known) = known {
            lines.push((label, value(known, factor, unit)));
        }
    };
    if parts.held {
        push("Weight", held.weight_n, 1.0, "N");
        push("Width", held.width_m, 1e3, "mm");
        push("Stiffness", held.grip_stiffness_n_m, 1e-3, "N/mm");
        push("Leaks", held.leaks_kg_s, 1e3, "g/s");
    }
    if let Some(guess) = held.contents.as_ref().filter(|_| parts.contents) {
        lines.push(("Density", value(guess.density, 1e-3, "g/cm³")));
    }
    lines
}

/// Value ± standard error with its unit.
fn value(known: Known, factor: f64, unit: &str) -> String {
    let (value, error) = (known.value * factor, known.std_error * factor);
    // One digit of the standard error is enough for a glance.
    let decimals = if error > 0.0 { (-error.log10().floor()).clamp(0.0, 6.0) as usize } else { 3 };
    format!("{} ± {} {unit}", number(value, decimals), number(error, decimals))
}

/// `Inside: fuel or oil (62 %), or water or something like it (31 %)`.
pub(super) fn contents(guess: &Guess) -> String {
    match guess.kinds.as_slice() {
        [] => "Inside: nothing of the list is as dense".to_owned(),
        [(name, p)] => format!("Inside: {name} ({}\u{a0}%)", percent(*p)),
        [(name, p), (other, q), ..] => {
            format!("Inside: {name} ({}\u{a0}%), or {other} ({}\u{a0}%)", percent(*p), percent(*q))
        }
    }
}

fn percent(p: f64) -> String {
    number(100.0 * p.min(0.99), 0)
}

/// Slip margin: text and urgency.
pub(super) fn slip(slip: &Slip) -> (String, Urgency) {
    let urgency = match slip.by_a_jolt {
        p if p > 0.5 => Urgency::Danger,
        p if p > 0.15 => Urgency::Caution,
        _ => Urgency::Note,
    };
    let [free, least, most] = [slip.free, slip.least, slip.most].map(|share| number(100.0 * share, 0));
    (format!("Grip to spare: {free} % ({least}–{most})"), urgency)
}

pub(super) fn title(held: &Held) -> String {
    object(&held.object)
}

/// A warning as one line.
pub(super) fn warning(warning: &Warning) -> (String, Urgency) {
    const FINGERS: [&str; 2] = ["Left finger", "Right finger"];
    match *warning {
        Warning::Force { finger, force_n: (force, error), limit_n, over } => {
            let (force, error) = with_error(force, Some(error));
            let error = error.map_or_else(String::new, |e| format!(" ± {e}"));
            let (word, urgency) =
                if over { ("too hard", Urgency::Danger) } else { ("near the limit", Urgency::Caution) };
            (format!("{}: {word}, {force}{error} of {} N", FINGERS[finger.min(1)], number(limit_n, 1)), urgency)
        }
        Warning::Collision(met) => {
            let (time, error) = met.in_s;
            let speed = number(1e3 * met.speed_m_s, 0);
            let error = number(error.max(0.01), 2);
            (format!("It will hit in {} ± {error} s, at {speed} mm/s", number(time, 2)), Urgency::Caution)
        }
        Warning::Edge { finger, left_m: (left, error), .. } => {
            let finger = FINGERS[finger.min(1)];
            if left > 0.0 {
                let (left, error) = (number(1e3 * left, 1), number(1e3 * error, 1));
                (format!("{finger}: {left} ± {error} mm to the edge of its reach"), Urgency::Caution)
            } else {
                (format!("{finger}: at the edge of its reach"), Urgency::Danger)
            }
        }
    }
}

/// Text about the constraint of an object.
pub(super) fn pull(pull: &Pull) -> String {
    let (force, error) = with_error(pull.force_n.norm(), Some(pull.std_error_n));
    let error = error.map_or_else(String::new, |e| format!(" ± {e}"));
    let doing = if pull.pulls { "Something holds it" } else { "Something held it" };
    match pull.anchor {
        Some(anchor) => {
            let [long, short] = anchor.axes_m.map(|a| number(1e3 * a.norm(), 0));
            format!("{doing}: {force}{error} N, tied where the ring is (± {long} and {short} mm)")
        }
        None => format!("{doing}: {force}{error} N along the line"),
    }
}

/// Text about a detected circle.
pub(super) fn circle(circle: &Circle) -> String {
    let center = number(1e3 * circle.center_error_m.norm(), 2);
    format!("It turns on a circle: radius {}, centre ± {center} mm", value(circle.radius, 1e3, "mm"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use estimator::assistant::guess;
    use haptics::Vec2;

    #[test]
    fn every_number_comes_with_its_error() {
        let held = Held {
            object: "barrel".to_owned(),
            weight_n: Some(Known { value: 1.0234, std_error: 0.012 }),
            grip_stiffness_n_m: Some(Known { value: 1850.0, std_error: 90.0 }),
            contents: Some(guess(Known { value: 1010.0, std_error: 60.0 })),
            ..Held::default()
        };
        let lines = super::held(&held, Assistant::default());
        assert_eq!(lines[0], ("Weight", "1.02 ± 0.01 N".to_owned()));
        assert_eq!(lines[1], ("Stiffness", "1.85 ± 0.09 N/mm".to_owned()));
        assert_eq!(lines[2], ("Density", "1.01 ± 0.06 g/cm³".to_owned()));
        let parts = Assistant { held: false, ..Assistant::default() };
        assert_eq!(super::held(&held, parts).len(), 1);
        let words = contents(held.contents.as_ref().expect("guessed"));
        assert!(words.starts_with("Inside: water or something like it (") && words.ends_with("%)"), "{words}");
        let near = Slip { free: 0.12, least: 0.01, most: 0.4, by_a_jolt: 0.6 };
        assert_eq!(slip(&near), ("Grip to spare: 12 % (1–40)".to_owned(), Urgency::Danger));
        let hard = Warning::Force { finger: 1, force_n: (3.2, 0.01), limit_n: 3.0, over: true };
        assert_eq!(warning(&hard), ("Right finger: too hard, 3.200 ± 0.010 of 3.0 N".to_owned(), Urgency::Danger));
        let edge = Warning::Edge { finger: 0, left_m: (0.0042, 2e-4), at_m: Vec2::zeros() };
        assert_eq!(warning(&edge).0, "Left finger: 4.2 ± 0.2 mm to the edge of its reach");
    }
}
