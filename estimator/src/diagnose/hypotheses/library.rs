//! Candidate library of the force: the regressor of each cause over the rows of a track, made from its law in
//! `haptics::law`.

use super::candidate::{Candidate, Column, Shape};
use super::grid::Grid;
use super::regressor_cache::Columns;
use crate::diagnose::data::regression_data::{Place, Row, Track, Zero};
use crate::diagnose::data::{row_means, stick_phases};
use crate::signal::derive::savitzky_golay;
use haptics::Vec2;
use haptics::law::{
    Backlash, CoulombFriction, EccentricMass, Effect, ForceBias, ForceDrift, FrictionAsymmetry, FrictionChange,
    Hysteresis, Inertia, Kind, Law, LoadFriction, LocalPush, LocalResistance, MAX_PARAMETERS, MassChange, Memory,
    Motion, PositionRipple, QuadraticDrag, Stribeck, ViscousFriction, Weight,
};

/// Least share of the friction that bends before it slides, and least share that counts as all of it.
const LEAST_BENT: f64 = 0.3;
const ALL_BENT: f64 = 0.65;
/// Presliding distance from which only a share of the friction may bend, in multiples of the shortest that is felt.
const LONG_BENT: f64 = 6.0;
/// Least share of the force that a gap may cut off.
const LEAST_BEHIND: f64 = 0.4;
/// Largest admissible share. Beyond it, another presliding distance or gap would fit better.
const MOST: f64 = 1.7;
/// Length of a ripple, in rows, below which it is averaged over each row.
const SHORT_RIPPLE: f64 = 25.0;
/// Shape parameter of presliding that springs back along a straight line.
const STRAIGHT: f64 = 0.5;

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
    /// All candidates.
    pub fn candidates(&self) -> Vec<Candidate> {
        self.made(false)
    }

    /// Only the candidates that have searched values.
    pub fn searched(&self) -> Vec<Candidate> {
        self.made(true)
    }

    fn made(&self, is_searched: bool) -> Vec<Candidate> {
        let mut all = Vec::new();
        self.friction(&mut all);
        // The moving part has no searched values.
        if !is_searched {
            self.motion(&mut all);
        }
        self.place(&mut all);
        self.memory(&mut all);
        self.time(&mut all);
        self.instrument(&mut all);
        all.retain(|c| !self.without.contains(&c.id) && (!is_searched || !c.searched.is_empty()));
        if self.track.freely.is_some() {
            let both_ways = super::free_motion::goes_both_ways(self.track);
            all.retain(|c| super::free_motion::can_show(c.id, both_ways));
        }
        all.retain(|c| c.columns.iter().all(|v| v.iter().all(|x| x.is_finite()) && v.iter().any(|x| *x != 0.0)));
        all
    }

    pub(crate) fn units(&self) -> Units {
        let angular = self.track.coordinate == haptics::law::Coordinate::Angular;
        Units { force: if angular { "N m" } else { "N" }, length: if angular { "rad" } else { "m" }, angular }
    }

    /// A regressor over the rows along the motion, 0 in free rows.
    fn column(&self, of: &dyn Fn(&Row) -> f64) -> Vec<f64> {
        let rows = self.track.rows.iter();
        rows.map(|r| if r.place == Place::Along { of(r) } else { 0.0 }).collect()
    }

    /// The force of a law with these values, in the rows along the motion.
    fn law(&self, law: &'static dyn Law, values: &[f64]) -> Column {
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

    fn friction(&self, all: &mut Vec<Candidate>) {
        all.push(self.plain(&CoulombFriction, &[1.0], 0).positive());
        all.push(self.plain(&ViscousFriction, &[1.0], 0).positive());
        if self.track.planar {
            all.push(self.plain(&LoadFriction, &[1.0], 0).positive());
            all.push(self.plain(&FrictionAsymmetry, &[0.0, 0.0, 1.0], 2));
        }
        // With motion in one direction, a constant and dry friction differ only where the direction is uncertain, which
        // is no evidence.
        let is_friction = !self.track.planar && self.track.goes_one_way();
        if self.track.zero != Zero::OfTheSensor && !is_friction {
            all.push(self.dry_asymmetry());
        }
        all.push(self.plain(&FrictionAsymmetry, &[0.0, 1.0, 0.0], 1));
        for (vs, alpha) in self.grid.stribeck.iter().copied() {
            let falls = self.plain(&Stribeck, &[1.0, vs, alpha], 0).at("vs", vs, self.unit(&Stribeck, 1)).positive();
            // Without an exponent, the Gaussian form is meant.
            all.push(if alpha > 0.0 { falls.at("alpha", alpha, "1") } else { falls });
        }
        all.push(self.plain(&QuadraticDrag, &[1.0], 0).positive());
    }

    /// Dry friction by direction. Along one coordinate its regressor is the constant that a sensor bias also is. The
    /// two differ only in standing rows, where friction may take any value, and at reversals, where the direction is
    /// uncertain. Neither counts as a difference.
    fn dry_asymmetry(&self) -> Candidate {
        let by_direction = self.plain(&FrictionAsymmetry, &[1.0, 0.0, 0.0], 0);
        if self.track.planar {
            return by_direction;
        }
        let columns = vec![Column::new(self.column(&|_| 1.0))];
        // The sensor bias takes precedence.
        Candidate { columns, cost: by_direction.cost + HARDLY, ..by_direction }
    }

    fn motion(&self, all: &mut Vec<Candidate>) {
        all.push(self.plain(&Inertia, &[1.0], 0).positive());
        all.push(Candidate::one("time-delay", Kind::Instrument, "tau", "s", self.late()));
    }

    /// Effect of a force delay of one second along the motion: the rate of the predicted force, and of the load that
    /// turns with the arm. The rate of the measured force is not used, because its noise would explain itself.
    fn late(&self) -> Vec<f64> {
        let rows = &self.track.rows;
        let radius = self.track.radius_m.unwrap_or(1.0);
        let turning = |row: &Row| row.motion.normal_force_n * row.motion.velocity / radius;
        let mut column = vec![0.0; rows.len()];
        for range in self.pieces() {
            for (i, rate) in range.clone().zip(self.rates(range)) {
                column[i] = -(rate + if self.track.planar { turning(&rows[i]) } else { 0.0 });
            }
        }
        column
    }

    /// Segments of rows along the motion.
    fn pieces(&self) -> Vec<std::ops::Range<usize>> {
        let mut pieces: Vec<std::ops::Range<usize>> = Vec::new();
        for i in self.track.along() {
            match pieces.last_mut() {
                Some(piece) if piece.end == i && self.track.follows(i) => piece.end += 1,
                _ => pieces.push(i..i + 1),
            }
        }
        pieces
    }

    /// Rates of the predicted force, through the window that the acceleration was seen through: what that takes off an
    /// inertia's force would otherwise pass for a delay.
    fn rates(&self, range: std::ops::Range<usize>) -> Vec<f64> {
        let time_s: Vec<f64> = self.track.rows[range.clone()].iter().map(|r| r.motion.time_s).collect();
        let force = &self.predicted[range];
        if let Some((half, order)) = self.track.slope {
            return savitzky_golay(&time_s, force, half, order).first;
        }
        let last = force.len() - 1;
        let rate = |k: usize| {
            let (before, after) = (k.saturating_sub(1), (k + 1).min(last));
            let apart_s = time_s[after] - time_s[before];
            if apart_s > 0.0 { (force[after] - force[before]) / apart_s } else { 0.0 }
        };
        (0..force.len()).map(rate).collect()
    }

    fn place(&self, all: &mut Vec<Candidate>) {
        if let Some(radius) = self.track.radius_m {
            self.gravity(all, radius);
            all.extend(super::gravity_tilt::tilt(self.track));
        }
        all.extend(super::slope::tilt(self.track));
        // A short ripple changes within a row.
        let short = SHORT_RIPPLE * self.track.quantile(0.9, |r| r.motion.velocity.abs()) * self.track.period_s;
        self.grid.ripples.iter().for_each(|length| self.ripple(all, *length, *length < short));
        self.springs(all);
        self.local(all);
        self.walls(all);
    }

    fn ripple(&self, all: &mut Vec<Candidate>, length: f64, is_short: bool) {
        let units = self.units();
        let column = |phase: f64| {
            let values = [1.0, length, phase];
            if is_short { self.law(&PositionRipple, &values) } else { self.law_of_place(&PositionRipple, &values) }
        };
        let columns = vec![column(0.0), column(-std::f64::consts::FRAC_PI_2)];
        let linear = vec![("A cos phi", units.force), ("A sin(-phi)", units.force)];
        let ripple = Candidate::of("position-ripple", Kind::Plant, columns, linear);
        all.push(ripple.at("lambda", length, units.length));
    }

    /// Gravity that the model does not have: across the arm's weight; for an angle without any gravity in the model,
    /// both parts.
    fn gravity(&self, all: &mut Vec<Candidate>, radius: f64) {
        let part = |values: &[f64]| self.law_of_place(&EccentricMass, values);
        if self.track.planar {
            let column = part(&[1.0, 0.0, radius]);
            all.push(Candidate::of("eccentric-mass", Kind::Plant, vec![column], vec![("a", self.units().force)]));
        } else {
            let columns = vec![part(&[1.0, 0.0, radius]), part(&[0.0, 1.0, radius])];
            let linear = vec![("a", self.units().force), ("b", self.units().force)];
            all.push(Candidate::of("eccentric-mass", Kind::Plant, columns, linear));
        }
    }

    /// Local resistance in both directions, and a push at a place.
    fn local(&self, all: &mut Vec<Candidate>) {
        let units = self.units();
        for (place, width) in self.grid.places.iter().copied() {
            let values = [1.0, place, width, self.grid.turn];
            let found = |c: Candidate| c.at("place", place, units.length).at("width", width, units.length);
            let named = |law: &'static dyn Law| {
                let column = self.law_of_place(law, &values);
                Candidate::of(
                    LocalResistance.id(),
                    Kind::Plant,
                    vec![column],
                    vec![(law.parameters()[0].name, units.force)],
                )
            };
            all.push(found(named(&LocalResistance).positive()));
            all.push(found(named(&LocalPush)));
        }
    }

    fn memory(&self, all: &mut Vec<Candidate>) {
        let units = self.units();
        all.extend(self.grid.ways.iter().map(|way| self.bent(*way, 0.0)));
        all.extend(self.grid.straight.iter().map(|way| self.bent(*way, STRAIGHT).at("shape", STRAIGHT, "1")));
        for way in self.grid.ways.iter().copied() {
            let gap = self.remembered(&Backlash, &[way], &|motion, memory, values| {
                1.0 - Backlash.engaged(motion, values, memory)
            });
            let felt = f64::from(u8::from(way > self.grid.felt));
            // A gap cuts off the resisting part of the force, or all of it.
            for (behind, whole) in [(self.resisting, false), (self.predicted, true)] {
                let mut column: Vec<f64> = gap.iter().zip(behind).map(|(g, f)| -felt * g * f).collect();
                stick_phases::plays(self.track, way, whole, &mut column);
                let backlash = Candidate::one("backlash", Kind::Plant, "share", "1", column);
                let backlash = backlash.shaped(Shape::Share { least: LEAST_BEHIND, whole: LEAST_BEHIND, most: MOST });
                all.push(backlash.at("delta", way, units.length));
            }
        }
    }

    /// Candidate by which the model's friction bends over `way` before it slides: the difference from sliding at once.
    fn bent(&self, way: f64, shape: f64) -> Candidate {
        let values = [1.0, 1.0 / way, shape];
        let bent = self.remembered(&Hysteresis, &values, &|motion, memory, _| memory[0] - motion.direction);
        let felt = f64::from(u8::from(way > self.grid.felt));
        let mut column: Vec<f64> = bent.iter().zip(self.dry).map(|(b, d)| felt * b * d).collect();
        stick_phases::bends(&self.track.rows, &values, &mut column);
        // Presliding of only part of the friction needs strong evidence: noise of the path during sticking looks like a
        // short bend.
        let least = if way > LONG_BENT * self.grid.felt { LEAST_BENT } else { ALL_BENT };
        let hysteresis = Candidate::one("hysteresis", Kind::Plant, "share", "1", column);
        hysteresis.shaped(Shape::Share { least, whole: ALL_BENT, most: MOST }).at("way", way, self.units().length)
    }

    /// A regressor of a law with memory, evaluated between the rows; its memory is cleared at every segment.
    fn remembered(
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
            match k.checked_sub(1).map(|before| track.fine[before]).filter(|before| before.stretch == point.stretch) {
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

    fn time(&self, all: &mut Vec<Candidate>) {
        let units = self.units();
        if self.track.planar {
            all.push(self.plain(&MassChange, &[0.0, 1.0], 1));
            for tau in self.grid.settling.iter().copied() {
                all.push(self.plain(&MassChange, &[0.0, 1.0, 0.0, 0.0, tau], 1).at("tau", tau, "s"));
            }
            for start in self.grid.starts.iter().copied() {
                // A step of the weight at `start`.
                let column = self.column(&|r| {
                    if r.motion.time_s >= start { Weight.force(&r.motion, &[1.0, 0.0, 0.0, 0.0, 0.0]) } else { 0.0 }
                });
                all.push(Candidate::one("mass-change", Kind::Plant, "step", units.force, column).at("t0", start, "s"));
            }
        }
        // A change of friction in proportion to the model's own, slow or sudden.
        let of_dry = |effect: &Effect| -> Vec<f64> {
            self.columns.of(self.track, effect).iter().zip(self.dry).map(|(w, d)| w * d).collect()
        };
        let change = |column| Candidate::one("friction-change", Kind::Plant, "relative change", "1", column);
        for tau in self.grid.warming.iter().copied() {
            let warm = Effect::new(&FrictionChange, &[0.0, 1.0, tau, 0.0, 0.0]);
            all.push(change(of_dry(&warm)).at("tau", tau, "s"));
        }
        for start in self.grid.starts.iter().copied() {
            let step = Effect::new(&FrictionChange, &[0.0, 1.0, 0.0, start, 0.0]);
            all.push(change(of_dry(&step)).at("t0", start, "s"));
        }
        // Friction that changes with another recorded channel: all of the resistance, or the dry part alone.
        for (name, unit, values) in self.track.extras() {
            let goes = |level: &dyn Fn(usize) -> f64| -> Vec<f64> {
                let rows = self.track.rows.iter().enumerate();
                rows.map(|(i, r)| if r.place == Place::Along { level(i) * values[i] } else { 0.0 }).collect()
            };
            let channel = (name, unit);
            let dry = goes(&|i| self.dry[i] * self.track.rows[i].motion.direction);
            all.push(change(dry).with(channel.clone()));
            all.push(change(goes(&|i| self.resisting[i])).with(channel));
        }
    }

    fn instrument(&self, all: &mut Vec<Candidate>) {
        let units = self.units();
        if let Some((first, others)) = self.fixed.split_first() {
            let mut known = first.clone();
            for other in others {
                known.iter_mut().zip(other).for_each(|(sum, more)| *sum += more);
            }
            all.push(Candidate::one("force-gain", Kind::Instrument, "g - 1", "1", known));
        }
        let every = |of: &dyn Fn(&Row) -> f64| self.track.rows.iter().map(of).collect::<Vec<f64>>();
        if self.track.planar {
            let bias = |axis: Vec2| every(&|r| r.along.dot(&axis) * Effect::new(&ForceBias, &[1.0]).force(&r.motion));
            all.push(pair("force-bias", [bias(Vec2::x()), bias(Vec2::y())], [("bx", "N"), ("by", "N")]));
            for tau in std::iter::once(0.0).chain(self.grid.settling.iter().copied()) {
                let effect = Effect::new(&ForceDrift, &[1.0, tau]);
                let drift = |axis: Vec2| every(&|r| r.along.dot(&axis) * effect.force(&r.motion));
                let rates = [("rx", "N/s"), ("ry", "N/s")];
                let found = pair("force-drift", [drift(Vec2::x()), drift(Vec2::y())], rates);
                all.push(if tau > 0.0 { found.at("tau", tau, "s") } else { found });
            }
            let cross = |to: Vec2, from: Vec2| every(&|r| r.along.dot(&to) * r.force.dot(&from));
            let id = "force-cross-axis";
            all.push(Candidate::one(id, Kind::Instrument, "kappa_xy", "1", cross(Vec2::x(), Vec2::y())));
            all.push(Candidate::one(id, Kind::Instrument, "kappa_yx", "1", cross(Vec2::y(), Vec2::x())));
            // The whole sensor is rotated: Fx − κ Fy and Fy + κ Fx.
            let turned = every(&|r| r.along.y * r.force.x - r.along.x * r.force.y);
            let turned = Candidate::one(id, Kind::Instrument, "kappa_turned", "rad", turned);
            all.push(Candidate { cost: turned.cost + HARDLY, ..turned });
        } else {
            let held = |r: &Row, force: f64| if r.place == Place::Along { force } else { 0.0 };
            let bias = every(&|r| held(r, Effect::new(&ForceBias, &[1.0]).force(&r.motion)));
            if self.track.zero != Zero::OfThePlant {
                all.push(Candidate::one("force-bias", Kind::Instrument, "b", units.force, bias));
            }
            for tau in std::iter::once(0.0).chain(self.grid.settling.iter().copied()) {
                let effect = Effect::new(&ForceDrift, &[1.0, tau]);
                let drift = every(&|r| held(r, effect.force(&r.motion)));
                let found = Candidate::one("force-drift", Kind::Instrument, "rate", self.unit(&ForceDrift, 0), drift);
                all.push(if tau > 0.0 { found.at("tau", tau, "s") } else { found });
            }
        }
    }
}

/// Penalty of one of two causes that are equivalent in some recordings, so that the other one is always named first.
/// Examples are a rotated sensor where the load keeps its sign, equivalent to friction by direction, and friction by
/// direction along one coordinate, equivalent to a bias.
const HARDLY: f64 = 0.02;

/// Dry friction at each row if it slid in the positive direction, from the resisting force alone.
pub fn dry_of(track: &Track, resisting: &[f64]) -> Vec<f64> {
    let rows = track.rows.iter().zip(resisting);
    rows.map(|(r, f)| if r.motion.direction.abs() > 0.05 { f / r.motion.direction } else { f.abs() }).collect()
}

fn pair(id: &'static str, columns: [Vec<f64>; 2], linear: [(&'static str, &'static str); 2]) -> Candidate {
    Candidate::several(id, Kind::Instrument, Vec::from(columns), linear.to_vec())
}

pub(crate) fn position(row: &Row) -> f64 {
    row.motion.position
}
