//! Times of the calendar and of the day, as loggers write them.

use crate::units::Dimension;
use crate::written_units::{self, Written};

/// Nanoseconds of a second, and seconds of a day.
const NS: i64 = 1_000_000_000;
pub const DAY_S: i64 = 86_400;

/// Order of day and month in dates of numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Order {
    /// Month first between slashes, day first between points and hyphens.
    #[default]
    Usual,
    /// Day first between slashes, month first between hyphens.
    Other,
}

impl Order {
    /// The other order.
    pub fn other(self) -> Self {
        if self == Self::Usual { Self::Other } else { Self::Usual }
    }
}

/// Form of the stamps of a table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Form {
    /// Column of the dates, if they stand apart from the times of the day.
    pub date: Option<usize>,
    /// True for stamps with a date, false for times of the day alone.
    pub is_dated: bool,
    /// Order of day and month.
    pub order: Order,
}

impl Form {
    /// Nanoseconds since the start of 1970, or since midnight of a time alone. `text`: the date, a blank, and the time.
    pub fn read(self, text: &str) -> Option<i64> {
        if self.is_dated { with_date(text, self.order) } else { of_day(text) }
    }
}

/// Evidence of a table's dates for the order of day and month.
#[derive(Clone, Copy, Debug, Default)]
pub struct Days {
    /// True if a date on another day than the first has two readings.
    pub is_open: bool,
    /// True if a date has one reading only, for a day above 12.
    pub is_settled: bool,
}

impl Days {
    /// Looks at a stamp, which may be on another day than the first.
    pub fn look_at(&mut self, form: Form, text: &str, is_another_day: bool) {
        let settles = settles_order(text).filter(|_| form.is_dated);
        self.is_settled |= settles == Some(true);
        self.is_open |= settles == Some(false) && is_another_day;
    }
}

/// Nanoseconds since the start of 1970 of a date with a time, or since midnight of a time alone: `2025-04-17T17:00:08.12Z`,
/// `20250417T170008.12Z`, `17.04.2025 17:00:08,12`, `4/17/25 5:00:08 PM`, `17:00:08.12`. A zone is left out of account but for its offset.
pub fn parse(text: &str) -> Option<i64> {
    with_date(text, Order::Usual).or_else(|| with_date(text, Order::Other)).or_else(|| of_day(text))
}

fn with_date(text: &str, order: Order) -> Option<i64> {
    let (rest, noon) = half_day(without_zone_name(text));
    let (rest, offset_s) = zone(rest);
    let rest = without_zone_name(rest);
    let (date, time) = rest.split_once(['T', ' '])?;
    let day_ns = day(date, order)?.checked_mul(DAY_S)?.checked_sub(offset_s)?.checked_mul(NS)?;
    let time = time.trim();
    let basic = || is_basic(date).then(|| basic_time(time)).flatten();
    day_ns.checked_add(time_of_day(time, noon).or_else(basic)?)
}

/// True for a date of eight digits without marks, `20250417` (ISO 8601, basic format).
fn is_basic(date: &str) -> bool {
    date.len() == 8 && date.bytes().all(|b| b.is_ascii_digit())
}

/// Nanoseconds since midnight of a time without colons, `170008.12`, as it stands behind such a date.
fn basic_time(time: &str) -> Option<i64> {
    let (hour, minute, second) = (time.get(..2)?, time.get(2..4)?, time.get(4..)?);
    time_of_day(&format!("{hour}:{minute}:{second}"), None)
}

/// Nanoseconds since midnight of a time of the day without a date, or of a duration.
pub fn of_day(text: &str) -> Option<i64> {
    let (rest, noon) = half_day(without_zone_name(text));
    time_of_day(zone(rest).0, noon).or_else(|| duration(text.trim()))
}

