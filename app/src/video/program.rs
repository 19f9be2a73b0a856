//! Interface to `ffmpeg` and `ffprobe`.

use crate::video::reading::VideoError;
use serde::Deserialize;
use std::ffi::OsString;
use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};

/// Size of a read, bytes.
const CHUNK: usize = 64 << 10;
/// Number of stored bytes of error output: the first ones tell the cause.
const COMPLAINTS: u64 = 4 << 10;

/// Options that allow only files, and only formats that contain pictures themselves. A playlist may name anything, and
/// is read repeatedly.
const SAFE: [&str; 4] = [
    "-protocol_whitelist",
    "file",
    "-format_whitelist",
    "mov,matroska,avi,mpeg,mpegts,ogg,gif,asf,flv,mpegvideo,h264,hevc,mjpeg,ivf",
];

/// Properties of a video, known before its pictures are read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facts {
    /// Original frame rate, Hz.
    pub rate_hz: f64,
    /// Duration, s; 0 if the file does not state it.
    pub duration_s: f64,
}

/// True when the programs that read videos are installed.
pub fn is_there() -> bool {
    ["ffmpeg", "ffprobe"].iter().all(|name| {
        let run = Command::new(name).arg("-version").stdout(Stdio::null()).stderr(Stdio::null()).status();
        run.is_ok_and(|status| status.success())
    })
}

/// The answer of `ffprobe -of json`.
#[derive(Deserialize)]
struct Probe {
    #[serde(default)]
    streams: Vec<ProbeStream>,
    #[serde(default)]
    format: ProbeFormat,
}

#[derive(Deserialize)]
struct ProbeStream {
    #[serde(default)]
    avg_frame_rate: String,
    #[serde(default)]
    r_frame_rate: String,
    duration: Option<String>,
}

#[derive(Default, Deserialize)]
struct ProbeFormat {
    duration: Option<String>,
}

/// Reads rate and duration of the first video in a file.
pub fn look(file: &Path) -> Result<Facts, VideoError> {
    let mut command = Command::new("ffprobe");
    command.args(["-v", "error"]).args(SAFE).args(["-select_streams", "v:0"]);
    command.args(["-show_entries", "stream=avg_frame_rate,r_frame_rate,duration:format=duration", "-of", "json"]);
    command.arg("-i").arg(input(file)).stdin(Stdio::null());
    let answer = command.output().map_err(not_started)?;
    let no_video = |problem: String| VideoError::NoVideo { problem, file: file.to_path_buf() };
    let probe: Probe = serde_json::from_slice(&answer.stdout)
        .map_err(|_| no_video(first_line(&String::from_utf8_lossy(&answer.stderr), file)))?;
    let Some(stream) = probe.streams.first() else {
        let complaint = String::from_utf8_lossy(&answer.stderr);
        let none = complaint.trim().is_empty();
        return Err(no_video(if none { "it holds no picture".to_owned() } else { first_line(&complaint, file) }));
    };
    let rate_hz = [&stream.avg_frame_rate, &stream.r_frame_rate].into_iter().find_map(|text| ratio(text));
    let duration = stream.duration.as_ref().or(probe.format.duration.as_ref());
    let duration_s = duration.and_then(|text| text.parse().ok()).filter(|s: &f64| s.is_finite() && *s > 0.0);
    Ok(Facts { rate_hz: rate_hz.unwrap_or(crate::video::reading::MOST_HZ), duration_s: duration_s.unwrap_or(0.0) })
}

/// `30000/1001` → 29.97; `None` if the text is not a rate.
fn ratio(text: &str) -> Option<f64> {
    let (above, below) = text.split_once('/')?;
    let (above, below): (f64, f64) = (above.parse().ok()?, below.parse().ok()?);
    Some(above / below).filter(|r| r.is_finite() && *r > 0.0)
}

/// A path that is never taken for an option or an address.
pub(super) fn input(file: &Path) -> OsString {
    let mut input = OsString::from("file:");
    input.push(file);
    input
}

/// Consumer of the output chunks; returns true if more are wanted.
type Sink<'a> = &'a mut dyn FnMut(&[u8]) -> bool;

