//! Memories of laws from tick to tick: fixed in size, owned by the integrator, never allocated.

/// Most effects on one coordinate; the memory of the state is sized for them.
pub const MAX_EFFECTS: usize = 16;

/// Memory of one effect. The meaning of its places is the law's own affair; zero is the rest state of every law.
pub type Memory = [f64; 2];

/// The memories of a list of effects, by index.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Memories([Memory; MAX_EFFECTS]);

/// The memory of an effect that has none.
pub(super) static BLANK: Memory = [0.0; 2];

impl Memories {
    /// Memory of the effect at `index`; blank beyond [`MAX_EFFECTS`].
    pub fn get(&self, index: usize) -> &Memory {
        self.0.get(index).unwrap_or(&BLANK)
    }

    /// The same, to be changed; `None` beyond [`MAX_EFFECTS`].
    pub fn get_mut(&mut self, index: usize) -> Option<&mut Memory> {
        self.0.get_mut(index)
    }
}
