//! What a diagnosis says, in words: the same for the window and the report.

use crate::text::format::capitalised;
use crate::text::states::state_name;
use estimator::diagnose::{Cause, CauseParameter, Diagnosis, Findings, ModelError, Residual, Verdict};
use estimator::segment::SystemState;
use estimator::words::{self, amount};
use haptics::law;

/// What a cause is called.
pub fn title(id: &str) -> String {
    match law::cause(id) {
        Some(entry) => entry.title.to_owned(),
        None if id.starts_with("other:") => "Something without a name".to_owned(),
        None => id.to_owned(),
    }
}

/// The answer in one line.
pub fn headline(diagnosis: &Diagnosis) -> String {
    headline_of("The model", diagnosis)
}

/// The answer in one line, about what was compared.
pub fn headline_of(model: &str, diagnosis: &Diagnosis) -> String {
    let certain = diagnosis.certain();
    let names: Vec<String> = certain.iter().map(|c| one(&c.id)).collect();
    match diagnosis.verdict {
        Verdict::None => "Nothing beyond the noise.".to_owned(),
        Verdict::Unexplained => unexplained(diagnosis),
        Verdict::Causes => format!("{model} misses {}.", joined(&names)),
        Verdict::Ambiguous if certain.is_empty() => {
            "This recording cannot tell which cause, if any, is there.".to_owned()
        }
        Verdict::Ambiguous => {
            let either = |cause: &Cause| {
                let others = diagnosis.alternatives.iter().filter(|a| a.instead_of == cause.id);
                let all: Vec<String> =
                    std::iter::once(&cause.id).chain(others.map(|a| &a.id)).map(|id| one(id)).collect();
                all.join(" or ")
            };
            let open: Vec<String> = certain.into_iter().map(either).collect();
            format!("{model} misses {}: this recording cannot tell which.", joined(&open))
        }
    }
}

/// Size and first variable of a model error, or that there is one; with the share of the strongest cause, if one is
/// certain.
fn unexplained(diagnosis: &Diagnosis) -> String {
    let variable = |error: &ModelError| Some((error.rms_n, error.over.first()?.variable.clone()));
    let error = diagnosis.model_error.as_ref().and_then(variable);
    let Some(((rms, variable), unit)) = error.zip(diagnosis.baseline.unit.as_ref()) else {
        return "Something is there that no known cause explains.".to_owned();
    };
    let found = diagnosis.certain().first().map_or_else(String::new, |cause| {
        let share = 100.0 * cause.gain.share_of_explainable.clamp(0.0, 1.0);
        format!("{} explains {share:.0} %; ", capitalised(&one(&cause.id)))
    });
    format!("{found}{} RMS go with {variable} and no known cause.", amount(rms, unit))
}

/// `a, b and c`, with small letters.
pub fn listed(names: &[String]) -> String {
    joined(&names.iter().map(|n| small(n)).collect::<Vec<_>>())
}

/// With a small letter in front, unless it is a person's name.
pub fn small(name: &str) -> String {
    if ["Coulomb", "Stribeck"].iter().any(|person| name.starts_with(person)) {
        return name.to_owned();
    }
    let mut letters = name.chars();
    letters.next().map_or_else(String::new, |first| first.to_lowercase().chain(letters).collect())
}

/// The name of a cause as one speaks of one: `an eccentric mass`, `Coulomb friction`, `the give of the pads`.
pub fn one(id: &str) -> String {
    /// What is not counted.
    const STUFF: [&str; 7] = ["friction", "inertia", "drag", "backlash", "hysteresis", "cross-talk", "slip"];
    /// What there is one of in any case: the fault is its size.
    const OWN: [&str; 4] = ["give", "gain", "scale", "weight"];
    let name = small(&title(id));
    if law::cause(id).is_none() {
        return name;
    }
    let of_what = name.split_once(" of ").or_else(|| name.split_once(" in ")).map_or(name.as_str(), |(what, _)| what);
    let what = of_what.rsplit(' ').next().unwrap_or(of_what).to_lowercase();
    if STUFF.contains(&what.as_str()) {
        name
    } else if OWN.contains(&of_what) {
        format!("the {name}")
    } else if name.starts_with(['a', 'e', 'i', 'o', 'u']) {
        format!("an {name}")
    } else {
        format!("a {name}")
    }
}

fn joined(words: &[String]) -> String {
    match words {
        [] => "something".to_owned(),
        [one] => one.clone(),
        [most @ .., last] => format!("{} and {last}", most.join(", ")),
    }
}

/// A parameter's name as a formula has it: `A cos phi` → `A cos φ`.
pub fn symbol(name: &str) -> String {
    const LETTERS: [(&str, &str); 7] =
        [("phi", "φ"), ("lambda", "λ"), ("delta", "δ"), ("tau", "τ"), ("kappa", "κ"), ("mu", "μ"), ("sigma", "σ")];
    let letter = |word: &str| {
        let end = word.trim_end_matches(|c: char| !c.is_alphabetic());
        let found = LETTERS.iter().find(|(spelt, _)| *spelt == end);
        found.map_or_else(|| word.to_owned(), |(spelt, letter)| word.replacen(spelt, letter, 1))
    };
    let spelt = name.replace('-', "−");
    spelt.split_inclusive(|c: char| !c.is_alphabetic()).map(letter).collect()
}

