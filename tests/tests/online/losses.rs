//! A block that loses part of its weight at once while it is carried.

use crate::generator::{Fault, perform};
use crate::online::{Event, Settings, replay};
use haptics::recording::Task;
use rayon::prelude::*;

#[test]
fn steady_carries_raise_no_alarm_and_a_noticed_loss_is_told_rightly() {
    let each = crate::each(12);
    let events = |seed: u64, loss_kg: f64| -> (Vec<Event>, f64) {
        let fault = Fault { loss: (loss_kg > 0.0).then_some((loss_kg, 1.5)), ..Fault::default() };
        let (recording, _) = perform(seed, &fault);
        let labels = recording.labels.as_ref().expect("generated");
        let time = recording.time_s.as_ref().expect("generated");
        let lifted = (0..labels.len()).find(|i| labels.get(*i) == Some("hold-above-ground")).expect("it is carried");
        let online = replay(std::slice::from_ref(&recording), Task::BlockStack, &Settings::default()).expect("fed");
        (online.report().events, time[lifted] + 1.5 - time[0])
    };
    let quiet: usize = (63_000..63_000 + each).into_par_iter().map(|s| events(s, 0.0).0.len()).sum();
    let found: Vec<(bool, f64)> = (63_000..63_000 + each)
        .into_par_iter()
        .map(|seed| {
            let (events, at_s) = events(seed, 0.006);
            let first = events.iter().find(|e| e.object == 0 && !e.grows && e.noticed_s > at_s);
            (first.is_some(), first.map_or(f64::INFINITY, |e| e.noticed_s - at_s))
        })
        .collect();
    let mut delays: Vec<f64> = found.iter().filter(|f| f.0).map(|f| f.1).collect();
    delays.sort_by(f64::total_cmp);
    println!("{quiet} false alarms in {each} recordings; {} of {each} losses of 6 g noticed", delays.len());
    // Few are noticed within the carry (docs/online.md); what is noticed must be told soon and of the right object and way.
    assert!(delays.iter().all(|d| *d < 4.0), "{delays:?}");
    assert!(quiet as u64 * 20 <= each, "{quiet} false alarms");
}
