//! Smallest and largest values of a long channel at every zoom: a plot reads them instead of the samples.

use std::ops::Range;

/// Samples in a block of the lowest level, and blocks in a block of the next.
const FAN: usize = 16;

/// Smallest and largest value of a range of samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// Smallest.
    pub low: f64,
    /// Largest.
    pub high: f64,
}

impl Band {
    /// Of nothing: joins with anything to that.
    const NONE: Self = Self { low: f64::INFINITY, high: f64::NEG_INFINITY };

    // Compared here and below, not `min` and `max`: bands hold numbers only, and each of these is one instruction.
    fn with(self, other: Self) -> Self {
        let low = if other.low < self.low { other.low } else { self.low };
        let high = if other.high > self.high { other.high } else { self.high };
        Self { low, high }
    }

    /// Of several together. Two at a time: a comparison does not wait for the one before.
    fn together(bands: &[Self]) -> Self {
        let (pairs, rest) = bands.as_chunks::<2>();
        let [even, odd] = pairs.iter().fold([Self::NONE; 2], |[even, odd], [a, b]| [even.with(*a), odd.with(*b)]);
        rest.iter().fold(even.with(odd), |all, b| all.with(*b))
    }

    /// Of these values; of none, one that joins with anything.
    pub fn of(values: &[f64]) -> Self {
        const LANES: usize = 4;
        // In lanes, so that the compiler can use wide registers; a value that is not a number is neither smaller nor
        // larger.
        let (mut lows, mut highs) = ([f64::INFINITY; LANES], [f64::NEG_INFINITY; LANES]);
        let (blocks, rest) = values.as_chunks::<LANES>();
        for block in blocks {
            for (k, &v) in block.iter().enumerate() {
                lows[k] = if v < lows[k] { v } else { lows[k] };
                highs[k] = if v > highs[k] { v } else { highs[k] };
            }
        }
        let whole = (lows.into_iter().zip(highs)).fold(Self::NONE, |all, (low, high)| all.with(Self { low, high }));
        rest.iter().fold(whole, |all, &v| all.with(Self { low: v, high: v }))
    }
}

/// One column of pixels of a plot: its time, and the band of the channel in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pixel {
    /// Time in the middle of the pixel, s.
    pub time_s: f64,
    /// Values of all samples in it.
    pub band: Band,
}

/// Levels of bands over the samples of one channel. It holds no samples: 1/15 of their number in bands of two values, 13 % of
/// their memory. It grows at its end while the samples come in, and samples may stay on disk.
#[derive(Clone, Debug, Default)]
pub struct Pyramid {
    /// `levels[k]` holds one band for each full block of FAN^(k+1) samples.
    levels: Vec<Vec<Band>>,
    /// Band of the unfinished block of every level, and how many samples or blocks it has.
    open: Vec<(Band, usize)>,
    count: usize,
}

impl Pyramid {
    /// Over samples that are there already.
    pub fn of(values: &[f64]) -> Self {
        let mut pyramid = Self::default();
        pyramid.extend(values);
        pyramid
    }

    /// Samples taken in.
    pub fn len(&self) -> usize {
        self.count
    }

    /// True before the first sample.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Bytes that the bands take.
    pub fn bytes(&self) -> usize {
        self.levels.iter().map(|l| l.capacity() * size_of::<Band>()).sum()
    }

    /// Takes the next samples in.
    pub fn extend(&mut self, values: &[f64]) {
        let mut rest = values;
        while !rest.is_empty() {
            let room = FAN - self.open.first().map_or(0, |o| o.1);
            let (now, later) = rest.split_at(room.min(rest.len()));
            self.put(0, Band::of(now), now.len());
            rest = later;
        }
        self.count += values.len();
    }

    /// Adds to the open block of a level; a full one goes down into its level and up into the next.
    fn put(&mut self, level: usize, band: Band, members: usize) {
        if self.open.len() == level {
            self.open.push((Band::NONE, 0));
            self.levels.push(Vec::new());
        }
        let (open, filled) = &mut self.open[level];
        (*open, *filled) = (open.with(band), *filled + members);
        if *filled == FAN {
            let full = *open;
            self.open[level] = (Band::NONE, 0);
            self.levels[level].push(full);
            self.put(level + 1, full, 1);
        }
    }

