//! Asking the system for real time: FIFO scheduling, locked memory, fine timers. A refusal is reported, never fatal.

use thread_priority::{
    RealtimeThreadSchedulePolicy, ThreadPriority, ThreadPriorityValue, ThreadSchedulePolicy,
    set_thread_priority_and_policy, thread_native_id,
};

/// What the system granted to the servo thread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Privileges {
    /// Whether it was asked for.
    pub asked: bool,
    /// First-in-first-out real-time scheduling (`SCHED_FIFO`).
    pub fifo: bool,
    /// All memory locked.
    pub memory_locked: bool,
}

impl Privileges {
    /// One sentence for the timing panel.
    pub fn sentence(self) -> &'static str {
        if !self.asked {
            return "Normal scheduling: real time was not asked for.";
        }
        match (self.fifo, self.memory_locked) {
            (true, true) => "Real-time scheduling and locked memory.",
            (true, false) => "Real-time scheduling; memory could not be locked.",
            (false, _) => {
                "Normal scheduling: the system refused real time (allow it with an rtprio limit for your user). \
                 Single ticks may come late."
            }
        }
    }
}

/// Asks for everything, for the calling thread.
pub fn acquire() -> Privileges {
    // Half of the range: above everything ordinary, below the kernel's own threads.
    Privileges { asked: true, fifo: fifo(50), memory_locked: lock_memory_and_sharpen_timers() }
}

/// Puts the calling thread above the servo, which spins: a guard that waits for its prisoner guards nothing.
pub fn raise_guard() {
    // A refusal leaves two ordinary threads, which share the processor.
    let _ = fifo(60);
}

fn fifo(priority: u8) -> bool {
    let priority = ThreadPriorityValue::try_from(priority).map_or(ThreadPriority::Max, ThreadPriority::Crossplatform);
    let policy = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo);
    set_thread_priority_and_policy(thread_native_id(), priority, policy).is_ok()
}

#[cfg(target_os = "linux")]
#[allow(unsafe_code)] // two system calls without memory arguments; there is no safe wrapper among the dependencies
fn lock_memory_and_sharpen_timers() -> bool {
    // SAFETY: prctl(PR_SET_TIMERSLACK) takes plain integers and affects the calling thread only. A normal thread's default
    // slack of 50 µs would be half of the spin time.
    unsafe { libc::prctl(libc::PR_SET_TIMERSLACK, 1_u64) };
    // SAFETY: mlockall takes plain flags; it fails harmlessly without the privilege. Only what is mapped now is locked:
    // locking the future would make every later allocation of the window count against the limit.
    unsafe { libc::mlockall(libc::MCL_CURRENT) == 0 }
}

#[cfg(not(target_os = "linux"))]
fn lock_memory_and_sharpen_timers() -> bool {
    false
}
