//! Reading a video into small pictures.

use crate::video::{pictures, program};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// Maximum frame rate, Hz: a higher one shows nothing new beside a plot.
pub(crate) const MOST_HZ: f64 = 30.0;
/// Maximum size of the longer side, pixels.
const MOST_PIXELS: u32 = 720;
/// Maximum duration of a video, s.
const LONGEST_S: f64 = 1_800.0;
/// Maximum memory for its pictures, bytes.
const MOST_BYTES: usize = 400 << 20;
/// Size of the pictures for motion detection, pixels.
const MOTION_PIXELS: [usize; 2] = [64, 36];

/// Reason why a video cannot be shown. Each is a sentence.
#[derive(Debug, thiserror::Error)]
pub enum VideoError {
    /// The reader is not installed.
    #[error(
        "Videos are read by the program ffmpeg, which was not found; install it (Debian and Ubuntu: apt install ffmpeg) and try again."
    )]
    NoReader,
    /// The reader did not start.
    #[error("The program ffmpeg cannot be started ({0}).")]
    NotStarted(std::io::Error),
    /// There is no such file, or reading is not permitted.
    #[error("The video cannot be read ({problem}): {}", file.display())]
    NoFile {
        /// What the system says.
        problem: std::io::Error,
        /// Which file.
        file: PathBuf,
    },
    /// The file contains no pictures.
    #[error("This is no video that can be read ({problem}): {}", file.display())]
    NoVideo {
        /// Error of the reader.
        problem: String,
        /// Which file.
        file: PathBuf,
    },
    /// It is too long or too large.
    #[error("The video is too long to be shown ({problem}); cut out the part that was recorded: {}", file.display())]
    TooLong {
        /// Exceeded limit, as text.
        problem: String,
        /// Which file.
        file: PathBuf,
    },
    /// The user has cancelled.
    #[error("Reading the video was cancelled.")]
    Cancelled,
}

/// Video of a recording: its file, and its position in time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VideoSource {
    /// The file.
    #[serde(with = "crate::path_bytes")]
    pub file: PathBuf,
    /// Index of the recording that it shows.
    #[serde(default)]
    pub recording: usize,
    /// Time of the recording at the video's first picture, s.
    #[serde(default)]
    pub begins_at_s: f64,
}

/// Decoded video.
#[derive(Clone, Debug)]
pub struct Video {
    /// Pictures a second.
    pub rate_hz: f64,
    /// Width and height, pixels.
    pub size: [usize; 2],
    /// All pictures as JPEG, one after another.
    bytes: Vec<u8>,
    /// End of each picture in `bytes`.
    ends: Vec<usize>,
}

/// Progress and cancellation of a read.
pub struct Watch<'a> {
    /// Receives the completed share, 0 … 1.
    pub progress: &'a dyn Fn(f64),
    /// Set to cancel.
    pub cancelled: &'a AtomicBool,
}

impl Video {
    /// Reads a video file of any format that `ffmpeg` knows.
    ///
    /// # Errors
    /// A sentence: no `ffmpeg`, no such file, no pictures in it, too long, or cancelled.
    pub fn read(file: &Path, watch: &Watch<'_>) -> Result<Self, VideoError> {
        std::fs::File::open(file).map_err(|problem| VideoError::NoFile { problem, file: file.to_path_buf() })?;
        let facts = program::look(file)?;
        if facts.duration_s > LONGEST_S {
            let problem = format!("{:.0} minutes; at most {:.0}", facts.duration_s / 60.0, LONGEST_S / 60.0);
            return Err(VideoError::TooLong { problem, file: file.to_path_buf() });
        }
        let rate_hz = facts.rate_hz.clamp(1.0, MOST_HZ);
        let expected = (facts.duration_s * rate_hz).max(1.0);
        let mut bytes = Vec::new();
        let mut cut = pictures::Cutter::default();
        program::jpeg_pictures(file, rate_hz, MOST_PIXELS, watch.cancelled, &mut |chunk| {
            cut.add(bytes.len(), chunk);
            bytes.extend_from_slice(chunk);
            (watch.progress)(cut.ends.len() as f64 / expected);
            bytes.len() <= MOST_BYTES
        })?;
        if bytes.len() > MOST_BYTES {
            let problem = format!("its pictures take more than {} MB", MOST_BYTES >> 20);
            return Err(VideoError::TooLong { problem, file: file.to_path_buf() });
        }
        let ends = cut.ends;
        let nothing = || VideoError::NoVideo { problem: "it holds no picture".to_owned(), file: file.to_path_buf() };
        let first = ends.first().and_then(|end| pictures::decode(&bytes[..*end])).ok_or_else(nothing)?;
        let size = [first.width() as usize, first.height() as usize];
        Ok(Self { rate_hz, size, bytes, ends })
    }

