//! Forces while blocks are carried, beside those while nothing is touched: weight, inertia, cables, and what is wrong with the sensors.

use super::cable::{cables, errors};
use super::seen::Seen;
use crate::diagnose::answer::{Found, Part, parameter};
use crate::diagnose::candidate::Candidate;
use crate::diagnose::compare::{Channel, stretches};
use crate::diagnose::geometry::Study;
use crate::diagnose::report::CauseParameter;
use crate::estimate::EstimateError;
use crate::identify::block::object;
use haptics::law::Kind;
use haptics::world::World;

/// Starts of a change of weight that are tried in every carry.
const STARTS: usize = 6;

/// What a row is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// Sum of both fingers along an axis, a block of this number in the air.
    Carried { number: usize, axis: usize },
    /// One finger along an axis, nothing touched.
    Free { finger: usize, axis: usize },
}

/// One row.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    pub recording: usize,
    pub i: usize,
    pub time_s: f64,
    pub place: Place,
}

/// All rows with the recordings that they are from.
pub struct Rows<'a> {
    pub seen: &'a [Seen<'a>],
    pub rows: Vec<Row>,
    pub stretch: Vec<usize>,
}

impl<'a> Rows<'a> {
    fn of(seen: &'a [Seen<'a>]) -> Self {
        let mut rows = Vec::new();
        for (recording, one) in seen.iter().enumerate() {
            let mut add = |place: Place, of: &[usize]| {
                rows.extend(of.iter().map(|i| Row { recording, i: *i, time_s: one.time_s(*i), place }));
            };
            for number in 1..=one.count {
                let carried = one.carried(number);
                for axis in [1, 0] {
                    add(Place::Carried { number, axis }, &carried);
                }
            }
            let free = one.free();
            for (finger, axis) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                add(Place::Free { finger, axis }, &free);
            }
        }
        let time: Vec<f64> = rows.iter().map(|r| r.time_s).collect();
        let period_s = seen.iter().map(|s| s.period_s).fold(0.0, f64::max);
        let other = |i: usize| rows[i].place != rows[i - 1].place || rows[i].recording != rows[i - 1].recording;
        let stretch = stretches(&time, period_s, other);
        Self { seen, rows, stretch }
    }

    pub fn column(&self, of: impl Fn(&Row) -> f64) -> Vec<f64> {
        self.rows.iter().map(of).collect()
    }

    /// A column over the carried rows of one axis, or both.
    pub fn carried(&self, of: impl Fn(&Seen<'_>, &Row, usize, usize) -> f64) -> Vec<f64> {
        self.column(|row| match row.place {
            Place::Carried { number, axis } => of(&self.seen[row.recording], row, number, axis),
            Place::Free { .. } => 0.0,
        })
    }

    /// Recorded force: the sum of both fingers, or one finger's.
    fn force_n(&self, row: &Row) -> f64 {
        let force = &self.seen[row.recording].force;
        match row.place {
            Place::Carried { axis, .. } => force[0][axis][row.i] + force[1][axis][row.i],
            Place::Free { finger, axis } => force[finger][axis][row.i],
        }
    }

    /// How much a fault of one finger's force along one axis is in a row.
    fn share(row: &Row, finger: usize, axis: usize) -> f64 {
        let holds = match row.place {
            Place::Carried { axis: own, .. } => own == axis,
            Place::Free { finger: f, axis: own } => f == finger && own == axis,
        };
        f64::from(u8::from(holds))
    }

    fn blocks(&self) -> usize {
        self.seen.iter().map(|s| s.count).max().unwrap_or(0)
    }

    /// Mean of the lift of a block, N.
    fn weight_n(&self, number: usize) -> f64 {
        let own = Place::Carried { number, axis: 1 };
        let lifts: Vec<f64> = self.rows.iter().filter(|r| r.place == own).map(|r| self.force_n(r)).collect();
        lifts.iter().sum::<f64>() / lifts.len().max(1) as f64
    }
}

/// The comparison and what its words need.
pub struct Carry {
    pub study: Study,
    pub along: Vec<bool>,
    pub stretch: Vec<usize>,
    /// Noise of a sum of two fingers, N.
    pub floor_n: f64,
    /// Longest carry, s.
    longest_s: f64,
    /// Of a cable's stiffness, anchor and length.
    cable_errors: Option<[f64; 4]>,
    /// Which block each row is of; 0 where nothing is held.
    numbers: Vec<usize>,
}

