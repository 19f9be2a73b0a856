//! A change of friction as a hypothesis, in proportion to the model's own: slow, sudden, or with a recorded channel.

use super::axis::Axis;
use super::candidate::Candidate;
use super::change_scan::{Scan, slides, widen_time};
use super::dictionary::Dictionary;
use super::grid::{Near, Point, Ranges, may_start};
use super::hypothesis::{About, Found, Hypothesis};
use super::relations::{Form, Over, Relation};
use super::variable::Variable;
use crate::diagnose::contract::CauseParameter;
use crate::diagnose::data::regression_data::{Place, Track};
use haptics::law::{Effect, FrictionChange, Kind, LoadFrictionChange};

pub(crate) const ID: &str = "friction-change";

/// Time constants of a slow change, in shares of the recording.
/// Choice: halved, 3 of 62 answers change; doubled, 2 of 62 answers change.
const WARMING_SHARES: Axis = Axis::geometric(0.1, 3.0, 7);
/// Points: time constant.
const WARMING: &str = "time constant";
/// Points: start time of a sudden change.
const STARTS: &str = "start";
/// Points: none; a scan finds the start time at which a sudden change explains most.
const SCAN: &str = "scan";

impl Hypothesis for FrictionChange {
    fn about(&self) -> About {
        About {
            id: ID,
            form: Form::Curve(&[Over::Motion, Over::Time]),
            relations: &[Relation::OfDryFriction, Relation::ShareOfDryFriction, Relation::NeedsBothWays],
            seen: Variable::Time,
            ..About::PLAIN
        }
    }

    fn coarse(&self, ranges: &Ranges<'_>) -> Vec<Point> {
        let warming = WARMING_SHARES.values().map(|share| Point::one(WARMING, share * ranges.track.span_s));
        let starts = ranges.starts().map(|start| Point::one(STARTS, start));
        warming.chain(starts).chain([Point::one(SCAN, 0.0)]).collect()
    }

    fn around(&self, near: &Near<'_>) -> Vec<Point> {
        let taus = near.of(ID).filter_map(|found| found.value("tau"));
        let warming =
            taus.flat_map(|tau| WARMING_SHARES.around(tau, 1.0, near.step)).map(|tau| Point::one(WARMING, tau));
        warming.chain(near.starts().into_iter().map(|start| Point::one(STARTS, start))).collect()
    }

    fn candidates(&self, data: &Dictionary<'_>) -> Vec<Candidate> {
        let of_dry = |values: &[f64]| -> Vec<f64> {
            data.law(&FrictionChange, values).iter().zip(data.dry).map(|(w, d)| w * d).collect()
        };
        let warm = |[tau, ..]: [f64; 3]| change(of_dry(&[0.0, 1.0, tau, 0.0, 0.0])).at("tau", tau, "s");
        let step = |[start, ..]: [f64; 3]| change(of_dry(&[0.0, 1.0, 0.0, start, 0.0])).at("t0", start, "s");
        let scanned = data.points(ID, SCAN).filter_map(|_| best_start_s(data));
        let starts = data.points(ID, STARTS).chain(scanned.map(|start_s| [start_s, 0.0, 0.0]));
        let in_time = data.points(ID, WARMING).map(warm).chain(starts.map(step));
        in_time.chain(with_channels(data)).collect()
    }

    fn widen(&self, parameters: &mut [CauseParameter], track: &Track) {
        parameters.iter_mut().filter(|p| p.name == "t0").for_each(|start| widen_time(start, track));
    }

    fn effects(&self, found: &Found<'_>) -> Vec<Effect> {
        // No law of a world depends on other recorded channels.
        if found.candidate.channel.is_some() {
            return Vec::new();
        }
        let starts = found.candidate.searched.first().is_some_and(|s| s.name == "t0");
        let [tau, start] = if starts { [0.0, found.searched(0)] } else { [found.searched(0), 0.0] };
        let of = |friction: f64| [0.0, found.value(0) * friction, tau, start];
        let everywhere = Effect::new(&FrictionChange, &of(found.dry.level_n));
        found.dry.parts(everywhere, Effect::new(&LoadFrictionChange, &of(found.dry.mu)))
    }
}

/// Start time at which a sudden change of the dry friction explains most. The starts are those of every recording.
fn best_start_s(data: &Dictionary<'_>) -> Option<f64> {
    let is_one = data.track.rows.iter().all(|row| row.recording == 0);
    let best_s = is_one.then(|| Scan::of(data, 0, 1, &|i| [slides(data, i), 0.0]).best_time_s()).flatten();
    best_s.filter(|start_s| may_start(data.track, *start_s))
}

fn change(column: Vec<f64>) -> Candidate {
    Candidate::one(ID, Kind::Plant, "relative change", "1", column)
}

/// Friction that changes with another recorded channel: the dry part alone, or all of the resistance.
fn with_channels(data: &Dictionary<'_>) -> Vec<Candidate> {
    let mut all = Vec::new();
    for (name, unit, values) in data.track.extras() {
        let goes = |level: &dyn Fn(usize) -> f64| -> Vec<f64> {
            let rows = data.track.rows.iter().enumerate();
            rows.map(|(i, r)| if r.place == Place::Along { level(i) * values[i] } else { 0.0 }).collect()
        };
        let channel = (name, unit);
        let dry = goes(&|i| data.dry[i] * data.track.rows[i].motion.direction);
        all.push(change(dry).with(channel.clone()));
        all.push(change(goes(&|i| data.resisting[i])).with(channel));
    }
    all
}