    /// Number of pictures, at least one.
    pub fn count(&self) -> usize {
        self.ends.len()
    }

    /// Duration, s.
    pub fn duration_s(&self) -> f64 {
        self.count() as f64 / self.rate_hz
    }

    /// Index of the picture at a time of the video, s; `None` before its start and after its end.
    pub fn index_at(&self, time_s: f64) -> Option<usize> {
        // A cursor placed exactly on a picture must not miss it by rounding.
        let index = (time_s * self.rate_hz + 1e-6).floor();
        (index >= 0.0 && index < self.count() as f64).then_some(index as usize)
    }

    /// Decoded picture; takes milliseconds. `None` past the end, or if the file is damaged.
    pub fn picture(&self, index: usize) -> Option<image::RgbImage> {
        let end = *self.ends.get(index)?;
        let start = if index == 0 { 0 } else { self.ends[index - 1] };
        pictures::decode(&self.bytes[start..end])
    }
}

/// Motion in a video: times of the video, s, and the mean change of brightness from picture to picture, 0 … 255.
///
/// # Errors
/// As [`Video::read`].
pub fn motion(file: &Path, cancelled: &AtomicBool) -> Result<(Vec<f64>, Vec<f64>), VideoError> {
    let rate_hz = program::look(file)?.rate_hz.clamp(1.0, MOST_HZ);
    let [wide, high] = MOTION_PIXELS;
    let mut grey = Vec::new();
    program::grey_pictures(file, rate_hz, MOTION_PIXELS, cancelled, &mut |chunk| {
        grey.extend_from_slice(chunk);
        grey.len() <= (LONGEST_S * MOST_HZ) as usize * wide * high
    })?;
    let change = |[a, b]: [&[u8]; 2]| {
        a.iter().zip(b).map(|(x, y)| f64::from(x.abs_diff(*y))).sum::<f64>() / (wide * high) as f64
    };
    let pictures: Vec<&[u8]> = grey.chunks_exact(wide * high).collect();
    let changes: Vec<f64> = pictures.windows(2).map(|pair| change([pair[0], pair[1]])).collect();
    // Motion between two pictures is assigned to the midpoint of their times.
    let times = (0..changes.len()).map(|k| (k as f64 + 0.5) / rate_hz).collect();
    Ok((times, changes))
}

/// True for the file signature of a video: MP4 and related formats, Matroska, AVI, MPEG, Ogg, GIF.
pub fn looks_like_video(start: &[u8]) -> bool {
    let at = |offset: usize, mark: &[u8]| start.get(offset..offset + mark.len()) == Some(mark);
    at(4, b"ftyp")
        || at(4, b"moov")
        || at(4, b"mdat")
        || at(0, &[0x1a, 0x45, 0xdf, 0xa3])
        || (at(0, b"RIFF") && at(8, b"AVI "))
        || at(0, &[0, 0, 1, 0xba])
        || at(0, b"OggS")
        || at(0, b"GIF8")
        || (at(0, &[0x47]) && at(188, &[0x47]))
}
