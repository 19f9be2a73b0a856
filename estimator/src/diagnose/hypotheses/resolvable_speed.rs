//! Lowest speed at which friction can be resolved: of motion within one averaged row only the sum is known.

use crate::diagnose::contract::CauseParameter;
use crate::diagnose::data::regression_data::{Place, Row, Track};
use haptics::law::{Law, Stribeck};

/// Number of rows, on either side, over which an acceleration is evaluated.
const ROWS: f64 = 2.0;
/// Share of the rows that count as slow.
const SLOW: f64 = 0.25;
/// Ratio by which a narrower peak is higher at equal area.
const HIGHER: f64 = 1.5;

/// Speed that a slow motion reaches within the time over which its acceleration is evaluated, m/s or rad/s.
fn told_from(track: &Track) -> f64 {
    let slow = track.quantile(SLOW, |r| r.motion.velocity.abs());
    let is_slow = |r: &&Row| r.place == Place::Along && r.motion.velocity.abs() <= slow;
    let mut rates: Vec<f64> = track.rows.iter().filter(is_slow).map(|r| r.motion.acceleration.abs()).collect();
    rates.sort_by(f64::total_cmp);
    rates.get(rates.len() / 2).map_or(0.0, |median| median * ROWS * track.period_s)
}

/// Widens the standard errors of Stribeck friction that falls off below the lowest resolved speed. Only its area is
/// then known, so its size and its speed are uncertain by as much as they are.
pub fn widen(id: &str, parameters: &mut [CauseParameter], track: &Track) {
    if id != Stribeck.id() {
        return;
    }
    let from = told_from(track);
    let Some(speed) = parameters.iter().find(|p| p.name == "vs").map(|p| p.value).filter(|vs| *vs > 0.0) else {
        return;
    };
    let open = (0.5 * from * (from / speed).powi(2)).min(from);
    for p in parameters {
        match p.name.as_str() {
            "vs" => p.std_error = p.std_error.hypot(open),
            "dFs" => p.std_error = p.std_error.hypot(p.value * HIGHER * (open / speed).min(1.0)),
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stated(vs: f64) -> Vec<CauseParameter> {
        let one = |name: &str, value| CauseParameter {
            name: name.to_owned(),
            value,
            std_error: 0.01 * value,
            unit: String::new(),
        };
        vec![one("dFs", 1.0), one("vs", vs)]
    }

    #[test]
    fn a_peak_that_is_gone_through_within_a_row_is_open_and_a_wide_one_is_not() {
        let row = |i: u32| {
            let mut row = Row::at_rest();
            row.motion.velocity = 0.01 * f64::from(i) - 0.5;
            row.motion.acceleration = 1.0;
            row
        };
        let track = Track::of_rows((0..100).map(row).collect());
        for (vs, least, most) in [(0.2, 0.009, 0.03), (0.01, 0.8, 2.0)] {
            let mut parameters = stated(vs);
            widen("stribeck", &mut parameters, &track);
            assert!((least..most).contains(&parameters[0].std_error), "{vs}: {parameters:?}");
        }
        let mut other = stated(0.01);
        widen("hysteresis", &mut other, &track);
        assert_eq!(other, stated(0.01));
    }
}
