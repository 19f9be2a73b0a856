//! What a fit says of a constraint beside its numbers, in words: the same for the command line and the window.

use crate::text::format;
use estimator::constraint::existence::{probability, sentence};
use estimator::estimate::{Constraint, ConstraintKind, Sided};

/// One short sentence a fact, without a full stop.
pub fn constraint_words(constraint: &Constraint) -> Vec<String> {
    let mut words = Vec::new();
    if let Some(leaning) = &constraint.leaning {
        let kind = kind_word(leaning.kind);
        words.push(match leaning.probability {
            Some(p) => format!("most likely {kind} (probability {p:.2})"),
            None => format!("most likely {kind}"),
        });
    }
    // Where the evidence has the test already, it is not told twice.
    if let Some(tested) = constraint.existence.as_ref().filter(|t| !constraint.evidence.contains(&sentence(t))) {
        words.push(match tested.exists {
            Some(true) => format!("held: unexplained force, p {}", probability(tested.p_value)),
            Some(false) => format!("nothing holds it: {:.3} N would have been seen", tested.detectable_n),
            None => "whether anything holds it stays open".to_owned(),
        });
    }
    match constraint.sided {
        Some(Sided::OneSided) => words.push("loaded from one side only".to_owned()),
        Some(Sided::TwoSided) => words.push("holds both ways".to_owned()),
        None => {}
    }
    if let Some(yielding) = &constraint.yielding {
        let high = yielding.interval_n_m.1.map_or("rigid".to_owned(), stiffness);
        words.push(format!(
            "its own stiffness, without the pads: {} to {high} (95 %)",
            stiffness(yielding.interval_n_m.0)
        ));
    }
    if let Some(pitch) = constraint.screw.as_ref().filter(|_| constraint.kind == ConstraintKind::Screw)
        && let Some(value) = pitch.pitch_m_rad
    {
        words.push(format!("pitch {:.2} mm a turn", 1e3 * std::f64::consts::TAU * value));
    }
    if let Some(guide) = &constraint.guide {
        words.push(format!(
            "written with {} control points, {:.2} mm from the recorded path (root mean square)",
            guide.points_m.len(),
            1e3 * guide.rms_m
        ));
    }
    for slip in &constraint.slips {
        let size = slip.displacement_m.iter().map(|d| d * d).sum::<f64>().sqrt();
        let when = slip.time_s.map_or(format!("sample {}", slip.sample), |t| format!("{t:.2} s"));
        words.push(format!("slipped by {:.2} mm at {when}", 1e3 * size));
    }
    if !constraint.phases.is_empty() {
        words.push(format!("{} phases of pushing in and drawing out", constraint.phases.len()));
    }
    words
}

fn kind_word(kind: ConstraintKind) -> &'static str {
    match kind {
        ConstraintKind::Revolute => "a hinge",
        ConstraintKind::Prismatic => "a slide",
        ConstraintKind::Free => "free",
        ConstraintKind::Membrane => "a membrane",
        ConstraintKind::Unilateral => "a surface or a cable",
        ConstraintKind::Spline => "a guide",
        ConstraintKind::Screw => "a screw",
        ConstraintKind::Undecided => "open",
    }
}

/// A stiffness with as many digits as one end of an interval is worth.
fn stiffness(value_n_m: f64) -> String {
    if value_n_m >= 1e4 {
        return format!("{} kN/m", rounded(1e-3 * value_n_m));
    }
    format!("{} N/m", rounded(value_n_m))
}

/// To two significant digits, also before the point.
fn rounded(value: f64) -> String {
    let step = 10_f64.powi((value.abs().max(1e-9).log10().floor() as i32 - 1).max(0));
    format::significant((value / step).round() * step, 2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use estimator::estimate::{Existence, Yielding};

    #[test]
    fn stiffness_has_the_digits_that_it_is_worth() {
        assert_eq!(stiffness(369_285.0), "370 kN/m");
        assert_eq!(stiffness(4894.2), "4900 N/m");
        assert_eq!(stiffness(12_345.0), "12 kN/m");
        assert_eq!(stiffness(0.0), "0 N/m");
    }

    #[test]
    fn a_test_that_the_evidence_tells_is_not_told_again() {
        let tested = Existence {
            exists: Some(true),
            p_value: 2.48e-8,
            false_alarm_rate: 0.01,
            unexplained_n: 0.33,
            std_error_n: 0.119,
            unexplained_rms_n: 0.4,
            detectable_n: 0.2,
            effective_samples: 30.0,
            direction: "normal".to_owned(),
        };
        let mut constraint = Constraint::blank(None, "a circle");
        constraint.yielding =
            Some(Yielding { stiffness_n_m: None, interval_n_m: (369_285.0, None), manipulator_n_m: 1000.0 });
        constraint.existence = Some(tested.clone());
        assert_eq!(
            constraint_words(&constraint),
            [
                "held: unexplained force, p = 2.5 × 10⁻⁸",
                "its own stiffness, without the pads: 370 kN/m to rigid (95 %)"
            ]
        );
        constraint.evidence = format!("a circle; {}", sentence(&tested));
        assert!(constraint.evidence.contains("p = 2.5 × 10⁻⁸"), "{}", constraint.evidence);
        assert_eq!(constraint_words(&constraint).len(), 1);
    }
}
