//! Share of a diagnosis that is done, and the wish to end it.

use foundation::estimate::EstimateError;
use std::fmt;
use std::sync::Arc;

type Listener = dyn Fn(f64) -> bool + Send + Sync;

/// Whoever waits for a diagnosis: is told how much is done, and says whether the rest is still wanted. Nobody by
/// default.
#[derive(Clone, Default)]
pub struct Progress(Option<Arc<Listener>>);

impl Progress {
    /// `listen` receives the share done, 0 … 1. If it returns false, the diagnosis ends with an error.
    pub fn new(listen: impl Fn(f64) -> bool + Send + Sync + 'static) -> Self {
        Self(Some(Arc::new(listen)))
    }

    /// Reports the share done; an error if the rest is not wanted.
    pub(crate) fn tell(&self, share: f64) -> Result<(), EstimateError> {
        match &self.0 {
            Some(listen) if !listen(share.clamp(0.0, 1.0)) => {
                Err(EstimateError::Other("the diagnosis was cancelled".to_owned()))
            }
            _ => Ok(()),
        }
    }
}

impl fmt::Debug for Progress {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(if self.0.is_some() { "Progress(heard)" } else { "Progress(unheard)" })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    #[test]
    fn it_is_heard_and_can_end_the_work() {
        Progress::default().tell(0.5).expect("nobody ends it");
        let heard = Arc::new(Mutex::new(Vec::new()));
        let ears = Arc::clone(&heard);
        let progress = Progress::new(move |share| {
            ears.lock().expect("one at a time").push(share);
            share < 0.6
        });
        progress.tell(0.4).expect("goes on");
        assert!(progress.tell(7.0).is_err_and(|e| e.to_string().contains("cancelled")));
        assert_eq!(*heard.lock().expect("free"), [0.4, 1.0]);
    }
}
