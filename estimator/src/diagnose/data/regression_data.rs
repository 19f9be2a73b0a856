//! Data set of a regression from one or several recordings: measured motion and force at a common, moderate rate.

use super::covariates::Extra;
use super::hung_weight::Hung;
use haptics::Vec2;
use haptics::law::{Coordinate, Effect, Motion};

/// Base model: laws with their non-linear values.
pub type Model = Vec<Effect>;

/// Kind of a row's force.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Place {
    /// Along the motion, while the object is held.
    #[default]
    Along,
    /// Horizontal, while nothing is touched.
    FreeX,
    /// Vertical, while nothing is touched.
    FreeY,
    /// No force, but the displacement of a standing object (`stick_phases.rs`), times `scale`.
    Stuck {
        /// Load on the friction as a share of it.
        share: f64,
        /// Side of the whole load: −1, 1, or 0 if it is unknown.
        side: f64,
        /// The load's noise as a share of the friction.
        noise: f64,
        /// N/m, N m/rad
        scale: f64,
    },
}

/// Motion between the rows, in which the direction may change, as finely as it is known.
#[derive(Clone, Copy, Debug, Default)]
pub struct Fine {
    pub segment: usize,
    pub time_s: f64,
    pub position: f64,
    pub velocity: f64,
    /// Direction of motion, −1 … 1, less than one in magnitude if it is uncertain.
    pub direction: f64,
    /// Uncertain share of the squared friction, 0 … 1.
    pub open: f64,
}

impl Fine {
    /// Motion at the point; quantities unknown between the rows are those of `row`.
    pub fn motion(&self, row: &Motion) -> Motion {
        let Self { time_s, position, velocity, direction, .. } = *self;
        Motion { time_s, position, velocity, direction, ..*row }
    }
}

/// Points of [`Track::fine`] over which a row is averaged.
#[derive(Clone, Copy, Debug, Default)]
pub struct Span {
    pub start: usize,
    pub len: usize,
    pub weighing: Weighing,
}

/// Weighting of the points of a row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Weighing {
    /// All the same.
    #[default]
    Even,
    /// Triangular weights, largest in the middle.
    Hat,
    /// Triangular weights that vanish at the first and last point: exactly those of a difference of two mean rates.
    Tent,
    /// Three arcs of a parabola whose first and last points count nothing: exactly what a second difference of three
    /// mean places has.
    Bell,
    /// A parabola that vanishes half a point beyond either end: that of a smoothed channel.
    Parabola,
}

impl Weighing {
    /// Weight of point `k` of `len`, up to a factor.
    fn of(self, k: usize, len: usize) -> f64 {
        let middle = 0.5 * len as f64;
        // From 0 at the first point to `knots` at the last one.
        let along = |knots: f64| knots * k as f64 / (len.max(2) - 1) as f64;
        match self {
            Self::Even => 1.0,
            Self::Hat => middle - (k as f64 + 0.5 - middle).abs(),
            Self::Parabola => 1.0 - ((k as f64 + 0.5 - middle) / middle).powi(2),
            Self::Tent => 1.0 - (along(2.0) - 1.0).abs(),
            Self::Bell => {
                let aside = (along(3.0) - 1.5).abs();
                if aside < 0.5 { 0.75 - aside * aside } else { 0.5 * (1.5 - aside).powi(2) }
            }
        }
    }
}

impl Span {
    /// Indices and weights, which sum to one.
    pub fn weights(self) -> impl Iterator<Item = (usize, f64)> {
        let raw = move |k: usize| self.weighing.of(k, self.len);
        let sum: f64 = (0..self.len).map(raw).sum();
        (0..self.len).map(move |k| (self.start + k, raw(k) / sum))
    }
}

/// One force with its motion; by default one of zero velocity, without a force.
#[derive(Clone, Copy, Debug, Default)]
pub struct Row {
    pub recording: usize,
    pub segment: usize,
    /// Source of the force.
    pub place: Place,
    /// Motion along the coordinate (its time runs from the start of the recording).
    pub motion: Motion,
    /// Angle of the arm, rad, unwrapped; the position itself for a coordinate without an arm.
    pub angle_rad: f64,
    /// Unit vector along +coordinate.
    pub along: Vec2,
    /// Measured force vector, N; (force, 0) for a coordinate without an arm.
    pub force: Vec2,
    /// Its rate, N/s.
    pub force_rate: Vec2,
    /// The force to be explained, N or N m.
    pub target: f64,
    /// Finer points over which it is averaged; empty if only the rows are known.
    pub span: Span,
    /// Uncertain share of the direction, 0 … 1 (as a share of the squared friction).
    pub open: f64,
}

/// Weight on the bearing of a crank, that of its handle.
#[derive(Clone, Copy, Debug, Default)]
pub struct Bearing {
    pub weight_n: f64,
    /// Mass of that weight, kg.
    pub mass_kg: f64,
    /// Inverse radius of the circle on which the bearing holds that mass, 1/m.
    pub per_radius: f64,
}

