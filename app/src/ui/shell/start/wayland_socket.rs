//! The open connection to a Wayland compositor that a program may be started with.

/// Environment variable that holds the number of its file descriptor.
pub const VARIABLE: &str = "WAYLAND_SOCKET";

/// True if this number is an open file, or none is named. The window library aborts at any other.
pub fn is_open(text: &str) -> bool {
    text.is_empty()
        || text.parse::<u32>().is_ok_and(|number| std::path::Path::new(&format!("/dev/fd/{number}")).exists())
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::fd::AsRawFd as _;

    #[test]
    fn an_open_file_is_told_from_a_number_that_is_none() {
        let file = tempfile::tempfile().expect("a file");
        assert!(is_open("") && is_open(&file.as_raw_fd().to_string()));
        assert!(!is_open("7777777") && !is_open("-1") && !is_open("abc"));
    }
}
