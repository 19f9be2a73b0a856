//! The history beside the window: a thread that has the database, asked and answered without waiting.

use super::aside;
use crate::history::attempt::Attempt;
use crate::history::store::{Query, Store};
use jiff::Timestamp;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;

/// What is asked.
enum Request {
    Add(Box<Attempt>),
    AddTrainee(String, Timestamp),
    Read(Query),
    Trainees,
    Export(PathBuf, Query),
}

/// What comes back.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// An attempt is on the disk: in the database, or beside it until that takes it.
    Kept(Box<Attempt>),
    /// Names of all trainees.
    Trainees(Vec<String>),
    /// Attempts, the oldest first.
    Attempts(Query, Vec<Attempt>),
    /// A table was written here.
    Exported(PathBuf),
    /// Attempts of earlier were taken in, so many.
    TakenIn(usize),
    /// One sentence.
    Problem(String),
}

/// The thread, from outside. When this is dropped, everything that was asked for is done first.
pub struct History {
    requests: Option<Sender<Request>>,
    answers: Receiver<Answer>,
    thread: Option<JoinHandle<()>>,
}

impl History {
    /// Starts the thread. `wake` is called after every answer: a window that sleeps looks then.
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

    /// Keeps an attempt that was made just now.
    pub fn add(&self, attempt: Attempt) {
        self.ask(Request::Add(Box::new(attempt)));
    }

    /// Adds a trainee; the names of all come back.
    pub fn add_trainee(&self, name: &str) {
        self.ask(Request::AddTrainee(name.to_owned(), Timestamp::now()));
    }

    /// Asks for the names of all trainees.
    pub fn read_trainees(&self) {
        self.ask(Request::Trainees);
    }

    /// Asks for attempts.
    pub fn read(&self, query: Query) {
        self.ask(Request::Read(query));
    }

    /// Writes attempts as a table.
    pub fn export(&self, to: PathBuf, query: Query) {
        self.ask(Request::Export(to, query));
    }

    /// What has come back since the last call; never waits.
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
    /// Nothing where it could not be opened yet.
    store: Option<Store>,
    /// True while attempts wait beside it that it has refused.
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

    /// The open database; what waits beside it is taken in when it opens.
    fn open(&mut self, answer: &dyn Fn(Answer)) -> Result<&mut Store, String> {
        if self.store.is_none() {
            self.store = Some(Store::open(&self.database)?);
            if let Err(problem) = self.take_in(answer) {
                answer(Answer::Problem(problem));
            }
        }
        self.store.as_mut().ok_or_else(|| "The history is not open.".to_owned())
    }

    /// Takes in what waits beside the database; an error where that refuses one.
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

    /// Keeps an attempt, behind those that wait: none may overtake another.
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
                    // It is opened anew for the next one: what was wrong may be over then.
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