impl Bearing {
    /// Outward force of that weight on the bearing, N.
    pub fn load_n(&self, row: &Row) -> f64 {
        self.mass_kg * row.motion.velocity.powi(2) * self.per_radius - self.weight_n * row.up_outward()
    }
}

impl Row {
    /// Upward part of the unit vector away from a crank's centre.
    pub fn up_outward(&self) -> f64 {
        // Gravity is along y, up or down.
        let up = if self.along.y.abs() > 1e-9 { (self.motion.up_along / self.along.y).signum() } else { 1.0 };
        -up * self.along.x
    }
}

#[cfg(test)]
impl Track {
    /// A track of these rows, 10 ms apart, for a linear motion.
    pub fn of_rows(rows: Vec<Row>) -> Self {
        let periods = Self { period_s: 0.01, raw_period_s: 0.01, ..Self::of(Coordinate::Linear) };
        Self { rows, force_noise: 1e-3, span_s: 1.0, ..periods }
    }
}

/// Rows with their noise.
#[derive(Clone, Debug)]
pub struct Track {
    /// In time order, recording after recording; free rows after the held ones of each.
    pub rows: Vec<Row>,
    /// Motion between the rows.
    pub fine: Vec<Fine>,
    /// Sampling period of the rows, s.
    pub period_s: f64,
    /// Sampling period of the recording, s.
    pub raw_period_s: f64,
    /// Length or angle.
    pub coordinate: Coordinate,
    /// Path length per radian of [`Row::angle_rad`], m (1 for angles); `None` if nothing rotates.
    pub radius_m: Option<f64>,
    /// True if the force across the motion and the free forces were measured, too.
    pub planar: bool,
    /// Noise of the velocity, m/s or rad/s.
    pub velocity_noise: f64,
    /// Noise of the position of a row, m or rad; 0 where it is unknown.
    pub position_noise: f64,
    /// Noise of one force row, N or N m.
    pub force_noise: f64,
    /// Noise of one row's force of inertia, N or N m, from the noise of the motion.
    pub inertial_noise: f64,
    /// True if that noise was measured without touch.
    pub noise_is_measured: bool,
    /// Longest recording, s.
    pub span_s: f64,
    /// Weight hung on the object, recording by recording.
    pub hung: Vec<Option<Hung>>,
    /// Load on the bearing of a crank beside the pull of the fingers; none unless the recording shows it.
    pub bearing: Bearing,
    /// Rows on either side, and order, of the polynomials whose slopes the accelerations are; none where they are
    /// differences of means.
    pub slope: Option<(usize, usize)>,
    /// Slow channels beside motion and force, recording by recording.
    pub extra: Vec<Vec<Extra>>,
    /// Data of a free motion, without external force, as in a recording without a force channel.
    pub freely: Option<Freely>,
    /// Evidence from the rests of a mechanism's force sensor on a constant force.
    pub zero: Zero,
}

/// A free motion, in which the forces of all laws sum to zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Freely {
    /// Mass or moment of inertia, kg or kg m²; 1 if it is unknown.
    pub inertia: f64,
    /// Relative standard error of it.
    pub relative_error: f64,
    /// True if it is known; otherwise all forces are per unit of inertia.
    pub is_known: bool,
    /// Acceleration of gravity, m/s².
    pub gravity_m_s2: f64,
    /// True if the rows are means over half swings, whose noise is not that of differences.
    pub is_energy: bool,
    /// Friction that is stated, and gravity if it is known.
    pub known: [Option<Effect>; 3],
}

impl Track {
    /// No rows yet, of one coordinate, whose noise is zero.
    pub fn of(coordinate: Coordinate) -> Self {
        Self {
            rows: Vec::new(),
            fine: Vec::new(),
            period_s: 0.0,
            raw_period_s: 0.0,
            coordinate,
            radius_m: (coordinate == Coordinate::Angular).then_some(1.0),
            planar: false,
            velocity_noise: 0.0,
            position_noise: 0.0,
            force_noise: 0.0,
            inertial_noise: 0.0,
            noise_is_measured: false,
            span_s: 0.0,
            hung: Vec::new(),
            bearing: Bearing::default(),
            slope: None,
            extra: Vec::new(),
            freely: None,
            zero: Zero::Open,
        }
    }

    /// Slow channels common to all recordings: name, unit, and the value at each row less the mean.
    pub fn extras(&self) -> Vec<(String, String, Vec<f64>)> {
        let Some(first) = self.extra.first() else { return Vec::new() };
        let find = |recording: usize, name: &str| self.extra.get(recording)?.iter().find(|e| e.name == name);
        let values = |name: &str| -> Option<Vec<f64>> {
            let values: Option<Vec<f64>> =
                self.rows.iter().map(|row| Some(find(row.recording, name)?.at(row.motion.time_s))).collect();
            let values = values?;
            let mean = self.along().map(|i| values[i]).sum::<f64>() / self.along().count().max(1) as f64;
            Some(values.iter().map(|v| v - mean).collect())
        };
        first.iter().filter_map(|e| Some((e.name.clone(), e.unit.clone(), values(&e.name)?))).collect()
    }

