//! Test results of the boards behind serial ports.

use super::Check;
use crate::boards::{ADVICE, Answers};
use haptics::device::haply::Tally;
use schemars::JsonSchema;
use serde::Serialize;

/// One check per board, left and right.
pub fn checks(tallies: &[Tally; 2]) -> Vec<Check> {
    ["left", "right"].iter().zip(tallies).map(|(side, tally)| check(side, Answers::from(tally))).collect()
}

fn check(side: &str, answers: Answers) -> Check {
    let ok = answers.are_fine();
    let advice = if ok { String::new() } else { format!(" {ADVICE}") };
    Check::new("answers", ok, format!("The {side} board: {}.{advice}", answers.sentence()))
}

/// Answers of a board.
#[derive(JsonSchema, Serialize)]
pub struct Counts {
    /// Answers that were asked for.
    answers: u64,
    /// Those that did not come or were wrong: the three below together.
    lost_or_wrong: u64,
    /// Too late or cut short.
    late: u64,
    /// With a wrong id or no numbers.
    wrong_id: u64,
    /// Where no hand can be.
    impossible: u64,
}

impl From<&Tally> for Counts {
    fn from(tally: &Tally) -> Self {
        let answers = Answers::from(tally);
        let [late, wrong_id, impossible] = answers.faults;
        Self { answers: answers.asked, lost_or_wrong: answers.lost_or_wrong(), late, wrong_id, impossible }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_broken_answers_are_fine_and_more_are_not() {
        for (faults, asked, ok) in [(0, 3_000, true), (30, 3_000, true), (300, 3_000, false), (600, 600, false)] {
            let check = check("left", Answers { asked, faults: [0, faults, 0] });
            assert_eq!(check.ok, ok, "{}", check.text);
            assert!(check.text.contains(&format!("left board: {faults} of {asked} answers were lost or wrong")));
            assert_eq!(check.text.contains("cable"), !ok);
        }
        assert!(checks(&[Tally::default(), Tally::default()]).iter().all(|check| check.text.contains("0 of 0")));
    }
}
