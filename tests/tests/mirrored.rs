//! A mirrored axis of one finger is named, whatever the fingers hold; what is as it should be is not.

use estimator::diagnose::{Options, diagnose};
use haptics::recording::Recording;
use tests::tasks::{Case, barrel, blocks, needle, switch};

/// A day's seeds, or what `TOUCHSTONE_SEED` says.
fn seed() -> u64 {
    let told = std::env::var("TOUCHSTONE_SEED").ok().and_then(|s| s.parse().ok());
    told.unwrap_or_else(|| {
        std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(1, |t| t.as_secs() / 86_400)
    })
}

fn cases(seed: u64) -> [(&'static str, Case); 4] {
    [
        ("blocks", blocks::make(blocks::Kind::Nothing, seed).0),
        ("barrel", barrel::make(barrel::Kind::Nothing, seed).0),
        ("needle", needle::make(needle::Kind::NothingInWorld, seed).0),
        ("switch", switch::make(switch::Kind::Nothing, seed).0),
    ]
}

/// The recordings with channels mirrored.
fn mirrored(recordings: &[Recording], names: &[&str]) -> Vec<Recording> {
    let mut other = recordings.to_vec();
    for channel in other.iter_mut().flat_map(|r| &mut r.channels).filter(|c| names.contains(&c.name.as_str())) {
        channel.values.iter_mut().for_each(|v| *v = -*v);
    }
    other
}

/// Whether the answer's first cause is this axis.
fn names(recordings: &[Recording], options: &Options, axis: &str) -> Result<bool, String> {
    let found = diagnose(recordings, options).map_err(|e| e.to_string())?;
    let first =
        found.causes.first().map(|c| (c.id.clone(), c.parameters.iter().map(|p| p.name.clone()).collect::<Vec<_>>()));
    Ok(first.is_some_and(|(id, which)| id == "axis-sign" && which.iter().any(|w| w == &format!("which: {axis}"))))
}

#[test]
fn a_mirrored_axis_is_named() {
    let first = seed();
    println!("TOUCHSTONE_SEED={first}");
    mirrored_axes_are_named(first);
}

/// Grips that weaken on the way, and a block that turns between the fingers.
#[test]
fn a_mirrored_axis_is_named_in_grips_that_do_not_hold() {
    mirrored_axes_are_named(20_785);
}

fn mirrored_axes_are_named(first: u64) {
    let (mut right, mut all) = (0, 0);
    for k in 0..3 {
        for (task, Case { recordings, options }) in cases(1_000 * first + k) {
            for axes in shown(task) {
                let rates: Vec<String> =
                    axes.iter().filter_map(|a| Some(format!("v{}_m_s", a.strip_suffix("_m")?))).collect();
                let channels: Vec<&str> = axes.iter().copied().chain(rates.iter().map(String::as_str)).collect();
                // Every other time the recorder mirrored the places and not the rates that it took elsewhere.
                let channels = if k == 1 { &axes[..] } else { &channels[..] };
                let named = names(&mirrored(&recordings, channels), &options, &axes.join(" and "));
                println!("{task}, {}: {named:?}", axes.join(" and "));
                all += 1;
                right += usize::from(named == Ok(true));
            }
        }
    }
    println!("{right} of {all}");
    assert!(right * 100 >= all * 95, "{right} of {all} named");
}

/// What such a recording shows: a switch is pushed along x by one finger at a time, a needle need not be lifted, and a barrel that is not
/// carried sideways has any width.
fn shown(task: &str) -> Vec<Vec<&'static str>> {
    let each = |names: &[&'static str]| names.iter().map(|n| vec![*n]).collect::<Vec<_>>();
    let along = each(&["fx1_N", "fx2_N", "x1_m", "x2_m"]);
    let up = each(&["fy1_N", "fy2_N", "y1_m", "y2_m"]);
    let both = vec![vec!["fx1_N", "fx2_N"], vec!["fy1_N", "fy2_N"], vec!["x1_m", "x2_m"], vec!["y1_m", "y2_m"]];
    match task {
        "switch" => along,
        "barrel" => each(&["fx1_N", "fx2_N"]).into_iter().chain(up).chain(both).collect(),
        "needle" => along.into_iter().chain(each(&["y1_m", "y2_m"])).collect(),
        _ => along.into_iter().chain(up).chain(both).collect(),
    }
}

/// A sensor that drifts at a finger without touch shows a force that looks like a pull.
#[test]
fn a_drifting_finger_is_not_mirrored() {
    for number in 0..12 {
        let Case { recordings, options } = switch::make(switch::Kind::Drift, 20_972_065 + number).0;
        let found = diagnose(&recordings, &options).expect("answers");
        assert!(found.causes.iter().all(|c| c.id != "axis-sign"), "case {number}: {:?}", found.causes);
    }
}

#[test]
fn what_is_right_is_not_mirrored() {
    let first = seed();
    println!("TOUCHSTONE_SEED={first}");
    for k in 0..8 {
        for (task, Case { recordings, options }) in cases(7_000 * first + k) {
            let found = diagnose(&recordings, &options).expect("answers");
            assert!(found.causes.iter().all(|c| c.id != "axis-sign"), "{task}, seed {k}: {:?}", found.causes);
        }
    }
}