    /// True if the motion has one direction: its backward share is no larger than a hand's tremor.
    pub fn goes_one_way(&self) -> bool {
        /// Largest share of backward travel of a motion with one direction: a hand's tremor.
        /// Choice: halved or doubled, none of 62 answers changes.
        const TREMBLES: f64 = 0.02;
        let [forward, backward] = self.ways();
        forward.min(backward) <= TREMBLES * (forward + backward)
    }

    /// Ways forward and backward.
    pub fn ways(&self) -> [f64; 2] {
        let way = |side: f64| self.along().map(|i| (side * self.rows[i].motion.velocity).max(0.0)).sum::<f64>();
        [way(1.0), way(-1.0)]
    }

    /// Indices of the rows along the motion.
    pub fn along(&self) -> impl Iterator<Item = usize> + '_ {
        self.rows.iter().enumerate().filter(|(_, r)| r.place == Place::Along).map(|(i, _)| i)
    }

    /// Unit of the force along the motion; of a free motion of unknown inertia, of a force per unit of it.
    pub fn force_unit(&self) -> &'static str {
        let per_inertia = self.freely.is_some_and(|free| !free.is_known);
        match (self.coordinate, per_inertia) {
            (Coordinate::Angular, false) => "N m",
            (Coordinate::Linear, false) => "N",
            (Coordinate::Angular, true) => "rad/s²",
            (Coordinate::Linear, true) => "m/s²",
        }
    }

    /// Quantile (share 0 … 1) of a quantity over the rows along the motion.
    pub fn quantile(&self, share: f64, of: impl Fn(&Row) -> f64) -> f64 {
        let mut values: Vec<f64> = self.along().map(|i| of(&self.rows[i])).collect();
        if values.is_empty() {
            return 0.0;
        }
        let place = ((values.len() - 1) as f64 * share).round() as usize;
        *values.select_nth_unstable_by(place, f64::total_cmp).1
    }

    /// Mean over a row of a function of the motion.
    pub fn mean(&self, row: &Row, of: &dyn Fn(&Motion) -> f64) -> f64 {
        if row.span.len == 0 {
            return of(&row.motion);
        }
        row.span.weights().map(|(k, weight)| weight * of(&self.fine[k].motion(&row.motion))).sum()
    }

    /// True if row `i` follows the row before it without a gap.
    pub fn follows(&self, i: usize) -> bool {
        i > 0 && self.rows[i].segment == self.rows[i - 1].segment && self.rows[i].place == self.rows[i - 1].place
    }
}

/// Joins the rows of several recordings of one object.
pub fn join(tracks: Vec<Track>) -> Option<Track> {
    let mut all = tracks.into_iter();
    let mut joined = all.next()?;
    for track in all {
        let (recordings, stretches) =
            joined.rows.iter().fold((0, 0), |(r, s), row| (r.max(row.recording + 1), s.max(row.segment + 1)));
        let before = joined.fine.len();
        let fine_stretches = joined.fine.last().map_or(0, |f| f.segment + 1);
        let shift = |row: Row| Row {
            recording: row.recording + recordings,
            segment: row.segment + stretches,
            span: Span { start: row.span.start + before, ..row.span },
            ..row
        };
        joined.fine.extend(track.fine.iter().map(|f| Fine { segment: f.segment + fine_stretches, ..*f }));
        let weight = joined.rows.len() as f64;
        let more = track.rows.len() as f64;
        let mean = |a: f64, b: f64| ((weight * a * a + more * b * b) / (weight + more).max(1.0)).sqrt();
        joined.velocity_noise = mean(joined.velocity_noise, track.velocity_noise);
        joined.position_noise = mean(joined.position_noise, track.position_noise);
        joined.force_noise = mean(joined.force_noise, track.force_noise);
        joined.inertial_noise = mean(joined.inertial_noise, track.inertial_noise);
        joined.noise_is_measured &= track.noise_is_measured;
        joined.planar &= track.planar;
        joined.span_s = joined.span_s.max(track.span_s);
        joined.slope = joined.slope.max(track.slope);
        joined.hung.resize(recordings, None);
        joined.hung.extend(track.hung);
        joined.extra.resize(recordings, Vec::new());
        joined.extra.extend(track.extra);
        joined.period_s = joined.period_s.max(track.period_s);
        joined.raw_period_s = joined.raw_period_s.max(track.raw_period_s);
        joined.rows.extend(track.rows.into_iter().map(shift));
    }
    Some(joined)
}

/// Evidence from the rests on a constant force.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Zero {
    /// No evidence: nobody let go, or the rests agree with neither.
    #[default]
    Open,
    /// The sensor reads zero without touch: the constant acts on the object.
    OfThePlant,
    /// The sensor reads that constant at rest.
    OfTheSensor,
}
