//! Work in the background: nothing here ever makes the window wait. A job brings back a change, so that no feature is known here.

use estimator::cancellation;
use estimator::log::preview::Preview;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::{Duration, Instant};

/// A job that takes longer than this is shown, with a way to cancel it.
const SHOWN_AFTER: Duration = Duration::from_millis(600);

/// A kind of work, declared beside the feature that needs it. At most one job of a kind runs at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct JobKind {
    name: &'static str,
    /// The kind whose result this one starts from.
    after: Option<&'static JobKind>,
    role: Role,
}

/// Treatment of a kind while other things happen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    /// It computes, and ends early when it is cancelled.
    Computes,
    /// It writes a file: it is never interrupted.
    Writes,
    /// It waits for the user: the program is not busy.
    Waits,
}

impl JobKind {
    /// A kind that computes from what is there.
    pub const fn new(name: &'static str) -> Self {
        Self { name, after: None, role: Role::Computes }
    }

    /// Starts from the result of another kind, and is cancelled when that result is replaced.
    pub const fn after(self, kind: &'static JobKind) -> Self {
        Self { after: Some(kind), ..self }
    }

    /// Writes a file, which nothing interrupts.
    pub const fn writes(self) -> Self {
        Self { role: Role::Writes, ..self }
    }

    /// Waits for the user.
    pub const fn waits(self) -> Self {
        Self { role: Role::Waits, ..self }
    }

    fn is_after(self, kind: JobKind) -> bool {
        self.after.is_some_and(|before| *before == kind || before.is_after(kind))
    }
}

/// The change that a job brings back, made on the thread of the window.
pub type Change<T> = Box<dyn FnOnce(&mut T, &egui::Context) + Send>;

/// The end of a job: a change, or a sentence about why there is none.
pub type Answer<T> = Result<Change<T>, String>;

/// A change as an answer.
pub fn change<T>(change: impl FnOnce(&mut T, &egui::Context) + Send + 'static) -> Answer<T> {
    Ok(Box::new(change))
}

/// The answer of a job that was cancelled.
pub fn no_change<T>() -> Answer<T> {
    change(|_, _| {})
}

struct Report<T> {
    kind: JobKind,
    generation: u64,
    answer: Answer<T>,
}

/// The state that a running job shares with the window.
#[derive(Clone, Debug, Default)]
pub struct Ticket(Arc<Shared>);

#[derive(Debug, Default)]
struct Shared {
    /// Share done in ten-thousandths; 0: nothing is known.
    done: AtomicU32,
    cancelled: AtomicBool,
    preview: Preview,
}

impl Ticket {
    /// Tells how much is done, 0 … 1.
    pub fn tell(&self, share: f64) {
        self.0.done.store((1e4 * share.clamp(0.0, 1.0)) as u32, Ordering::Relaxed);
    }

    /// Tells how much is done; false once the job was cancelled.
    pub fn goes_on(&self, share: f64) -> bool {
        self.tell(share);
        !self.cancelled().load(Ordering::Relaxed)
    }

    /// Set when nobody wants the answer any more.
    pub fn cancelled(&self) -> &AtomicBool {
        &self.0.cancelled
    }

    /// The place for what a reader has read so far.
    pub fn preview(&self) -> &Preview {
        &self.0.preview
    }

    fn share(&self) -> Option<f64> {
        let done = self.0.done.load(Ordering::Relaxed);
        (done > 0).then(|| f64::from(done) * 1e-4)
    }
}

struct Running<T> {
    kind: JobKind,
    generation: u64,
    title: String,
    begun: Instant,
    ticket: Ticket,
    if_given_up: Option<Change<T>>,
}

/// A job that takes its time.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// Its kind.
    pub kind: JobKind,
    /// Its title.
    pub title: String,
    /// Share of the work that is done, 0 … 1; `None` if unknown.
    pub share: Option<f64>,
    /// Since when.
    pub elapsed: Duration,
}

/// Starts jobs and collects their changes of a `T`.
pub struct Jobs<T> {
    sender: Sender<Report<T>>,
    receiver: Receiver<Report<T>>,
    running: Vec<Running<T>>,
    generation: u64,
}

impl<T> Default for Jobs<T> {
    fn default() -> Self {
        let (sender, receiver) = channel();
        Self { sender, receiver, running: Vec::new(), generation: 0 }
    }
}

/// A job that was just started.
pub struct Started<'a, T>(Option<&'a mut Running<T>>);

impl<T> Started<'_, T> {
    /// The change in its place when the user gives it up.
    pub fn if_given_up(self, change: impl FnOnce(&mut T, &egui::Context) + Send + 'static) {
        if let Some(running) = self.0 {
            running.if_given_up = Some(Box::new(change));
        }
    }
}

