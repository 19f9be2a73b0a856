//! The blind battery from the command line.
//!
//! `cargo run --release -p blind --example blind -- --fast [SEED]` (or `--whole`) asks the program and prints how it did.
//! `cargo run --release -p blind --example blind -- --long [SEED]` times answers for minute-long recordings at 1 kHz.
//! `cargo run --release -p blind --example blind -- --dump DIR N SEED` writes N cases as files, their truth in a folder apart.
//! `cargo run --release -p blind --example blind -- --experiments [SEED [N]]` performs what answers ask for: N cases of every effect.
//! `cargo run --release -p blind --example blind -- --one DIR ID [FORM [RATIO [RATE [SEED]]]]` writes one of a kind.
//! `cargo run --release -p blind --example blind -- --only ID [SEED]` asks the cases of a whole battery in which one effect is hidden alone.
//! `cargo run --release -p blind --example blind -- --list SEED…` asks whole batteries and prints every case in a line.
//! `cargo run --release -p blind --example blind -- --structured SEED…` asks about recordings with structured model error and counts certain names; `--list-structured` has a line for each.
//! `cargo run --release -p blind --example blind -- --again DIR SEED…` (or `--again-structured`) writes cases of batteries that a report names by their seeds.
//! `cargo run --release -p blind --example blind -- --table [SEED]` makes every effect once and prints how large it came out.

use blind::{
    Bench, Chance, Counts, Effect, Job, Log, Set, Spec, Structure, StructureCounts, ask, battery, certain, dump, long,
    make, report, score, structured,
};
use estimator::diagnose::diagnose;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

/// A battery counts its cases on from its seed times this.
const BATTERY: u64 = 1_000_003;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let number = |text: Option<&&str>, default: u64| text.and_then(|t| t.parse().ok()).unwrap_or(default);
    match words.as_slice() {
        ["--long", rest @ ..] => time_long(number(rest.first(), 1)),
        ["--dump", folder, rest @ ..] => {
            dump_cases(Path::new(folder), number(rest.first(), 10), number(rest.get(1), 1));
        }
        ["--fast", rest @ ..] => ask_all(Counts::FAST, number(rest.first(), 1)),
        ["--whole", rest @ ..] => ask_all(Counts::WHOLE, number(rest.first(), 1)),
        ["--experiments", rest @ ..] => experiments(number(rest.first(), 1), number(rest.get(1), 2)),
        ["--one", folder, id, rest @ ..] => one(Path::new(folder), id, rest),
        ["--only", id, rest @ ..] => only(id, number(rest.first(), 1)),
        ["--list", seeds @ ..] => seeds.iter().for_each(|seed| list(number(Some(seed), 1))),
        ["--structured", seeds @ ..] => with_structure(seeds, false),
        ["--list-structured", seeds @ ..] => with_structure(seeds, true),
        ["--again", folder, seeds @ ..] => again(&|seed| battery(Counts::WHOLE, seed), Path::new(folder), seeds),
        ["--again-structured", folder, seeds @ ..] => {
            again(&|seed| structured(StructureCounts::USUAL, seed), Path::new(folder), seeds);
        }
        ["--table", rest @ ..] => {
            table(number(rest.first(), 7));
            table_of_structures(number(rest.first(), 7));
        }
        _ => {
            eprintln!(
                "blind --fast [SEED] | --whole [SEED] | --long [SEED] | --dump DIR [N [SEED]] | --one DIR ID … | --only ID [SEED] | --list SEED… | --structured SEED… | --list-structured SEED… | --again DIR SEED… | --again-structured DIR SEED… | --table [SEED]"
            );
            return ExitCode::from(2);
        }
    }
    ExitCode::SUCCESS
}

/// Asks the program and prints how it did.
fn ask_all(counts: Counts, seed: u64) {
    let jobs = battery(counts, seed);
    println!("{} cases, seed {seed}", jobs.len());
    let start = Instant::now();
    let rows = ask(&jobs, &|recordings, options| diagnose(recordings, options).map_err(|e| e.to_string()));
    println!("{}", report(&rows));
    println!("{:.0} s in all, generator included", start.elapsed().as_secs_f64());
}