/// Nanoseconds of a duration as MATLAB writes it, `0.005 sec`, or pandas, `0 days 00:00:00.005`; also `5ms`, `PT0.005S` (ISO 8601),
/// and `-00:00:05.000` before a trigger.
fn duration(text: &str) -> Option<i64> {
    if let Some(rest) = text.strip_prefix('-') {
        return if rest.matches(':').count() == 2 { time_of_day(rest, None).map(i64::wrapping_neg) } else { None };
    }
    if let Some((days, time)) = text.split_once(" days ") {
        return (days.parse::<i64>().ok()?.checked_mul(DAY_S * NS)?).checked_add(time_of_day(time, None)?);
    }
    if let Some(rest) = text.strip_prefix("PT") {
        let (minutes, seconds) = rest.split_once('M').unwrap_or(("0", rest));
        let seconds = minutes.parse::<f64>().ok()? * 60.0 + seconds.strip_suffix('S')?.parse::<f64>().ok()?;
        return nanoseconds(seconds);
    }
    let end = text.find(|c: char| !c.is_ascii_digit() && c != '.').filter(|end| *end > 0)?;
    let (number, unit) = (&text[..end], text[end..].trim_start());
    match written_units::parse(unit, &[Dimension::Time]) {
        Written::Known(Dimension::Time, factor) => nanoseconds(number.parse::<f64>().ok()? * factor),
        _ => None,
    }
}

fn nanoseconds(seconds: f64) -> Option<i64> {
    let ns = seconds * NS as f64;
    (ns.abs() < i64::MAX as f64).then(|| ns.round() as i64)
}

/// The text without the name of a zone behind a blank: `UTC`, `CEST`.
fn without_zone_name(text: &str) -> &str {
    let text = text.trim();
    let is_name = |word: &str| (3..=5).contains(&word.len()) && word.bytes().all(|b| b.is_ascii_uppercase());
    text.rsplit_once(' ').filter(|(_, word)| is_name(word)).map_or(text, |(rest, _)| rest.trim_end())
}

/// True for a date without a time.
pub fn is_date(text: &str) -> bool {
    day(text.trim(), Order::Usual).or_else(|| day(text.trim(), Order::Other)).is_some()
}

/// True for a text whose date settles the order of day and month, false for one that has two readings; none for a date
/// that is the same in both orders.
pub fn settles_order(text: &str) -> Option<bool> {
    let date = text.trim().split(['T', ' ']).next().unwrap_or_default();
    match (day(date, Order::Usual), day(date, Order::Other)) {
        (Some(usual), Some(other)) => (usual != other).then_some(false),
        (None, None) => None,
        _ => Some(true),
    }
}

/// True if the two stamps, ns, lie on different days.
pub fn is_another_day(a_ns: i64, b_ns: i64) -> bool {
    a_ns.div_euclid(DAY_S * NS) != b_ns.div_euclid(DAY_S * NS)
}

/// The text without AM or PM, also written `a.m.`, and true for PM.
fn half_day(text: &str) -> (&str, Option<bool>) {
    let upper = text.to_ascii_uppercase();
    let ends = |ends: [&str; 2]| {
        let end = ends.into_iter().find(|end| upper.ends_with(end))?;
        Some(text[..text.len() - end.len()].trim_end())
    };
    match (ends(["AM", "A.M."]), ends(["PM", "P.M."])) {
        (Some(rest), _) => (rest, Some(false)),
        (_, Some(rest)) => (rest, Some(true)),
        _ => (text, None),
    }
}

/// The text without its zone, and the zone's offset, s.
fn zone(text: &str) -> (&str, i64) {
    if let Some(rest) = text.strip_suffix(['Z', 'z']) {
        return (rest, 0);
    }
    // A date has hyphens, too: the sign of a zone stands behind a colon, or behind the T of a time without any.
    let clock = text.find(':').or_else(|| text.find('T')).unwrap_or(text.len());
    let sign = text[clock..].rfind(['+', '-']).map(|at| clock + at);
    let parsed = sign.and_then(|at| {
        let digits: String = text[at + 1..].chars().filter(char::is_ascii_digit).collect();
        let value: i64 = digits.parse().ok()?;
        let seconds = if digits.len() <= 2 { 3600 * value } else { 3600 * (value / 100) + 60 * (value % 100) };
        Some((&text[..at], if text[at..].starts_with('-') { -seconds } else { seconds }))
    });
    parsed.unwrap_or((text, 0))
}

