//! What is said of a Haply board's answers, in the self-test and on the Devices page.

use haptics::device::haply::{Fault, Tally};

/// More lost or wrong answers than this share are a cable or a board to look at. The protocol has no checksum: where many
/// answers are seen to be wrong, some are not seen.
const TOLERATED: f64 = 0.03;

/// What to do about a board that answers badly.
pub const ADVICE: &str = "Check its cable and power, and that nothing else uses its port.";

/// A board's counts, at one moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Answers {
    /// Questions.
    pub asked: u64,
    /// Lost and wrong answers by reason, as in [`Fault::ALL`].
    pub faults: [u64; Fault::ALL.len()],
}

impl From<&Tally> for Answers {
    fn from(tally: &Tally) -> Self {
        // The faults first: what is asked meanwhile can only make the share smaller.
        let faults = Fault::ALL.map(|why| tally.count(why));
        Self { asked: tally.asked(), faults }
    }
}

/// What happened, for people.
fn words(why: Fault) -> &'static str {
    match why {
        Fault::Late => "too late or cut short",
        Fault::Foreign => "with the wrong id or no numbers",
        Fault::Impossible => "where no hand can be",
    }
}

impl Answers {
    /// Lost and wrong answers.
    pub fn lost_or_wrong(&self) -> u64 {
        self.faults.iter().sum()
    }

    /// Whether there are few enough of them.
    pub fn are_fine(&self) -> bool {
        self.lost_or_wrong() as f64 <= TOLERATED * self.asked as f64
    }

    /// `30 of 3000 answers were lost or wrong: 20 too late or cut short, 10 where no hand can be`.
    pub fn sentence(&self) -> String {
        let reasons: Vec<String> = Fault::ALL
            .into_iter()
            .zip(self.faults)
            .filter(|(_, count)| *count > 0)
            .map(|(why, count)| format!("{count} {}", words(why)))
            .collect();
        let tail = if reasons.is_empty() { String::new() } else { format!(": {}", reasons.join(", ")) };
        format!("{} of {} answers were lost or wrong{tail}", self.lost_or_wrong(), self.asked)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reasons_are_counted_and_named() {
        let fine = Answers { asked: 3000, faults: [20, 0, 10] };
        assert!(fine.are_fine());
        assert_eq!(
            fine.sentence(),
            "30 of 3000 answers were lost or wrong: 20 too late or cut short, 10 where no hand can be"
        );
        let bad = Answers { asked: 3000, faults: [0, 100, 0] };
        assert!(!bad.are_fine() && bad.sentence().ends_with("100 with the wrong id or no numbers"));
        assert_eq!(Answers::from(&Tally::default()).sentence(), "0 of 0 answers were lost or wrong");
    }
}