/// Asks, performs what the answers ask for, and prints what came of it.
fn experiments(seed: u64, per_effect: u64) {
    let counts =
        Counts { nulls: 0, per_effect: per_effect as usize, pairs: 0, per_nameless: 0, hard: 30 * per_effect as usize };
    let jobs = battery(counts, seed);
    let rows = ask(&jobs, &|recordings, options| diagnose(recordings, options).map_err(|e| e.to_string()));
    println!("{} cases, seed {seed}\n{}", rows.len(), blind::tables::experiments(&rows));
}

/// Asks for minute-long recordings one after the other and prints how long the answers took.
fn time_long(seed: u64) {
    for job in long(4, seed) {
        let (case, _) = job.make();
        let start = Instant::now();
        let answer = diagnose(&case.recordings, &score::options(&case));
        let took_s = start.elapsed().as_secs_f64();
        println!("{} {} samples: {took_s:.3} s, {}", case.bench.name(), case.recordings[0].len(), answer.is_ok());
    }
}

/// Writes a mixture of the sets.
fn dump_cases(folder: &Path, count: u64, seed: u64) {
    let jobs = battery(Counts::WHOLE, seed);
    let mut chance = Chance::new(seed, 99);
    let sets = [Set::Null, Set::Single, Set::Single, Set::Single, Set::Pair, Set::Nameless, Set::Hard];
    for k in 0..count {
        let set = sets[k as usize % sets.len()];
        let of_set: Vec<_> = jobs.iter().filter(|job| job.set == set).collect();
        let job = of_set[chance.whole(0, of_set.len() as u32 - 1) as usize];
        let (case, truth) = job.make();
        let name = format!("case-{k:03}");
        if let Err(error) = dump::write(folder, &name, job, &case, &truth) {
            eprintln!("{} cannot be written: {error}", folder.display());
            return;
        }
        println!("{name} {} {} {} Hz", case.bench.name(), case.log.name(), case.rate_hz);
    }
}

/// Writes one case: an effect by its id, its form, its size beside the noise, the rate, the seed.
fn one(folder: &Path, id: &str, rest: &[&str]) {
    let Some(effect) = Effect::from_id(id) else {
        eprintln!("{id} is none of the effects; `--table` lists them");
        return;
    };
    let number = |k: usize, default: f64| rest.get(k).and_then(|t| t.parse().ok()).unwrap_or(default);
    let bench = if effect.on_crank() { Bench::OneFinger } else { Bench::Linear };
    let spec = Spec {
        rate_hz: number(2, 100.0),
        seconds: 20.0,
        ..Spec::hiding(vec![(effect, number(0, 0.0) as u32)], number(1, 1.0), bench)
    };
    let job = Job { set: Set::Single, spec, seed: number(3, 1.0) as u64 };
    let (case, truth) = job.make();
    if let Err(error) = dump::write(folder, id, &job, &case, &truth) {
        eprintln!("{} cannot be written: {error}", folder.display());
    }
}

/// Asks where one effect is hidden alone, and prints every answer.
fn only(id: &str, seed: u64) {
    let Some(effect) = Effect::from_id(id) else {
        eprintln!("{id} is none of the effects; `--table` lists them");
        return;
    };
    let alone = |job: &Job| job.set == Set::Single && job.spec.effects.iter().all(|(hidden, _)| *hidden == effect);
    let jobs: Vec<Job> = battery(Counts::WHOLE, seed).into_iter().filter(alone).collect();
    let rows = ask(&jobs, &|recordings, options| diagnose(recordings, options).map_err(|e| e.to_string()));
    for row in &rows {
        let (bench, log) = (row.bench.name(), row.log.name());
        println!("effect/noise {:4}, {bench}, {log}, {} Hz, seed {}: {}", row.ratio, row.rate_hz, row.seed, row.said());
    }
    let right = rows.iter().filter(|row| row.first_right()).count();
    let in_set = rows.iter().filter(|row| row.set_right()).count();
    println!("{right} of {} have {id} first, {in_set} among what cannot be told apart, seed {seed}", rows.len());
}

/// Every case of a whole battery in a line: what it is, what was hidden, what equals that there, and what was said.
fn list(seed: u64) {
    let jobs = battery(Counts::WHOLE, seed);
    let rows = ask(&jobs, &|recordings, options| diagnose(recordings, options).map_err(|e| e.to_string()));
    for row in &rows {
        let kind = format!("{}, {}, {} Hz", row.bench.name(), row.log.name(), row.rate_hz);
        let (hidden, equals, said, named) =
            (row.ids().join(","), row.equals.join(","), row.said(), row.named().join(","));
        println!("{:?}|{}|{kind}|{}|{hidden}|{equals}|{said}|{named}", row.set, row.seed, row.ratio);
    }
}