/// Converts the whole video to JPEG pictures at an even rate from time 0, no side longer than `most_pixels`.
pub fn jpeg_pictures(
    file: &Path,
    rate_hz: f64,
    most_pixels: u32,
    cancelled: &AtomicBool,
    sink: Sink<'_>,
) -> Result<(), VideoError> {
    let filter = format!(
        "fps={rate_hz}:start_time=0,scale=w='min({most_pixels},iw)':h='min({most_pixels},ih)':force_original_aspect_ratio=decrease"
    );
    stream(
        file,
        &["-vf", &filter, "-c:v", "mjpeg", "-q:v", "4", "-pix_fmt", "yuvj420p", "-f", "image2pipe"],
        cancelled,
        sink,
    )
}

/// Converts the whole video to grey pictures of one size, one byte per pixel.
pub fn grey_pictures(
    file: &Path,
    rate_hz: f64,
    [wide, high]: [usize; 2],
    cancelled: &AtomicBool,
    sink: Sink<'_>,
) -> Result<(), VideoError> {
    let filter = format!("fps={rate_hz}:start_time=0,scale={wide}:{high}:flags=area,format=gray");
    stream(file, &["-vf", &filter, "-f", "rawvideo"], cancelled, sink)
}

/// Runs `ffmpeg` and forwards its output. A damaged end is not an error as long as there were pictures before it.
fn stream(file: &Path, output: &[&str], cancelled: &AtomicBool, sink: Sink<'_>) -> Result<(), VideoError> {
    let mut command = Command::new("ffmpeg");
    command.args(["-nostdin", "-v", "error"]).args(SAFE).arg("-i").arg(input(file));
    command.args(["-map", "0:v:0", "-an", "-sn"]).args(output).args(["-threads", "1", "pipe:1"]);
    let mut child = Running(
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().map_err(not_started)?,
    );
    let complaints = child.0.stderr.take().map(|pipe| std::thread::spawn(move || first_words(pipe)));
    let mut chunk = vec![0; CHUNK];
    let mut came = 0_usize;
    if let Some(mut pipe) = child.0.stdout.take() {
        loop {
            if cancelled.load(Ordering::Relaxed) {
                return Err(VideoError::Cancelled);
            }
            match pipe.read(&mut chunk) {
                Ok(0) => break,
                Ok(n) => {
                    came += n;
                    if !sink(&chunk[..n]) {
                        return Ok(());
                    }
                }
                Err(e) if e.kind() == std::io::ErrorKind::Interrupted => {}
                Err(e) => return Err(VideoError::NotStarted(e)),
            }
        }
    }
    if came > 0 {
        return Ok(());
    }
    let said = complaints.and_then(|thread| thread.join().ok()).unwrap_or_default();
    Err(VideoError::NoVideo { problem: first_line(&said, file), file: file.to_path_buf() })
}

/// Child process that ends with its owner.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Reads all output, so that the program never blocks, and keeps the beginning.
pub(super) fn first_words(mut pipe: impl Read) -> String {
    let mut kept = Vec::new();
    let _ = pipe.by_ref().take(COMPLAINTS).read_to_end(&mut kept);
    let _ = std::io::copy(&mut pipe, &mut std::io::sink());
    String::from_utf8_lossy(&kept).into_owned()
}

/// First error line of the program, without the file's name, which is reported anyway.
pub(super) fn first_line(said: &str, file: &Path) -> String {
    let name = format!("file:{}", file.display());
    let line = said.lines().map(str::trim).find(|line| !line.is_empty()).unwrap_or("it holds no picture");
    line.replace(&format!("{name}: "), "").replace(&name, "the file")
}

pub(super) fn not_started(error: std::io::Error) -> VideoError {
    if error.kind() == std::io::ErrorKind::NotFound { VideoError::NoReader } else { VideoError::NotStarted(error) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_ratios() {
        assert!((ratio("30000/1001").expect("a rate") - 29.970_03).abs() < 1e-4);
        assert!(ratio("0/0").is_none() && ratio("25").is_none() && ratio("1/0").is_none() && ratio("-1/2").is_none());
    }

    #[test]
    fn a_name_is_never_an_option_or_an_address() {
        assert_eq!(input(Path::new("-y")), "file:-y");
        assert_eq!(input(Path::new("http://x/y.mp4")), "file:http://x/y.mp4");
    }

    #[test]
    fn complaints_do_not_repeat_the_file() {
        let said = "file:/a/b.mp4: Invalid data found\nmore";
        assert_eq!(first_line(said, Path::new("/a/b.mp4")), "Invalid data found");
        assert_eq!(first_line("  \n", Path::new("/a/b.mp4")), "it holds no picture");
    }
}
