//! The scripted operator's levels of skill and deliberate mistakes by name: for the command line, the window and sidecars.

use haptics::device::{Mistake, Skill};
use haptics::world::{Shape, World};

/// A level of skill: its name in commands and files, as it is shown, and what it is like.
pub const LEVELS: [(&str, &str, &str); 5] = [
    ("steady", "Steady", "A steady hand that follows its plan: what calibration recordings are made with"),
    ("novice", "Novice", "First time at it: slow, tense, misses and corrects"),
    ("intermediate", "Intermediate", "Has done it some times"),
    ("advanced", "Advanced", "Does it well"),
    ("expert", "Expert", "Quick, light and straight"),
];

/// The level that is meant when none is named.
pub const USUAL: &str = LEVELS[0].0;

/// A level by its name; the error is one sentence with all the names.
pub fn skill(name: &str) -> Result<Skill, String> {
    Skill::from_name(name).ok_or_else(|| {
        let names = LEVELS.map(|(name, ..)| name).join(", ");
        format!("there is no level of skill `{name}`; choose one of {names}")
    })
}

/// A mistake's name in commands and files.
pub fn mistake_name(mistake: Mistake) -> &'static str {
    match mistake {
        Mistake::WeakPinch => "weak-pinch",
        Mistake::Crush => "crush",
        Mistake::MisalignedStack => "misaligned-stack",
        Mistake::EarlyRelease => "early-release",
        Mistake::WrongDirection => "wrong-direction",
        Mistake::Overshoot => "overshoot",
    }
}

/// What happens, for people.
pub fn mistake_words(mistake: Mistake) -> (&'static str, &'static str) {
    match mistake {
        Mistake::WeakPinch => ("Weak pinch", "The pinch loosens on the way up: the block slips and falls"),
        Mistake::Crush => ("Crushing pinch", "The pinch is several times too hard"),
        Mistake::MisalignedStack => ("Crooked stack", "The block is put down beside the middle of the one below"),
        Mistake::EarlyRelease => ("Letting go too early", "The block is let go on the way"),
        Mistake::WrongDirection => ("Wrong direction", "The first turn starts the wrong way round"),
        Mistake::Overshoot => ("Pushing too far", "The needle goes far beyond the sheet"),
    }
}

/// A mistake by its name; the error is one sentence with all the names.
pub fn mistake(name: &str) -> Result<Mistake, String> {
    Mistake::ALL.into_iter().find(|mistake| mistake_name(*mistake) == name).ok_or_else(|| {
        let names = Mistake::ALL.map(mistake_name).join(", ");
        format!("there is no mistake `{name}`; choose one of {names}")
    })
}

/// The mistakes that the operator can make in a world. It does one task a world: the first of crank, sheet, switch, barrel,
/// blocks that stands in it.
pub fn mistakes_in(world: &World) -> Vec<Mistake> {
    let fits = |mistake: &Mistake| {
        if world.crank.is_some() {
            matches!(mistake, Mistake::Crush | Mistake::WrongDirection)
        } else if world.membrane.is_some() {
            *mistake == Mistake::Overshoot
        } else if world.switch.is_some() {
            false
        } else if world.blocks.iter().any(|block| block.shape == Shape::Barrel) {
            *mistake == Mistake::Crush
        } else {
            !world.blocks.is_empty() && mistake.is_of_blocks()
        }
    };
    Mistake::ALL.into_iter().filter(fits).collect()
}

/// Refuses mistakes that a world gives no occasion for, in one sentence.
pub fn check_mistakes(mistakes: &[Mistake], world: &World) -> Result<(), String> {
    let possible = mistakes_in(world);
    let Some(wrong) = mistakes.iter().find(|mistake| !possible.contains(mistake)) else { return Ok(()) };
    let name = mistake_name(*wrong);
    if possible.is_empty() {
        return Err(format!("the operator makes no mistakes in this world, so not `{name}` either"));
    }
    let names: Vec<&str> = possible.into_iter().map(mistake_name).collect();
    Err(format!("there is no occasion for `{name}` in this world; here the operator can make {}", names.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::device::{Device as _, ScriptedOperator};
    use haptics::world::{State, presets};

    #[test]
    fn names_are_read_and_unknown_ones_answered_with_all_that_exist() {
        for (name, ..) in LEVELS {
            assert!(skill(name).is_ok(), "{name}");
        }
        assert_eq!(skill(USUAL), Ok(Skill::default()));
        let error = skill("genius").expect_err("no such level");
        assert!(LEVELS.iter().all(|(name, ..)| error.contains(name)), "{error}");
        for known in Mistake::ALL {
            assert_eq!(mistake(mistake_name(known)), Ok(known));
        }
        let error = mistake("sneeze").expect_err("no such mistake");
        assert!(Mistake::ALL.iter().all(|known| error.contains(mistake_name(*known))), "{error}");
    }

    /// How far the wanted fingers of two operators are apart at the most, m, during their first 30 s over an empty force.
    fn difference(world: &World, mistakes: &[Mistake]) -> f64 {
        let state = State::resting(world);
        let operator = |mistakes| ScriptedOperator::with_mistakes(world, &state, Skill::default(), mistakes, 3);
        let (mut usual, mut other) = (operator(&[]), operator(mistakes));
        let command = haptics::device::Command::default();
        (0..30_000)
            .map(|_| {
                let (a, b) = (usual.exchange(&command, 1e-3), other.exchange(&command, 1e-3));
                (0..2).map(|f| (a.tip_in_world[f] - b.tip_in_world[f]).norm()).fold(0.0, f64::max)
            })
            .fold(0.0, f64::max)
    }

    #[test]
    fn exactly_the_mistakes_that_are_offered_change_what_the_operator_does() {
        for world in presets::all() {
            let offered = mistakes_in(&world);
            for mistake in Mistake::ALL {
                let differs = difference(&world, &[mistake]) > 1e-6;
                assert_eq!(offered.contains(&mistake), differs, "{mistake:?} in {}", world.name);
                assert_eq!(check_mistakes(&[mistake], &world).is_ok(), differs);
            }
        }
        let refused = check_mistakes(&[Mistake::Overshoot], &presets::barrel()).expect_err("no needle there");
        assert!(refused.contains("overshoot") && refused.contains("crush"), "{refused}");
    }
}
