//! Counts the packets of a remote device.

use super::packet::Refused;
use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

#[derive(Debug, Default)]
pub(super) struct Counters {
    pub accepted: AtomicU64,
    pub greeted: AtomicU64,
    pub refused: [AtomicU64; Refused::ALL.len()],
}

/// Packets so far, for panels and tests; read from any thread.
#[derive(Clone, Debug)]
pub struct UdpMonitor {
    pub(super) counters: Arc<Counters>,
    address: SocketAddr,
}

impl UdpMonitor {
    pub(super) fn new(address: SocketAddr) -> Self {
        Self { counters: Arc::new(Counters::default()), address }
    }

    /// Motion packets that moved the fingers.
    pub fn accepted(&self) -> u64 {
        self.counters.accepted.load(Ordering::Relaxed)
    }

    /// Devices that asked for a session.
    pub fn greeted(&self) -> u64 {
        self.counters.greeted.load(Ordering::Relaxed)
    }

    /// Packets that were refused for a reason.
    pub fn refused(&self, why: Refused) -> u64 {
        self.counters.refused[why as usize].load(Ordering::Relaxed)
    }

    /// Address that the device listens on.
    pub fn address(&self) -> SocketAddr {
        self.address
    }
}
