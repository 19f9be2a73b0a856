//! Videos made from pictures, by the program `ffmpeg`: for the gallery and tests, which have no camera.

use super::program::{first_line, first_words, input, not_started};
use crate::video::reading::VideoError;
use image::RgbImage;
use std::io::Write as _;
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::thread::JoinHandle;

/// A video that is being written.
pub struct Writer {
    program: Child,
    pipe: ChildStdin,
    complaints: JoinHandle<String>,
    size: [u32; 2],
}

impl Writer {
    /// Starts a video of pictures of `size` pixels at `rate_hz`; the file extension sets the format.
    ///
    /// # Errors
    /// A sentence: no `ffmpeg`.
    pub fn begin(file: &Path, size: [u32; 2], rate_hz: f64) -> Result<Self, VideoError> {
        let ([wide, high], rate) = (size, rate_hz.to_string());
        let mut program = Command::new("ffmpeg")
            .args(["-nostdin", "-v", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", &format!("{wide}x{high}")])
            .args(["-r", &rate, "-i", "pipe:0", "-c:v", "mpeg4", "-q:v", "3", "-pix_fmt", "yuv420p", "-y"])
            .arg(input(file))
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(not_started)?;
        let broken = || VideoError::NotStarted(std::io::ErrorKind::BrokenPipe.into());
        let pipe = program.stdin.take().ok_or_else(broken)?;
        let stderr = program.stderr.take().ok_or_else(broken)?;
        Ok(Self { program, pipe, complaints: std::thread::spawn(move || first_words(stderr)), size })
    }

    /// Adds a picture. One of another size is skipped.
    ///
    /// # Errors
    /// The disk or the program refuses.
    pub fn add(&mut self, picture: &RgbImage) -> Result<(), VideoError> {
        if [picture.width(), picture.height()] == self.size {
            self.pipe.write_all(picture.as_raw()).map_err(VideoError::NotStarted)?;
        }
        Ok(())
    }

    /// Ends the video; the file is complete afterwards.
    ///
    /// # Errors
    /// Error message of the program.
    pub fn finish(mut self, file: &Path) -> Result<(), VideoError> {
        drop(self.pipe);
        let ended = self.program.wait().map_err(VideoError::NotStarted)?;
        if ended.success() {
            return Ok(());
        }
        let said = self.complaints.join().unwrap_or_default();
        Err(VideoError::NoVideo { problem: first_line(&said, file), file: file.to_path_buf() })
    }
}