/// Compares what may act on carried blocks and on the sensors. `world`: inertia and cables of it belong to the model.
pub fn carry(seen: &[Seen<'_>], world: Option<&World>, threshold: f64) -> Result<Carry, EstimateError> {
    const LEAST_ROWS: usize = 30;
    let rows = Rows::of(seen);
    let is_carried = |r: &Row| matches!(r.place, Place::Carried { .. });
    // Every other row: what acts in one short stretch of a carry is seen where it is fitted and where it is held out.
    let testable: Vec<bool> = rows.rows.iter().enumerate().map(|(i, r)| i % 2 == 0 && is_carried(r)).collect();
    let carried = rows.rows.iter().filter(|r| is_carried(r)).count();
    if carried < LEAST_ROWS {
        return Err(EstimateError::TooFewSamples {
            recording: seen.first().map(|s| s.blocks.recording.name.clone()).unwrap_or_default(),
            samples: carried,
            what: " of carried blocks, a filter window apart".to_owned(),
            needed: LEAST_ROWS,
        });
    }
    let known: Vec<Option<f64>> =
        (1..=rows.blocks()).map(|k| seen.iter().find_map(|s| s.known_weight_n(k).filter(|_| s.count >= k))).collect();
    let base = base(&rows, world, &known);
    let given = rows.carried(|one, row, number, axis| known[number - 1].map_or(0.0, |w| needed(one, row, w, axis, world.is_some())));
    let y: Vec<f64> = rows.rows.iter().zip(&given).map(|(r, g)| rows.force_n(r) - g).collect();
    // A row of one finger has the noise of one sensor.
    let weight: Vec<f64> =
        rows.rows.iter().map(|r| if is_carried(r) { 1.0 } else { std::f64::consts::SQRT_2 }).collect();
    let period_s = seen.iter().map(|s| s.period_s).fold(0.0, f64::max);
    let plant = plant(&rows, world.is_some());
    // Beside weights and inertia: a cable is looked for before it is compared.
    let mut beside = base.clone();
    beside.extend(plant.iter().filter(|c| c.id == "inertia").flat_map(|c| c.columns.clone()));
    let cables = cables(&rows, &y, &beside, &weight);
    let mut candidates = plant;
    candidates.extend(instrument(&rows, &known, &given));
    candidates.extend(cables);
    candidates.extend(generic(&rows));
    let channel =
        Channel { y, base, candidates, stretch: rows.stretch.clone(), testable: testable.clone(), weight, period_s };
    let study = channel.compare(threshold)?;
    let floor_n = floor(&rows, &study);
    let numbers = rows.rows.iter().map(|r| if let Place::Carried { number, .. } = r.place { number } else { 0 }).collect();
    let cable_errors = errors(&rows, &study);
    Ok(Carry { longest_s: longest_s(&rows), cable_errors, study, along: testable, stretch: rows.stretch, floor_n, numbers })
}

/// Force that carrying a weight needs along an axis, N.
fn needed(one: &Seen<'_>, row: &Row, weight_n: f64, axis: usize, with_inertia: bool) -> f64 {
    let up = if axis == 1 { 1.0 } else { 0.0 };
    let gravity = one.blocks.recording.meta.gravity().max(1e-9);
    weight_n * (up + if with_inertia { one.acceleration[axis][row.i] / gravity } else { 0.0 })
}

/// One weight a block; of a world with what its mass does in motion.
fn base(rows: &Rows<'_>, world: Option<&World>, known: &[Option<f64>]) -> Vec<Vec<f64>> {
    let unknown = (1..=rows.blocks()).filter(|k| known[k - 1].is_none());
    let mut base: Vec<Vec<f64>> = unknown
        .map(|k| {
            rows.carried(|one, row, number, axis| {
                if number == k { needed(one, row, 1.0, axis, world.is_some()) } else { 0.0 }
            })
        })
        .collect();
    for (k, block) in world.iter().flat_map(|w| &w.blocks).enumerate() {
        let Some(cable) = &block.cable else { continue };
        base.push(rows.carried(|one, row, number, axis| {
            let away = haptics::Vec2::new(one.place[0][row.i], one.place[1][row.i]) - cable.anchor_m;
            let length = away.norm().max(1e-9);
            let pull = haptics::law::AddedConstraint::cable_n(cable.stiffness_n_m, cable.length_m, length);
            if number == k + 1 { pull * away[axis] / length } else { 0.0 }
        }));
    }
    base
}

fn plant(rows: &Rows<'_>, has_inertia: bool) -> Vec<Candidate> {
    let mut found = Vec::new();
    let blocks = rows.blocks();
    if !has_inertia {
        let columns: Vec<Vec<f64>> = (1..=blocks)
            .map(|k| rows.carried(|one, row, number, axis| if number == k { one.acceleration[axis][row.i] } else { 0.0 }))
            .collect();
        const NAMES: [&str; 4] = ["m block-1", "m block-2", "m block-3", "m block-4"];
        if blocks <= NAMES.len() {
            let linear = NAMES[..blocks].iter().map(|n| (*n, "kg")).collect();
            found.push(Candidate::several("inertia", Kind::Plant, columns, linear).positive());
        } else {
            let column = rows.carried(|one, row, _, axis| one.acceleration[axis][row.i]);
            found.push(Candidate::one("inertia", Kind::Plant, "m", "kg", column).positive());
        }
    }
    let drag = rows.carried(|one, row, _, axis| one.velocity[axis][row.i]);
    found.push(Candidate::one("viscous-friction", Kind::Plant, "c", "N s/m", drag).positive());
    let tilted = rows.carried(|_, _, number, axis| if axis == 0 { rows.weight_n(number) } else { 0.0 });
    found.push(Candidate::one("gravity-tilt", Kind::Plant, "angle", "rad", tilted));
    for k in 1..=blocks {
        leaks(rows, k, &mut found);
    }
    found
}

/// Changes of the weight of one block: evenly from when it is lifted or from later on, or all at once.
fn leaks(rows: &Rows<'_>, k: usize, found: &mut Vec<Candidate>) {
    let times: Vec<f64> =
        rows.rows.iter().filter(|r| r.place == (Place::Carried { number: k, axis: 1 })).map(|r| r.time_s).collect();
    let (Some(first), Some(last)) = (times.first(), times.last()) else { return };
    let lift = |of: &dyn Fn(f64) -> f64| {
        rows.carried(|_, row, number, axis| if number == k && axis == 1 { of(row.time_s) } else { 0.0 })
    };
    let rate = |from: f64| lift(&|t| (t - from).max(0.0));
    found.push(Candidate::one("mass-change", Kind::Plant, "rate", "N/s", rate(*first)));
    for s in 1..=STARTS {
        let start = first + (last - first) * s as f64 / (STARTS + 1) as f64;
        let later = Candidate::one("mass-change", Kind::Plant, "rate", "N/s", rate(start));
        found.push(later.at("t0", start, "s"));
        let step = lift(&|t| f64::from(u8::from(t >= start)));
        found.push(Candidate::one("mass-change", Kind::Plant, "step", "N", step).at("t0", start, "s"));
    }
}

const BIAS: [[(&str, &str); 2]; 2] = [[("bx1", "N"), ("by1", "N")], [("bx2", "N"), ("by2", "N")]];
const DRIFT: [[(&str, &str); 2]; 2] = [[("rx1", "N/s"), ("ry1", "N/s")], [("rx2", "N/s"), ("ry2", "N/s")]];

fn instrument(rows: &Rows<'_>, known: &[Option<f64>], given: &[f64]) -> Vec<Candidate> {
    let mut found = Vec::new();
    let all = |id: &'static str, names: &[[(&'static str, &'static str); 2]; 2], of: &dyn Fn(&Row) -> f64| {
        let column = |finger: usize, axis: usize| rows.column(|r| Rows::share(r, finger, axis) * of(r));
        let mut made = Vec::new();
        // One channel alone, both of one finger, or everything.
        for finger in [0, 1] {
            for axis in [0, 1] {
                let (name, unit) = names[finger][axis];
                made.push(Candidate::one(id, Kind::Instrument, name, unit, column(finger, axis)));
            }
            let both = vec![column(finger, 0), column(finger, 1)];
            made.push(Candidate::several(id, Kind::Instrument, both, names[finger].to_vec()));
        }
        let columns = vec![column(0, 0), column(0, 1), column(1, 0), column(1, 1)];
        made.push(Candidate::several(id, Kind::Instrument, columns, names.concat()));
        made
    };
    found.extend(all("force-bias", &BIAS, &|_| 1.0));
    found.extend(all("force-drift", &DRIFT, &|r| r.time_s));
    // Sensors may begin to drift when they are loaded: only what is free afterwards tells that from a block that changes.
    let loaded_s = |r: &Row| {
        let carried = |o: &&Row| o.recording == r.recording && matches!(o.place, Place::Carried { .. });
        rows.rows.iter().filter(carried).map(|o| o.time_s).fold(f64::INFINITY, f64::min)
    };
    let since: Vec<f64> = (0..rows.seen.len())
        .map(|k| rows.rows.iter().find(|r| r.recording == k).map_or(0.0, loaded_s))
        .collect();
    for (finger, axis) in [(0, 1), (1, 1), (0, 0), (1, 0)] {
        let (name, unit) = DRIFT[finger][axis];
        let column =
            rows.column(|r| Rows::share(r, finger, axis) * (r.time_s - since[r.recording]).max(0.0));
        found.push(Candidate::one("force-drift", Kind::Instrument, name, unit, column));
    }
    // One finger's force along the other axis, where only the sum is compared: what a carried row has of it.
    let other = |row: &Row, finger: usize, to: usize| {
        let force = &rows.seen[row.recording].force[finger];
        Rows::share(row, finger, to) * force[1 - to][row.i]
    };
    for (finger, to, name) in
        [(0, 1, "kappa_yx1"), (1, 1, "kappa_yx2"), (0, 0, "kappa_xy1"), (1, 0, "kappa_xy2")]
    {
        let column = rows.column(|r| other(r, finger, to));
        found.push(Candidate::one("force-cross-axis", Kind::Instrument, name, "1", column));
    }
    for (to, name) in [(1, "kappa_yx"), (0, "kappa_xy")] {
        let column = rows.column(|r| other(r, 0, to) + other(r, 1, to));
        found.push(Candidate::one("force-cross-axis", Kind::Instrument, name, "1", column));
    }
    if known.iter().any(Option::is_some) {
        found.push(Candidate::one("force-gain", Kind::Instrument, "g - 1", "1", given.to_vec()));
    }
    found
}

