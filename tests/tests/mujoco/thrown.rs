//! Cubes that MuJoCo throws, thrown again in our world with the friction and the free fall that were fitted to the log.

use super::fits::{Made, analysed};
use super::table::{Row, Table};
use haptics::Vec2;
use haptics::law::contact::VelocityLoss;
use haptics::recording::Recording;
use haptics::world::{Block, Floor, Input, Pose, State, World, step};

/// Side of the cube, m: whoever throws it knows that.
const SIDE_M: f64 = 0.1;
/// Samples of the flight that say how it was thrown: no cube touches that soon.
const FLIGHT: usize = 15;
/// How much a landing bounces no recording of places alone shows: hardly, as things of wood do.
const RESTITUTION: f64 = 0.1;
/// Tick of our world, s.
const STEP_S: f64 = 1.25e-4;
/// Where a cube comes to rest may be off by this share of its way on the table, as the median of all throws.
const MEDIAN: f64 = 0.05;

/// How a cube was thrown: place, angle, and their rates at the log's first sample.
struct Throw {
    start: Pose,
    velocity_m_s: Vec2,
    rate_rad_s: f64,
}

/// Value and rate at the first sample, by least squares.
fn line(time_s: &[f64], values: impl Iterator<Item = f64>) -> (f64, f64) {
    let values: Vec<f64> = values.collect();
    let n = values.len() as f64;
    let (mean_s, mean) = (time_s.iter().sum::<f64>() / n, values.iter().sum::<f64>() / n);
    let over: f64 = time_s.iter().map(|t| (t - mean_s).powi(2)).sum();
    let rate = time_s.iter().zip(&values).map(|(t, v)| (t - mean_s) * (v - mean)).sum::<f64>() / over;
    (mean + rate * (time_s[0] - mean_s), rate)
}

fn column<'a>(log: &'a Recording, name: &str) -> &'a [f64] {
    log.channel(name).unwrap_or_else(|| panic!("the log has {name}"))
}

/// Counter-clockwise, seen with x to the right and z up.
fn angle_rad(log: &Recording, i: usize) -> f64 {
    -2.0 * column(log, "qy")[i].atan2(column(log, "qw")[i])
}

fn throw(log: &Recording, gravity_m_s2: f64) -> Throw {
    let time_s = &log.time_s.as_ref().expect("a clock")[..FLIGHT];
    let (x_m, vx_m_s) = line(time_s, column(log, "x_m")[..FLIGHT].iter().copied());
    let risen = column(log, "z_m").iter().zip(time_s).map(|(z, t)| z + 0.5 * gravity_m_s2 * (t - time_s[0]).powi(2));
    let (z_m, vz_m_s) = line(time_s, risen);
    let (angle_rad, rate_rad_s) = line(time_s, (0..FLIGHT).map(|i| angle_rad(log, i)));
    let start = Pose { center_m: Vec2::new(x_m, z_m), angle_rad };
    Throw { start, velocity_m_s: Vec2::new(vx_m_s, vz_m_s), rate_rad_s }
}

/// The same throw in our world, for as long as the log lasts: where and how it lies then.
fn thrown_again(throw: &Throw, seconds: f64, (friction, gravity_m_s2): (f64, f64)) -> Pose {
    let mut world = World::empty("thrown");
    world.gravity_m_s2 = gravity_m_s2;
    let loss = Some(VelocityLoss { e: RESTITUTION, mu: friction });
    world.floor = Some(Floor { height_m: 0.0, friction, loss, ..Floor::default() });
    let mut cube = Block::upright("cube", 0.37, SIDE_M, SIDE_M, 0.0, 0.0);
    (cube.start, cube.block_friction) = (throw.start, friction);
    world.blocks = vec![cube];
    let away = [Vec2::new(-9.0, 9.0), Vec2::new(9.0, 9.0)];
    let input = Input { tip_in_world: away, tip_velocity: [Vec2::zeros(); 2] };
    let mut state = State::new(&world, away);
    (state.bodies[0].velocity_m_s, state.bodies[0].rate_rad_s) = (throw.velocity_m_s, throw.rate_rad_s);
    for _ in 0..(seconds / STEP_S) as usize {
        step(&world, &mut state, &input, STEP_S);
    }
    let body = &state.bodies[0];
    Pose { center_m: body.center_m, angle_rad: body.angle_rad }
}

/// Where the cubes come to rest in both programs.
pub fn compared(made: &Made) -> Table {
    let (logs, analysis) = analysed(made, "thrown");
    let found = |name: &str| analysis.fit.parameter("body", name).and_then(|p| p.value).expect("it was found");
    let object = (found("friction"), found("free_fall_m_s2"));
    let (mut ways, mut off, mut same) = (Vec::new(), Vec::new(), 0);
    for log in &logs {
        let (time_s, x_m) = (log.time_s.as_ref().expect("a clock"), column(log, "x_m"));
        let (first_s, last) = (time_s[0], time_s.len() - 1);
        let again = thrown_again(&throw(log, object.1), time_s[last] - first_s, object);
        let way_m = (x_m[last] - x_m[FLIGHT]).abs();
        println!(
            "throw: rests at {:.4} m in MuJoCo, {:.4} m here, turned by {:.3} and {:.3} rad",
            x_m[last],
            again.center_m.x,
            angle_rad(log, last),
            again.angle_rad
        );
        same += usize::from((again.angle_rad - angle_rad(log, last)).abs() < 0.2);
        ways.push(way_m);
        off.push((again.center_m.x - x_m[last]).abs() / way_m);
    }
    let median = |all: &mut Vec<f64>| {
        all.sort_by(f64::total_cmp);
        all[all.len() / 2]
    };
    let (way_m, off) = (median(&mut ways), median(&mut off));
    let row = |what: &str, shown: [String; 3], (found, wanted, tolerance): (f64, f64, f64)| Row {
        labels: vec![what.to_owned()],
        shown: shown.to_vec(),
        found,
        wanted,
        tolerance,
        per: 1.0,
        places: 2,
    };
    let throws = logs.len();
    let share = |n: usize| n as f64 / throws as f64;
    let rows = vec![
        row(
            "where it comes to rest, median",
            [format!("{way_m:.3} m"), format!("{:.1} % of the way", 100.0 * off), format!("{:.0} %", 100.0 * MEDIAN)],
            (off, 0.0, MEDIAN),
        ),
        row(
            "on which side it lies",
            [format!("{throws} throws"), format!("{} others", throws - same), format!("{} others", throws / 5)],
            (share(throws - same), 0.0, 0.2),
        ),
    ];
    Table { head: vec!["thrown again", "way", "off by", "may be"], rows }
}
