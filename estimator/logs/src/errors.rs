//! Errors of reading a log: one sentence each, the problem first and the path last.

mod words;

use haptics::recording::Suggested;
use haptics::text_file::one_line as plain;
use std::collections::BTreeMap;
use std::path::PathBuf;
use words::{cell_advice, chosen, columns_advice, mapped_instead, place, stated_factor, unequal_advice, unit_fault};

/// Advice about a cell that is not like the others.
pub const CORRECT_CELL: &str = "correct that cell or remove the row";
/// Advice about a column without numbers, and about a cell of a container, which nobody corrects.
pub const MAP_ANOTHER: &str = "map another column in the sidecar, or record that channel again";
/// Advice about a clock without numbers.
pub const WRITE_TIMES: &str =
    "no row has a number or a known time there: write times as seconds or as 2026-03-04T23:59:55.123";

/// Error that kept a log from being loaded. Nothing is half-loaded: the result is a recording or one of these.
#[derive(Debug, thiserror::Error)]
pub enum LogError {
    /// The operating system refused.
    #[error("the file cannot be read ({reason}); check the path and its permissions: {path}", reason = plain(reason), path = path.display())]
    Io {
        /// Reason that the operating system reports.
        reason: String,
        /// The file.
        path: PathBuf,
    },
    /// A folder was given.
    #[error("this is a folder, not a log; name a file in it: {path}", path = path.display())]
    Directory {
        /// The folder.
        path: PathBuf,
    },
    /// A pipe, a device, …
    #[error("this is not a regular file; save the log to a file first: {path}", path = path.display())]
    NotAFile {
        /// Path that was given.
        path: PathBuf,
    },
    /// Too large to hold.
    #[error(
        "the file has {size_gib:.1} GiB and at most {limit_gib:.1} GiB can be read; cut it into shorter recordings: {path}",
        path = path.display()
    )]
    TooLarge {
        /// Its size, GiB.
        size_gib: f64,
        /// The limit, GiB.
        limit_gib: f64,
        /// The file.
        path: PathBuf,
    },
    /// The file is still being written.
    #[error(
        "the file changed from {before} to {after} bytes while it was read; wait until the recording has ended and read it again: {path}",
        path = path.display()
    )]
    Grew {
        /// Size before, bytes.
        before: u64,
        /// Size after, bytes.
        after: u64,
        /// The file.
        path: PathBuf,
    },
    /// The reading was cancelled.
    #[error("reading was cancelled; nothing of the file is loaded: {path}", path = path.display())]
    Cancelled {
        /// The file.
        path: PathBuf,
    },
    /// No content.
    #[error("the file is empty; record again or choose another file: {path}", path = path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// A header without samples.
    #[error("the file has a header but no samples; record again or choose another file: {path}", path = path.display())]
    HeaderOnly {
        /// The file.
        path: PathBuf,
    },
    /// Not a table at all.
    #[error("this is not a table of numbers ({why}); give a CSV file with a header line, an MCAP, a Parquet or a MATLAB file: {path}", why = plain(why), path = path.display())]
    NotATable {
        /// Signs of its real kind.
        why: String,
        /// The file.
        path: PathBuf,
    },
    /// Cut off, or with contents that cannot be.
    #[error("the {format} file is damaged ({why}); copy or export it again: {path}", why = plain(why), path = path.display())]
    Damaged {
        /// `MCAP`, `Parquet`, …
        format: &'static str,
        /// Fault and its place.
        why: String,
        /// The file.
        path: PathBuf,
    },
    /// The recorder still runs or did not end well, and it is not known to write whole blocks.
    #[error("the {format} file ends in the middle ({why}); wait until the recording has ended, or copy it again: {path}", why = plain(why), path = path.display())]
    CutOff {
        /// `MCAP`, `Parquet`, …
        format: &'static str,
        /// Place of its end.
        why: String,
        /// The file.
        path: PathBuf,
    },
    /// Sound, but packed in a way that is not read.
    #[error("the {format} file is compressed with {codec}, which is not read; write it with {instead}: {path}", codec = plain(codec), path = path.display())]
    Packed {
        /// `MCAP`, `Parquet`, …
        format: &'static str,
        /// Name of the compression.
        codec: String,
        /// Compressions that are read.
        instead: &'static str,
        /// The file.
        path: PathBuf,
    },
    /// A container without anything that can be read as columns of numbers.
    #[error("nothing in the {format} file can be read as columns of numbers ({why}); {advice}: {path}", why = plain(why), advice = columns_advice(format), path = path.display())]
    NoColumns {
        /// `MCAP`, `Parquet`, …
        format: &'static str,
        /// Contents of the container.
        why: String,
        /// The file.
        path: PathBuf,
    },
    /// Topics that cannot be put on one clock.
    #[error("the topics cannot be put on one clock ({why}); choose other columns in the sidecar, or record them together: {path}", why = plain(why), path = path.display())]
    Clocks {
        /// Conflict of the clocks.
        why: String,
        /// The file.
        path: PathBuf,
    },
    /// No clock of a container runs on.
    #[error("no clock of the file can be used ({why}); give \"rate_hz\" in the sidecar, or map the field that holds the time to t_s: {path}", why = plain(why), path = path.display())]
    NoClock {
        /// Fault of the clock, and its topic.
        why: String,
        /// The file.
        path: PathBuf,
    },
    /// An item of a list that is chosen by its place, although other items stand there later.
    #[error("the column `{column}` is an item by its place in the list, and the names at that place change; map it by its name ({names}): {path}", column = plain(column), names = plain(names), path = path.display())]
    ByPlace {
        /// The column.
        column: String,
        /// Columns by name that it could be.
        names: String,
        /// The file.
        path: PathBuf,
    },
    /// Another file of the same run does not fit.
    #[error("the file cannot be joined to the log ({why}): {path}", why = plain(why), path = path.display())]
    Join {
        /// Fault, and its remedy.
        why: String,
        /// The other file.
        path: PathBuf,
    },
    /// A recording cannot be kept in this format.
    #[error("the recording cannot be written ({why}): {path}", why = plain(why), path = path.display())]
    NotWritable {
        /// Fault, and its remedy.
        why: String,
        /// The file.
        path: PathBuf,
    },
    /// The first line holds numbers.
    #[error(
        "the first line holds numbers instead of column names; put a header line such as `t_s,x_m,y_m` above it, or map the columns by their places in the sidecar: \"columns\": {{\"t_s\": \"column 1\", \"q_m\": \"column 2\"}}: {path}",
        path = path.display()
    )]
    NoHeader {
        /// The file.
        path: PathBuf,
    },
    /// No column is read.
    #[error("no column holds numbers beside the time, or numbers in every row; map the columns that are meant with \"columns\" in the sidecar: {path}", path = path.display())]
    NoChannels {
        /// The file.
        path: PathBuf,
    },
    /// The same name twice.
    #[error("two columns give `{column}` ({first} and {second}); rename one, or choose with \"columns\" in the sidecar{chosen}: {path}", chosen = chosen(column, choice.as_deref()), column = plain(column), first = plain(first), second = plain(second), path = path.display())]
    DuplicateColumn {
        /// The name.
        column: String,
        /// The first column's name in the file.
        first: String,
        /// The second's.
        second: String,
        /// Name by which a sidecar can choose the first one.
        choice: Option<Box<str>>,
        /// The file.
        path: PathBuf,
    },
    /// A column that the sidecar or the quantity needs is not there.
    #[error("the column `{column}` is missing: {why}; the file has {present}{instead}: {path}", instead = mapped_instead(instead), why = plain(why), column = plain(column), present = plain(present), path = path.display())]
    MissingColumn {
        /// The program's or file's name of it.
        column: String,
        /// Task that needs the column.
        why: String,
        /// Columns of the file.
        present: String,
        /// Entries of `columns` with which it is not needed.
        instead: Box<BTreeMap<String, String>>,
        /// The file.
        path: PathBuf,
    },
    /// A unit the program cannot convert.
    #[error("the column `{column}` {has}; use one of {accepted} and the like, or state its factor in the sidecar: \"columns\": {{\"{name}\": \"{column}\"}}, \"scale\": {{\"{name}\": SI value of 1}}: {path}", name = plain(name), column = plain(column), has = unit_fault(unit), path = path.display())]
    UnknownUnit {
        /// The column.
        column: String,
        /// The unit found.
        unit: String,
        /// Units that can be used.
        accepted: &'static str,
        /// The program's name of its quantity.
        name: String,
        /// The file.
        path: PathBuf,
    },
    /// A length mapped to a force, or a similar mistake.
    #[error("`{target}` is mapped to `{column}`, whose unit `{unit}` measures something else; map another column, or give its factor with \"scale\" in the sidecar: {path}", column = plain(column), unit = plain(unit), target = plain(target), path = path.display())]
    WrongDimension {
        /// The program's name.
        target: String,
        /// The file's name.
        column: String,
        /// Its unit.
        unit: String,
        /// The file.
        path: PathBuf,
    },
    /// A name in metres above a unit row in millimetres, or a similar contradiction.
    #[error("the name of the column `{column}` says {named} and its stated unit is `{shown}`; state the factor that holds in the sidecar: {entry}: {path}", column = plain(column), shown = plain(stated), entry = stated_factor(column, (named, stated), *factor), path = path.display())]
    TwoUnits {
        /// The file's name.
        column: String,
        /// Unit in the name.
        named: &'static str,
        /// Unit in the file's row of units, in its metadata, or behind its numbers.
        stated: String,
        /// SI value of that unit over the SI value of the name's; none if they measure different things.
        factor: Option<f64>,
        /// The file.
        path: PathBuf,
    },
    /// Text where a number belongs.
    #[error("{at}, column `{column}`: {what}; {advice}: {path}", at = place(*row, *line), column = plain(column), what = plain(what), advice = cell_advice(advice, mend.as_deref()), path = path.display())]
    BadCell {
        /// Row of data, from 1.
        row: usize,
        /// Line in the file, from 1; 0 where the format has no lines.
        line: u64,
        /// Column.
        column: String,
        /// Content of the cell.
        what: Box<str>,
        /// The way out.
        advice: &'static str,
        /// Entries of a sidecar that leave out such rows, or columns that the log can do without.
        mend: Option<Box<Suggested>>,
        /// The file.
        path: PathBuf,
    },
    /// A row of another length.
    #[error("{at} has {found} cells and the header has {expected}; {advice}: {path}", at = place(*row, *line), advice = unequal_advice(*found, *expected), path = path.display())]
    UnequalRow {
        /// Row of data, from 1.
        row: usize,
        /// Line in the file, from 1; 0 where the format has no lines.
        line: u64,
        /// Cells there.
        found: usize,
        /// Cells in the header.
        expected: usize,
        /// The file.
        path: PathBuf,
    },
    /// Other column names stand between the rows.
    #[error("{at} holds other column names: a second table begins there; put it into a file of its own: {path}", at = place(*row, *line), path = path.display())]
    SecondTable {
        /// Row of data, from 1.
        row: usize,
        /// Line in the file, from 1.
        line: u64,
        /// The log.
        path: PathBuf,
    },
    /// Lines of facts stand between the names and the rows.
    #[error("{at} holds text and no numbers, and so do the rows above it: leave one line of column names right above the numbers, and no other: {path}", at = place(*row, *line), path = path.display())]
    NoNumbers {
        /// Row of data, from 1.
        row: usize,
        /// Line in the file, from 1.
        line: u64,
        /// The log.
        path: PathBuf,
    },
    /// A needed column is empty in one of several runs.
    #[error("{at}, column `{column}`: the run that begins there has no value in this column while the others have some; put the values of one instant into one row, or give the channel a file of its own and \"join\" it: {path}", at = place(*row, *line), column = plain(column), path = path.display())]
    NoValues {
        /// First row of the run, from 1.
        row: usize,
        /// Its line in the file, from 1; 0 where the format has no lines.
        line: u64,
        /// The column.
        column: String,
        /// The log.
        path: PathBuf,
    },
    /// Time does not increase.
    #[error("{at}, column `{column}`: time {how} ({previous} s, then {time} s); {advice}: {path}", how = if *goes_back { "goes backwards" } else { "stands still" }, at = place(*row, *line), column = plain(column), path = path.display())]
    Time {
        /// Row of data, from 1.
        row: usize,
        /// Line in the file, from 1; 0 where the format has no lines.
        line: u64,
        /// The time column.
        column: String,
        /// True if time goes backwards, false if it stands still.
        goes_back: bool,
        /// Before, s.
        previous: f64,
        /// There, s.
        time: f64,
        /// The way out.
        advice: Box<str>,
        /// Mean rate of the rows if time only stands still, Hz.
        rate_hz: Option<f64>,
        /// The file.
        path: PathBuf,
    },
    /// `select` leaves nothing.
    #[error("no row has {column} = {wanted}; the file has {present}: {path}", column = plain(column), present = plain(present), wanted = plain(wanted), path = path.display())]
    NothingSelected {
        /// The column.
        column: String,
        /// The value asked for.
        wanted: String,
        /// Values seen there.
        present: String,
        /// The file.
        path: PathBuf,
    },
    /// A window of time without samples.
    #[error("no sample lies in the window of time ({window}): the log runs from {first_s} to {last_s} s; state another --from-s or --to-s, or correct the window in the sidecar: {path}", path = path.display())]
    EmptyWindow {
        /// The window, in words.
        window: String,
        /// First time of the log, s.
        first_s: f64,
        /// Its last time, s.
        last_s: f64,
        /// The log.
        path: PathBuf,
    },
    /// The sidecar is faulty.
    #[error("the sidecar is malformed ({why}); correct it or remove it: {path}", why = plain(why), path = path.display())]
    Sidecar {
        /// Fault and its place.
        why: String,
        /// The sidecar.
        path: PathBuf,
    },
    /// A file could not be written.
    #[error("the file cannot be written ({reason}); check the folder and its permissions: {path}", reason = plain(reason), path = path.display())]
    Write {
        /// Reason that the operating system reports.
        reason: String,
        /// The file.
        path: PathBuf,
    },
}
