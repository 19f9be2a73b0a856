//! Data from which the laws make their regressors over the rows of a track.

use super::candidate::{Candidate, Column};
use super::grid::Grid;
use super::regressor_cache::Columns;
use crate::diagnose::data::regression_data::{Place, Row, Track};
use crate::diagnose::data::row_means;
use haptics::law::{Effect, Law, MAX_PARAMETERS, Memory, Motion};

/// Data from which the regressors are made.
pub struct Dictionary<'a> {
    pub track: &'a Track,
    /// Force predicted by the base model, one per row.
    pub predicted: &'a [f64],
    /// Dry and viscous part of that prediction.
    pub resisting: &'a [f64],
    /// The dry friction at each row if it slid in the positive direction.
    pub dry: &'a [f64],
    /// Forces that are completely known: they determine the gain of the sensor.
    pub fixed: &'a [Vec<f64>],
    /// Causes that already belong to the model.
    pub without: &'a [&'a str],
    /// The values that are tried.
    pub grid: &'a Grid,
    /// Regressors already made on this track.
    pub columns: &'a Columns,
}

/// Units of a force, a coordinate and their mixtures.
pub(crate) struct Units {
    pub(crate) force: &'static str,
    pub(crate) length: &'static str,
    angular: bool,
}

impl Dictionary<'_> {
    pub(crate) fn units(&self) -> Units {
        let angular = self.track.coordinate == haptics::law::Coordinate::Angular;
        Units { force: if angular { "N m" } else { "N" }, length: if angular { "rad" } else { "m" }, angular }
    }

    /// Searched values of one form of a law.
    pub(crate) fn points<'a>(&'a self, id: &'a str, form: &'a str) -> impl Iterator<Item = [f64; 3]> + 'a {
        self.grid.of(id, form)
    }

    /// A regressor over the rows along the motion, 0 in free rows.
    pub(crate) fn column(&self, of: &dyn Fn(&Row) -> f64) -> Vec<f64> {
        let rows = self.track.rows.iter();
        rows.map(|r| if r.place == Place::Along { of(r) } else { 0.0 }).collect()
    }

    /// A regressor over all rows.
    pub(crate) fn every(&self, of: &dyn Fn(&Row) -> f64) -> Vec<f64> {
        self.track.rows.iter().map(of).collect()
    }

    /// The force of a law with these values, in the rows along the motion.
    pub(crate) fn law(&self, law: &'static dyn Law, values: &[f64]) -> Column {
        self.columns.of(self.track, &Effect::new(law, values))
    }

    /// The same for a law of position that depends on the direction in proportion, if at all.
    pub(crate) fn law_of_place(&self, law: &'static dyn Law, values: &[f64]) -> Column {
        self.columns.of_place(self.track, &Effect::new(law, values))
    }

    /// The unit of a parameter as the law's page has it.
    pub(crate) fn unit(&self, law: &'static dyn Law, index: usize) -> &'static str {
        let spec = &law.parameters()[index];
        if self.units().angular { spec.unit_angular } else { spec.unit }
    }

    /// A cause that is one law with one linear parameter, number `index`, the others at `values`.
    pub(crate) fn plain(&self, law: &'static dyn Law, values: &[f64], index: usize) -> Candidate {
        let spec = &law.parameters()[index];
        Candidate::of(law.id(), law.kind(), vec![self.law(law, values)], vec![(spec.name, self.unit(law, index))])
    }

    /// A regressor of a law with memory, evaluated between the rows; its memory is cleared at every segment.
    pub(crate) fn remembered(
        &self,
        law: &'static dyn Law,
        values: &[f64],
        of: &dyn Fn(&Motion, &Memory, &[f64; MAX_PARAMETERS]) -> f64,
    ) -> Column {
        self.columns.remembered(law, values, || {
            let mut padded = [0.0; MAX_PARAMETERS];
            padded[..values.len()].copy_from_slice(values);
            if self.track.fine.is_empty() {
                self.remembered_by_rows(law, &padded, of)
            } else {
                self.remembered_finely(law, &padded, of)
            }
        })
    }

    fn remembered_finely(
        &self,
        law: &'static dyn Law,
        padded: &[f64; MAX_PARAMETERS],
        of: &dyn Fn(&Motion, &Memory, &[f64; MAX_PARAMETERS]) -> f64,
    ) -> Vec<f64> {
        let track = self.track;
        let mut memory = Memory::default();
        let mut felt = Vec::with_capacity(track.fine.len());
        for (k, point) in track.fine.iter().enumerate() {
            let motion = |velocity| Motion {
                time_s: point.time_s,
                position: point.position,
                velocity,
                direction: point.direction,
                ..Motion::default()
            };
            match k.checked_sub(1).map(|before| track.fine[before]).filter(|before| before.segment == point.segment) {
                // The mean speed between two points.
                Some(before) => {
                    let mean = motion(0.5 * (before.velocity + point.velocity));
                    law.advance(&mean, padded, &mut memory, point.time_s - before.time_s);
                }
                None => memory = Memory::default(),
            }
            felt.push(of(&motion(point.velocity), &memory, padded));
        }
        row_means::of_points(track, &felt, |_| 0.0)
    }

    fn remembered_by_rows(
        &self,
        law: &'static dyn Law,
        padded: &[f64; MAX_PARAMETERS],
        of: &dyn Fn(&Motion, &Memory, &[f64; MAX_PARAMETERS]) -> f64,
    ) -> Vec<f64> {
        let mut memory = Memory::default();
        let rows = &self.track.rows;
        (0..rows.len())
            .map(|i| {
                if rows[i].place != Place::Along {
                    return 0.0;
                }
                if self.track.follows(i) {
                    let velocity = 0.5 * (rows[i - 1].motion.velocity + rows[i].motion.velocity);
                    let motion = Motion { velocity, ..rows[i].motion };
                    law.advance(&motion, padded, &mut memory, rows[i].motion.time_s - rows[i - 1].motion.time_s);
                } else {
                    memory = Memory::default();
                }
                of(&rows[i].motion, &memory, padded)
            })
            .collect()
    }
}
