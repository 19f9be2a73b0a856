//! Columns of laws, each made once: the rounds of a comparison ask for most of them again.

use super::force::{column, column_of_place};
use super::track::Track;
use haptics::law::{Effect, Law, MAX_PARAMETERS};
use std::cell::RefCell;
use std::collections::HashMap;

/// How a law becomes a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum How {
    /// [`column`]
    Means,
    /// [`column_of_place`]
    OfPlace,
    /// What a law with a memory does on its way over the rows.
    Remembered,
}

/// A law's id, the bits of its values, and how it became a column.
type Key = (&'static str, [u64; MAX_PARAMETERS], How);

/// What was made on one track, which changes in its loads only.
#[derive(Default)]
pub struct Columns {
    known: RefCell<HashMap<Key, Vec<f64>>>,
}

impl Columns {
    /// As [`column`].
    pub fn of(&self, track: &Track, effect: &Effect) -> Vec<f64> {
        self.made(effect.law(), &effect.values, How::Means, || column(track, effect))
    }

    /// As [`column_of_place`].
    pub fn of_place(&self, track: &Track, effect: &Effect) -> Vec<f64> {
        self.made(effect.law(), &effect.values, How::OfPlace, || column_of_place(track, effect))
    }

    /// What `make` makes of a law that remembers: the same for the same values, each time.
    pub fn remembered(&self, law: &'static dyn Law, values: &[f64], make: impl FnOnce() -> Vec<f64>) -> Vec<f64> {
        self.made(law, values, How::Remembered, make)
    }

    /// The loads changed: what goes with them is to be made anew.
    pub fn forget_loads(&mut self) {
        self.known.get_mut().retain(|(id, ..), _| haptics::law::law(id).is_some_and(|law| !law.feels_load()));
    }

    fn made(&self, law: &dyn Law, values: &[f64], how: How, make: impl FnOnce() -> Vec<f64>) -> Vec<f64> {
        let mut bits = [0; MAX_PARAMETERS];
        bits.iter_mut().zip(values).for_each(|(bits, value)| *bits = value.to_bits());
        self.known.borrow_mut().entry((law.id(), bits, how)).or_insert_with(make).clone()
    }
}

#[cfg(test)]
mod tests {
    use super::super::track::Row;
    use super::*;
    use haptics::law::{LoadFriction, Motion, ViscousFriction};

    fn track(load_n: f64) -> Track {
        let motion = Motion { velocity: 0.2, direction: 1.0, normal_force_n: load_n, ..Motion::default() };
        Track::of_rows(vec![Row { motion, ..Row::at_rest() }; 3])
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
        // Other values are another column.
        assert_eq!(columns.of(&track(5.0), &Effect::new(&LoadFriction, &[0.5]))[0], 2.5);
    }
}
