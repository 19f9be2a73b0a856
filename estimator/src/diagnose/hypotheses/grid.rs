//! Search grids of the non-linear values: coarse at first, then finer around the values found.

use super::candidate::Candidate;
use crate::diagnose::data::interpolation::FINE_HZ;
use crate::diagnose::data::regression_data::{Place, Track};
use std::f64::consts::TAU;

/// Tried numbers of ripples per turn (over the range, if nothing turns).
const RIPPLES: std::ops::RangeInclusive<u32> = 2..=40;
/// Least length of a ripple, in rows of the fastest motion. The rows average out a shorter one.
const LEAST_ROWS_A_RIPPLE: f64 = 1.0;
/// Number of tried places of a local resistance, and its widths as shares of the range.
const PLACES: usize = 24;
const WIDTHS: [f64; 3] = [0.12, 0.2, 0.35];
/// Speeds of the decay of static friction, as shares of the usual speed.
const STRIBECK: [f64; 7] = [0.06, 0.1, 0.16, 0.26, 0.4, 0.6, 0.9];
/// Exponents of that decay; 0 is the Gaussian.
const FALLING: [f64; 2] = [0.0, 1.0];
/// Ratio of speeds at which a Gaussian is most like an exponential.
const LIKE_EXPONENTIAL: f64 = 1.5;
/// Presliding distances and half gaps, as shares of the range of positions.
const WAYS: [f64; 14] =
    [0.00003, 0.00006, 0.00012, 0.00024, 0.0005, 0.001, 0.002, 0.004, 0.008, 0.016, 0.032, 0.065, 0.13, 0.2];
/// Shortest of these that is felt at a reversal, in points of the motion at the usual speed. (At the reversal the
/// motion is slower.)
const STEPS: f64 = 0.06;
/// The same with inertia in the model: the filters of force and motion blur every reversal by as much.
const STEPS_OF_MASS: f64 = 0.25;
/// The same for a crank, in standard deviations of the summed rate noise within a row. Such noise alone builds up and
/// releases a shorter presliding, which reduces the friction while the handle sticks, as the noise of the velocity
/// does.
const STEPS_OF_NOISE: f64 = 3.0;
/// The same where the object was seen to stand, in standard deviations of its position noise.
const SEEN: f64 = 0.5;
/// Number of tried anchor directions of a cable, and the slack shares of the travel around it.
const CABLES: u32 = 16;
const SLACK: [f64; 3] = [0.35, 0.6, 0.8];
/// Initial distance of the anchor, in arm lengths, and the distances tried.
const REACH: f64 = 5.0;
const REACHES: [f64; 3] = [2.5, REACH, 20.0];
/// Number of tried rest positions of a hardening spring, and their largest distance from the middle, in half ranges.
const WALLS: [f64; 6] = [0.4, 0.5, 0.6, 0.7, 0.8, 0.9];
/// Places of rest of a spring that hardens: so many, up to so many half ranges from the middle.
const RESTS: u32 = 13;
const RESTS_WITHIN: f64 = 1.5;
/// Number of rest positions if the linear part of the spring shows.
const FINER_RESTS: u32 = 25;
/// Time constants of a friction change, in shares of the recording.
const WARMING: [f64; 4] = [0.1, 0.3, 1.0, 3.0];
/// Time constants of a decaying drift or leak, in shares of the recording.
const SETTLING: [f64; 2] = [0.2, 0.5];
/// Number of tried start times of a sudden change.
const STARTS: u32 = 16;

/// Values to try, in the units of the track.
#[derive(Clone, Debug, Default)]
pub struct Grid {
    /// Speed and exponent.
    pub stribeck: Vec<(f64, f64)>,
    pub ways: Vec<f64>,
    /// Presliding distances of friction that springs back along a straight line (Bouc and Wen).
    pub straight: Vec<f64>,
    /// Shortest presliding distance that is felt in the force. Shorter ones show only in the displacement of a standing
    /// object.
    pub felt: f64,
    /// Wave lengths.
    pub ripples: Vec<f64>,
    /// Place and width.
    pub places: Vec<(f64, f64)>,
    /// Period of the position; 0 if there is none.
    pub turn: f64,
    /// Place and side.
    pub walls: Vec<(f64, f64)>,
    /// Direction of the anchor, rad, length at rest, m, and distance of the anchor in arms.
    pub cables: Vec<(f64, f64, f64)>,
    /// Places of rest.
    pub rests: Vec<f64>,
    /// The same for a spring whose linear part shows, too. Tried if such a spring was found.
    pub hardening: Vec<f64>,
    pub warming: Vec<f64>,
    pub settling: Vec<f64>,
    pub starts: Vec<f64>,
}

