//! Who practises, and how they get better: what the window knows of the history.

use super::session::{Session, Tone};
use crate::history::attempt::{Attempt, Conditions};
use crate::history::keeper::{Answer, History};
use crate::history::store::Query;
use estimator::training::progress::{self, CurvePoint, LearningCurve, Try};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Points of a drawn curve.
const POINTS: usize = 80;
/// How much farther than the last attempt the curve goes, as a share of all.
const AHEAD: f64 = 0.15;

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
    /// Those with a score: their number from 1, and what learning is followed by.
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

impl Learned {
    /// Of attempts under the same conditions, the oldest first.
    pub fn new(attempts: Vec<Attempt>) -> Self {
        let tries: Vec<(usize, Try)> =
            attempts.iter().enumerate().filter_map(|(k, attempt)| Some((k + 1, attempt.as_try()?))).collect();
        let plain: Vec<Try> = tries.iter().map(|(_, t)| *t).collect();
        let number = |k: usize| tries[k].0;
        let session = |s: progress::Session| (number(s.first), number(s.end - 1), s.mean, s.half_width);
        let sessions = progress::sessions(&plain).into_iter().map(session).collect();
        let values: Vec<f64> = plain.iter().map(|t| t.value).collect();
        let curve = LearningCurve::fit(&values);
        let last = values.len() as f64 * (1.0 + AHEAD);
        let at = |k: usize| 1.0 + (last - 1.0) * k as f64 / (POINTS - 1) as f64;
        let points = curve.iter().flat_map(|curve| (0..POINTS).map(|k| curve.at(at(k)))).collect();
        let proficient_at = progress::proficient_at(&plain).map(number);
        Self { attempts, tries, sessions, curve, points, proficient_at }
    }
}

/// What the window knows of the history.
#[derive(Default)]
pub struct Learning {
    history: Option<History>,
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
    /// What an expert scores, by lesson.
    pub experts: BTreeMap<String, f64>,
    /// The curve that is shown.
    pub learned: Learned,
}

impl Learning {
    /// Whether anything is kept.
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

impl Session {
    /// Keeps attempts in this database from now on, and shows what is there.
    pub fn open_history(&mut self, ctx: &egui::Context, database: PathBuf) {
        let ctx = ctx.clone();
        match History::start(database, move || ctx.request_repaint()) {
            Ok(history) => {
                history.read_trainees();
                self.learning.keep_in(history);
            }
            Err(problem) => self.fail(problem),
        }
    }

    /// Keeps an attempt; false where nothing is kept.
    pub fn keep_attempt(&mut self, attempt: Attempt) -> bool {
        let history = self.learning.history.as_ref();
        history.is_some_and(|history| {
            history.add(attempt);
            true
        })
    }

    /// Writes the attempts of who practises as a table.
    pub fn export_history(&mut self, to: PathBuf) {
        let query = Query { trainee: self.learning.trainee.clone(), lesson: None };
        if let Some(history) = &self.learning.history {
            history.export(to, query);
        }
    }

    /// Takes what the history has answered.
    pub(super) fn follow_history(&mut self) {
        let Some(history) = &self.learning.history else { return };
        for answer in history.poll() {
            match answer {
                Answer::Kept(attempt) => self.attempt_kept(*attempt),
                Answer::Trainees(names) => self.trainees_known(names),
                Answer::Attempts(query, attempts) if query.trainee == self.learning.trainee => {
                    self.learning.take(attempts);
                }
                Answer::Attempts(..) => {}
                Answer::Exported(path) => self.say_saved(&path),
                Answer::TakenIn(1) => {
                    self.say(Tone::Done, "An attempt of earlier was taken into the history.".to_owned());
                }
                Answer::TakenIn(count) => {
                    self.say(Tone::Done, format!("{count} attempts of earlier were taken into the history."));
                }
                Answer::Problem(problem) => self.fail(problem),
            }
        }
    }

    fn attempt_kept(&mut self, attempt: Attempt) {
        let learning = &mut self.learning;
        if !learning.trainees.contains(&attempt.trainee) {
            learning.trainees.push(attempt.trainee.clone());
        }
        if learning.trainee.as_ref() == Some(&attempt.trainee) {
            // The newest, whatever the clock says. What the history was asked for before has been answered before, without it; what
            // it is asked for afterwards takes the place of these.
            let mut attempts = std::mem::take(&mut learning.attempts);
            attempts.push(attempt);
            learning.take(attempts);
        }
    }

    /// Where there is one trainee, they practise.
    fn trainees_known(&mut self, names: Vec<String>) {
        self.learning.trainees = names;
        if let ([only], None) = (self.learning.trainees.as_slice(), &self.learning.trainee) {
            let only = only.clone();
            self.learning.choose(&only);
        }
    }
}
