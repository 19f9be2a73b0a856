//! The answer in words.

use super::rates::Rates;
use super::verdict::{SIGNIFICANT, Verdict};
use super::weighing::Measured;

/// A rate of a force, mN/s.
fn force(rate: Measured) -> String {
    format!("{:+.2} ± {:.2} mN/s", 1e3 * rate.value, 1e3 * rate.std_error)
}

/// Mass lost or gained, g/s.
fn mass(leak: Option<Measured>) -> String {
    leak.map_or_else(String::new, |leak| {
        let way = if leak.value < 0.0 { "gains" } else { "loses" };
        format!("; it {way} {:.3} ± {:.3} g/s", 1e3 * leak.value.abs(), 1e3 * leak.std_error)
    })
}

pub(super) fn why(verdict: Verdict, rates: &Rates, leak: Option<Measured>) -> String {
    let reading = force(rates.reading);
    let bias = rates.drift.map_or_else(String::new, force);
    match verdict {
        Verdict::Steady => {
            format!("the reading does not change while the object is carried: {reading} over {:.1} s", rates.lasted_s)
        }
        Verdict::Leak => format!(
            "the reading changes by {reading} while the object is carried, and without it the sensors rest where they did \
             before ({bias}){}",
            mass(leak)
        ),
        Verdict::SensorDrift => format!(
            "the reading changes by {reading} while the object is carried, and the sensors' rest moved just so ({bias}): the weight \
             itself stays"
        ),
        Verdict::Both => format!(
            "the reading changes by {reading} while the object is carried; the sensors' rest moved, too ({bias}), but not by that \
             much{}",
            mass(leak)
        ),
        Verdict::CannotTell => cannot(rates, &reading, &bias),
    }
}

fn cannot(rates: &Rates, reading: &str, bias: &str) -> String {
    if rates.drift.is_some() {
        return format!(
            "the reading changes by {reading} while the object is carried, but the sensors' rest is known too badly ({bias}) to say \
             whether it moved as well"
        );
    }
    let missing = match (rates.before, rates.after) {
        (true, false) => "there is no reading without the object afterwards",
        (false, true) => "there is no reading without the object before",
        _ => "there is no reading without the object",
    };
    let sides = match rates.across {
        Some(a) if a.is_significant(SIGNIFICANT) => {
            "; the horizontal sum moves as well, so the sensors do drift, but the object may leak besides"
        }
        _ => "",
    };
    format!(
        "the reading changes by {reading} while the object is carried, and {missing}: a leak and a drift look alike{sides}"
    )
}

pub(super) fn motion(verdict: Verdict, rates: &Rates) -> Option<String> {
    if verdict != Verdict::CannotTell {
        return None;
    }
    Some(if rates.drift.is_some() {
        "carry it for longer, and let go for longer before and after".to_owned()
    } else if rates.before || !rates.after {
        "let go for a second, with the fingers off everything".to_owned()
    } else {
        "let go for a second before the next carry and once more after it".to_owned()
    })
}