/// Rest positions of a spring, evenly spaced about the middle of a range.
fn rests(count: u32, (low, high): (f64, f64)) -> Vec<f64> {
    let share = |k: u32| 2.0 * f64::from(k) / f64::from(count - 1) - 1.0;
    (0..count).map(|k| 0.5 * (low + high + RESTS_WITHIN * (high - low) * share(k))).collect()
}

/// Ripples of what swings freely that are shorter than any of a turn: it goes through them slowly wherever it turns
/// round.
fn shorter(track: &Track, range: f64) -> impl Iterator<Item = f64> {
    let longest =
        if track.freely.is_some() { track.radius_m.unwrap_or(0.0) * TAU / f64::from(*RIPPLES.end()) } else { 0.0 };
    RIPPLES.map(move |n| range / f64::from(n)).filter(move |length| *length < longest)
}

impl Grid {
    /// Grid of the first round.
    pub fn coarse(track: &Track) -> Self {
        let position = |share| track.quantile(share, |r| r.motion.position);
        let (low, high) = (position(0.0), position(1.0));
        let range = (high - low).max(1e-12);
        let fast = track.quantile(0.9, |r| r.motion.velocity.abs());
        let turn = track.radius_m.map(|r| TAU * r);
        // A distance shorter than the spacing of two points cannot be distinguished from a reversal between them.
        let between_s = track.raw_period_s.max(1.0 / FINE_HZ).min(track.period_s);
        let point_s = if track.fine.is_empty() { track.period_s } else { between_s };
        let stands = track.rows.iter().any(|r| matches!(r.place, Place::Stuck { .. }));
        let felt = if track.planar {
            (STEPS * point_s * fast).max(STEPS_OF_NOISE * track.velocity_noise * track.period_s)
        } else {
            STEPS_OF_MASS * point_s * fast
        };
        let least = if stands { (SEEN * track.position_noise).min(felt) } else { felt };
        let scale = track.radius_m.map_or(range, |r| range.min(2.0 * r));
        // On a crank, positions repeat every turn.
        let whole = turn.filter(|t| range > 0.8 * t);
        let (from, span) = whole.map_or((low, range), |t| (0.0, t));
        let places = (0..PLACES).map(|k| from + span * (k as f64 + 0.5) / PLACES as f64);
        let sides = [(1.0, 0.0), (-1.0, 1.0)];
        let walls = WALLS.iter().flat_map(|w| sides.map(|(side, base)| (position(base + side * w), side)));
        let rest = |share: f64| track.radius_m.unwrap_or(0.0) * (REACH - 1.0 + 2.0 * share);
        Self {
            stribeck: FALLING.iter().flat_map(|alpha| STRIBECK.map(|share| (share * fast, *alpha))).collect(),
            felt,
            straight: Vec::new(),
            ways: WAYS.map(|share| share * scale).into_iter().filter(|way| *way > least).collect(),
            ripples: RIPPLES
                .map(|n| turn.unwrap_or(range) / f64::from(n))
                .chain(shorter(track, range))
                .filter(|length| *length > LEAST_ROWS_A_RIPPLE * fast * track.period_s)
                .collect(),
            places: places.flat_map(|p| WIDTHS.map(|w| (p, w * span))).collect(),
            turn: whole.unwrap_or(0.0),
            walls: walls.collect(),
            cables: (0..CABLES)
                .flat_map(|k| SLACK.map(|s| (TAU * f64::from(k) / f64::from(CABLES), rest(s), REACH)))
                .collect(),
            rests: rests(RESTS, (low, high)),
            hardening: Vec::new(),
            warming: WARMING.map(|share| share * track.span_s).to_vec(),
            settling: SETTLING.map(|share| share * track.span_s).to_vec(),
            starts: (1..STARTS).map(|k| track.span_s * f64::from(k) / f64::from(STARTS)).collect(),
        }
    }

    /// Adds another grid's values.
    pub fn with(mut self, more: Self) -> Self {
        self.stribeck.extend(more.stribeck);
        self.ways.extend(more.ways);
        self.straight.extend(more.straight);
        self.ripples.extend(more.ripples);
        self.places.extend(more.places);
        self.walls.extend(more.walls);
        self.cables.extend(more.cables);
        self.rests.extend(more.rests);
        self.hardening.extend(more.hardening);
        self.warming.extend(more.warming);
        self.settling.extend(more.settling);
        self.starts.extend(more.starts);
        self
    }

