//! Sufficiency of the data, as a short table.

use crate::text::format;
use estimator::online::information::Enough;
use std::fmt::Write;

/// One line per parameter: attained share of the target accuracy, and the missing motion. Empty without targets.
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
