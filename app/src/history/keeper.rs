//! History for the window: a thread that owns the database and answers requests without blocking.

use super::aside;
use crate::history::attempt::Attempt;
use crate::history::store::{Query, Store};
use jiff::Timestamp;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;

/// Request to the thread.
enum Request {
    Add(Box<Attempt>),
    AddTrainee(String, Timestamp),
    Read(Query),
    Trainees,
    Export(PathBuf, Query),
}

/// Answer of the thread.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// An attempt is on the disk: in the database, or beside it until that accepts it.
    Kept(Box<Attempt>),
    /// Names of all trainees.
    Trainees(Vec<String>),
    /// Attempts, the oldest first.
    Attempts(Query, Vec<Attempt>),
    /// A table was written to this file.
    Exported(PathBuf),
    /// Number of earlier attempts that were imported.
    TakenIn(usize),
    /// Problem, in one sentence.
    Problem(String),
}

/// Handle of the thread. On drop, all pending requests are completed first.
pub struct History {
    requests: Option<Sender<Request>>,
    answers: Receiver<Answer>,
    thread: Option<JoinHandle<()>>,
}

impl History {
    /// Starts the thread. `wake` is called after every answer, so that a sleeping window polls.
    pub fn start(database: PathBuf, wake: impl Fn() + Send + 'static) -> Result<Self, String> {
        let (requests, asked) = channel();
        let (sender, answers) = channel();
        let answer = move |answer: Answer| {
            // A closed window needs no answer.
            let _ = sender.send(answer);
            wake();
        };
        let work = move || Keeper { database, store: None, has_refused: false }.run(&asked, &answer);
        let thread = std::thread::Builder::new().name("history".to_owned()).spawn(work);
        let thread = thread.map_err(|error| format!("The system gave no thread for the history ({error})."))?;
        Ok(Self { requests: Some(requests), answers, thread: Some(thread) })
    }

    fn ask(&self, request: Request) {
        // The thread lives as long as this does.
        let _ = self.requests.as_ref().map(|requests| requests.send(request));
    }

    /// Stores an attempt that was made just now.
    pub fn add(&self, attempt: Attempt) {
        self.ask(Request::Add(Box::new(attempt)));
    }

    /// Adds a trainee; the answer contains all names.
    pub fn add_trainee(&self, name: &str) {
        self.ask(Request::AddTrainee(name.to_owned(), Timestamp::now()));
    }

    /// Requests the names of all trainees.
    pub fn read_trainees(&self) {
        self.ask(Request::Trainees);
    }

    /// Requests attempts.
    pub fn read(&self, query: Query) {
        self.ask(Request::Read(query));
    }

    /// Writes attempts as a table.
    pub fn export(&self, to: PathBuf, query: Query) {
        self.ask(Request::Export(to, query));
    }

    /// Answers since the last call; never blocks.
    pub fn poll(&self) -> Vec<Answer> {
        self.answers.try_iter().collect()
    }
}

impl Drop for History {
    fn drop(&mut self) {
        // Without a sender the thread ends once everything is done.
        self.requests = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

struct Keeper {
    database: PathBuf,
    /// Database; `None` while it could not be opened.
    store: Option<Store>,
    /// True while rejected attempts wait beside it.
    has_refused: bool,
}

impl Keeper {
    fn run(mut self, asked: &Receiver<Request>, answer: &dyn Fn(Answer)) {
        if let Err(problem) = self.open(answer) {
            answer(Answer::Problem(problem));
        }
        while let Ok(request) = asked.recv() {
            answer(self.done(request, answer).unwrap_or_else(Answer::Problem));
        }
    }

    /// Open database; attempts that wait beside it are imported when it opens.
    fn open(&mut self, answer: &dyn Fn(Answer)) -> Result<&mut Store, String> {
        if self.store.is_none() {
            self.store = Some(Store::open(&self.database)?);
            if let Err(problem) = self.take_in(answer) {
                answer(Answer::Problem(problem));
            }
        }
        self.store.as_mut().ok_or_else(|| "The history is not open.".to_owned())
    }

    /// Imports the attempts that wait beside the database; an error if it rejects one.
    fn take_in(&mut self, answer: &dyn Fn(Answer)) -> Result<(), String> {
        let Some(store) = &mut self.store else { return Ok(()) };
        let (taken, problems, all) = aside::take_in(&self.database, store);
        if taken > 0 {
            answer(Answer::TakenIn(taken));
        }
        problems.into_iter().map(Answer::Problem).for_each(answer);
        self.has_refused = all.is_err();
        all
    }

    /// Stores an attempt behind those that wait: none may overtake another.
    fn keep(&mut self, attempt: &Attempt, answer: &dyn Fn(Answer)) -> Result<(), String> {
        self.open(answer)?;
        if self.has_refused {
            self.take_in(answer)?;
        }
        self.open(answer)?.keep(attempt)
    }

    fn done(&mut self, request: Request, answer: &dyn Fn(Answer)) -> Result<Answer, String> {
        match request {
            Request::Add(attempt) => {
                if let Err(problem) = self.keep(&attempt, answer) {
                    aside::keep(&self.database, &attempt)?;
                    // It is reopened for the next one: the problem may be resolved then.
                    self.store = None;
                    answer(Answer::Problem(format!(
                        "{problem} The attempt is kept beside it and taken in at the next start."
                    )));
                }
                Ok(Answer::Kept(attempt))
            }
            Request::AddTrainee(name, created) => {
                let store = self.open(answer)?;
                store.add_trainee(&name, created)?;
                store.trainees().map(Answer::Trainees)
            }
            Request::Trainees => self.open(answer)?.trainees().map(Answer::Trainees),
            Request::Read(query) => {
                let (found, problem) = self.open(answer)?.attempts_and_problems(&query)?;
                problem.into_iter().map(Answer::Problem).for_each(answer);
                Ok(Answer::Attempts(query, found))
            }
            Request::Export(to, query) => {
                let (found, problem) = self.open(answer)?.attempts_and_problems(&query)?;
                problem.into_iter().map(Answer::Problem).for_each(answer);
                export(&to, &found)?;
                Ok(Answer::Exported(to))
            }
        }
    }
}

fn export(to: &Path, attempts: &[Attempt]) -> Result<(), String> {
    let text = super::table::csv(attempts)?;
    crate::write_whole::write_whole(to, &text)
}
