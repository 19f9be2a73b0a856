//! A fit without some of the rows.

use super::layout::Use;
use super::normal_equations::{LEAST_LEFT, System, scaled};
use nalgebra::DMatrix;

impl System {
    /// Coefficients of the model's and the chosen candidates' regressors from all training rows but these; `None` if
    /// only these rows determine one of them.
    pub fn without(&self, rows: &[usize], chosen: &[usize]) -> Option<Vec<f64>> {
        let columns = self.columns(chosen);
        let all: Vec<usize> = columns.iter().copied().chain([self.target()]).collect();
        let trains = |i: &&usize| matches!(self.uses[**i], Use::Always | Use::Fold(_));
        let own = rows.iter().filter(trains);
        let mut left = DMatrix::from_fn(all.len(), all.len(), |a, b| self.train[(all[a], all[b])]);
        for row in own {
            // Rows that whitening removes are in none of the products: every column is zero there.
            let values: Vec<f64> = all.iter().map(|c| self.whitened[*c][*row]).collect();
            for (a, x) in values.iter().enumerate() {
                values.iter().enumerate().for_each(|(b, y)| left[(a, b)] -= x * y);
            }
        }
        let is_told = |k: usize| left[(k, k)] >= LEAST_LEFT * self.train[(all[k], all[k])];
        if !(0..columns.len()).all(is_told) {
            return None;
        }
        let places: Vec<usize> = (0..columns.len()).collect();
        scaled(&left, &places, columns.len()).map(|(values, ..)| values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::hypotheses::candidate::Candidate;
    use crate::diagnose::selection::layout::Layout;
    use haptics::law::Kind;

    #[test]
    fn rows_that_are_left_out_do_not_matter_and_what_they_alone_tell_is_not_told() {
        const ROWS: usize = 400;
        let window: Vec<usize> = (100..140).collect();
        let ramp: Vec<f64> = (0..ROWS).map(|i| (0.1 * i as f64).sin()).collect();
        let step: Vec<f64> = (0..ROWS).map(|i| f64::from(u8::from(window.contains(&i)))).collect();
        let candidates = vec![
            Candidate::one("inertia", Kind::Plant, "m", "kg", ramp.clone()),
            Candidate::one("local-resistance", Kind::Plant, "F", "N", step),
        ];
        let fit = |spoiled: f64| {
            let y: Vec<f64> =
                (0..ROWS).map(|i| 1.0 + 2.0 * ramp[i] + if window.contains(&i) { spoiled } else { 0.0 }).collect();
            let testable: Vec<bool> = (0..ROWS).map(|i| i % 2 == 0).collect();
            let layout = Layout::of(vec![0; ROWS], &testable, 0.01);
            System::new(&[vec![1.0; ROWS]], &candidates, &y, &layout, Vec::new())
        };
        for spoiled in [0.0, 7.0] {
            let values = fit(spoiled).without(&window, &[0]).expect("all other rows tell both");
            assert!((values[0] - 1.0).abs() < 1e-6 && (values[1] - 2.0).abs() < 1e-6, "{values:?}");
        }
        assert!((fit(7.0).solve(&[0]).expect("solved").values[0] - 1.0).abs() > 0.1, "with them it is another fit");
        assert!(fit(7.0).without(&window, &[1]).is_none());
    }
}
