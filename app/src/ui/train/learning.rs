//! Who practises, and how they get better: what the window knows of the history.

use crate::history::attempt::{Attempt, Conditions};
use crate::history::keeper::History;
use crate::history::store::Query;
use estimator::training::progress::{CurvePoint, LearningCurve, Try};
use std::collections::BTreeMap;

/// Points of a drawn curve.
pub(crate) const POINTS: usize = 80;

/// Length of the curve beyond the last attempt, as a share of all attempts.
pub(crate) const AHEAD: f64 = 0.15;

/// A lesson under its conditions.
#[derive(Clone, Debug, PartialEq)]
pub struct Practised {
    /// Id of the lesson.
    pub lesson: String,
    /// Under what.
    pub conditions: Conditions,
}

impl Practised {
    fn of(attempt: &Attempt) -> Self {
        Self { lesson: attempt.lesson.clone(), conditions: attempt.conditions }
    }

    /// For people.
    pub fn words(&self) -> String {
        format!("{}{}", crate::text::format::capitalised(&self.lesson.replace('-', " ")), self.conditions.in_words())
    }
}

/// The learning curve of one trainee at one lesson, ready to be drawn.
#[derive(Clone, Debug, Default)]
pub struct Learned {
    /// Their attempts, the oldest first.
    pub attempts: Vec<Attempt>,
    /// Attempts with a score: their number from 1, and the measures that learning is followed by.
    pub tries: Vec<(usize, Try)>,
    /// Means of sessions: number of the first and last attempt, mean, half of its 95 % interval.
    pub sessions: Vec<(usize, usize, f64, Option<f64>)>,
    /// The power law of practice, where there are enough attempts.
    pub curve: Option<LearningCurve>,
    /// Its points, by the number of the attempt.
    pub points: Vec<CurvePoint>,
    /// Number of the attempt after which the trainee was proficient.
    pub proficient_at: Option<usize>,
}

/// Training history, as far as the window needs it.
#[derive(Default)]
pub struct Learning {
    pub(crate) history: Option<History>,
    /// Names of all trainees.
    pub trainees: Vec<String>,
    /// Who practises.
    pub trainee: Option<String>,
    /// The name of a new one.
    pub name_field: String,
    /// All attempts of who practises, the oldest first.
    pub attempts: Vec<Attempt>,
    /// The lesson that is looked at; the one that was practised last when absent.
    pub chosen: Option<Practised>,
    /// Scores of the experts, by lesson.
    pub experts: BTreeMap<String, f64>,
    /// The curve that is shown.
    pub learned: Learned,
}

impl Learning {
    /// True if attempts are kept.
    pub fn is_kept(&self) -> bool {
        self.history.is_some()
    }

    /// Keeps attempts there from now on.
    pub fn keep_in(&mut self, history: History) {
        self.history = Some(history);
    }

    /// Lessons that who practises has attempted, with their conditions, in the order of the first attempts.
    pub fn practised(&self) -> Vec<Practised> {
        let mut found: Vec<Practised> = Vec::new();
        for practised in self.attempts.iter().map(Practised::of) {
            if !found.contains(&practised) {
                found.push(practised);
            }
        }
        found
    }

    /// The lesson that is looked at.
    pub fn shown(&self) -> Option<Practised> {
        self.chosen.clone().or_else(|| self.attempts.last().map(Practised::of))
    }

    /// Looks at a lesson.
    pub fn look_at(&mut self, practised: Option<Practised>) {
        self.chosen = practised;
        let shown = self.shown();
        let mine = self.attempts.iter().filter(|a| Some(Practised::of(a)) == shown).cloned().collect();
        self.learned = Learned::new(mine);
    }

    /// Shows these attempts.
    pub fn take(&mut self, attempts: Vec<Attempt>) {
        self.attempts = attempts;
        let chosen = self.chosen.take().filter(|chosen| self.practised().contains(chosen));
        self.look_at(chosen);
    }

    /// Who practises from now on; their attempts are asked for.
    pub fn choose(&mut self, trainee: &str) {
        self.trainee = Some(trainee.to_owned());
        self.chosen = None;
        self.take(Vec::new());
        self.ask();
    }

    fn ask(&self) {
        let query = Query { trainee: self.trainee.clone(), lesson: None };
        if let Some(history) = self.history.as_ref().filter(|_| query.trainee.is_some()) {
            history.read(query);
        }
    }

    /// Adds a trainee, who practises from now on.
    pub fn add_trainee(&mut self) {
        let name = std::mem::take(&mut self.name_field).trim().to_owned();
        if let Some(history) = self.history.as_ref().filter(|_| !name.is_empty()) {
            history.add_trainee(&name);
            self.choose(&name);
        }
    }
}
