use crate::video::program::is_there;
use crate::video::reading::Video;
use crate::video::reading::VideoError;
use crate::video::reading::Watch;
use crate::video::reading::looks_like_video;
use crate::video::reading::motion;
use crate::video::writer::Writer;
use image::RgbImage;
use std::io::Write as _;
use std::path::Path;
use std::process::Command;
use std::sync::atomic::AtomicBool;

/// Writes a video of generated pictures: `of(k)` is the picture of index `k`.
pub fn film(file: &Path, rate_hz: u32, count: usize, of: impl Fn(usize) -> RgbImage) {
    let mut writer = Writer::begin(file, [160, 90], f64::from(rate_hz)).expect("it starts");
    for k in 0..count {
        writer.add(&of(k)).expect("it is taken");
    }
    writer.finish(file).expect("written");
}

/// A bright upright bar at `x`, 0 … 1.
pub fn bar(x: f64) -> RgbImage {
    let left = (x.clamp(0.0, 1.0) * 140.0) as u32;
    RgbImage::from_fn(160, 90, |column, _| image::Rgb([if (left..left + 20).contains(&column) { 220 } else { 40 }; 3]))
}

/// True, with a visible message, where videos cannot be read.
pub fn no_reader() -> bool {
    let missing = !is_there();
    if missing {
        let _ = writeln!(std::io::stderr(), "skipped: ffmpeg is not installed");
    }
    missing
}

fn read(file: &Path) -> Result<Video, VideoError> {
    Video::read(file, &Watch { progress: &|_| {}, cancelled: &AtomicBool::new(false) })
}

#[test]
fn the_picture_of_a_moment_is_that_of_the_moment() {
    if no_reader() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("hand, 1.mp4");
    film(&file, 20, 60, |k| bar(k as f64 / 59.0));
    let video = read(&file).expect("read");
    assert_eq!((video.count(), video.size, video.rate_hz), (60, [160, 90], 20.0));
    assert!((video.duration_s() - 3.0).abs() < 1e-9);
    for k in [0, 7, 30, 59] {
        assert_eq!(video.index_at(k as f64 / 20.0), Some(k));
        let picture = video.picture(k).expect("decoded");
        let bright: Vec<u32> = (0..160).filter(|x| picture.get_pixel(*x, 45).0[0] > 130).collect();
        let middle = f64::from(bright.iter().sum::<u32>()) / bright.len() as f64;
        let expected = (k as f64 / 59.0 * 140.0).floor() + 9.5;
        assert!((middle - expected).abs() < 1.5, "picture {k}: the bar is at {middle}, not {expected}");
    }
    assert_eq!((video.index_at(-0.01), video.index_at(3.0)), (None, None));
    assert!(video.picture(60).is_none());
}

#[test]
fn large_and_fast_videos_become_small_and_keep_their_shape() {
    if no_reader() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("large.mkv");
    let made = Command::new("ffmpeg")
        .args(["-nostdin", "-v", "error", "-f", "lavfi", "-i", "testsrc=d=1:s=1920x1080:r=60", "-c:v", "mpeg4", "-y"])
        .arg(&file)
        .status();
    assert!(made.expect("it runs").success());
    let video = read(&file).expect("read");
    assert_eq!((video.size, video.rate_hz, video.count()), ([720, 405], 30.0, 30));
}

#[test]
fn motion_is_where_the_picture_changes() {
    if no_reader() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("a.avi");
    // It rests, moves for a second, rests.
    film(&file, 25, 75, |k| bar(((k as f64 - 25.0) / 25.0).clamp(0.0, 1.0)));
    let (times, changes) = motion(&file, &AtomicBool::new(false)).expect("read");
    assert_eq!((times.len(), changes.len()), (74, 74));
    let mean = |from: f64, to: f64| {
        let within: Vec<f64> =
            times.iter().zip(&changes).filter(|(t, _)| (from..to).contains(*t)).map(|(_, c)| *c).collect();
        within.iter().sum::<f64>() / within.len() as f64
    };
    assert!(mean(1.1, 1.9) > 10.0 * mean(0.0, 0.9).max(mean(2.1, 3.0)), "{changes:?}");
}

#[test]
fn what_cannot_be_shown_says_why() {
    let folder = tempfile::tempdir().expect("a folder");
    let missing = read(&folder.path().join("none.mp4")).expect_err("no file").to_string();
    assert!(missing.starts_with("The video cannot be read") && missing.ends_with("none.mp4"), "{missing}");
    if no_reader() {
        return;
    }
    let text = folder.path().join("text.mp4");
    std::fs::write(&text, "t_s,q_m\n0,1\n").expect("written");
    let refused = read(&text).expect_err("no video").to_string();
    assert!(refused.starts_with("This is no video"), "{refused}");
    // A playlist of other files is not a video either: its targets are not opened.
    let whole = folder.path().join("whole.mp4");
    film(&whole, 10, 10, |_| bar(0.5));
    let list = folder.path().join("list.m3u8");
    let lines = format!("#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\n{}\n", whole.display());
    std::fs::write(&list, lines).expect("written");
    assert!(read(&list).is_err(), "a list is followed");
    let cancelled = Video::read(&whole, &Watch { progress: &|_| {}, cancelled: &AtomicBool::new(true) });
    assert!(matches!(cancelled, Err(VideoError::Cancelled)));
}

#[test]
fn a_video_that_breaks_off_is_shown_as_far_as_it_goes() {
    if no_reader() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("whole.mkv");
    film(&file, 20, 100, |k| bar(k as f64 / 99.0));
    let bytes = std::fs::read(&file).expect("there");
    let broken = folder.path().join("broken.mkv");
    std::fs::write(&broken, &bytes[..bytes.len() / 2]).expect("written");
    let count = read(&broken).expect("as far as it goes").count();
    assert!((10..100).contains(&count), "{count}");
}

#[test]
fn videos_are_told_by_how_they_begin() {
    let mp4 = b"\0\0\0\x20ftypisom\0\0\x02\0";
    assert!(looks_like_video(mp4) && looks_like_video(&[0x1a, 0x45, 0xdf, 0xa3, 1]));
    assert!(looks_like_video(b"RIFF\x10\0\0\0AVI LIST"));
    for other in [&b"t_s,q_m\n"[..], b"{\"a\": 1}", b"\x89MCAP0\r\n", b"PAR1", b"", b"RIFF\0\0\0\0WAVE", b"G"] {
        assert!(!looks_like_video(other), "{other:?}");
    }
}
