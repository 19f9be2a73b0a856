//! Cases with structured model error as the tables of [`super::certain`] count them, whatever was recorded.

use super::effect::Effect;
use super::score::{Row, stated_set};
use super::sets::Set;
use super::tolerated::tolerated;
use estimator::diagnose::{Findings, Verdict};

/// A cause is certain above this posterior.
///
/// Choice: the odds at which a reader stops to look further.
pub const CERTAIN: f64 = 0.95;

/// A named cause beside the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Name<'a> {
    /// Its id.
    pub id: &'a str,
    /// Its posterior.
    pub posterior: f64,
    /// The verdict is `causes` and the posterior is above [`CERTAIN`].
    pub is_certain: bool,
    /// Hidden, or exactly equal to what is.
    pub is_right: bool,
    /// It describes the structure itself.
    pub is_tolerated: bool,
}

/// A case with its answer.
pub trait Counted {
    /// Object and length in words.
    fn group(&self) -> &str;
    /// Family of the structured model error; empty without any.
    fn family(&self) -> &str;
    /// [`Set::Structured`] where nothing else is hidden, [`Set::Beside`] where an effect is.
    fn set(&self) -> Set;
    /// The wanted size could not be had: the case does not count.
    fn is_missed(&self) -> bool;
    /// The answer, or the sentence of the error.
    fn answer(&self) -> Result<&Findings, &str>;
    /// Ids of causes from the catalogue that are hidden, and of those that nobody can tell from them.
    fn right_ids(&self) -> Vec<&str>;
    /// Ids that describe the structure itself.
    fn tolerated_ids(&self) -> &[&str];
    /// Ids of what is there in any case, and no question: their names do not count.
    fn ids_besides(&self) -> &[&str] {
        &[]
    }
    /// Noise of a reading, N.
    fn noise_n(&self) -> f64;
    /// Stated noise floor over the noise where the structure is left out; not a number beside an effect.
    fn clean_floor(&self) -> f64;

    /// All named causes, strongest first (terms without a name are none).
    fn names(&self) -> Vec<Name<'_>> {
        let (Ok(answer), right, tolerated) = (self.answer(), self.right_ids(), self.tolerated_ids()) else {
            return Vec::new();
        };
        let counts = |id: &str| !id.starts_with("other:") && !self.ids_besides().contains(&id);
        let named = answer.causes.iter().filter(|c| counts(&c.id));
        named
            .map(|c| Name {
                id: &c.id,
                posterior: c.posterior,
                is_certain: answer.verdict == Verdict::Causes && c.posterior > CERTAIN,
                is_right: right.contains(&c.id.as_str()),
                is_tolerated: tolerated.contains(&c.id.as_str()),
            })
            .collect()
    }

    /// Number of certain names that are wrong, and without those that describe the structure.
    fn false_certain(&self) -> [usize; 2] {
        let names = self.names();
        let wrong = || names.iter().filter(|n| n.is_certain && !n.is_right);
        [wrong().count(), wrong().filter(|n| !n.is_tolerated).count()]
    }

    /// The first name is right and certain.
    fn right_for_certain(&self) -> bool {
        self.names().first().is_some_and(|n| n.is_certain && n.is_right)
    }

    /// The same, or the hidden cause is among what the answer says it could be.
    fn right_or_in_set(&self) -> bool {
        let set = self.answer().map_or_else(|_| Vec::new(), stated_set);
        self.right_for_certain() || self.right_ids().iter().any(|id| set.contains(id))
    }

    /// True for an answer with that verdict.
    fn has_verdict(&self, verdict: Verdict) -> bool {
        self.answer().is_ok_and(|a| a.verdict == verdict)
    }

    /// Stated noise floor over the noise that there is.
    fn floor_over_noise(&self) -> f64 {
        self.answer().map_or(f64::NAN, |a| a.noise_floor_n / self.noise_n())
    }

    /// Verdict, and names with their posteriors, in a line.
    fn told(&self) -> String {
        let verdict =
            self.answer().map_or_else(|e| format!("error: {e}"), |a| format!("{:?}", a.verdict).to_lowercase());
        let name = |n: &Name<'_>| format!("{}{} {:.3}", n.id, if n.is_right { " (right)" } else { "" }, n.posterior);
        let names: Vec<String> = self.names().iter().map(name).collect();
        format!("{verdict}|{}{}", names.join(", "), if self.is_missed() { "|missed" } else { "" })
    }
}

impl Row {
    /// The structured model error in this case.
    pub fn structure(&self) -> Option<Effect> {
        self.hidden.iter().map(|(effect, _)| *effect).find(|effect| effect.is_structure())
    }
}

impl Counted for Row {
    fn group(&self) -> &str {
        match (self.bench.is_crank(), self.seconds > 40.0) {
            (true, false) => "cranks, 20 s",
            (true, true) => "cranks, 60 s",
            (false, _) => "mechanisms",
        }
    }

    fn family(&self) -> &str {
        self.structure().map_or("", Effect::id).trim_start_matches("structure:")
    }

    fn set(&self) -> Set {
        self.set
    }

    fn is_missed(&self) -> bool {
        self.missed
    }

    fn answer(&self) -> Result<&Findings, &str> {
        self.answer.as_ref().map_err(String::as_str)
    }

    fn right_ids(&self) -> Vec<&str> {
        self.ids().into_iter().chain(self.equals.iter().copied()).collect()
    }

    fn tolerated_ids(&self) -> &[&str] {
        self.structure().map_or(&[], tolerated)
    }

    fn noise_n(&self) -> f64 {
        self.noise_n
    }

    fn clean_floor(&self) -> f64 {
        self.clean_floor
    }
}