fn generic(rows: &Rows<'_>) -> Vec<Candidate> {
    let span = rows.rows.iter().map(|r| r.time_s).fold(0.0, f64::max).max(1e-9);
    let mut found = Vec::new();
    for (axis, name) in [(1, "lift"), (0, "side force")] {
        let mut term = |expression: &str, of: &dyn Fn(&Seen<'_>, &Row) -> f64| {
            let column = rows.carried(|one, row, _, a| if a == axis { of(one, row) } else { 0.0 });
            found.push(Candidate {
                expression: Some(format!("{expression} ({name})")),
                ..Candidate::one("other", Kind::Plant, "amplitude", "", column)
            });
        };
        for k in 1..=4 {
            term(&format!("cos({k} pi t/T)"), &|_, r| (std::f64::consts::PI * f64::from(k) * r.time_s / span).cos());
        }
        term("x", &|s, r| s.place[0][r.i]);
        term("y", &|s, r| s.place[1][r.i]);
        term("grip", &|s, r| s.blocks.grip[r.i]);
        term("vx abs(vx)", &|s, r| s.velocity[0][r.i] * s.velocity[0][r.i].abs());
        term("vy abs(vy)", &|s, r| s.velocity[1][r.i] * s.velocity[1][r.i].abs());
    }
    found
}

