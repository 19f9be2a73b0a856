//! Files of 5 GB under every name that the program reads, and tables of 10⁵ columns: refused in a sentence or read, in bounded memory.

use crate::{Chaos, MEMORY, must_be_a_sentence};
use app::history::store::Store;
use app::ui::document::autosave::Autosave;
use app::ui::document::prepared::Prepared;
use app::ui::document::project::Project;
use estimator::log;
use estimator::segment::definition::Definition;
use estimator::training::lesson::Lesson;
use haptics::device::udp::Key;
use haptics::recording::{Channel, Recording};
use haptics::world::World;
use rand::RngExt as _;
use std::fmt::Write as _;
use std::fs::File;
use std::io::Write as _;
use std::path::{Path, PathBuf};

const BYTES: u64 = 5 << 30;
/// Memory that looking at a huge file may take, bytes.
const ALLOWED: usize = 160 << 20;
const COLUMNS: usize = 100_000;
const ROWS: usize = 4;
/// A table with ten thousands of columns costs names and headers, not samples, bytes a column.
const A_COLUMN: usize = 6_000;

/// A file of 5 GB that takes no room: its first bytes, then zeros.
fn sparse(path: &Path, start: &[u8]) {
    let mut file = File::create(path).expect("made");
    file.write_all(start).expect("written");
    file.set_len(BYTES).expect("sparse");
}

/// What the work takes at its peak, bytes.
fn peak<T>(work: impl FnOnce() -> T) -> (T, usize) {
    MEMORY.reset_peak_usage();
    let before = MEMORY.current_usage();
    let done = work();
    (done, MEMORY.peak_usage().saturating_sub(before))
}

type Read = fn(&Path) -> Result<(), String>;

fn plain<T, E: std::fmt::Display>(read: Result<T, E>) -> Result<(), String> {
    read.map(drop).map_err(|error| error.to_string())
}

pub fn refused_or_bounded(chaos: &mut Chaos) {
    let folder = chaos.scratch();
    let files: [(&str, &[u8], Read); 10] = [
        ("a.csv", b"t_s,x1_m\n0,1\n", |p| plain(log::load(p, None))),
        ("b.mcap", b"\x89MCAP0\r\n", |p| plain(log::load(p, None))),
        ("c.parquet", b"PAR1", |p| plain(log::load(p, None))),
        ("world.json", b"{", |p| plain(World::load(p))),
        ("lesson.json", b"{", |p| plain(Lesson::load(p))),
        ("task.json", b"{", |p| plain(Definition::read(p))),
        ("work.touchstone.json", b"{", |p| plain(Project::read(p))),
        ("hand.key", b"00", |p| plain(Key::load(p))),
        ("history.sqlite", b"SQLite format 3\0", |p| plain(Store::open(p))),
        ("d.csv", b"t_s,x1_m\n0,1\n1,2\n", |p| {
            // The log is good; its sidecar is not.
            let log = p.with_file_name("e.csv");
            std::fs::write(&log, "t_s,x1_m\n0,1\n1,2\n").expect("written");
            plain(log::load(&log, Some(p)))
        }),
    ];
    for (name, start, read) in files {
        let path = folder.path().join(name);
        sparse(&path, start);
        let (refused, used) = peak(|| read(&path));
        must_be_a_sentence(&refused.expect_err("5 GB are refused"), &path);
        assert!(used < ALLOWED, "{name}: {used} bytes for a refusal");
        std::fs::remove_file(&path).expect("there");
        chaos.count("files of 5 GB", 1);
    }
    // What a window has kept is put aside.
    sparse(&folder.path().join("session.json"), b"{");
    let (begun, used) = peak(|| Autosave::begin(folder.path()).map(drop));
    assert!(begun.is_some() && used < ALLOWED, "{used} bytes");
    drop(folder);
    // In the first lap and now and then: one table takes seconds.
    if !chaos.folder.join("wide.csv").exists() || chaos.rng.random_range(0..4) == 0 {
        columns(chaos);
    }
}

/// Tables with 10⁵ columns in every format, made once.
fn wide_tables(folder: &Path) -> Vec<PathBuf> {
    let paths = ["csv", "mcap", "parquet"].map(|ending| folder.join("wide").with_extension(ending)).to_vec();
    if paths.iter().all(|path| path.exists()) {
        return paths;
    }
    let channel = |k: usize| Channel { name: format!("c{k}"), unit: String::new(), values: vec![k as f64; ROWS] };
    let wide = Recording {
        name: "wide".to_owned(),
        time_s: Some((0..ROWS).map(|i| i as f64).collect()),
        channels: (0..COLUMNS).map(channel).collect(),
        ..Recording::default()
    };
    std::fs::write(&paths[0], table()).expect("written");
    for path in &paths[1..] {
        log::write(std::slice::from_ref(&wide), path, &[]).expect("writes");
    }
    paths
}

/// As the window takes them in.
fn columns(chaos: &mut Chaos) {
    for path in wide_tables(&chaos.folder) {
        let (loaded, used) = peak(|| log::load(&path, None));
        let size = std::fs::metadata(&path).expect("there").len() as usize;
        assert!(used < ALLOWED + 2 * size, "{path:?}: {used} bytes for a file of {size}");
        match loaded {
            Err(error) => must_be_a_sentence(&error.to_string(), &path),
            Ok(mut recordings) => {
                let recording = recordings.remove(0);
                assert_eq!((recording.channels.len(), recording.len()), (COLUMNS, ROWS), "{path:?}");
                let (_, used) = peak(|| Prepared::new(recording));
                assert!(used < A_COLUMN * COLUMNS, "{path:?}: {used} bytes to show it");
                chaos.count("tables of 100 000 columns that load", 1);
            }
        }
    }
}

fn table() -> String {
    let mut text = (0..COLUMNS).fold("t_s".to_owned(), |mut all, k| {
        let _ = write!(all, ",c{k}");
        all
    });
    for row in 0..ROWS {
        let _ = write!(text, "\n{row}");
        (0..COLUMNS).for_each(|k| {
            let _ = write!(text, ",{k}");
        });
    }
    text + "\n"
}
