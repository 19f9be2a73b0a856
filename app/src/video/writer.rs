//! Videos made from pictures, by the program `ffmpeg`: for what has no camera, as the gallery and tests.

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
    /// Begins a video of pictures of `size` pixels, `rate_hz` a second; the file's ending tells the format.
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

    /// Another picture. One of another size is left out.
    ///
    /// # Errors
    /// The disk or the program refuses.
    pub fn add(&mut self, picture: &RgbImage) -> Result<(), VideoError> {
        if [picture.width(), picture.height()] == self.size {
            self.pipe.write_all(picture.as_raw()).map_err(VideoError::NotStarted)?;
        }
        Ok(())
    }

    /// The end; the file is whole afterwards.
    ///
    /// # Errors
    /// What the program complained about.
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