/// Asks about recordings with structured model error; prints tables over all seeds, or a line for each case.
fn with_structure(seeds: &[&str], listed: bool) {
    let start = Instant::now();
    let jobs: Vec<Job> = seeds
        .iter()
        .filter_map(|text| text.parse().ok())
        .flat_map(|seed| structured(StructureCounts::USUAL, seed))
        .collect();
    let rows = ask(&jobs, &|recordings, options| diagnose(recordings, options).map_err(|e| e.to_string()));
    if listed {
        for row in &rows {
            println!("{}", certain::line(row));
        }
        return;
    }
    println!("{} cases, seeds {}", rows.len(), seeds.join(" "));
    println!("{}", certain::report(&rows));
    println!("{:.0} s in all, generator included", start.elapsed().as_secs_f64());
}

/// Writes cases of batteries by the seeds that a report names them by.
fn again(jobs_of: &dyn Fn(u64) -> Vec<Job>, folder: &Path, seeds: &[&str]) {
    for seed in seeds.iter().filter_map(|text| text.parse::<u64>().ok()) {
        let jobs = jobs_of(seed / BATTERY);
        let Some(job) = jobs.iter().find(|job| job.seed == seed) else {
            eprintln!("{seed} is no case of this battery");
            continue;
        };
        let (case, truth) = job.make();
        if let Err(error) = dump::write(folder, &seed.to_string(), job, &case, &truth) {
            eprintln!("{} cannot be written: {error}", folder.display());
        }
    }
}

/// Every effect in every form, once.
fn table(seed: u64) {
    for bench in [Bench::OneFinger, Bench::TwoFingers, Bench::Linear, Bench::Angular] {
        for effect in Effect::NAMED.into_iter().chain(Effect::NAMELESS) {
            let fits = match bench {
                Bench::OneFinger => effect.on_crank(),
                Bench::TwoFingers => effect.on_two_fingers(),
                Bench::Linear | Bench::Angular => effect.on_mechanism(bench == Bench::Angular),
            };
            if !fits {
                continue;
            }
            for form in effect.forms_on(bench.is_crank()) {
                let effects = vec![(effect, form)];
                let spec = Spec { seconds: 20.0, ..Spec::hiding(effects, 1.0, bench) };
                let start = Instant::now();
                let (_, truth) = make(&spec, seed);
                println!(
                    "{:8} {:18} {:30} size {:10.3e} ratio {:.3} noise {:.4} {:.2} s",
                    bench.name(),
                    effect.id(),
                    effect.form(form),
                    truth.hidden[0].size,
                    truth.ratio[0],
                    truth.noise_n,
                    start.elapsed().as_secs_f64()
                );
            }
        }
    }
}

/// Every structure in every form, once at each size.
fn table_of_structures(seed: u64) {
    for bench in [Bench::OneFinger, Bench::TwoFingers, Bench::Linear, Bench::Angular] {
        let there = |effect: &Effect| match bench {
            Bench::OneFinger => true,
            Bench::TwoFingers => effect.on_two_fingers(),
            Bench::Linear | Bench::Angular => effect.on_mechanism(bench == Bench::Angular),
        };
        for effect in Effect::STRUCTURES.into_iter().filter(there) {
            for form in 0..effect.forms() {
                let start = Instant::now();
                let ratios = [1.0, 2.0, 4.0].map(|ratio| {
                    let structure = Some(Structure { effect, form, ratio });
                    let (log, rate_hz, seconds) = (Log::Mixed, 100.0, 20.0);
                    let spec = Spec { effects: Vec::new(), ratio: 0.0, structure, bench, log, rate_hz, seconds };
                    let (_, truth) = make(&spec, seed);
                    format!("size {:10.3e} ratio {:.3}", truth.hidden[0].size, truth.ratio[0])
                });
                let (name, form) = (effect.id(), effect.form(form));
                let took_s = start.elapsed().as_secs_f64();
                println!("{:8} {name:30} {form:24} {} {took_s:.2} s", bench.name(), ratios.join(", "));
            }
        }
    }
}
