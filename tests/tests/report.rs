//! `touchstone report` from outside: the page is well-formed, needs nothing from anywhere, says what `fit` says, and survives what fails.

use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use scraper::{Html, Selector};
use serde_json::Value;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tests::{touchstone, workspace};

fn run(arguments: &[&str]) -> Output {
    Command::new(touchstone()).args(arguments).current_dir(workspace()).output().expect("the program starts")
}

fn json(arguments: &[&str]) -> Value {
    let mut all = arguments.to_vec();
    all.push("--json");
    let output = run(&all);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("one JSON object and nothing else")
}

fn text(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}

/// The page of `logs`, parsed, and its text; every rule that holds for any page is checked on the way.
fn report(logs: &[&str], status: i32) -> (Html, String, Output) {
    let folder = tempfile::tempdir().expect("a folder");
    let out = text(&folder.path().join("report.html"));
    let mut arguments = vec!["report"];
    arguments.extend(logs);
    arguments.extend(["--out", &out]);
    let output = run(&arguments);
    assert_eq!(output.status.code(), Some(status), "{logs:?}: {}", String::from_utf8_lossy(&output.stderr));
    let page = std::fs::read_to_string(&out).expect("the page is written");
    let parsed = Html::parse_document(&page);
    assert!(parsed.errors.is_empty(), "{:?}", parsed.errors);
    needs_nothing(&parsed, &page);
    assert!(page.len() < 3_000_000, "{} bytes", page.len());
    (parsed, page, output)
}

fn all(page: &Html, selector: &str) -> Vec<String> {
    let selector = Selector::parse(selector).expect("a selector");
    page.select(&selector).map(|e| e.text().collect::<String>()).collect()
}

/// No script, nothing that is fetched, no address outside the page.
fn needs_nothing(page: &Html, source: &str) {
    for active in ["script", "iframe", "object", "embed", "img", "link", "base", "form", "foreignObject", "use"] {
        assert!(all(page, active).is_empty(), "<{active}>");
    }
    let any = Selector::parse("*").expect("a selector");
    for element in page.select(&any) {
        for (name, value) in element.value().attrs() {
            assert!(!name.starts_with("on"), "{name}");
            assert!(!["src", "srcset", "data", "action", "xlink:href"].contains(&name), "{name}=\"{value}\"");
            assert!(name != "href" || value.starts_with('#'), "{value}");
            assert!(name != "style" || !value.contains("url("), "{value}");
        }
    }
    // Identifiers that links lead to are there, once each.
    for link in page.select(&Selector::parse("a").expect("a selector")) {
        let target = link.value().attr("href").expect("a target").trim_start_matches('#').to_owned();
        assert_eq!(source.matches(&format!("id=\"{target}\"")).count(), 1, "{target}");
    }
}

fn attribute(page: &Html, selector: &str, name: &str) -> Vec<Option<String>> {
    let selector = Selector::parse(selector).expect("a selector");
    page.select(&selector).map(|e| e.value().attr(name).map(str::to_owned)).collect()
}

/// The page's parameters are those of `fit --json`, to the last digit.
fn same_parameters(page: &Html, log: &str) -> Value {
    let fit = json(&["fit", log]);
    let wanted: Vec<(Option<String>, Option<f64>, Option<f64>)> = fit["parameters"]
        .as_array()
        .expect("parameters")
        .iter()
        .map(|p| {
            let name = format!("{}.{}", p["object"].as_str().expect("an object"), p["name"].as_str().expect("a name"));
            (Some(name), p["value"].as_f64(), p["std_error"].as_f64())
        })
        .collect();
    let number = |text: Option<String>| text.map(|t| t.parse::<f64>().expect("a number"));
    let names = attribute(page, "tr[data-parameter]", "data-parameter");
    let values = attribute(page, "tr[data-parameter]", "data-value").into_iter().map(number);
    let errors = attribute(page, "tr[data-parameter]", "data-error").into_iter().map(number);
    let mut found: Vec<_> = names.into_iter().zip(values).zip(errors).map(|((n, v), e)| (n, v, e)).collect();
    let mut wanted = wanted;
    assert!(!wanted.is_empty(), "{log} shows something");
    // The page groups them by object.
    found.sort_by(|a, b| a.0.cmp(&b.0));
    wanted.sort_by(|a, b| a.0.cmp(&b.0));
    assert_eq!(found, wanted);
    fit
}

fn asset(name: &str) -> String {
    text(&workspace().join("assets/recordings").join(name))
}

