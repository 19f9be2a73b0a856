//! Blocks and needles with structured force that no law describes: a catalogue cause is not certain because of it.

use blind::certain::{Alone, Beside};
use blind::{Counted, Share};
use estimator::diagnose::diagnose;
use tests::tasks::structured::family::Group;
use tests::tasks::structured::score::{Row, ask};
use tests::tasks::structured::sets::{Counts, structured};

/// A seed on which nothing was chosen.
const SEED: u64 = 4711;
/// Probability of a worse result by chance, beyond which the test fails.
const LUCK: f64 = 0.01;

#[test]
fn structure_gives_blocks_and_needles_few_certain_names() {
    let jobs = structured(Counts { blocks: [2, 1], needles: [2, 1] }, SEED);
    let rows = ask(&jobs, &|recordings, options| diagnose(recordings, options).map_err(|e| e.to_string()));
    for (group, most, least) in [(Group::Blocks, 0.1, 0.5), (Group::Needles, 0.05, 0.6)] {
        let own: Vec<&Row> = rows.iter().filter(|r| r.group == group).collect();
        let (alone, beside) = (Alone::of(&own), Beside::of(&own));
        let name = group.name();
        assert!(alone.fair.of > 0 && alone.fair.at_least(LUCK) <= most, "{name}: false certain names {}", alone.fair);
        assert!(beside.right.of > 0 && beside.right.at_most(LUCK) >= least, "{name}: right {}", beside.right);
        // Hum is fast, and belongs to the noise. A sensor that wanders slowly does not.
        let of_sensor: Vec<&Row> = own.iter().copied().filter(|r| r.family.name().starts_with("sensor-")).collect();
        let floors = [alone.floor, Alone::of(&of_sensor).floor];
        assert!(floors[0] <= 1.3 && floors[1] <= 1.5, "{name}: structure raises the noise floor {floors:.2?} times");
        let names = own.iter().flat_map(|r| r.names()).filter(|n| n.posterior >= 0.95 && !n.is_tolerated);
        let right = Share::count(names, |n| n.is_right);
        assert!(right.of > 0 && right.at_most(LUCK) >= 0.85, "{name}: right of what is said with 95 % {right}");
    }
}
