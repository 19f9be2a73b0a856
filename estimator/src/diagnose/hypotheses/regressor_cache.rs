//! Cache of regressors: the rounds of a comparison need most of them again.

use super::candidate::Column;
use crate::diagnose::data::regression_data::{Row, Track};
use crate::diagnose::data::row_means::{at_points, column, column_of_place, is_short, of_points};
use haptics::law::{Effect, Law, MAX_PARAMETERS};
use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;
use std::sync::Arc;

/// Method by which a law becomes a regressor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum How {
    /// Mean over each row, see [`column`].
    Means,
    /// [`column_of_place`]
    OfPlace,
    /// Simulated over the rows, for a law with memory.
    Remembered,
}

/// A law's id and the bits of its values.
type Which = (&'static str, [u64; MAX_PARAMETERS]);
/// A law with its values and the method of its regressor.
type Key = (Which, How);

fn which(law: &dyn Law, values: &[f64]) -> Which {
    let mut bits = [0; MAX_PARAMETERS];
    bits.iter_mut().zip(values).for_each(|(bits, value)| *bits = value.to_bits());
    (law.id(), bits)
}

/// Cache of the regressors of one track, of which only the loads change.
#[derive(Default)]
pub struct Columns {
    known: RefCell<HashMap<Key, Column>>,
    /// Force of the last law at the finer points: the next law may be it times the direction.
    felt: RefCell<Option<(Which, Rc<[f64]>)>>,
}

impl Columns {
    /// Regressor of a law, see [`column`].
    pub fn of(&self, track: &Track, effect: &Effect) -> Column {
        self.made(effect.law(), &effect.values, How::Means, || self.mean(track, effect))
    }

    /// Regressor of a law of position, see [`column_of_place`].
    pub fn of_place(&self, track: &Track, effect: &Effect) -> Column {
        self.made(effect.law(), &effect.values, How::OfPlace, || {
            if is_short(track) { column_of_place(track, effect) } else { self.mean(track, effect) }
        })
    }

    /// Regressor by means, see [`column`]. A law that is another law times the direction reuses that law, which is
    /// evaluated once for both.
    fn mean(&self, track: &Track, effect: &Effect) -> Vec<f64> {
        let (law, alone) = (effect.law(), |row: &Row| effect.force(&row.motion));
        let other = law.times_direction();
        let Some(felt) = self.felt(track, &Effect::new(other.unwrap_or(law), &effect.values)) else {
            return column(track, effect);
        };
        if other.is_none() {
            return of_points(track, &felt, alone);
        }
        let turned: Vec<f64> = felt.iter().zip(&track.fine).map(|(felt, point)| felt * point.direction).collect();
        of_points(track, &turned, alone)
    }

    /// Force at the finer points. None if the law needs more than they hold.
    fn felt(&self, track: &Track, effect: &Effect) -> Option<Rc<[f64]>> {
        let which = which(effect.law(), &effect.values);
        let mut last = self.felt.borrow_mut();
        if let Some((_, felt)) = last.as_ref().filter(|(known, _)| *known == which) {
            return Some(Rc::clone(felt));
        }
        let felt: Rc<[f64]> = at_points(track, effect)?.into();
        *last = Some((which, Rc::clone(&felt)));
        Some(felt)
    }

    /// Regressor of a law with memory, made by `make` at the first request for these values.
    pub fn remembered(&self, law: &'static dyn Law, values: &[f64], make: impl FnOnce() -> Vec<f64>) -> Column {
        self.made(law, values, How::Remembered, make)
    }

    /// Removes the regressors that depend on the loads after these changed.
    pub fn forget_loads(&mut self) {
        self.known.get_mut().retain(|((id, _), _), _| haptics::law::law(id).is_some_and(|law| !law.feels_load()));
    }

    fn made(&self, law: &dyn Law, values: &[f64], how: How, make: impl FnOnce() -> Vec<f64>) -> Column {
        let mut known = self.known.borrow_mut();
        Arc::clone(known.entry((which(law, values), how)).or_insert_with(|| make().into()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::data::regression_data::Fine;
    use crate::diagnose::data::regression_data::Span;
    use crate::diagnose::data::regression_data::Weighing;
    use haptics::law::LoadFriction;
    use haptics::law::LocalPush;
    use haptics::law::LocalResistance;
    use haptics::law::Motion;
    use haptics::law::ViscousFriction;

    fn track(load_n: f64) -> Track {
        let motion = Motion { velocity: 0.2, direction: 1.0, normal_force_n: load_n, ..Motion::default() };
        Track::of_rows(vec![Row { motion, ..Row::default() }; 3])
    }

    #[test]
    fn a_column_is_made_once_and_anew_where_it_goes_with_a_load_that_changed() {
        let mut columns = Columns::default();
        let (drags, rubs) = (Effect::new(&ViscousFriction, &[1.0]), Effect::new(&LoadFriction, &[1.0]));
        let both = |columns: &Columns, track: &Track| [columns.of(track, &drags)[0], columns.of(track, &rubs)[0]];
        assert_eq!(both(&columns, &track(2.0)), [0.2, 2.0]);
        assert_eq!(both(&columns, &track(5.0)), [0.2, 2.0], "nobody said that the loads had changed");
        columns.forget_loads();
        assert_eq!(both(&columns, &track(5.0)), [0.2, 5.0]);
        // Other values make another regressor.
        assert_eq!(columns.of(&track(5.0), &Effect::new(&LoadFriction, &[0.5]))[0], 2.5);
    }

    #[test]
    fn what_resists_and_what_pushes_at_a_place_are_told_apart_by_the_direction_at_every_point() {
        // The direction reverses in the middle of a row.
        let point = |k: usize| Fine { position: 0.01, direction: if k < 3 { 1.0 } else { -0.5 }, ..Fine::default() };
        let span = Span { start: 0, len: 4, weighing: Weighing::Even };
        let rows = vec![Row { span, ..Row::default() }];
        let track = Track { fine: (0..4).map(point).collect(), period_s: 0.04, ..Track::of_rows(rows) };
        let columns = Columns::default();
        let of =
            |law: &'static dyn Law, place: f64| columns.of_place(&track, &Effect::new(law, &[1.0, place, 0.04]))[0];
        for place in [0.01, 0.02] {
            let pushes = of(&LocalPush, place);
            assert!((of(&LocalResistance, place) - 0.625 * pushes).abs() < 1e-12 && pushes > 0.4, "{pushes}");
        }
        assert_eq!(of(&LocalPush, 0.01), 1.0);
    }
}
