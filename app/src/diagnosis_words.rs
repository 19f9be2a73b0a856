//! What a diagnosis says, in words: the same for the window and the report.

use estimator::diagnose::{Cause, Diagnosis, Verdict};
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
    let names: Vec<String> = diagnosis.causes.iter().map(|c| title(&c.id)).collect();
    match diagnosis.verdict {
        Verdict::None => "Nothing beyond the noise.".to_owned(),
        Verdict::Unexplained => "Something is there that no known cause explains.".to_owned(),
        Verdict::Causes => format!("{model} misses {}.", listed(&names)),
        Verdict::Ambiguous => {
            let either = |cause: &Cause| {
                let others = diagnosis.alternatives.iter().filter(|a| a.instead_of == cause.id);
                let all: Vec<String> =
                    std::iter::once(&cause.id).chain(others.map(|a| &a.id)).map(|id| small(&title(id))).collect();
                all.join(" or ")
            };
            let open: Vec<String> = diagnosis.causes.iter().map(either).collect();
            format!("{model} misses {}: this recording cannot tell which.", joined(&open))
        }
    }
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

fn joined(words: &[String]) -> String {
    match words {
        [] => "something".to_owned(),
        [one] => one.clone(),
        [most @ .., last] => format!("{} and {last}", most.join(", ")),
    }
}

/// Shown unit of the forces.
pub fn force_unit(diagnosis: &Diagnosis) -> &'static str {
    if diagnosis.course.is_angular { "N·m" } else { "N" }
}

/// `N s/m` → `N·s/m`; nothing for a pure number.
pub fn shown_unit(unit: &str) -> String {
    if unit == "1" { String::new() } else { unit.replace("Nm", "N·m").replace(' ', "·") }
}

/// Shown unit of what a cause's gain is counted in, and its factor from SI.
pub fn gain_unit(cause: &Cause, diagnosis: &Diagnosis) -> (&'static str, f64) {
    match (cause.evidence.contains("of the path"), diagnosis.course.is_angular) {
        (true, _) => ("mm", 1e3),
        (false, true) => ("N·m", 1.0),
        (false, false) => ("N", 1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
