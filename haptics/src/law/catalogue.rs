//! The catalogue: every law of a coordinate, and the page of every cause.

use super::entry::Entry;
use super::force_law::Law;
use super::{contact, instrument};

macro_rules! catalogue {
    (causes { $($cause_file:ident: $cause:ident,)* } models { $($model_file:ident: $model:ident,)* }) => {
        /// Laws that a diagnosis can name.
        static CAUSES: &[&dyn Law] = &[$(&super::$cause),*];

        /// Every law of a coordinate: first those that a diagnosis can name, then those that only models are made of.
        pub static CATALOGUE: &[&dyn Law] = &[$(&super::$cause,)* $(&super::$model),*];
    };
}

crate::laws!(catalogue);

/// The law with this id.
pub fn law(id: &str) -> Option<&'static dyn Law> {
    CATALOGUE.iter().copied().find(|law| law.id() == id)
}

/// The pages of all laws, of contacts and of faults of the measurement.
pub fn entries() -> impl Iterator<Item = &'static Entry> {
    with_others(CATALOGUE)
}

/// The pages of everything that a diagnosis can name. Laws that only models are made of are left out.
pub fn causes() -> impl Iterator<Item = &'static Entry> {
    with_others(CAUSES)
}

/// The pages of these laws, then of contacts, then of faults of the measurement.
fn with_others(laws: &'static [&'static dyn Law]) -> impl Iterator<Item = &'static Entry> {
    laws.iter().map(|law| law.entry()).chain(contact::ENTRIES.iter().copied()).chain(&instrument::ENTRIES)
}

/// The page of the cause with this id.
pub fn cause(id: &str) -> Option<&'static Entry> {
    causes().find(|entry| entry.id == id)
}