/// A recording of the scripted operator.
fn recorded(folder: &Path, task: &str) -> String {
    let log = text(&folder.join(format!("{task}.csv")));
    json(&["record", "--task", task, "--operator", "scripted", "--seed", "11", "--out", &log]);
    log
}

#[test]
fn a_crank_and_blocks_stand_on_one_page_with_what_the_other_commands_say() {
    let (crank, stack) = (asset("crank.csv"), asset("stack.csv"));
    let (page, source, _) = report(&[&crank, &stack], 0);
    assert_eq!(all(&page, "#overview tbody tr").len(), 2);
    assert_eq!(all(&page, "h2"), ["crank.csv", "stack.csv", "How to repeat this"]);
    let (one, _, _) = report(&[&crank], 0);
    let fit = same_parameters(&one, &crank);
    assert!(all(&one, "#overview").is_empty(), "one log needs no overview");
    let evidence = fit["constraints"][0]["evidence"].as_str().expect("evidence");
    assert!(all(&one, ".cause p").iter().any(|p| p.to_lowercase().contains(&evidence.to_lowercase())), "{evidence}");
    let diagnosis = json(&["diagnose", &crank]);
    let named: Vec<Option<String>> =
        diagnosis["causes"].as_array().expect("causes").iter().map(|c| c["id"].as_str().map(str::to_owned)).collect();
    assert_eq!(attribute(&one, "[data-cause]", "data-cause"), named);
    let (two, _, _) = report(&[&stack], 0);
    same_parameters(&two, &stack);
    // What went in, so that it can be repeated.
    let digest = |path: &str| {
        let output = Command::new("sha256sum").arg(path).output().ok().filter(|o| o.status.success());
        output.map(|o| String::from_utf8_lossy(&o.stdout).split(' ').next().unwrap_or_default().to_owned())
    };
    match digest(&crank) {
        Some(hash) => assert!(source.contains(&hash), "{hash}"),
        None => tests::skipped("sha256sum is not here"),
    }
    for word in ["--out", "touchstone report", env!("CARGO_PKG_VERSION"), "crank.meta.json"] {
        assert!(source.contains(word), "{word}");
    }
    // Pictures: states, signals, path, real against virtual, residuals.
    assert!(all(&page, "svg.chart").len() > 20, "{}", all(&page, "svg.chart").len());
    assert!(source.matches("var(--simulated)").count() > 8);
}

#[test]
fn needles_and_switches_have_pages_too() {
    let folder = tempfile::tempdir().expect("a folder");
    let needle = recorded(folder.path(), "needle");
    let (page, _, _) = report(&[&needle], 0);
    same_parameters(&page, &needle);
    let switch = recorded(folder.path(), "switch");
    let (page, _, _) = report(&[&switch], 0);
    same_parameters(&page, &switch);
    // What a task cannot have is a sentence, not a failure.
    let said = all(&page, ".failed").join(" ");
    let diagnosed = run(&["diagnose", &switch, "--json"]);
    assert!(diagnosed.status.success() || said.contains("cannot be diagnosed"), "{said}");
}

/// A slide that is pushed to and fro for some seconds, from formulas of this test; `moving` 0 leaves noise alone.
fn slide(path: &Path, seconds: f64, rate_hz: f64, channel: &str, moving: f64) {
    let mut rng = StdRng::seed_from_u64(5);
    let mut noise = move |size: f64| size * (rng.random_range(-1.0..1.0) + rng.random_range(-1.0..1.0));
    let mut table = format!("t_s,q_m,f_N,{channel}\n");
    for i in 0..(seconds * rate_hz) as usize {
        let t = i as f64 / rate_hz;
        let (q, v, a) = (0.1 * (2.0 * t).sin(), 0.2 * (2.0 * t).cos(), -0.4 * (2.0 * t).sin());
        let force = moving * (5.0 * a + 3.0 * v + 0.8 * v.signum()) + noise(0.02);
        let _ = writeln!(table, "{t:.5},{:.9},{force:.6},{:.3}", moving * q + noise(2e-6), 20.0 + t);
    }
    std::fs::write(path, table).expect("written");
}

#[test]
fn a_mechanism_with_hostile_names_is_printed_as_text() {
    let folder = tempfile::tempdir().expect("a folder");
    let name = "<script>alert('1')</script> & \"a\" \u{202e}.csv".replace('/', "\u{2215}");
    let log = folder.path().join(name);
    slide(&log, 8.0, 1e3, "<img src=x onerror=alert(1)>_degC", 1.0);
    let log = text(&log);
    let (page, source, _) = report(&[&log], 0);
    same_parameters(&page, &log);
    assert!(!source.contains("<script") && !source.contains("<img") && !source.contains('\u{202e}'));
    assert!(all(&page, "h2")[0].contains("alert('1')"), "it is told as it is called: {:?}", all(&page, "h2"));
    assert!(all(&page, ".channels").join(" ").contains("<img src=x onerror=alert(1)>"));
}

