//! The last word to a board when this program was killed: a second process that outlives it.
//!
//! The firmware keeps its last torque for ever. A dropped [`super::Board`] and a hanging servo are dealt with in this
//! process; SIGKILL is not. A child process therefore holds the board's port as its standard output and reads a pipe
//! whose other end only this process holds. At the end of the pipe, for whatever reason, the child writes [`farewell`].

use super::protocol::torque_frame;
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::time::Duration;

/// The argument that makes `touchstone` such a child; the board's id follows.
pub const ARGUMENT: &str = "torque-guard";

/// Bytes that end every torque: a zero command, then zeros that complete a frame which was cut in two and otherwise
/// read as resets, and a zero command again.
pub fn farewell(id: u8) -> Vec<u8> {
    let zero = torque_frame(id, [0.0; 2]);
    [zero.as_slice(), [0; 10].as_slice(), zero.as_slice()].concat()
}

/// The child's whole work: waits for the end of `pipe`, then says farewell on `port`, three times.
pub fn guard(mut pipe: impl Read, mut port: impl Write, id: u8) -> std::io::Result<()> {
    let mut bytes = [0; 64];
    while !matches!(pipe.read(&mut bytes), Ok(0) | Err(_)) {}
    for _ in 0..3 {
        port.write_all(&farewell(id))?;
        port.flush()?;
        std::thread::sleep(Duration::from_millis(10));
    }
    Ok(())
}

/// The running child; it says farewell when this is dropped, and when this process dies.
pub struct Outliving {
    child: Child,
    pipe: Option<ChildStdin>,
}

impl Outliving {
    /// Starts `program` (the `touchstone` program) as the guard of the board at `port`, which this process must not have
    /// opened exclusively.
    #[cfg(unix)]
    pub fn start(program: &Path, port: &str, id: u8) -> std::io::Result<Self> {
        use std::os::unix::fs::OpenOptionsExt;
        use std::os::unix::process::CommandExt;
        let port = std::fs::File::options().write(true).custom_flags(libc::O_NOCTTY).open(port)?;
        let mut child = Command::new(program)
            .args([ARGUMENT, &id.to_string()])
            .stdin(Stdio::piped())
            .stdout(Stdio::from(port))
            .stderr(Stdio::null())
            // A group of its own: Ctrl+C in the terminal must not end the guard with the guarded.
            .process_group(0)
            .spawn()?;
        let pipe = child.stdin.take();
        Ok(Self { child, pipe })
    }

    /// Elsewhere ports are open once only: there is no such guard.
    #[cfg(not(unix))]
    pub fn start(_: &Path, _: &str, _: u8) -> std::io::Result<Self> {
        Err(std::io::ErrorKind::Unsupported.into())
    }
}

impl Drop for Outliving {
    fn drop(&mut self) {
        self.pipe = None;
        // It ends by itself within a few hundredths of a second.
        let _ = self.child.wait();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn says_zero_when_the_pipe_ends() {
        let mut port = Vec::new();
        guard(std::io::empty(), &mut port, 5).expect("a vector takes everything");
        assert!(port.starts_with(&[2, 5, 0, 0, 0, 0, 0, 0, 0, 0]) && port.len() == 90);
        assert!(port.iter().all(|b| matches!(b, 0 | 2 | 5)));
    }

    #[test]
    fn a_frame_cut_in_two_is_completed_with_zeros() {
        // The firmware has read `02 05` and six bytes of torque; whatever follows, the last whole command is zero torque.
        for cut in 1..10 {
            let mut stream = torque_frame(5, [0.1, 0.1])[..cut].to_vec();
            stream.extend(farewell(5));
            let (mut at, mut last) = (0, None);
            while at < stream.len() {
                match stream[at] {
                    2 if at + 10 <= stream.len() => {
                        last = Some(stream[at + 2..at + 10].to_vec());
                        at += 10;
                    }
                    0 => {
                        last = Some(vec![0; 8]);
                        at += 2;
                    }
                    _ => at += 1,
                }
            }
            assert_eq!(last, Some(vec![0; 8]), "cut after {cut} bytes");
        }
    }
}
