//! Readings kept for later in a fixed space: when it is full, neighbours are averaged and every kept one stands for twice as much.

/// A store of rows of N numbers, the first one a time.
#[derive(Clone, Debug)]
pub(super) struct DecimatingStore<const N: usize> {
    rows: Vec<[f64; N]>,
    sum: [f64; N],
    summed: u32,
    each: u32,
}

impl<const N: usize> DecimatingStore<N> {
    /// Room for `capacity` rows, allocated here.
    pub(super) fn new(capacity: usize) -> Self {
        Self { rows: Vec::with_capacity(capacity.max(4)), sum: [0.0; N], summed: 0, each: 1 }
    }

    /// Keeps a row, or its part in a mean.
    pub(super) fn push(&mut self, row: [f64; N]) {
        for (sum, value) in self.sum.iter_mut().zip(row) {
            *sum += value;
        }
        self.summed += 1;
        if self.summed < self.each {
            return;
        }
        if self.rows.len() == self.rows.capacity() {
            self.halve();
            if self.summed < self.each {
                return;
            }
        }
        let share = 1.0 / f64::from(self.summed);
        self.rows.push(self.sum.map(|v| v * share));
        (self.sum, self.summed) = ([0.0; N], 0);
    }

    fn halve(&mut self) {
        let pairs = self.rows.len() / 2;
        for k in 0..pairs {
            let (a, b) = (self.rows[2 * k], self.rows[2 * k + 1]);
            self.rows[k] = std::array::from_fn(|i| 0.5 * (a[i] + b[i]));
        }
        self.rows.truncate(pairs);
        self.each *= 2;
    }

    /// The rows so far.
    pub(super) fn rows(&self) -> &[[f64; N]] {
        &self.rows
    }

    /// One column.
    pub(super) fn column(&self, index: usize) -> Vec<f64> {
        self.rows.iter().map(|r| r[index]).collect()
    }

    /// Forgets them.
    pub(super) fn clear(&mut self) {
        self.rows.clear();
        (self.sum, self.summed, self.each) = ([0.0; N], 0, 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_and_times_survive_halving_and_the_space_is_fixed() {
        let mut store = DecimatingStore::<2>::new(64);
        let room = store.rows.capacity();
        for i in 0..10_000 {
            store.push([f64::from(i), 3.0 * f64::from(i)]);
        }
        assert!(store.rows().len() >= 30 && store.rows.capacity() == room);
        assert!(store.rows().windows(2).all(|w| w[1][0] > w[0][0]));
        assert!(store.rows().iter().all(|r| (r[1] - 3.0 * r[0]).abs() < 1e-9));
        assert!(store.rows()[0][0] < 300.0 && store.rows()[store.rows().len() - 1][0] > 9000.0);
    }
}
