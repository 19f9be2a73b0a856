//! What a test says of the boards behind serial ports.

use super::Check;
use haptics::device::haply::Tally;
use serde_json::{Value, json};

/// More lost or wrong answers than this share are a cable or a board to look at. The protocol has no checksum: where many
/// answers are seen to be wrong, some are not seen.
const TOLERATED: f64 = 0.03;

/// One check a board, left and right.
pub fn checks(tallies: &[Tally; 2]) -> Vec<Check> {
    ["left", "right"].iter().zip(tallies).map(|(side, tally)| check(side, tally.faults(), tally.asked())).collect()
}

fn check(side: &str, faults: u64, asked: u64) -> Check {
    let ok = faults as f64 <= TOLERATED * asked as f64;
    let advice = if ok { "" } else { " Check its cable and power, and that nothing else uses its port." };
    Check::new("answers", ok, format!("The {side} board: {faults} of {asked} answers were lost or wrong.{advice}"))
}

/// The counts.
pub fn json(tally: &Tally) -> Value {
    json!({ "answers": tally.asked(), "lost_or_wrong": tally.faults() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_broken_answers_are_fine_and_more_are_not() {
        for (faults, asked, ok) in [(0, 3_000, true), (30, 3_000, true), (300, 3_000, false), (600, 600, false)] {
            let check = check("left", faults, asked);
            assert_eq!(check.ok, ok, "{}", check.text);
            assert!(check.text.contains(&format!("left board: {faults} of {asked} answers were lost or wrong.")));
            assert_eq!(check.text.contains("cable"), !ok);
        }
        assert!(checks(&[Tally::default(), Tally::default()]).iter().all(|check| check.text.contains("0 of 0")));
    }
}