#[test]
fn what_shows_nothing_has_a_page_that_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let log = folder.path().join("still.csv");
    slide(&log, 3.0, 1e3, "room_degC", 0.0);
    let log = text(&log);
    let (page, _, _) = report(&[&log], 0);
    same_parameters(&page, &log);
    assert!(attribute(&page, "tr[data-parameter]", "data-value").iter().filter(|v| v.is_none()).count() > 2);
    assert!(all(&page, "td").iter().any(|t| t == "not identified"));
    // No task can be told: the stages fail one by one, the recording is still shown.
    let strange = folder.path().join("strange.csv");
    let mut table = "t_s,room_degC\n".to_owned();
    for i in 0..200 {
        let _ = writeln!(table, "{i}.0,{i}");
    }
    std::fs::write(&strange, table).expect("written");
    let (page, _, _) = report(&[&text(&strange)], 0);
    assert!(!all(&page, ".failed").is_empty() && !all(&page, "svg.chart").is_empty());
}

#[test]
fn a_broken_log_is_a_sentence_on_the_page_and_a_failure_in_the_end() {
    let folder = tempfile::tempdir().expect("a folder");
    let broken = folder.path().join("broken.csv");
    std::fs::write(&broken, "t_s,q_m,f_N\n0.0,1.0,abc\n").expect("written");
    let (broken, missing) = (text(&broken), text(&folder.path().join("missing.csv")));
    let (page, _, output) = report(&[&broken, &asset("crank.csv"), &missing], 1);
    let said = all(&page, ".broken");
    assert!(said.len() == 2 && said[0].contains("abc"), "{said:?}");
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    let last = errors.lines().last().expect("a sentence");
    assert!(last.contains("broken.csv") && last.contains("1 more"), "{errors}");
    assert!(all(&page, "tr[data-parameter]").len() > 8, "the crank is there all the same");
}

#[test]
fn a_report_never_overwrites_its_log() {
    let folder = tempfile::tempdir().expect("a folder");
    let log = folder.path().join("slide.csv");
    slide(&log, 0.2, 1e3, "room_degC", 1.0);
    let before = std::fs::read(&log).expect("there");
    let output = run(&["report", &text(&log), "--out", &text(&log)]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("choose another --out"));
    assert_eq!(std::fs::read(&log).expect("still there"), before);
}

#[test]
fn more_samples_make_no_longer_page() {
    let folder = tempfile::tempdir().expect("a folder");
    let length = |rate_hz: f64| {
        let log: PathBuf = folder.path().join("slide.csv");
        slide(&log, 8.0, rate_hz, "room_degC", 1.0);
        let (page, source, _) = report(&[&text(&log)], 0);
        assert!(all(&page, "svg.chart").len() > 4);
        source.len()
    };
    let (few, many) = (length(500.0), length(10_000.0));
    println!("{few} and {many} bytes");
    assert!(many < few + few / 2, "{few} and {many} bytes: twenty times as many samples");
}

/// The crank's log as a bad day would leave it: a second is missing, a channel stands still for 0.3 s, another meets its limit.
fn spoilt(folder: &Path) -> PathBuf {
    let whole = std::fs::read_to_string(asset("crank.csv")).expect("the log");
    let mut lines = whole.lines();
    let header: Vec<&str> = lines.next().expect("names").split(',').collect();
    let column = |name: &str| header.iter().position(|h| *h == name).expect("a column");
    let (clipped, stuck) = (column("fx1_N"), column("fy2_N"));
    let mut rows: Vec<Vec<String>> = lines.map(|l| l.split(',').map(str::to_owned).collect()).collect();
    let held = rows[1110][stuck].clone();
    for row in &mut rows[1110..1170] {
        row[stuck].clone_from(&held);
    }
    for row in &mut rows {
        let force: f64 = row[clipped].parse().expect("a number");
        row[clipped] = format!("{:.3}", force.clamp(-2.171, 2.171));
    }
    rows.drain(2221..2421);
    let text: Vec<String> = rows.iter().map(|row| row.join(",")).collect();
    let log = folder.join("spoilt.csv");
    std::fs::write(&log, format!("{}\n{}\n", header.join(","), text.join("\n"))).expect("written");
    // The rows in which a channel is stuck stay in, to be marked.
    let sidecar = std::fs::read_to_string(asset("crank.meta.json")).expect("its sidecar");
    let mut sidecar: Value = serde_json::from_str(&sidecar).expect("JSON");
    sidecar["as_recorded"] = serde_json::json!(["stuck-channel"]);
    std::fs::write(folder.join("spoilt.meta.json"), sidecar.to_string()).expect("written");
    log
}

