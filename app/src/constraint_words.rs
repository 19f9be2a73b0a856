//! What a fit says of a constraint beside its numbers, in words: the same for the command line and the window.

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
    if let Some(tested) = &constraint.existence {
        words.push(match tested.exists {
            Some(true) => format!("held: unexplained force, p = {:.1e}", tested.p_value),
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
        let high = yielding.interval_n_m.1.map_or("rigid".to_owned(), |h| format!("{h:.0} N/m"));
        words.push(format!("stiffness {:.0} N/m to {high} (95 %)", yielding.interval_n_m.0));
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
        ConstraintKind::Unilateral => "a surface",
        ConstraintKind::Spline => "a guide",
        ConstraintKind::Screw => "a screw",
        ConstraintKind::Undecided => "open",
    }
}
