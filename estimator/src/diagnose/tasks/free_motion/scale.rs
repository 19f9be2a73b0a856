//! Texts of a free motion: units, warnings, causes not excited, next experiment.

use crate::diagnose::answer::build::Named;
use crate::diagnose::contract::NotExcited;
use crate::diagnose::data::regression_data::{Model, Track};
use crate::diagnose::hypotheses::all::with_both_ways;
use crate::diagnose::hypotheses::{force_bias, force_gain};
use crate::diagnose::tasks::free_motion::Scale;
use estimation::identify::mechanism::Stated;
use haptics::law::Coordinate;

/// Causes that a motion without a force sensor never shows.
const HIDDEN: [&str; 2] = [force_gain::ID, force_bias::ID];

/// Adapts texts that were written for a driven motion.
pub fn put_right(found: &mut Named, track: &Track, both_ways: bool) {
    let Some(free) = track.freely else { return };
    let angular = track.coordinate == Coordinate::Angular;
    for parameter in found.causes.iter_mut().flat_map(|c| &mut c.parameters) {
        if parameter.unit.starts_with('N') {
            parameter.std_error = parameter.std_error.hypot(parameter.value * free.relative_error);
            if !free.is_known {
                parameter.unit = per_inertia(&parameter.unit).to_owned();
            }
        }
    }
    for hidden in &mut found.not_excited {
        hidden.why = format!(
            "this free motion hides it behind the model's own terms; {}",
            if angular { "release it from farther away, or from both sides" } else { "let it go faster, or both ways" }
        );
    }
    found.not_excited.extend(HIDDEN.map(|id| NotExcited {
        id: id.to_owned(),
        why: "the recording has no force column, so there is no force sensor whose gain or bias could show".to_owned(),
    }));
    if !both_ways {
        found.not_excited.extend(with_both_ways().map(|id| NotExcited {
            id: id.to_owned(),
            why: "it goes one way only and slows down, which is then the same as friction, or as friction that changes with speed; let it \
                  go the other way, too"
                .to_owned(),
        }));
    }
}

/// The terms of the model, each once, the inertia first.
pub fn model_name(model: &Model) -> String {
    let mut names = vec!["inertia"];
    for effect in model {
        if !names.contains(&effect.law().id()) {
            names.push(effect.law().id());
        }
    }
    names.join("+")
}

/// A unit of the laws per kg m² or kg.
fn per_inertia(unit: &str) -> &str {
    const UNITS: [(&str, &str); 11] = [
        ("N m", "rad/s²"),
        ("N m s", "1/s"),
        ("N m s²", "1/rad"),
        ("N m/rad", "1/s²"),
        ("N m/rad³", "1/(rad² s²)"),
        ("N", "m/s²"),
        ("N s/m", "1/s"),
        ("N s²/m²", "1/m"),
        ("N/m", "1/s²"),
        ("N/m³", "1/(m² s²)"),
        ("N/m^1.5", "1/(m^0.5 s²)"),
    ];
    UNITS.iter().find(|(of, _)| *of == unit).map_or(unit, |(_, per)| per)
}

/// Sentence on the source of the scale of all values; `None` for a driven motion.
pub fn sentence(track: &Track, scale: Scale) -> Option<String> {
    let free = track.freely?;
    let angular = track.coordinate == Coordinate::Angular;
    let (what, unit) = if angular { ("moment of inertia", "kg m²") } else { ("mass", "kg") };
    let name = if angular { "inertia_kg_m2, or mass_kg and com_m of a pendulum" } else { "mass_kg" };
    let inertia = free.inertia;
    Some(match scale {
        Scale::Stated => {
            format!(
                "there is no force column: the motion is taken to be free, with the stated {what} of {inertia:.4} {unit}"
            )
        }
        Scale::ByRatio(by) => format!(
            "there is no force column: the motion is taken to be free, and the known {} gives a {what} of {inertia:.4} {unit} ± {:.2} % \
             beside what was found",
            known(by),
            100.0 * free.relative_error
        ),
        Scale::Hidden => format!(
            "there is no force column, and what the sidecar knows does not show in this motion: all values are per unit of {what} (1 {unit}); \
             state {name} under \"known\" in the sidecar"
        ),
        Scale::Nothing => format!(
            "there is no force column and nothing is known: all values are per unit of {what} (1 {unit}); state {name} under \"known\" in the \
             sidecar"
        ),
    })
}

fn known(by: Stated) -> &'static str {
    match by {
        Stated::Inertia(_) => "inertia",
        Stated::Gravity(_) => "gravity moment",
        Stated::Viscous(_) => "viscous friction",
        Stated::Coulomb(_) => "Coulomb friction",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::hypotheses::all::can_show;
    use haptics::law::{EccentricMass, Effect, Law, ViscousFriction, entries};

    #[test]
    fn units_are_per_unit_of_inertia() {
        assert_eq!(per_inertia("N m"), "rad/s²");
        // Every law that a free motion can show has its units in the table.
        let laws = entries().filter(|e| can_show(e.id, true));
        for spec in laws.flat_map(|e| e.parameters) {
            for unit in [spec.unit, spec.unit_angular] {
                assert!(!per_inertia(unit).starts_with('N'), "{unit} of {}", spec.name);
            }
        }
    }

    #[test]
    fn a_model_names_each_term_once() {
        let laws: [&'static dyn Law; 3] = [&EccentricMass, &EccentricMass, &ViscousFriction];
        let model: Model = laws.map(|law| Effect::new(law, &[1.0])).to_vec();
        assert_eq!(model_name(&model), "inertia+eccentric-mass+viscous-friction");
        assert_eq!(model_name(&Model::new()), "inertia");
    }
}