    /// The band of samples `range`. `read` gives the band of samples that no block covers whole: at most 2·(FAN − 1) of them
    /// at the ends of the range, from memory or from disk.
    pub fn band(&self, range: Range<usize>, read: &dyn Fn(Range<usize>) -> Band) -> Option<Band> {
        let range = range.start..range.end.min(self.count);
        if range.is_empty() {
            return None;
        }
        let (mut first, mut end) = (range.start.div_ceil(FAN), range.end / FAN);
        if first >= end {
            return Some(read(range));
        }
        let mut band = Band::NONE;
        if range.start < first * FAN {
            band = band.with(read(range.start..first * FAN));
        }
        if end * FAN < range.end {
            band = band.with(read(end * FAN..range.end));
        }
        // Up through the levels: at each only the blocks that the next one does not cover whole.
        for blocks in &self.levels {
            let (upper_first, upper_end) = (first.div_ceil(FAN), end / FAN);
            if upper_first >= upper_end {
                return Some(band.with(Band::together(&blocks[first..end])));
            }
            for edge in [first..upper_first * FAN, upper_end * FAN..end] {
                band = band.with(Band::together(&blocks[edge]));
            }
            (first, end) = (upper_first, upper_end);
        }
        Some(band)
    }

    /// The size of the largest blocks with at most `samples` samples; 1 when there are none.
    pub fn grain(samples: usize) -> usize {
        let mut grain = 1;
        while grain * FAN <= samples {
            grain *= FAN;
        }
        grain
    }

    /// The smallest number of samples, at least `samples`, that [`Pyramid::whole`] can answer for without the samples.
    pub fn granule(&self, samples: usize) -> usize {
        samples.max(1).div_ceil(FAN) * FAN
    }

    /// The band of samples `range`, which starts at a multiple of [`Pyramid::granule`] and ends at one or at the end.
    pub fn whole(&self, range: Range<usize>) -> Option<Band> {
        let open = self.open.first().map_or(Band::NONE, |o| o.0);
        // Only the samples of the open block at the end are in no block.
        self.band(range, &|_| open)
    }

    /// Bands of the samples between `from_s` and `to_s`, s, for a plot `pixels` wide: one a pixel that has a sample in
    /// it. `time_s` and `values` are those the pyramid was made of. Work: O(pixels · log samples).
    pub fn query(&self, time_s: &[f64], values: &[f64], from_s: f64, to_s: f64, pixels: usize) -> Vec<Pixel> {
        let read = |range: Range<usize>| Band::of(&values[range]);
        self.query_with(time_s, &read, from_s, to_s, pixels)
    }

