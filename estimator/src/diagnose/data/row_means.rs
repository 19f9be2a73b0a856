//! Means over the rows of a track, with the parts that many regressors share computed once.

use super::limits::SLOW_ROW_S;
use super::regression_data::{Place, Row, Span, Track, Weighing};
use haptics::law::{Effect, Motion};

/// True if the rows are short for effects of position.
pub fn is_short(track: &Track) -> bool {
    track.period_s <= SLOW_ROW_S
}

/// Force of a law of position that depends on the direction in proportion, if at all, like [`column`]. Within a short
/// row it is nearly linear.
pub fn column_of_place(track: &Track, effect: &Effect) -> Vec<f64> {
    if !is_short(track) {
        return column(track, effect);
    }
    let of = |row: &Row| if row.place == Place::Along { effect.force(&row.motion) } else { 0.0 };
    track.rows.iter().map(of).collect()
}

/// Force of a law with its linear parameters at one (only the first, if it has several), 0 in free rows.
pub fn column(track: &Track, effect: &Effect) -> Vec<f64> {
    match at_points(track, effect) {
        Some(felt) => of_points(track, &felt, |row| effect.force(&row.motion)),
        None => by_rows(track, effect),
    }
}

/// Weights of rows, shared by rows with the same number of points.
#[derive(Default)]
pub struct Weights {
    known: Vec<((Weighing, usize), Vec<f64>)>,
}

impl Weights {
    fn of(&mut self, span: Span) -> &[f64] {
        let shape = (span.weighing, span.len);
        let place = self.known.iter().position(|(known, _)| *known == shape).unwrap_or_else(|| {
            self.known.push((shape, span.weights().map(|(_, weight)| weight).collect()));
            self.known.len() - 1
        });
        &self.known[place].1
    }

    /// Mean over a row of a function of the motion, as [`Track::mean`].
    pub fn mean(&mut self, track: &Track, row: &Row, of: impl Fn(&Motion) -> f64) -> f64 {
        if row.span.len == 0 {
            return of(&row.motion);
        }
        let points = &track.fine[row.span.start..row.span.start + row.span.len];
        let weighed = self.of(row.span).iter().zip(points);
        weighed.map(|(weight, point)| weight * of(&point.motion(&row.motion))).sum()
    }
}

/// Means of the force at the finer points, 0 in free rows. `alone`: value of a row without such points.
pub fn of_points(track: &Track, felt: &[f64], alone: impl Fn(&Row) -> f64) -> Vec<f64> {
    let mut weights = Weights::default();
    let mean = |row: &Row| {
        if row.place != Place::Along {
            return 0.0;
        }
        if row.span.len == 0 {
            return alone(row);
        }
        let felt = &felt[row.span.start..row.span.start + row.span.len];
        weights.of(row.span).iter().zip(felt).map(|(weight, felt)| weight * felt).sum()
    };
    track.rows.iter().map(mean).collect()
}

/// Force of a law at each of the finer points; `None` if the law needs more than they hold.
pub fn at_points(track: &Track, effect: &Effect) -> Option<Vec<f64>> {
    let force = |motion: Motion| effect.force(&motion);
    effect.law().is_of_path().then(|| track.fine.iter().map(|p| force(p.motion(&Motion::default()))).collect())
}

/// The force of a law, each row a mean over its own points, 0 in free rows.
fn by_rows(track: &Track, effect: &Effect) -> Vec<f64> {
    let mut weights = Weights::default();
    let mean = |row: &Row| {
        if row.place == Place::Along { weights.mean(track, row, |motion| effect.force(motion)) } else { 0.0 }
    };
    track.rows.iter().map(mean).collect()
}

/// Mean, and its standard error by the scatter of the values.
pub fn mean_and_error(values: &[f64]) -> (f64, f64) {
    let n = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
    (mean, (squares / (n - 1.0).max(1.0) / n).sqrt())
}

/// Standard deviation.
pub fn spread(values: &[f64]) -> f64 {
    let n = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / n;
    (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::data::regression_data::Fine;
    use haptics::law::CATALOGUE;
    use haptics::law::Motion;

    /// Rows of every weighing that overlap, one without points, and a free one.
    fn track() -> Track {
        let point = |k: usize| {
            let time_s = 0.0025 * k as f64;
            let (position, velocity) = (0.1 * (7.0 * time_s).sin(), 0.7 * (7.0 * time_s).cos());
            Fine { time_s, position, velocity, direction: (30.0 * velocity).tanh(), ..Fine::default() }
        };
        let kinds = [Weighing::Even, Weighing::Hat, Weighing::Tent, Weighing::Bell, Weighing::Parabola];
        let row = |k: usize| Row {
            span: Span { start: 5 * k, len: 9 + k % 3, weighing: kinds[k % kinds.len()] },
            motion: Motion {
                time_s: 0.1,
                position: 0.03,
                velocity: 0.4,
                acceleration: 0.1 * k as f64,
                direction: 0.9,
                normal_force_n: 1.0 + 0.2 * k as f64,
                up_along: 0.01 * k as f64,
            },
            ..Row::default()
        };
        let mut rows: Vec<Row> = (0..30).map(row).collect();
        rows[7].span.len = 0;
        rows[11].place = Place::FreeX;
        Track { fine: (0..200).map(point).collect(), ..Track::of_rows(rows) }
    }

    #[test]
    fn laws_looked_at_once_are_to_the_bit_what_they_are_row_by_row() {
        let track = track();
        for &law in CATALOGUE {
            let effect = Effect::new(law, &[1.0, 0.02, 0.15, 0.0, 0.4]);
            let plain = |row: &Row| {
                if row.place == Place::Along { track.mean(row, &|m| effect.force(m)) } else { 0.0 }
            };
            let bits = |column: &[f64]| column.iter().map(|v| v.to_bits()).collect::<Vec<u64>>();
            let wanted = bits(&track.rows.iter().map(plain).collect::<Vec<f64>>());
            assert_eq!(bits(&by_rows(&track, &effect)), wanted, "{}", law.id());
            let felt = at_points(&track, &effect);
            assert_eq!(felt.is_some(), law.is_of_path());
            if let Some(felt) = felt {
                let once = of_points(&track, &felt, |row| effect.force(&row.motion));
                assert_eq!(bits(&once), wanted, "{}", law.id());
            }
        }
    }
}