/// Number of a month by its name, in English or German, or by its first three letters.
fn month(text: &str) -> Option<i64> {
    const NAMES: [(&str, &str); 12] = [
        ("january", "januar"),
        ("february", "februar"),
        ("march", "märz"),
        ("april", "april"),
        ("may", "mai"),
        ("june", "juni"),
        ("july", "juli"),
        ("august", "august"),
        ("september", "september"),
        ("october", "oktober"),
        ("november", "november"),
        ("december", "dezember"),
    ];
    let text = text.to_lowercase();
    let is = |name: &str| text == name || name.chars().take(3).eq(text.chars());
    let at = NAMES.iter().position(|(english, german)| is(english) || is(german))?;
    i64::try_from(at + 1).ok()
}

/// Days since the start of 1970 of `2025-04-17`, `20250417`, `2025/04/17`, `17.04.2025`, `17-Apr-2025` or `4/17/2025`.
fn day(date: &str, order: Order) -> Option<i64> {
    let basic = || vec![&date[..4], &date[4..6], &date[6..]];
    let parts: Vec<&str> = if is_basic(date) { basic() } else { date.split(['-', '/', '.']).collect() };
    let [a, b, c] = parts.as_slice() else { return None };
    let number = |text: &str| text.parse::<i64>().ok().filter(|_| text.bytes().all(|b| b.is_ascii_digit()));
    let (year, month, day) = match () {
        () if a.len() == 4 => (number(a)?, number(b).or_else(|| month(b))?, number(c)?),
        () if is_month_first(date, order) => (number(c)?, number(a)?, number(b)?),
        () => (number(c)?, number(b).or_else(|| month(b))?, number(a)?),
    };
    let year = if year < 100 { 2000 + year } else { year };
    if !(1900..2200).contains(&year) || !(1..=12).contains(&month) || !(1..=31).contains(&day) {
        return None;
    }
    // Days of the proleptic Gregorian calendar, with years from March on (Hinnant 2013).
    let (y, m) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    let (era, of_era) = (y.div_euclid(400), y.rem_euclid(400));
    let of_year = (153 * m + 2) / 5 + day - 1;
    Some(era * 146_097 + 365 * of_era + of_era / 4 - of_era / 100 + of_year - 719_468)
}

fn is_month_first(date: &str, order: Order) -> bool {
    if date.contains('/') { order == Order::Usual } else { date.contains('-') && order == Order::Other }
}

/// Nanoseconds since midnight of `17:00`, `17:00:08`, `17:00:08.123456` or `17:00:08:123` (milliseconds, or micro- or nanoseconds
/// in six or nine digits), and of minutes and seconds, `58:55.000`, as spreadsheets write them.
fn time_of_day(time: &str, afternoon: Option<bool>) -> Option<i64> {
    let mut parts = time.split(':');
    let (first, next, last) = (parts.next()?, parts.next()?, parts.next());
    let (hour, minute, second) = match last {
        None if next.contains(['.', ',']) => ("0", first, next),
        _ => (first, next, last.unwrap_or("0")),
    };
    let (second, fraction) = match (second.split_once(['.', ',']), parts.next()) {
        (Some(parted), None) => parted,
        (None, None) => (second, ""),
        (None, Some(fraction)) if matches!(fraction.len(), 3 | 6 | 9) => (second, fraction),
        _ => return None,
    };
    let (hour, minute, second) = (whole(hour)?, whole(minute)?, whole(second)?);
    if parts.next().is_some() || hour > 23 || minute > 59 || second > 60 {
        return None;
    }
    let hour = match afternoon {
        Some(is_pm) => hour % 12 + if is_pm { 12 } else { 0 },
        None => hour,
    };
    let digits = fraction.get(..fraction.len().min(9)).filter(|f| f.bytes().all(|b| b.is_ascii_digit()))?;
    let ns = if digits.is_empty() { 0 } else { digits.parse::<i64>().ok()? * 10_i64.pow(9 - digits.len() as u32) };
    Some((3600 * hour + 60 * minute + second) * NS + ns)
}