/// The text of every section, under its heading.
fn sections(page: &Html) -> Vec<(String, String)> {
    let (card, heading) = (Selector::parse("section.card").expect("a selector"), Selector::parse("h3").expect("one"));
    let named = |e: scraper::ElementRef<'_>| Some((e.select(&heading).next()?.text().collect(), e.text().collect()));
    page.select(&card).filter_map(named).collect()
}

/// What every section of a report about a spoilt log must say, by its heading, in order.
const SAID: [(&str, &[&str]); 7] = [
    (
        "What was recorded",
        &[
            "18.5 s",
            "200 Hz",
            "1 gap(s) in the time",
            "fx1_N stands at exactly its extreme value",
            "fy2_N stops changing",
        ],
    ),
    ("What happened when", &["Turning", "turn-1", "gap", "does not change", "at its limit", "Agreement"]),
    (
        "Parameters",
        &["Radius", "21.20", "± ", "Circle through the handle's positions", "not identified", "Not measured"],
    ),
    ("Constraints", &["A hinge", "something guides it", "Its own stiffness, without the pads"]),
    ("Real against virtual", &["fx1_N", "Left over, RMS", "%", "Noise simulated", "Nothing is simulated in the gap"]),
    (
        "What the model gets wrong",
        &[
            "Fault of a channel",
            "Saturated force channel",
            "probability",
            "95 % interval",
            "data that took no part",
            "Noise",
        ],
    ),
    (
        "What could not be known",
        &[
            "Crank, coulomb friction",
            "push as well as pull",
            "lost in their own errors",
            "Crank, inertia",
            "would not have been seen",
        ],
    ),
];

#[test]
fn every_section_is_there_and_says_what_it_is_for() {
    let folder = tempfile::tempdir().expect("a folder");
    let log = text(&spoilt(folder.path()));
    let (page, _, _) = report(&[&log], 0);
    let found = sections(&page);
    assert_eq!(found.iter().map(|s| s.0.as_str()).collect::<Vec<_>>(), SAID.map(|s| s.0));
    for ((heading, said), (_, words)) in found.iter().zip(SAID) {
        for word in words {
            assert!(said.contains(word), "{heading} does not say {word:?}: {said}");
        }
    }
    let diagnosed = json(&["diagnose", &log]);
    let wrong = &found[5].1;
    for cause in diagnosed["causes"].as_array().expect("causes") {
        let evidence = cause["evidence"].as_str().expect("evidence").to_lowercase();
        assert!(wrong.to_lowercase().contains(evidence.trim_end_matches('.')), "{evidence}");
    }
    let provenance = all(&page, "#provenance").join(" ");
    for word in ["Program", "Revision of its sources", "Command", "SHA-256", "What the sidecar", "gravity_m_s2"] {
        assert!(provenance.contains(word), "{word}: {provenance}");
    }
    let hashes = all(&page, "#provenance td.mono");
    assert!(hashes.len() == 2 && hashes.iter().all(|h| h.len() == 64), "log and sidecar: {hashes:?}");
    let summary = all(&page, ".summary").join(" ");
    assert!(summary.contains("3 warnings about the quality of the data"), "{summary}");
}

/// Neighbours that a path draws a line between.
fn strokes(path: &str) -> Vec<(f64, f64)> {
    let runs = path.split('M').filter(|run| !run.is_empty());
    let x = |point: &str| point.split(' ').next().and_then(|x| x.parse::<f64>().ok()).expect("a place");
    runs.flat_map(|run| {
        let places: Vec<f64> = run.split('L').map(x).collect();
        places.windows(2).map(|w| (w[0], w[1])).collect::<Vec<_>>()
    })
    .collect()
}

