//! Judgement of an answer by recordings that took part in nothing.

use crate::diagnose::contract::{Alternative, Cause, Diagnosis, Validation, Verdict, is_certain};
use crate::diagnose::data::limits::HALF;
use crate::diagnose::findings::Findings;

impl Findings {
    /// Adds the figures of other recordings of the same object. A cause with which such a recording is certainly
    /// predicted worse is not certain any more, whatever its standing in the first ones. A figure counts once.
    pub fn judge_by(&mut self, figures: Vec<Validation>) {
        for figure in figures {
            if self.validation.contains(&figure) {
                continue;
            }
            // The upper end of the 95 % interval.
            if figure.interval[1] < 0.0 {
                self.doubt_causes_of(&figure);
            }
            self.validation.push(figure);
        }
    }

    /// Ids of the causes that took part in a figure.
    fn causes_of(&self, figure: &Validation) -> Vec<String> {
        let in_channel = |channel: &String, id: &str| self.kept.iter().any(|k| k.id == id && k.channel == channel);
        let took_part = |id: &String| {
            !figure.left_out.contains(id) && figure.of.as_ref().is_none_or(|channel| in_channel(channel, id))
        };
        self.causes.iter().map(|cause| cause.id.clone()).filter(took_part).collect()
    }

    fn doubt_causes_of(&mut self, figure: &Validation) {
        let ids = self.causes_of(figure);
        if ids.is_empty() {
            return;
        }
        let Diagnosis { causes, alternatives, verdict, warnings, .. } = &mut self.diagnosis;
        let is_any_certain = |causes: &[Cause], all: &[Alternative]| causes.iter().any(|cause| is_certain(cause, all));
        let was_certain = is_any_certain(causes, alternatives);
        causes.iter_mut().filter(|cause| ids.contains(&cause.id)).for_each(|cause| doubt(cause, alternatives));
        causes.sort_by_key(|cause| !is_certain(cause, alternatives));
        if was_certain && !is_any_certain(causes, alternatives) {
            *verdict = Verdict::Unexplained;
        }
        let rise = -100.0 * figure.share;
        let named = ids.join(", ");
        warnings.insert(
            0,
            format!("doubtful, because the residual power of another recording rises by {rise:.0} %: {named}"),
        );
    }
}

/// A cause and its alternatives together become as likely as not.
fn doubt(cause: &mut Cause, alternatives: &mut [Alternative]) {
    let own: Vec<&mut Alternative> = alternatives.iter_mut().filter(|a| a.instead_of == cause.id).collect();
    let whole = cause.posterior + own.iter().map(|a| a.posterior).sum::<f64>();
    let share = (HALF / whole.max(f64::MIN_POSITIVE)).min(1.0);
    cause.posterior *= share;
    for alternative in own {
        alternative.posterior *= share;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::contract::Gain;
    use haptics::law::Kind;

    fn cause(id: &str, posterior: f64) -> Cause {
        Cause {
            id: id.to_owned(),
            kind: Kind::Plant,
            parameters: Vec::new(),
            p_value: 0.0,
            posterior,
            standing: None,
            gain: Gain::default(),
            evidence: String::new(),
        }
    }

    fn answer() -> Findings {
        let causes = vec![cause("viscous-friction", 0.985), cause("mass-change", 0.97)];
        Diagnosis { verdict: Verdict::Causes, causes, ..Diagnosis::default() }.into()
    }

    #[test]
    fn a_recording_that_is_predicted_worse_takes_the_certainty_of_the_causes_that_took_part() {
        let mut found = answer();
        let worse = Validation {
            share: -0.4,
            interval: [-0.6, -0.2],
            left_out: vec!["mass-change".to_owned()],
            ..Validation::default()
        };
        found.judge_by(vec![worse.clone(), worse]);
        let [kept, doubted] = found.causes.as_slice() else { panic!("{:?}", found.causes) };
        assert_eq!((kept.id.as_str(), kept.posterior), ("mass-change", 0.97));
        assert!(doubted.id == "viscous-friction" && (doubted.posterior - 0.5).abs() < 1e-12, "{doubted:?}");
        assert_eq!((found.verdict, found.validation.len()), (Verdict::Causes, 1));
        assert!(found.warnings.len() == 1 && found.warnings[0].contains("40 %"), "{:?}", found.warnings);
        found.judge_by(vec![Validation { share: -0.1, interval: [-0.2, -0.05], ..Validation::default() }]);
        assert_eq!(found.verdict, Verdict::Unexplained);
    }

    #[test]
    fn a_recording_that_cannot_tell_changes_nothing() {
        let mut found = answer();
        found.judge_by(vec![Validation { share: -0.1, interval: [-0.4, 0.1], ..Validation::default() }]);
        assert_eq!((found.causes.clone(), found.verdict), (answer().causes.clone(), Verdict::Causes));
        assert!(found.warnings.is_empty());
    }
}
