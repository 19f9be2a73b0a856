//! Whether memory grows from lap to lap: what is allocated and alive, to the byte, and what the system counts.

use crate::MEMORY;

/// What may come and go between laps: thread-local buffers, caches of the allocator and the database, bytes.
const SLACK: usize = 3 << 20;
/// Pages that the allocator keeps for itself between laps, more or less of them after a table of 100 000 columns, bytes.
const PAGES: usize = 96 << 20;

/// After a lap.
#[derive(Clone, Copy, Debug)]
pub struct Memory {
    /// Allocated and not freed.
    alive: usize,
    /// Resident, where the system says.
    resident: Option<usize>,
}

impl Memory {
    pub fn now() -> Self {
        Self { alive: MEMORY.current_usage(), resident: resident() }
    }
}

/// Resident memory, bytes; `None` where the system does not say.
fn resident() -> Option<usize> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmRSS:"))?;
    line.split_whitespace().nth(1)?.parse::<usize>().ok().map(|kib| kib * 1024)
}

/// The later half of the laps needs no more than the earlier one; the first lap fills pools and does not count.
pub fn must_be_flat(laps: &[Memory]) {
    let settled = &laps[1..];
    let (early, late) = settled.split_at(settled.len() / 2);
    let most = |laps: &[Memory], of: fn(&Memory) -> usize| laps.iter().map(of).max().unwrap_or(0);
    let mib = |bytes: usize| bytes as f64 / f64::from(1 << 20);
    let (before, after) = (most(early, |m| m.alive), most(late, |m| m.alive));
    println!("memory: {:.2} MiB alive in the earlier half, {:.2} MiB in the later", mib(before), mib(after));
    assert!(after <= before + SLACK, "memory that is alive grows: {laps:?}");
    if laps.iter().all(|lap| lap.resident.is_some()) {
        let of = |m: &Memory| m.resident.unwrap_or(0);
        let (before, after) = (most(early, of), most(late, of));
        println!("memory: {:.0} MiB resident in the earlier half, {:.0} MiB in the later", mib(before), mib(after));
        assert!(after <= before + PAGES, "resident memory grows: {laps:?}");
    }
}