/// What a parameter says that is no quantity: which axes point the other way, or are swapped; which block it is about.
pub fn said_in_words(parameter: &CauseParameter) -> Option<String> {
    if parameter.name == "block" {
        return Some(format!("at block {:.0}", parameter.value));
    }
    let which = parameter.name.strip_prefix("which: ")?;
    Some(match which.split_once(" with ") {
        Some((one, other)) => format!("{one} and {other} are swapped"),
        None if which.contains(" and ") => format!("{which} point the other way"),
        None => format!("{which} points the other way"),
    })
}

/// Shown unit of what was compared.
pub fn compared_unit(diagnosis: &Findings) -> String {
    diagnosis.baseline.unit.as_deref().map_or_else(|| force_unit(diagnosis).to_owned(), shown_unit)
}

/// A state within a sentence.
pub fn state_in_words(state: SystemState) -> String {
    if state == SystemState::NoState { "in between".to_owned() } else { small(state_name(state)) }
}

/// Shown unit of what is left of one channel in its states, and its factor from SI.
pub fn residual_unit(left: &[&Residual]) -> (String, f64) {
    let most = left.iter().flat_map(|l| [l.rms_before, l.noise_floor.unwrap_or(0.0)]).fold(0.0, f64::max);
    prefixed(left.first().map_or("", |l| l.unit.as_str()), most)
}

/// Shown unit of a number of this size, with its prefix, and its factor from SI.
fn prefixed(unit: &str, size: f64) -> (String, f64) {
    let (scale, prefix) = words::prefix(size, unit);
    (format!("{prefix}{}", shown_unit(unit)), scale.recip())
}

/// Shown unit of the forces.
pub fn force_unit(diagnosis: &Findings) -> &'static str {
    diagnosis.course.force_unit()
}

/// `N s/m` → `N·s/m`; nothing for a pure number.
pub fn shown_unit(unit: &str) -> String {
    if unit == "1" { String::new() } else { unit.replace("Nm", "N·m").replace(' ', "·") }
}

/// Shown unit of what a cause's gain is counted in, and its factor from SI.
pub fn gain_unit(cause: &Cause, diagnosis: &Findings) -> (String, f64) {
    match cause.gain.unit.as_deref() {
        Some(unit) => prefixed(unit, cause.gain.heldout_rms_before),
        None => prefixed(force_unit(diagnosis), cause.gain.heldout_rms_before),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_that_point_the_other_way_are_said_and_quantities_are_not() {
        let said = |name: &str| {
            let parameter = CauseParameter { name: name.to_owned(), value: -1.0, std_error: 0.0, unit: "1".to_owned() };
            said_in_words(&parameter)
        };
        assert_eq!(said("which: fx1_N").as_deref(), Some("fx1_N points the other way"));
        assert_eq!(said("which: fx and fy").as_deref(), Some("fx and fy point the other way"));
        assert_eq!(said("which: fx with fy").as_deref(), Some("fx and fy are swapped"));
        assert_eq!(said("mu"), None);
    }

    #[test]
    fn letters_that_are_spelt_out_become_letters_and_words_stay() {
        let all = ["A cos phi", "A sin(-phi)", "lambda", "kappa_xy", "Fc", "maximum", "g - 1"].map(symbol);
        assert_eq!(all, ["A cos φ", "A sin(−φ)", "λ", "κ_xy", "Fc", "maximum", "g − 1"]);
    }

    #[test]
    fn a_cause_is_spoken_of_with_its_article() {
        let spoken: Vec<String> = law::causes().map(|entry| one(entry.id)).collect();
        for name in [
            "an eccentric mass",
            "a tilted plane",
            "Coulomb friction",
            "Stribeck friction",
            "changing friction",
            "a changing weight",
            "the give of the pads",
            "the gain of the force channel",
            "cross-talk of the force axes",
            "slip in the fingers",
            "a delay between channels",
            "an offset of a joint sensor",
            "a loss at an impact",
        ] {
            assert!(spoken.iter().any(|s| s == name), "{name} is not in {spoken:?}");
        }
        assert_eq!(one("other:moves"), "something without a name");
        let bare = |s: &&String| !["a ", "an ", "the "].iter().any(|article| s.starts_with(article));
        let bare: Vec<&String> = spoken.iter().filter(bare).collect();
        assert!(2 * bare.len() < spoken.len(), "only what is not counted goes without: {bare:?}");
    }

    #[test]
    fn names_are_listed_as_in_a_sentence() {
        let list = |names: &[&str]| listed(&names.iter().map(|n| (*n).to_owned()).collect::<Vec<_>>());
        assert_eq!(
            list(&["Backlash", "Coulomb friction", "Return spring"]),
            "backlash, Coulomb friction and return spring"
        );
        assert_eq!(list(&["Tilted plane"]), "tilted plane");
    }
}