/// Length of the longest carry, s.
fn longest_s(rows: &Rows<'_>) -> f64 {
    let carries = rows.seen.iter().flat_map(|one| (1..=one.count).map(move |number| (one, one.carried(number))));
    let lengths = carries.filter_map(|(one, rows)| Some(one.time_s(*rows.last()?) - one.time_s(*rows.first()?)));
    lengths.fold(0.0, f64::max)
}

/// Noise of the sum of two fingers, from where nothing is touched (N); from the residual where that never was.
fn floor(rows: &Rows<'_>, study: &Study) -> f64 {
    let Some(solved) = &study.solved else { return 0.0 };
    let picks = study.picks();
    let left = crate::diagnose::geometry::residual(&study.y, &study.base, &study.candidates, &picks, solved);
    let mean = |free: bool| {
        let of = (0..left.len()).filter(|i| matches!(rows.rows[*i].place, Place::Free { .. }) == free);
        let (sum, n) = of.fold((0.0, 0_u32), |(s, n), i| (s + left[i] * left[i], n + 1));
        (n > 0).then(|| (sum / f64::from(n)).sqrt())
    };
    mean(true).map_or_else(|| mean(false).unwrap_or(0.0), |one| std::f64::consts::SQRT_2 * one)
}

impl Carry {
    /// True when this cause was found.
    pub fn has(&self, id: &str) -> bool {
        self.study.picks().iter().any(|p| self.study.candidates[*p].id == id)
    }