fn whole(text: &str) -> Option<i64> {
    let is_short = (1..=2).contains(&text.len()) && text.bytes().all(|b| b.is_ascii_digit());
    if is_short { text.parse().ok() } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_of_the_calendar_are_read_to_the_nanosecond() {
        let base = 1_744_909_208_i64 * NS;
        for (text, ns) in [
            ("2025-04-17T17:00:08.120", base + 120_000_000),
            ("2025-04-17 17:00:08.120000", base + 120_000_000),
            ("2025-04-17T17:00:08Z", base),
            ("2025-04-17T19:00:08+02:00", base),
            ("2025-04-17T12:00:08.5-0500", base + NS / 2),
            ("17.04.2025 17:00:08,120", base + 120_000_000),
            ("4/17/25 5:00:08 PM", base),
            ("2025/04/17 17:00:08.123456789", base + 123_456_789),
            ("17:00:08.120", (17 * 3600 + 8) * NS + 120_000_000),
            ("58:55.005", (58 * 60 + 55) * NS + 5_000_000),
            ("17-Apr-2025 17:00:08.12", base + 120_000_000),
            ("12:30 AM", 30 * 60 * NS),
            ("12:30:08.5 p.m.", (12 * 3600 + 30 * 60 + 8) * NS + NS / 2),
            ("2025-04-17 17:00:08.12 UTC", base + 120_000_000),
            ("4/17/25 5:00:08 PM CEST", base),
            ("2025-04-17 19:00:08 GMT+2", base),
            ("0.005 sec", 5_000_000),
            ("5ms", 5_000_000),
            ("PT1M0.005S", 60 * NS + 5_000_000),
            ("-00:00:05.000", -5 * NS),
            ("1 days 00:00:00.005000", DAY_S * NS + 5_000_000),
            ("17:00:08:120", (17 * 3600 + 8) * NS + 120_000_000),
            ("17:00:08:120450", (17 * 3600 + 8) * NS + 120_450_000),
            ("20250417T170008.120Z", base + 120_000_000),
            ("20250417T190008.12+0200", base + 120_000_000),
            ("20250417 17:00:08", base),
            ("1970-01-01T00:00:00", 0),
        ] {
            assert_eq!(parse(text), Some(ns), "{text}");
        }
        for text in [
            "",
            "17",
            "0.5",
            "2025-04-17",
            "25:00",
            "2025-13-01T00:00",
            "a:b",
            "12:00:00.x",
            "5 mm",
            "5mm",
            "PT5",
            "sec",
            "-1:00",
            "1:2:3:4",
            "1:2:3.5:400",
            "17:00:08:12",
            "20250417",
            "20250417T1700",
            "20251317T170008",
            "170008.12",
        ] {
            assert_eq!(parse(text), None, "{text}");
        }
    }

    #[test]
    fn a_day_above_twelve_settles_the_order() {
        assert_eq!(parse("13/04/2026 12:00"), parse("13.04.2026 12:00"));
        assert_eq!(parse("04/13/2026 12:00"), parse("13.04.2026 12:00"));
        assert_eq!(parse("04-13-2026 12:00"), parse("13.04.2026 12:00"));
        assert_eq!(parse("03/04/2026 12:00"), parse("04.03.2026 12:00"));
        let texts = ["03/04/2026 12:00", "13/04/2026", "04-13-2026", "03/03/2026", "2026/03/04", "03.04.2026", "12:00"];
        assert!(is_date("02-mai-2026") && !is_date("02-xyz-2026") && settles_order("2-Jan-2026") == Some(true));
        assert_eq!(texts.map(settles_order), [Some(false), Some(true), Some(true), None, None, None, None]);
        assert!(
            is_date("2026-04-13")
                && is_date("20260413")
                && !is_date("2026-04-13 12:00")
                && !is_date("12:00")
                && !is_date("1.2")
        );
    }
}