impl<T: 'static> Jobs<T> {
    /// Runs `work` on a thread of its own. A job of the same kind that still runs is forgotten: only the newest answer counts. The
    /// window shows `title` while the job takes its time, unless it is empty.
    pub fn start(
        &mut self,
        ctx: &egui::Context,
        kind: JobKind,
        title: impl Into<String>,
        work: impl FnOnce(&Ticket) -> Answer<T> + Send + 'static,
    ) -> Started<'_, T> {
        self.cancel(kind);
        self.generation += 1;
        let (generation, ticket) = (self.generation, Ticket::default());
        let running = Running {
            kind,
            generation,
            title: title.into(),
            begun: Instant::now(),
            ticket: ticket.clone(),
            if_given_up: None,
        };
        let (sender, ctx) = (self.sender.clone(), ctx.clone());
        let spawned = std::thread::Builder::new().name(kind.name.to_owned()).spawn(move || {
            let answer = catch_unwind(AssertUnwindSafe(|| done_if_wanted(kind, &ticket, work))).unwrap_or_else(|_| {
                Err("An internal fault stopped this step; the rest of the program goes on.".to_owned())
            });
            // A closed window needs no answer.
            let _ = sender.send(Report { kind, generation, answer });
            ctx.request_repaint();
        });
        self.running.push(running);
        if let Err(error) = spawned {
            let answer = Err(format!("The system gave no thread for this step ({error})."));
            let _ = self.sender.send(Report { kind, generation, answer });
        }
        Started(self.running.last_mut())
    }

    /// Ends a job: it is told to stop, and its answer will be dropped.
    pub fn cancel(&mut self, kind: JobKind) {
        self.stop(|running| running == kind);
    }

    /// Ends the jobs that start from the result of this kind, because that result is replaced.
    pub fn cancel_after(&mut self, kind: JobKind) {
        self.stop(|running| running.is_after(kind));
    }

    /// Ends a job that the user does not want to wait for; the change is the one that the job declared for this case.
    pub fn give_up(&mut self, kind: JobKind) -> Option<Change<T>> {
        self.stop(|running| running == kind).into_iter().find_map(|running| running.if_given_up)
    }

    fn stop(&mut self, concerns: impl Fn(JobKind) -> bool) -> Vec<Running<T>> {
        let (stopped, kept) = std::mem::take(&mut self.running).into_iter().partition(|r| concerns(r.kind));
        self.running = kept;
        let stopped: Vec<Running<T>> = stopped;
        for running in &stopped {
            running.ticket.cancelled().store(true, Ordering::Relaxed);
        }
        stopped
    }

    /// True while such a job runs.
    pub fn is_running(&self, kind: JobKind) -> bool {
        self.running.iter().any(|running| running.kind == kind)
    }

    /// True while anything computes; a waiting dialog does not count.
    pub fn is_busy(&self) -> bool {
        self.running.iter().any(|running| running.kind.role != Role::Waits)
    }

    /// The job that has been running longest, of those with a title, once it takes its time.
    pub fn progress(&self) -> Option<Progress> {
        let longest = self.running.iter().filter(|r| !r.title.is_empty()).min_by_key(|r| r.begun)?;
        let elapsed = longest.begun.elapsed();
        (elapsed > SHOWN_AFTER).then(|| Progress {
            kind: longest.kind,
            title: longest.title.clone(),
            share: longest.ticket.share(),
            elapsed,
        })
    }

    /// Preview and progress of a long read of this kind; `None` before the first samples.
    pub fn preview(&self, kind: JobKind) -> Option<(&Preview, Progress)> {
        let progress = self.progress().filter(|p| p.kind == kind)?;
        let reading = self.running.iter().find(|r| r.kind == kind)?;
        let preview = reading.ticket.preview();
        (!preview.is_empty()).then_some((preview, progress))
    }

    /// The answers since the last call; never waits.
    pub fn poll(&mut self) -> Vec<Answer<T>> {
        let mut answers = Vec::new();
        while let Ok(report) = self.receiver.try_recv() {
            let mine = |r: &Running<T>| (r.kind, r.generation) == (report.kind, report.generation);
            if let Some(index) = self.running.iter().position(mine) {
                self.running.remove(index);
                answers.push(report.answer);
            }
        }
        answers
    }
}

/// Does the work, and ends early where the estimator looks whether it is still wanted.
fn done_if_wanted<T>(kind: JobKind, ticket: &Ticket, work: impl FnOnce(&Ticket) -> Answer<T>) -> Answer<T> {
    if kind.role == Role::Writes {
        return work(ticket);
    }
    let asked = ticket.clone();
    let wanted = move || !asked.cancelled().load(Ordering::Relaxed);
    cancellation::while_wanted(wanted, || work(ticket)).unwrap_or_else(no_change)
}