    /// Values between those of the coarse grid, around the ones found; `step`: distance from them, 1 at first.
    pub fn around(found: &[&Candidate], track: &Track, step: f64) -> Self {
        let coarse = Self::coarse(track);
        let mut grid = Self { turn: coarse.turn, felt: coarse.felt, ..Self::default() };
        let (low, high) = (track.quantile(0.0, |r| r.motion.position), track.quantile(1.0, |r| r.motion.position));
        let range = high - low;
        let span = if grid.turn > 0.0 { grid.turn } else { range };
        let radius = track.radius_m.unwrap_or(0.0);
        for candidate in found {
            let value = |name: &str| candidate.searched.iter().find(|s| s.name == name).map(|s| s.value);
            let times = |v: f64, factors: &[f64]| factors.iter().map(|f| f.powf(step) * v).collect::<Vec<f64>>();
            match candidate.id {
                "stribeck" => {
                    let alpha = value("alpha").unwrap_or(0.0);
                    let vs = value("vs").unwrap_or(0.0);
                    // The other exponent is tried as finely: on the coarse grid the wrong one may fit better.
                    let [gaussian, exponential] =
                        if alpha == 1.0 { [vs * LIKE_EXPONENTIAL, vs] } else { [vs, vs / LIKE_EXPONENTIAL] };
                    for (alpha, vs) in [(0.0, gaussian), (1.0, exponential)] {
                        let speeds = times(vs, &[0.72, 0.85, 1.0, 1.18, 1.38]);
                        grid.stribeck.extend(speeds.into_iter().map(|vs| (vs, alpha)));
                    }
                }
                "hysteresis" | "backlash" => {
                    let way = value("way").or(value("delta")).unwrap_or(0.0);
                    if value("shape").is_none() {
                        grid.ways.extend(times(way, &[0.62, 0.79, 1.0, 1.26, 1.6]));
                    }
                    if candidate.id == "hysteresis" {
                        grid.straight.extend(times(way, &[0.62, 0.79, 1.0, 1.26, 1.6]));
                    }
                }
                "position-ripple" if track.radius_m.is_none() || track.freely.is_some() => {
                    grid.ripples.extend(times(
                        value("lambda").unwrap_or(0.0),
                        &[0.93, 0.96, 0.98, 0.99, 1.0, 1.01, 1.02, 1.04, 1.07],
                    ));
                }
                "local-resistance" => {
                    let (Some(place), Some(width)) = (value("place"), value("width")) else { continue };
                    for aside in [-0.6, -0.3, 0.0, 0.3, 0.6] {
                        let place = place + step * aside * span / PLACES as f64;
                        grid.places.extend(times(width, &[0.65, 0.8, 1.0, 1.25, 1.5]).iter().map(|w| (place, *w)));
                    }
                }
                "added-constraint" => {
                    // A wall and a hardening spring are similar.
                    grid.hardening = rests(FINER_RESTS, (low, high));
                    if let (Some(direction), Some(rest)) = (value("anchor direction"), value("rest length")) {
                        let found = value("anchor distance").map_or(REACH, |d| d / radius.max(1e-12));
                        for turn in [-0.6, -0.3, 0.0, 0.3, 0.6].map(|s| s * step * TAU / f64::from(CABLES)) {
                            let rests = [-0.3, -0.15, 0.0, 0.15, 0.3].map(|s| rest + s * step * radius);
                            grid.cables.extend(rests.map(|rest| (direction + turn, rest, found)));
                            // The same slack with another distance of the anchor.
                            for reach in REACHES.into_iter().filter(|reach| (reach - found).abs() > 1e-6) {
                                let rests = [-0.2, 0.0, 0.2].map(|s| rest + (s * step + reach - found) * radius);
                                grid.cables.extend(rests.map(|rest| (direction + turn, rest, reach)));
                            }
                        }
                    } else if let Some(place) = value("place") {
                        let places = [-0.06, -0.03, 0.03, 0.06].map(|s| place + s * step * range);
                        grid.walls.extend(places.map(|place| (place, candidate.side)));
                    }
                }
                "return-spring" if candidate.columns.len() <= 2 && candidate.searched.is_empty() => {}
                "return-spring" => {
                    grid.hardening = rests(FINER_RESTS, (low, high));
                    let apart = step * RESTS_WITHIN * range / f64::from(RESTS - 1);
                    let rest = value("q0").into_iter();
                    grid.rests.extend(rest.flat_map(|q0| [-0.67, -0.33, 0.0, 0.33, 0.67].map(|s| q0 + s * apart)));
                }
                "friction-change" if value("tau").is_some() => {
                    grid.warming.extend(times(value("tau").unwrap_or(0.0), &[0.58, 0.69, 0.83, 1.0, 1.2, 1.44, 1.7]));
                }
                "mass-change" | "force-drift" if value("tau").is_some() => {
                    grid.settling.extend(times(value("tau").unwrap_or(0.0), &[0.5, 0.7, 1.0, 1.4, 2.0]));
                }
                _ => {}
            }
            if let Some(start) = value("t0") {
                let apart = step * track.span_s / f64::from(STARTS);
                grid.starts.extend([-0.67, -0.33, 0.0, 0.33, 0.67].map(|s| start + s * apart));
            }
        }
        grid
    }
}
