//! The shift of a file's clock to that of the log: stated, found in a channel of both, or told by dated clocks.

use super::grid::Signal;
use super::offset::{self, ClockOffset, Refusal};
use crate::origin::Dated;
use crate::units;
use haptics::recording::{JoinedFile, Recording};

/// A shift of times: the log's time is `t + offset_s + skew (t − middle_s)`.
pub struct Shift {
    offset_s: f64,
    middle_s: f64,
    skew: f64,
    /// The shift, its error, and its source, in words.
    pub said: String,
}

impl Shift {
    fn constant(offset_s: f64, said: String) -> Self {
        Self { offset_s, middle_s: 0.0, skew: 0.0, said }
    }

    fn found(found: ClockOffset, by: &str) -> Self {
        let ClockOffset { offset_s, half_width_s, middle_s, .. } = found;
        let mut said =
            format!("{} s (95 % interval) are added to its times, by {by}", with_error(offset_s, half_width_s));
        if let Some((skew, error)) = found.skew {
            let more = format!(
                "; that holds at its {middle_s:.1} s, and the log's clock counts {} ppm more than its own (one standard \
                 error)",
                with_error(1e6 * skew, 1e6 * error)
            );
            said.push_str(&more);
        }
        Self { offset_s, middle_s, skew: found.skew.map_or(0.0, |(skew, _)| skew), said }
    }

    /// A time of the file, s, on the log's clock.
    pub fn moved(&self, t: f64) -> f64 {
        t + self.offset_s + self.skew * (t - self.middle_s)
    }
}

/// A number with the digits that its error leaves.
fn with_error(value: f64, error: f64) -> String {
    let decimals = (1.0 - error.log10().floor()).clamp(0.0, 7.0) as usize;
    format!("{value:.decimals$} ± {error:.decimals$}")
}

/// The shift of `other` to the log. `own`: recordings of the log, one after the other on one clock. An error in words if
/// nothing shows the shift.
pub fn between(own: &[Dated], other: &Dated, file: &JoinedFile) -> Result<Shift, String> {
    let name = file.file.display().to_string();
    let stated = |offset_s: &str| {
        format!("\"join\": [{{\"file\": {}, \"offset_s\": {offset_s}}}]", serde_json::Value::from(name.as_str()))
    };
    if let Some(offset_s) = file.offset_s {
        return Ok(Shift::constant(offset_s, format!("{offset_s} s are added to its times, as stated")));
    }
    if let Some(by) = &file.by {
        let found = estimate(own, &other.recording, by.names()).map_err(|fault| fault.sentence(by.names(), &stated))?;
        return Ok(found);
    }
    let mut first: Option<String> = None;
    for name in shared_names(&own[0].recording, &other.recording) {
        match estimate(own, &other.recording, (name, name)) {
            Ok(found) => return Ok(found),
            Err(fault) => first = first.or_else(|| Some(fault.sentence((name, name), &stated))),
        }
    }
    if let (Some(here), Some(there)) = (own[0].origin, other.origin)
        && here.is_dated == there.is_dated
    {
        let offset_s = 1e-9 * (i128::from(there.ns) - i128::from(here.ns)) as f64;
        let said = "both clocks are dated and taken as they stand; their difference is unknown, and offset_s states it";
        return Ok(Shift::constant(offset_s, said.to_owned()));
    }
    let nothing = || {
        format!(
            "nothing shows the offset of its clock: no channel is in both files, and no dates are; state the seconds that \
             are added to its times, 0 for one clock: {}",
            stated("0")
        )
    };
    Err(first.unwrap_or_else(nothing))
}

/// Names of channels that both recordings have, the program's first.
fn shared_names<'a>(own: &'a Recording, other: &Recording) -> Vec<&'a str> {
    let names = own.channels.iter().map(|c| c.name.as_str()).filter(|name| other.channel(name).is_some());
    let (mut known, others): (Vec<&str>, Vec<&str>) = names.partition(|name| units::is_program_name(name));
    known.extend(others);
    known
}

/// Reason why a channel shows no shift.
enum Fault {
    Absent { name: String, is_own: bool },
    Refused(Refusal),
}

impl Fault {
    /// The sentence. `stated`: the sidecar with an offset.
    fn sentence(&self, (own, other): (&str, &str), stated: &dyn Fn(&str) -> String) -> String {
        let by = channel(own, other);
        match self {
            Self::Absent { name, is_own } => {
                let place = if *is_own { "the log" } else { "it" };
                format!("\"by\" names `{name}`, which is no channel of {place}; name one of both files")
            }
            Self::Refused(Refusal::Flat) => {
                format!("{by} has fewer than 50 samples or does not vary; state the offset: {}", stated("0"))
            }
            Self::Refused(Refusal::Unlike { offset_s, correlation }) => format!(
                "{by} shows no event of both files: at the best offset, {offset_s:.3} s, the correlation is only \
                 {correlation:.2}; state the offset: {}",
                stated("0")
            ),
            Self::Refused(Refusal::Ambiguous { offset_s, rival_s }) => format!(
                "{by} repeats itself: offsets of {offset_s:.3} s and of {rival_s:.3} s fit about as well; state the right \
                 one: {}",
                stated(&format!("{offset_s:.3}"))
            ),
        }
    }
}

/// A channel of both files, for a sentence.
fn channel(own: &str, other: &str) -> String {
    if own == other { format!("the channel `{own}`") } else { format!("the channel `{own}` with its `{other}`") }
}

/// The shift that a channel shows. `names`: in the log, and in the other file.
fn estimate(own: &[Dated], other: &Recording, (here, there): (&str, &str)) -> Result<Shift, Fault> {
    let absent = |name: &str, is_own| Fault::Absent { name: name.to_owned(), is_own };
    let (mut time, mut values) = (Vec::new(), Vec::new());
    for Dated { recording, .. } in own {
        values.extend_from_slice(recording.channel(here).ok_or_else(|| absent(here, true))?);
        time.extend_from_slice(recording.time_s.as_deref().unwrap_or_default());
    }
    let theirs = Signal {
        time_s: other.time_s.as_deref().unwrap_or_default(),
        values: other.channel(there).ok_or_else(|| absent(there, false))?,
    };
    let found = offset::estimate(Signal { time_s: &time, values: &values }, theirs).map_err(Fault::Refused)?;
    let by = format!("{} (correlation {:.3})", channel(here, there), found.correlation);
    Ok(Shift::found(found, &by))
}
