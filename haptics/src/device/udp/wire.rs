//! Transport of the packets: a socket, or the substitute of a test.

use std::io::Result;
use std::net::{SocketAddr, UdpSocket};

/// Carries packets of a remote device. Nothing here waits.
pub trait Wire: Send {
    /// The next packet that has come, cut to `into`: its size and its sender; [`std::io::ErrorKind::WouldBlock`] when there is none.
    fn receive(&mut self, into: &mut [u8]) -> Result<(usize, SocketAddr)>;

    /// Sends a packet, or loses it.
    fn send(&mut self, packet: &[u8], to: SocketAddr);
}

impl Wire for UdpSocket {
    fn receive(&mut self, into: &mut [u8]) -> Result<(usize, SocketAddr)> {
        self.recv_from(into)
    }

    fn send(&mut self, packet: &[u8], to: SocketAddr) {
        // A packet that cannot be sent is a packet that is lost: the device goes to zero force by itself.
        let _ = self.send_to(packet, to);
    }
}
