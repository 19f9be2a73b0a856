//! The key that both sides share, and the seal on every packet.

use hmac::{Hmac, KeyInit, Mac};
use sha2::Sha256;
use std::path::Path;

/// Bytes of a seal: HMAC-SHA-256, shortened to its first 128 bits (RFC 2104, section 5).
pub const SEAL_BYTES: usize = 16;

/// Why a key could not be used.
#[derive(Debug, thiserror::Error)]
pub enum KeyError {
    /// The file could not be read.
    #[error("the key file {file} could not be read ({reason}); make one with 64 random hexadecimal digits")]
    File {
        /// Its path.
        file: String,
        /// Reason that the operating system reports.
        reason: String,
    },
    /// Not a key.
    #[error("a key is 64 hexadecimal digits (256 bits), and this is not one; `openssl rand -hex 32` makes one")]
    Digits,
}

/// A shared key, ready to seal and to check. Its bytes are never printed.
#[derive(Clone)]
pub struct Key {
    // Keyed once: sealing a packet copies this state and allocates nothing.
    keyed: Hmac<Sha256>,
}

impl std::fmt::Debug for Key {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Key(secret)")
    }
}

impl Key {
    /// A key from its 32 bytes.
    pub fn new(bytes: [u8; 32]) -> Self {
        Self { keyed: Hmac::new(&padded(&bytes).into()) }
    }

    /// A key from 64 hexadecimal digits; white space around them is ignored.
    pub fn from_hex(text: &str) -> Result<Self, KeyError> {
        let digits = text.trim().as_bytes();
        let mut bytes = [0; 32];
        if digits.len() != 2 * bytes.len() {
            return Err(KeyError::Digits);
        }
        let digit = |d: u8| char::from(d).to_digit(16).map(|v| v as u8).ok_or(KeyError::Digits);
        for (byte, pair) in bytes.iter_mut().zip(digits.chunks_exact(2)) {
            *byte = 16 * digit(pair[0])? + digit(pair[1])?;
        }
        Ok(Self::new(bytes))
    }

    /// A key from a file that holds 64 hexadecimal digits.
    pub fn load(path: &Path) -> Result<Self, KeyError> {
        let text = crate::text_file::read(path)
            .map_err(|e| KeyError::File { file: path.display().to_string(), reason: e.to_string() })?;
        Self::from_hex(&text)
    }

    /// Weaknesses of a readable key file, as sentences for a person: a key that anybody would try first, or a file that
    /// others on this machine may read (known on Unix only).
    pub fn doubts(path: &Path) -> Vec<String> {
        let mut doubts = Vec::new();
        let digits = crate::text_file::read(path).unwrap_or_default();
        let digits = digits.trim().as_bytes();
        if digits.first().is_some_and(|first| digits.iter().all(|digit| digit == first)) {
            doubts.push(format!(
                "The key in {} is one digit over and over, which anybody can guess; `openssl rand -hex 32` makes a better one.",
                path.display()
            ));
        }
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // Any right of the group or of others.
            if std::fs::metadata(path).is_ok_and(|file| file.permissions().mode() & 0o077 != 0) {
                doubts.push(format!(
                    "Others on this machine may use the key file {}; `chmod 600` keeps it to yourself.",
                    path.display()
                ));
            }
        }
        doubts
    }

    pub(super) fn seal(&self, message: &[u8]) -> [u8; SEAL_BYTES] {
        let mut mac = self.keyed.clone();
        mac.update(message);
        let whole = mac.finalize().into_bytes();
        std::array::from_fn(|i| whole[i])
    }

    /// Takes the same time whether the first or the last byte is wrong.
    pub(super) fn is_sealed(&self, message: &[u8], seal: &[u8]) -> bool {
        let mut mac = self.keyed.clone();
        mac.update(message);
        seal.len() == SEAL_BYTES && mac.verify_truncated_left(seal).is_ok()
    }
}

/// HMAC's own padding of a short key to one block of SHA-256: zeros.
fn padded(key: &[u8; 32]) -> [u8; 64] {
    let mut block = [0; 64];
    block[..32].copy_from_slice(key);
    block
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seals_as_the_standard_says() {
        // RFC 4231, test case 2, with its 4-byte key padded to 32 bytes by zeros, which HMAC does anyway.
        let mut bytes = [0; 32];
        bytes[..4].copy_from_slice(b"Jefe");
        let seal = Key::new(bytes).seal(b"what do ya want for nothing?");
        assert_eq!(seal[..8], [0x5b, 0xdc, 0xc1, 0x46, 0xbf, 0x60, 0x75, 0x4e]);
    }

    #[test]
    fn keys_are_read_or_refused_in_words() {
        let hex = "00112233445566778899aabbccddeeff".repeat(2);
        assert!(Key::from_hex(&format!("  {hex}\n")).is_ok());
        for wrong in ["", "0011", &hex[1..], &hex.replace('a', "g"), &hex.replace("aa", "é")] {
            assert!(Key::from_hex(wrong).is_err_and(|e| e.to_string().contains("64 hexadecimal")), "{wrong}");
        }
        let missing = Key::load(Path::new("/nowhere/key")).expect_err("no such file");
        assert!(missing.to_string().contains("/nowhere/key"));
        assert_eq!(format!("{:?}", Key::new([7; 32])), "Key(secret)");
    }

    #[cfg(unix)]
    #[test]
    fn keys_that_anybody_knows_are_doubted() {
        use std::os::unix::fs::PermissionsExt;
        let file = std::env::temp_dir().join(format!("touchstone-key-{}", std::process::id()));
        let doubts = |digits: &str, mode: u32| {
            std::fs::write(&file, digits).expect("it takes text");
            std::fs::set_permissions(&file, std::fs::Permissions::from_mode(mode)).expect("it is ours");
            Key::doubts(&file).join(" ")
        };
        let random = "00112233445566778899aabbccddeeff".repeat(2);
        assert_eq!(doubts(&random, 0o600), "");
        assert!(doubts(&format!("{}\n", "0".repeat(64)), 0o600).contains("guess"));
        for mode in [0o644, 0o640, 0o604] {
            assert!(doubts(&random, mode).contains("chmod 600"), "{mode:o}");
        }
        std::fs::remove_file(&file).expect("it is ours");
        assert!(Key::doubts(Path::new("/nowhere/key")).is_empty(), "what cannot be read is another sentence");
    }
}