#[cfg(test)]
mod tests {
    use super::*;

    const READ: JobKind = JobKind::new("read");
    const FIT: JobKind = JobKind::new("fit").after(&READ);
    const REPLAY: JobKind = JobKind::new("replay").after(&FIT);
    const SAVE: JobKind = JobKind::new("save").writes();

    /// A window that knows one word.
    type Word = &'static str;

    fn says(word: Word) -> Answer<Word> {
        change(move |said: &mut Word, _| *said = word)
    }

    fn wait(jobs: &mut Jobs<Word>) -> Vec<Result<Word, String>> {
        let begun = Instant::now();
        while begun.elapsed() < Duration::from_secs(10) {
            let answers = jobs.poll();
            if !answers.is_empty() {
                return answers.into_iter().map(|answer| answer.map(made)).collect();
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        Vec::new()
    }

    fn made(change: Change<Word>) -> Word {
        let mut said = "";
        change(&mut said, &egui::Context::default());
        said
    }

    #[test]
    fn a_panicking_job_ends_in_a_sentence() {
        let mut jobs = Jobs::default();
        jobs.start(&egui::Context::default(), FIT, "", |_| panic!("a bug"));
        assert!(jobs.is_busy());
        assert!(matches!(wait(&mut jobs).as_slice(), [Err(_)]));
        assert!(!jobs.is_busy());
    }

    #[test]
    fn only_the_newest_answer_counts() {
        let mut jobs = Jobs::default();
        let ctx = egui::Context::default();
        for word in ["old", "new"] {
            jobs.start(&ctx, SAVE, "", move |_| says(word));
        }
        // In either order: the old answer must never come out, so the only change is the new one.
        let answers = wait(&mut jobs);
        assert!(!jobs.is_busy());
        assert_eq!(answers, [Ok("new")]);
    }

    #[test]
    fn jobs_end_that_start_from_a_result_that_is_replaced() {
        let (mut jobs, ctx) = (Jobs::<Word>::default(), egui::Context::default());
        let until_cancelled = |ticket: &Ticket| {
            while ticket.goes_on(0.5) {
                std::thread::sleep(Duration::from_millis(1));
            }
            no_change()
        };
        for kind in [READ, FIT, REPLAY] {
            jobs.start(&ctx, kind, "", until_cancelled).if_given_up(|said, _| *said = "given up");
        }
        assert_eq!(jobs.give_up(READ).map(made), Some("given up"), "alone");
        assert!(jobs.is_running(FIT) && jobs.is_running(REPLAY) && jobs.give_up(READ).is_none());
        jobs.cancel_after(FIT);
        assert!(jobs.is_running(FIT) && !jobs.is_running(REPLAY));
        jobs.start(&ctx, REPLAY, "", until_cancelled);
        jobs.cancel_after(READ);
        assert!(!jobs.is_busy());
    }

    #[test]
    fn a_cancelled_job_is_told_and_its_answer_dropped() {
        let mut jobs = Jobs::<Word>::default();
        let (told, heard) = channel();
        jobs.start(&egui::Context::default(), READ, "Reading", move |ticket| {
            ticket.tell(0.25);
            while !ticket.cancelled().load(Ordering::Relaxed) {
                std::thread::sleep(Duration::from_millis(1));
            }
            told.send(()).expect("the test listens");
            no_change()
        });
        let begun = Instant::now();
        while jobs.progress().is_none_or(|p| p.share.is_none()) && begun.elapsed() < Duration::from_secs(10) {
            std::thread::sleep(Duration::from_millis(5));
        }
        let progress = jobs.progress().expect("it takes its time");
        assert_eq!((progress.title.as_str(), progress.share), ("Reading", Some(0.25)));
        jobs.cancel(READ);
        heard.recv_timeout(Duration::from_secs(10)).expect("it ends");
        assert!(!jobs.is_busy() && jobs.progress().is_none() && jobs.poll().is_empty());
    }

    #[test]
    fn a_cancelled_job_ends_in_the_loops_of_the_estimator_but_a_file_is_written() {
        for (kind, ends) in [(FIT, true), (SAVE, false)] {
            let mut jobs = Jobs::<Word>::default();
            let ((go, may_go), (told, heard)) = (channel(), channel());
            jobs.start(&egui::Context::default(), kind, "Working", move |_| {
                may_go.recv().expect("the test goes on");
                told.send(cancellation::check().is_err()).expect("the test listens");
                no_change()
            });
            jobs.cancel(kind);
            go.send(()).expect("the job waits");
            assert_eq!(heard.recv_timeout(Duration::from_secs(10)), Ok(ends), "{kind:?}");
        }
    }
}
