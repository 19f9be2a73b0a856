//! Carried blocks and needles with structured model error from the command line.
//!
//! `cargo run -p tests --bin structured -- SEED…` asks about them and counts certain names; `--list SEED…` has a line for each.
//! `--show CASE…` prints the whole answers to single cases by the seeds in that list.
//! `cargo run -p tests --bin structured -- --sizes SEED…` makes them and prints how large they came out.

use blind::{Share, certain};
use estimator::diagnose::diagnose;
use std::process::ExitCode;
use std::time::Instant;
use tests::tasks::structured::family::Group;
use tests::tasks::structured::score::{Row, ask, line};
use tests::tasks::structured::sets::{BATTERY, Counts, Job, structured};

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["--list", seeds @ ..] if !seeds.is_empty() => rows(seeds).iter().for_each(|row| println!("{}", line(row))),
        ["--sizes", seeds @ ..] if !seeds.is_empty() => sizes(seeds),
        ["--show", cases @ ..] if !cases.is_empty() => cases.iter().filter_map(|c| c.parse().ok()).for_each(show),
        [] | ["--list" | "--sizes" | "--show"] => {
            eprintln!("structured SEED… | --list SEED… | --show CASE… | --sizes SEED…");
            return ExitCode::from(2);
        }
        seeds => report(seeds),
    }
    ExitCode::SUCCESS
}

fn jobs(seeds: &[&str]) -> Vec<Job> {
    let seeds = seeds.iter().filter_map(|text| text.parse().ok());
    seeds.flat_map(|seed| structured(Counts::USUAL, seed)).collect()
}

fn rows(seeds: &[&str]) -> Vec<Row> {
    ask(&jobs(seeds), &|recordings, options| diagnose(recordings, options).map_err(|e| e.to_string()))
}

fn show(seed: u64) {
    let Some(job) = structured(Counts::USUAL, seed / BATTERY).into_iter().find(|job| job.seed == seed) else {
        eprintln!("{seed} is no case of this battery");
        return;
    };
    let made = job.make();
    let case = made.case;
    let answer = diagnose(&case.recordings, &case.options).map_err(|e| e.to_string());
    let sizes = made.scaled.sizes;
    println!("{} {} {:?} {sizes:?} noise {} N", job.group.name(), job.family.name(), job.hidden(), made.noise_n);
    println!("{answer:#?}");
    let clean = diagnose(&made.clean.recordings, &made.clean.options).map_err(|e| e.to_string());
    println!("without the structure: {clean:#?}");
}

fn report(seeds: &[&str]) {
    let start = Instant::now();
    let rows = rows(seeds);
    println!("{} cases, seeds {}", rows.len(), seeds.join(" "));
    for group in [Group::Blocks, Group::Needles] {
        let own: Vec<Row> = rows.iter().filter(|row| row.group == group).cloned().collect();
        println!("\n{}\n\n{}", group.name(), certain::report(&own));
        let clean = own.iter().filter(|row| row.hidden.is_none());
        println!("named without the structure: {}", Share::count(clean, |row| !row.clean_names.is_empty()));
        let beside = own.iter().filter(|row| row.hidden.is_some() && !row.is_missed);
        let is_first = |row: &Row| row.clean_names.first().map(String::as_str) == row.hidden;
        println!("the effect is named first without the structure: {}", Share::count(beside, is_first));
        let mean_s = |k: usize| own.iter().map(|row| row.took_s[k]).sum::<f64>() / own.len().max(1) as f64;
        println!("{:.2} s to make a case, {:.2} s to answer it", mean_s(0), mean_s(1));
    }
    println!("\nboth\n\n{}", certain::report(&rows));
    println!("{:.0} s in all, generator included", start.elapsed().as_secs_f64());
}

fn sizes(seeds: &[&str]) {
    for job in jobs(seeds) {
        let start = Instant::now();
        let made = job.make();
        let scaled = &made.scaled;
        println!(
            "{:8} {:20} form {} {:20} sizes {:?} ratios {:.3?} wanted {:?}{} {:.2} s",
            job.group.name(),
            job.family.name(),
            job.form,
            job.hidden().unwrap_or(""),
            scaled.sizes.iter().map(|x| format!("{x:.2e}")).collect::<Vec<String>>(),
            scaled.ratios,
            job.ratios,
            if scaled.is_missed { " missed" } else { "" },
            start.elapsed().as_secs_f64()
        );
    }
}
