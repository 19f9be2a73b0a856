//! Extensions and depth of the X server. It is asked only after no window opened on it.

use x11rb::connection::{Connection as _, RequestConnection as _};
use x11rb::errors::ConnectError;
use x11rb::rust_connection::RustConnection;

/// Extensions that the window library needs: it panics without one.
const NEEDED: [&str; 3] = ["RANDR", "XInputExtension", "XKEYBOARD"];

/// An X server, as far as it says why no window opens on it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum XServer {
    /// Nobody answers.
    Silent,
    /// It does not let this program in.
    Refusing,
    /// It answers.
    Answering {
        /// Needed extensions that it lacks.
        lacks: Vec<&'static str>,
        /// Bits per pixel of its screen.
        depth: u8,
    },
}

/// Asks the server that `DISPLAY` names.
pub fn ask() -> XServer {
    match RustConnection::connect(None) {
        Ok((server, screen)) => {
            // An error is no answer, and is no reason to say that something is missing.
            let lacks_it = |name: &'static str| matches!(server.extension_information(name), Ok(None));
            let lacks = NEEDED.into_iter().filter(|name| lacks_it(name)).collect();
            let depth = server.setup().roots.get(screen).map_or(0, |screen| screen.root_depth);
            XServer::Answering { lacks, depth }
        }
        Err(ConnectError::SetupAuthenticate(_) | ConnectError::SetupFailed(_)) => XServer::Refusing,
        Err(_) => XServer::Silent,
    }
}