    /// What is read of the horizontal force of each finger in its vertical channel, as found.
    pub fn cross(&self) -> [f64; 2] {
        let Some(solved) = &self.study.solved else { return [0.0; 2] };
        let mut found = [0.0; 2];
        let mut at = self.study.base.len();
        for pick in self.study.picks() {
            let candidate = &self.study.candidates[pick];
            match candidate.linear[0].0 {
                "kappa_yx1" => found[0] += solved.values[at],
                "kappa_yx2" => found[1] += solved.values[at],
                "kappa_yx" => found = found.map(|f| f + solved.values[at]),
                _ => {}
            }
            at += candidate.columns.len();
        }
        found
    }

    /// For the answer: which block a change of weight is of.
    pub fn states(&self, candidate: &Candidate, mut found: Vec<CauseParameter>) -> Vec<CauseParameter> {
        if candidate.id == "mass-change" {
            let row = candidate.columns[0].iter().position(|v| *v != 0.0);
            let number = row.map_or(0, |i| self.numbers[i]);
            found.push(parameter("block", number as f64, 0.0, "1"));
        }
        if let ("added-constraint", Some(errors)) = (candidate.id, self.cable_errors) {
            for (name, error) in ["k", "anchor x", "anchor y", "length"].into_iter().zip(errors) {
                found.iter_mut().filter(|p| p.name == name).for_each(|p| p.std_error = p.std_error.max(error));
            }
        }
        found
    }

    /// What in the residual shows a cause.
    pub fn shows(&self, found: &Found<'_>) -> String {
        let value = |k: usize| found.parameters.get(k).map_or(0.0, |p| p.value);
        match found.candidate.id {
            "inertia" => {
                let masses: Vec<String> = found
                    .parameters
                    .iter()
                    .enumerate()
                    .map(|(k, p)| format!("{} {:.1} g", object(k + 1), 1e3 * p.value))
                    .collect();
                format!("the force follows the acceleration while blocks are carried ({})", masses.join(", "))
            }
            "mass-change" => {
                "the lift changes while a block is carried, and the forces of empty fingers do not".to_owned()
            }
            "force-bias" => "empty fingers feel a force, and the same is missing while blocks are carried".to_owned(),
            "force-drift" => "the forces of empty fingers go with time, and those of carried blocks with them".to_owned(),
            "force-gain" => format!("carried blocks weigh {:+.1} % of what is known of them too much", 100.0 * value(0)),
            "force-cross-axis" => "one axis of a finger's force follows the other".to_owned(),
            "added-constraint" => "the net force on a carried block pulls towards one place from a distance on".to_owned(),
            "gravity-tilt" => "a carried block pulls to one side in proportion to its weight".to_owned(),
            "viscous-friction" => "the force follows the speed of the carried block".to_owned(),
            other => format!("{other} shows in the net force"),
        }
    }

    /// Sizes that could just matter, and what would show them.
    pub fn usual(&self, candidate: &Candidate) -> Option<(f64, &'static str)> {
        // One hundredth of a newton over the longest carry.
        let slow = 0.01 / self.longest_s.max(1.0);
        Some(match candidate.id {
            "inertia" => (0.02, "blocks were carried too evenly; carry them fast, with stops"),
            "mass-change" => (slow, "blocks were not carried for long; hold one still for some seconds"),
            "force-bias" => (0.01, "nothing was ever let go; start and end with a second of free motion"),
            "force-drift" => (slow, "the recording is too short, or nothing was let go at both ends"),
            "force-cross-axis" => (0.03, "the grip hardly varied; squeeze softly and hard while a block is carried"),
            "added-constraint" => (30.0, "blocks were hardly moved while they were carried"),
            "gravity-tilt" => (0.03, "no block was carried for long enough"),
            "viscous-friction" => (0.3, "blocks were carried too slowly"),
            _ => return None,
        })
    }

    /// As a part of the answer.
    pub fn part<'a>(
        &'a self,
        shows: &'a dyn Fn(&Found<'_>) -> String,
        states: &'a dyn Fn(&Candidate, Vec<CauseParameter>) -> Vec<CauseParameter>,
        usual: &'a dyn Fn(&Candidate) -> Option<(f64, &'static str)>,
    ) -> Part<'a> {
        Part {
            study: &self.study,
            channel: "net force on carried blocks",
            unit: "N",
            floor: self.floor_n,
            along: &self.along,
            stretch: &self.stretch,
            shows,
            states,
            usual,
        }
    }
}
