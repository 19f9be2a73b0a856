//! Whether there is enough data, as a short table.

use crate::text::format;
use estimator::online::enough::Enough;
use std::fmt::Write;

/// One line a parameter: how much of the wanted accuracy is reached, and what is missing. Empty without wishes.
pub fn table(all: &[Enough]) -> String {
    let mut text = String::new();
    if all.is_empty() {
        return text;
    }
    let _ = writeln!(text, "enough data?");
    for one in all {
        let quantity = format::parameter(&one.name, None);
        let what = format!("{}  {}", format::object(&one.object), quantity.label);
        let _ = writeln!(text, "  {what:<34} {:>4.0} %  {}", 100.0 * one.share, format::missing(one));
    }
    text
}
