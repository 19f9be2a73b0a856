//! Explanations of quantities for tooltips: the meaning, and the effect as a formula.

/// A quantity in two sentences.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lesson {
    /// Meaning of the quantity.
    pub what: &'static str,
    /// Effect of the quantity as a formula; empty where there is none.
    pub formula: &'static str,
}

const fn lesson(what: &'static str, formula: &'static str) -> Lesson {
    Lesson { what, formula }
}

/// Explanation of a fitted parameter; `None` for one that explains itself.
pub fn parameter(name: &str) -> Option<Lesson> {
    let of_a_turn = name.ends_with("_Nm") || name.ends_with("_Nm_s");
    let stem = stem(name);
    material(stem, of_a_turn).or_else(|| place(stem)).or_else(|| object(stem))
}

/// Name without its unit.
fn stem(name: &str) -> &str {
    const UNITS: [&str; 18] = [
        "_per_mass_m_s2",
        "_kg_m2",
        "_kg_m3",
        "_kg_s",
        "_N_s_m",
        "_N_m3",
        "_N_m2",
        "_Nm_s",
        "_N_m",
        "_Nm",
        "_m_s2",
        "_m_s",
        "_kg",
        "_rad",
        "_m",
        "_N",
        "_mu",
        "_s",
    ];
    UNITS.iter().find_map(|unit| name.strip_suffix(unit)).unwrap_or(name)
}

fn material(stem: &str, of_a_turn: bool) -> Option<Lesson> {
    Some(match stem {
        "weight" => lesson("The force with which gravity pulls it down.", "F = m g"),
        "mass" => lesson("How much it resists being sped up, and how heavy it is.", "F = m a"),
        "inertia" => lesson("How much it resists being turned faster or slower.", "τ = J α"),
        "coulomb" if of_a_turn => lesson("Dry friction: as large at any speed, against the turning.", "τ = τc sign(ω)"),
        "coulomb" => lesson("Dry friction: as large at any speed, against the motion.", "F = Fc sign(v)"),
        "viscous" if of_a_turn => lesson("Friction that grows with the speed, as in oil.", "τ = b ω"),
        "viscous" | "damping" => lesson("Friction that grows with the speed, as in oil.", "F = b v"),
        "friction" => lesson("Friction where it began to slide: the shear there over the normal force.", "μ = Ft / Fn"),
        "friction_lower_bound" => lesson(
            "It held at least this much shear for its normal force; it never slid, so it may hold more.",
            "μ ≥ Ft / Fn",
        ),
        "shaft_friction" => lesson("Dry friction between the needle's shaft and the sheet.", "F = Fc sign(v)"),
        "stiffness" => lesson("Force for every metre that it gives.", "F = k x"),
        "hardening" => lesson("How much stiffer it becomes with depth.", "F = k x + h x³"),
        "shear_stiffness" => lesson("Force for every metre that the pads give sideways.", "Ft = ks x"),
        "gravity_moment" => lesson("The largest torque of its own weight about the axis.", "τ = m g r cos φ"),
        "offset" => lesson("A constant force: of a spring, a tilt, or a sensor's zero.", "F = F0"),
        "resistance" => lesson("Force against the motion, all kinds together.", ""),
        _ => return None,
    })
}

fn place(stem: &str) -> Option<Lesson> {
    Some(match stem {
        "width" | "knob_width" | "handle_width" => {
            lesson("The distance of the pads when they just touch: their give is taken out.", "w = d(F → 0)")
        }
        "height" => lesson("The rise from its resting place to that of what it was put on.", ""),
        "radius" => lesson("Radius of the circle that the grasp follows.", ""),
        "center_x" | "center_y" | "center" => lesson("The point about which the handle turns.", ""),
        "surface_position" | "surface" => lesson("Where the sheet lies before it is touched.", ""),
        "gravity_phase" => lesson("The angle at which the weight's torque is largest.", ""),
        "direction" => lesson("The way that it moves, counter-clockwise from the horizontal.", ""),
        "travel" => lesson("The way from one end stop to the other.", ""),
        "snap_position" => lesson("Where the resistance passes from one side to the other.", ""),
        "length" => lesson("Length of the cable when it is just taut.", ""),
        "anchor_x" | "anchor_y" => lesson("Where the cable is tied.", ""),
        _ => return None,
    })
}

fn object(stem: &str) -> Option<Lesson> {
    Some(match stem {
        "puncture_force" => lesson("The force at which the needle goes through.", ""),
        "peak_force" => lesson("The largest resistance before it gives way.", ""),
        "trough_force" | "return_trough_force" => lesson("The smallest resistance after it has given way.", ""),
        "constraint_stiffness" | "wall_stiffness" | "stop_stiffness" => {
            lesson("Force for every metre beyond where it should stop; hand and sensors give, too.", "F = k x")
        }
        "leak" => lesson("How much it loses every second.", "m(t) = m0 − ṁ t"),
        "density" | "content_density" => lesson("Mass for its volume: a hint at what is inside.", "ρ = m / V"),
        "content_mass" => lesson("What is inside weighs the whole less the empty one.", "m = m_all − m_empty"),
        "largest_tension" => lesson("The largest pull of the cable that was seen.", ""),
        "com" => lesson("Distance of the centre of mass from the axis.", ""),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::tests::{CRANK, STACK, cart, session};

    #[test]
    fn what_fits_find_is_explained() {
        for recording in [STACK.clone(), CRANK.clone(), cart()] {
            let session = session(recording);
            for parameter in &session.calibration.analysis.as_ref().expect("fitted").fit.parameters {
                assert!(super::parameter(&parameter.name).is_some(), "{}", parameter.name);
            }
        }
    }

    #[test]
    fn torques_are_told_from_forces_and_sentences_end() {
        assert_eq!(parameter("coulomb_Nm").map(|l| l.formula), Some("τ = τc sign(ω)"));
        assert_eq!(parameter("coulomb_N").map(|l| l.formula), Some("F = Fc sign(v)"));
        assert_eq!(parameter("mass_kg").map(|l| l.formula), Some("F = m a"));
        assert_eq!(parameter("nonsense_V"), None);
        for name in ["weight_N", "friction_lower_bound", "center_x_m", "leak_kg_s", "friction_mu", "inertia_kg_m2"] {
            assert!(parameter(name).is_some_and(|l| l.what.ends_with('.')), "{name}");
        }
    }
}
