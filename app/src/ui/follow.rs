//! Following what happens between frames: the answers of jobs, and the features that watch something.

use super::session::Session;

impl Session {
    /// Takes in what the jobs bring; call once a frame.
    pub fn poll(&mut self, ctx: &egui::Context) {
        for answer in self.jobs.poll() {
            match answer {
                Ok(change) => change(self, ctx),
                Err(problem) => self.job_failed(problem),
            }
        }
        super::recorder::follow(ctx, self);
        self.follow_experiment(ctx);
        self.follow_history();
        self.follow_lesson(ctx);
        let (now_s, held) = ctx.input(|i| (i.time, i.pointer.any_down()));
        self.note_changes(now_s, held);
        self.follow_choice(ctx);
        self.follow_what_if(ctx);
    }

    /// A job has failed.
    fn job_failed(&mut self, problem: String) {
        self.experiments.asks_again = false;
        if !self.document.recordings.is_empty() && self.calibration.analysis.is_none() {
            self.calibration.fit_problem = Some(problem.clone());
        }
        self.messages.fail(problem);
    }

    /// Reads the same log again.
    pub fn reload(&mut self, ctx: &egui::Context) {
        match self.document.path.clone() {
            Some(_) if self.document.sources.len() > 1 => self.restore(ctx, super::project_files::project_of(self)),
            Some(path) => self.open(ctx, &path),
            None => self.messages.fail("There is no file to reload: open a log first."),
        }
    }
}