    /// [`Pyramid::query`] with samples that are read when they are needed.
    pub fn query_with(
        &self,
        time_s: &[f64],
        read: &dyn Fn(Range<usize>) -> Band,
        from_s: f64,
        to_s: f64,
        pixels: usize,
    ) -> Vec<Pixel> {
        let length = to_s - from_s;
        if !length.is_finite() || length <= 0.0 {
            return Vec::new();
        }
        let width = (to_s - from_s) / pixels.max(1) as f64;
        let edge = |k: usize| if k == pixels { to_s } else { from_s + k as f64 * width };
        let index = |t: f64| time_s.partition_point(|&sample| sample < t).min(self.count);
        let mut found = Vec::with_capacity(pixels);
        let mut first = index(from_s);
        for k in 0..pixels {
            let end = index(edge(k + 1));
            if let Some(band) = self.band(first..end, read) {
                found.push(Pixel { time_s: 0.5 * (edge(k) + edge(k + 1)), band });
            }
            first = end.max(first);
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn signal(n: usize, seed: u64) -> Vec<f64> {
        let mut state = seed;
        (0..n)
            .map(|_| {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (state >> 20) as f64 / 1e12 - 5.0
            })
            .collect()
    }

    fn plain(values: &[f64]) -> Option<Band> {
        (!values.is_empty()).then(|| Band::of(values))
    }

    proptest! {
        #[test]
        fn any_range_is_that_of_its_samples(n in 0..5000_usize, seed in any::<u64>(), a in 0..5000_usize, b in 0..5000_usize) {
            let values = signal(n, seed);
            let pyramid = Pyramid::of(&values);
            let (a, b) = (a.min(n), b.min(n));
            let range = a.min(b)..a.max(b);
            let read = |r: Range<usize>| Band::of(&values[r]);
            prop_assert_eq!(pyramid.band(range.clone(), &read), plain(&values[range]));
        }

        #[test]
        fn growing_piece_by_piece_gives_the_same(pieces in proptest::collection::vec(0..700_usize, 0..12), seed in any::<u64>()) {
            let values = signal(pieces.iter().sum(), seed);
            let mut grown = Pyramid::default();
            let mut first = 0;
            for piece in pieces {
                grown.extend(&values[first..first + piece]);
                first += piece;
            }
            let whole = Pyramid::of(&values);
            prop_assert_eq!(&grown.levels, &whole.levels);
            prop_assert_eq!(grown.len(), values.len());
        }

        #[test]
        fn pixels_hold_exactly_their_samples(n in 1..3000_usize, seed in any::<u64>(), from in -1.0..4.0_f64, width in 0.0..4.0_f64, pixels in 0..200_usize) {
            // Uneven times with a gap.
            let time: Vec<f64> = (0..n).map(|i| i as f64 * 1e-3 + if i > n / 2 { 0.3 } else { 0.0 } + 4e-4 * (i as f64).sin()).collect();
            let values = signal(n, seed);
            let found = Pyramid::of(&values).query(&time, &values, from, from + width, pixels);
            let mut expected = Vec::new();
            for k in 0..pixels {
                let step = width / pixels as f64;
                let low = from + k as f64 * step;
                let high = if k + 1 == pixels { from + width } else { from + (k + 1) as f64 * step };
                let inside: Vec<f64> = (0..n).filter(|&i| time[i] >= low && time[i] < high).map(|i| values[i]).collect();
                expected.extend(plain(&inside));
            }
            prop_assert_eq!(found.iter().map(|p| p.band).collect::<Vec<_>>(), expected);
        }
    }

    #[test]
    fn a_range_between_edges_of_blocks_reads_no_sample() {
        let values = signal(300_000, 5);
        let pyramid = Pyramid::of(&values);
        assert_eq!([0, 1, 15, 16, 255, 256, 5_000].map(Pyramid::grain), [1, 1, 1, 16, 16, 256, 4_096]);
        let read = |_: Range<usize>| -> Band { panic!("a sample is read") };
        let range = 16 * 31..16 * 3_000;
        assert_eq!(pyramid.band(range.clone(), &read), plain(&values[range]));
    }

    #[test]
    fn few_samples_are_read_whatever_the_zoom() {
        let values = signal(300_000, 3);
        let time: Vec<f64> = (0..values.len()).map(|i| i as f64 * 1e-3).collect();
        let pyramid = Pyramid::of(&values);
        assert!(pyramid.bytes() < values.len() * 8 / 3, "{}", pyramid.bytes());
        for (from, to) in [(0.0, 300.0), (1.0, 31.0), (100.0, 100.5)] {
            let read = std::cell::Cell::new(0);
            let counted = |r: Range<usize>| {
                read.set(read.get() + r.len());
                Band::of(&values[r])
            };
            let found = pyramid.query_with(&time, &counted, from, to, 500);
            assert!(found.len() == 500 && read.get() <= 500 * 2 * FAN, "{} {}", found.len(), read.get());
        }
        assert!(pyramid.query(&time, &values, 5.0, 5.0, 10).is_empty());
        assert!(pyramid.query(&time, &values, f64::NAN, 5.0, 10).is_empty());
    }
}
