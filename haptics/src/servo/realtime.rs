//! Asking the system for real time: FIFO scheduling, locked memory, fine timers. A refusal is reported, never fatal.

use thread_priority::{
    RealtimeThreadSchedulePolicy, ThreadPriority, ThreadPriorityValue, ThreadSchedulePolicy,
    set_thread_priority_and_policy, thread_native_id,
};

/// What the system granted to the servo thread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, schemars::JsonSchema, serde::Serialize)]
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
            (true, false) => {
                "Real-time scheduling; memory could not be locked (allow it with a memlock limit for your user). \
                 Memory that was swapped out can make a tick late."
            }
            (false, true) => {
                "Normal scheduling with locked memory: the system refused real time (allow it with an rtprio limit for \
                 your user). Single ticks may come late."
            }
            (false, false) => {
                "Normal scheduling: the system refused real time (allow it with an rtprio limit for your user). \
                 Single ticks may come late."
            }
        }
    }
}

/// The system that is asked: the real one, or in tests one with set answers.
trait System {
    /// First-in-first-out scheduling for the calling thread, priority 1 to 99.
    fn fifo(&self, priority: u8) -> bool;
    /// Locked memory for the process and fine timers for the calling thread.
    fn lock_memory(&self) -> bool;
}

/// This machine.
struct Machine;

impl System for Machine {
    fn fifo(&self, priority: u8) -> bool {
        let priority =
            ThreadPriorityValue::try_from(priority).map_or(ThreadPriority::Max, ThreadPriority::Crossplatform);
        let policy = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo);
        set_thread_priority_and_policy(thread_native_id(), priority, policy).is_ok()
    }

    fn lock_memory(&self) -> bool {
        lock_memory_and_sharpen_timers()
    }
}

/// Half of the range: above everything ordinary, below the kernel's own threads.
const SERVO_PRIORITY: u8 = 50;
/// Above the servo, which spins: a guard that waits for its prisoner guards nothing.
const GUARD_PRIORITY: u8 = 60;

/// Asks for everything, for the calling thread.
pub fn acquire() -> Privileges {
    acquire_from(&Machine)
}

fn acquire_from(system: &impl System) -> Privileges {
    // Memory is asked for whatever became of the scheduling: each helps without the other.
    Privileges { asked: true, fifo: system.fifo(SERVO_PRIORITY), memory_locked: system.lock_memory() }
}

/// Puts the calling thread above the servo.
pub fn raise_guard() {
    // A refusal leaves two ordinary threads, which share the processor.
    let _ = Machine.fifo(GUARD_PRIORITY);
}

#[cfg(target_os = "linux")]
#[allow(unsafe_code)] // two system calls without memory arguments; there is no safe wrapper among the dependencies
fn lock_memory_and_sharpen_timers() -> bool {
    // SAFETY: prctl(PR_SET_TIMERSLACK) takes plain integers and affects the calling thread only. A normal thread's default
    // slack of 50 µs would be half of the spin time.
    unsafe { libc::prctl(libc::PR_SET_TIMERSLACK, 1_u64) };
    // SAFETY: mlockall takes plain flags; it fails harmlessly without the privilege. Only present mappings are locked:
    // locking the future would make every later allocation of the window count against the limit.
    unsafe { libc::mlockall(libc::MCL_CURRENT) == 0 }
}

#[cfg(not(target_os = "linux"))]
fn lock_memory_and_sharpen_timers() -> bool {
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::RefCell;

    /// Grants as told and writes the requests down.
    struct Granting(bool, bool, RefCell<Vec<u8>>);

    impl System for Granting {
        fn fifo(&self, priority: u8) -> bool {
            self.2.borrow_mut().push(priority);
            self.0
        }

        fn lock_memory(&self) -> bool {
            self.2.borrow_mut().push(0);
            self.1
        }
    }

    #[test]
    fn everything_is_asked_for_and_each_answer_is_said() {
        for (fifo, memory_locked, says, but) in [
            (true, true, "Real-time scheduling and locked memory", "refused"),
            (true, false, "memlock limit", "rtprio"),
            (false, true, "with locked memory: the system refused real time", "memlock"),
            (false, false, "refused real time (allow it with an rtprio limit", "locked memory"),
        ] {
            let system = Granting(fifo, memory_locked, RefCell::default());
            let got = acquire_from(&system);
            assert_eq!(got, Privileges { asked: true, fifo, memory_locked });
            assert_eq!(
                *system.2.borrow(),
                [SERVO_PRIORITY, 0],
                "a refusal of the one is no reason not to ask for the other"
            );
            assert!(got.sentence().contains(says) && !got.sentence().contains(but), "{}", got.sentence());
        }
        assert!(Privileges::default().sentence().contains("not asked for"));
        const { assert!(GUARD_PRIORITY > SERVO_PRIORITY) };
    }
}