#[test]
fn no_curve_and_no_state_runs_through_a_gap() {
    let folder = tempfile::tempdir().expect("a folder");
    let (page, _, _) = report(&[&text(&spoilt(folder.path()))], 0);
    let select = |s: &str| Selector::parse(s).expect("a selector");
    let number = |e: &scraper::ElementRef<'_>, name: &str| {
        e.value().attr(name).and_then(|v| v.parse::<f64>().ok()).expect("a number")
    };
    let (mut curves, mut states) = (0, 0);
    for chart in page.select(&select("svg.chart")) {
        let Some(gap) = chart.select(&select("rect.gap")).next() else { continue };
        let (from, to) = (number(&gap, "x"), number(&gap, "x") + number(&gap, "width"));
        assert!(to - from > 10.0, "a second can be seen");
        for line in chart.select(&select("path.line")) {
            let Some(data) = line.value().attr("d").filter(|d| !d.contains(['V', 'H', 'h', 'v'])) else { continue };
            curves += 1;
            let across = strokes(data).into_iter().find(|(a, b)| *a < to - 1.0 && *b > from + 1.0);
            assert_eq!(across, None, "a line through the gap {from} … {to}");
        }
        for state in chart.select(&select("rect.tint, g rect")) {
            states += 1;
            let (a, b) = (number(&state, "x"), number(&state, "x") + number(&state, "width"));
            assert!(b < from + 1.0 || a > to - 1.0, "a state in the gap: {a} … {b}");
        }
    }
    assert!(curves > 15 && states > 20, "{curves} curves, {states} states");
    assert!(!all(&page, "rect.stuck title").is_empty(), "what stands still is marked");
    assert!(all(&page, "rect.limit title").iter().all(|t| t.contains("fx1_N at its limit")));
    assert!(all(&page, "rect.limit title").len() > 4);
}

#[test]
fn a_replay_does_not_go_through_a_gap() {
    let folder = tempfile::tempdir().expect("a folder");
    let (world, log) = (text(&folder.path().join("world.json")), folder.path().join("gap.csv"));
    json(&["fit", &asset("crank.csv"), "--out", &world]);
    // Most of a turn is missing: a straight line between its ends would pull the handle off its circle.
    let whole = std::fs::read_to_string(asset("crank.csv")).expect("the log");
    let kept = whole.lines().filter(|line| {
        let time_s = line.split(',').next().and_then(|t| t.parse::<f64>().ok());
        time_s.is_none_or(|t| !(5.0..6.2).contains(&t))
    });
    std::fs::write(&log, kept.collect::<Vec<_>>().join("\n")).expect("written");
    std::fs::copy(asset("crank.meta.json"), folder.path().join("gap.meta.json")).expect("its sidecar");
    let out = text(&folder.path().join("forces.csv"));
    let said = run(&["simulate", &world, &text(&log), "--out", &out]);
    let said = String::from_utf8_lossy(&said.stdout).into_owned();
    assert!(said.contains("1 gap(s) in the time are not simulated"), "{said}");
    let left: Vec<f64> = said
        .lines()
        .filter_map(|l| l.split_once("measured − predicted: ")?.1.split(' ').next()?.parse().ok())
        .collect();
    assert!(left.len() == 4 && left.iter().all(|l| *l < 0.06), "with the line through the gap up to 0.3 N: {left:?}");
}

#[test]
fn a_clean_replay_says_which_noise_it_leaves_beside_a_diagnosis_that_finds_nothing() {
    let (page, _, _) = report(&[&asset("crank.csv")], 0);
    let summary = all(&page, ".summary").join(" ");
    assert!(summary.contains("leaves nothing beyond the noise. Its replay leaves"), "{summary}");
    assert!(summary.contains("noise of the sensor and of the simulated force itself"), "{summary}");
    let found = sections(&page);
    assert!(found[4].1.contains("In fx1_N, fy1_N, fx2_N and fy2_N nothing more than that is left."), "{}", found[4].1);
    assert!(all(&page, "rect.gap, rect.stuck, rect.limit").is_empty(), "nothing is marked where nothing is wrong");
}

#[test]
fn a_log_whose_task_cannot_be_told_counts_no_parameters_and_says_why() {
    let folder = tempfile::tempdir().expect("a folder");
    let log = folder.path().join("strange.csv");
    let rows: Vec<String> = (0..200).map(|i| format!("{i}.0,{i}")).collect();
    std::fs::write(&log, format!("t_s,room_degC\n{}\n", rows.join("\n"))).expect("written");
    let (page, _, output) = report(&[&text(&log), &asset("crank.csv")], 0);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        said.contains("strange.csv: no parameters, because the fit did not succeed: the task of strange.csv"),
        "{said}"
    );
    assert!(said.contains("crank.csv: 12 of 12 parameters were measured") && !said.contains("0 of 0"), "{said}");
    let summary = &all(&page, ".summary")[0];
    assert!(summary.contains("The fit did not succeed: The task of strange.csv"), "{summary}");
}
