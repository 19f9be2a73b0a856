//! Files after public reports (`../shared/cases`): a test for each, with the answer that is right.

use estimator::diagnose::{Diagnosis, Options as DiagnoseOptions, diagnose};
use estimator::log;
use estimator::pipeline::{Options, analyse};
use haptics::recording::Recording;
use std::path::PathBuf;
use tests::{skipped, workspace};

/// A parameter's names along a line and about an axis.
type Names = [&'static str; 2];
const MASS: Names = ["mass_kg", "inertia_kg_m2"];
const VISCOUS: Names = ["viscous_N_s_m", "viscous_Nm_s"];
const COULOMB: Names = ["coulomb_N", "coulomb_Nm"];
/// Largest relative error of a value: that of the recordings with the usual file.
const NEAR: f64 = 0.05;

/// A file of a case, or `None` with a visible word that it was skipped.
fn case(file: &str) -> Option<PathBuf> {
    let path = workspace().join("../shared/cases/2026-11").join(file);
    if !path.is_file() {
        skipped(&format!("{file} is not here (../shared/cases)"));
        return None;
    }
    Some(path)
}

fn read(file: &str) -> Option<Vec<Recording>> {
    Some(log::load(&case(file)?, None).unwrap_or_else(|error| panic!("{file}: {error}")))
}

/// Kinds of the warnings about a file.
fn kinds(recordings: &[Recording]) -> Vec<&str> {
    recordings.iter().flat_map(|r| &r.warnings).map(|w| w.kind.as_str()).collect()
}

/// Compares mass, viscous friction, and dry friction of a file with their true values.
fn is(file: &str, truth: [f64; 3]) -> Option<Vec<Recording>> {
    let recordings = read(file)?;
    let fit = analyse(&recordings, &Options::default()).unwrap_or_else(|error| panic!("{file}: {error}")).fit;
    for (names, right) in [MASS, VISCOUS, COULOMB].into_iter().zip(truth) {
        let found = fit.parameters.iter().find(|p| names.contains(&p.name.as_str())).and_then(|p| p.value);
        assert!(found.is_some_and(|v| (v / right - 1.0).abs() < NEAR), "{file}: {names:?} {found:?}, not {right}");
    }
    Some(recordings)
}

/// [`is`] for the recording behind most cases.
fn is_the_drawer(file: &str) -> Option<Vec<Recording>> {
    is(file, [1.5, 4.0, 2.0])
}

fn refusal(file: &str) -> Option<String> {
    Some(log::load(&case(file)?, None).expect_err(file).to_string())
}

fn diagnosis(file: &str) -> Option<Diagnosis> {
    let answer = diagnose(&read(file)?, &DiagnoseOptions::default());
    Some(answer.unwrap_or_else(|error| panic!("{file}: {error}")).diagnosis)
}

fn ids(diagnosis: &Diagnosis) -> Vec<&str> {
    diagnosis.causes.iter().map(|cause| cause.id.as_str()).collect()
}

#[test]
fn advice_to_sort() {
    if let Some(all) = read("advice-to-sort/micros_wrap.csv") {
        assert!(all[0].warnings.iter().any(|w| w.text.contains("runs over")), "{:?}", all[0].warnings);
    }
    if let Some(error) = refusal("advice-to-sort/coarse_stamps_with_rate.csv") {
        assert!(error.contains(r#""columns": {"t_s": null}"#) && !error.contains("sort the"), "{error}");
    }
}

#[test]
fn burst_stamps() {
    let Some(all) = is("burst-stamps/bursts.csv", [1.2, 5.0, 1.5]) else { return };
    assert!(kinds(&all).contains(&"burst-stamps"));
    assert!(all[0].rate_hz().is_some_and(|rate| (rate / 500.0 - 1.0).abs() < 0.01));
}

#[test]
fn copied_channel() {
    for file in ["copied-channel/copy_beside.csv", "copied-channel/fitted_torque_is_a_copy.csv"] {
        let Some(all) = read(file) else { return };
        assert!(kinds(&all).contains(&"copied-channel"), "{file}");
    }
    let fitted = diagnosis("copied-channel/fitted_torque_is_a_copy.csv").expect("the file is there");
    assert!(ids(&fitted).contains(&"channel-fault"), "{:?}", ids(&fitted));
}

#[test]
fn duplicate_names_and_messages() {
    for file in ["names_not_asked_for.csv", "each_message_twice.mcap", "one_repeated_stamp.mcap"] {
        is_the_drawer(&format!("duplicate-names-and-messages/{file}"));
    }
}

#[test]
fn held_samples() {
    let Some(all) = is("held-samples/position_held_10.csv", [1.2, 5.0, 1.5]) else { return };
    assert!(kinds(&all).contains(&"held-samples"));
    assert!(all[0].rate_hz().is_some_and(|rate| (rate / 100.0 - 1.0).abs() < 0.01));
}

#[test]
fn hysteresis_taken_for_a_delay() {
    let Some(control) = diagnosis("hysteresis-taken-for-a-delay/control_dry_friction_and_spring.csv") else { return };
    assert_eq!(ids(&control), ["return-spring"]);
    for (file, right, way_m) in [
        ("bend_01mm.csv", vec!["hysteresis"], 1e-4),
        ("bend_1mm_and_spring.csv", vec!["return-spring", "hysteresis"], 1e-3),
    ] {
        let bent = diagnosis(&format!("hysteresis-taken-for-a-delay/{file}")).expect("the file is there");
        assert_eq!(ids(&bent), right, "{file}");
        let hysteresis = bent.causes.iter().find(|cause| cause.id == "hysteresis").expect("named");
        let way = hysteresis.parameters.iter().find(|p| p.name == "way").expect("a presliding distance");
        assert!((way.value / way_m - 1.0).abs() < 0.15, "{file}: {} m", way.value);
    }
}

#[test]
fn iso_time() {
    let Some(all) = is_the_drawer("iso-time/iso.csv") else { return };
    assert!(all[0].rate_hz().is_some_and(|rate| (rate / 100.0 - 1.0).abs() < 0.01));
}

#[test]
fn joint_order() {
    is_the_drawer("joint-order/order_changes_by_name.mcap");
    if let Some(error) = refusal("joint-order/order_changes_by_index.mcap") {
        assert!(error.contains("by its name"), "{error}");
    }
}

#[test]
fn junk_readings() {
    let Some(_) = is("junk-readings/spikes.csv", [1.2, 5.0, 1.5]) else { return };
    let found = diagnosis("junk-readings/spikes.csv").expect("the file is there");
    assert_eq!(ids(&found), ["channel-fault"]);
}

#[test]
fn labview_text() {
    is_the_drawer("labview-text/measurement.lvm");
}

#[test]
fn lines_above_and_units_below_the_header() {
    for file in ["testing_machine.csv", "force_sensor_demo.csv", "oscilloscope.csv"] {
        is_the_drawer(&format!("lines-above-and-units-below-the-header/{file}"));
    }
}

#[test]
fn mapped_column_overridden() {
    is_the_drawer("mapped-column-overridden/two_pairs.csv");
}

#[test]
fn nanosecond_clock() {
    for file in ["timestamp_ns.csv", "topic_echo.csv"] {
        let Some(all) = is_the_drawer(&format!("nanosecond-clock/{file}")) else { return };
        assert!(all[0].duration_s().is_some_and(|span| (span - 6.99).abs() < 0.02), "{file}");
    }
}

#[test]
fn not_a_number_in_an_unmapped_joint() {
    is_the_drawer("not-a-number-in-an-unmapped-joint/nan_other_joint.mcap");
}

#[test]
fn parquet_lists_and_codecs() {
    is_the_drawer("parquet-lists-and-codecs/lists.parquet");
    is_the_drawer("parquet-lists-and-codecs/brotli.parquet");
}

#[test]
fn real_instron() {
    let file = "real-instron/compression_as_exported.csv";
    let Some(all) = read(file) else { return };
    assert!(all[0].rate_hz().is_some_and(|rate| (rate / 25.0 - 1.0).abs() < 0.01));
    // A number that counts is no cause, and the sign is right.
    let found = diagnosis(file).expect("the file is there");
    let said = serde_json::to_string(&found.causes).expect("JSON");
    assert!(!said.contains("Segment") && !said.contains("Cycle") && !ids(&found).contains(&"axis-sign"), "{said}");
}

#[test]
fn real_lvm() {
    let Some(short) = read("real-lvm/short.lvm") else { return };
    assert!(short[0].rate_hz().is_some_and(|rate| (rate * 3.906_25e-5 - 1.0).abs() < 1e-3));
    let three = read("real-lvm/no_decimal_separator.lvm").expect("the file is there");
    assert!(three[0].channels.len() >= 3 && three[0].time_s.is_some());
}

#[test]
fn space_separated() {
    is_the_drawer("space-separated/controller_record.csv");
}

#[test]
fn sparse_table() {
    is_the_drawer("sparse-table/force_every_fifth.csv");
    is_the_drawer("sparse-table/interleaved.csv");
    let Some(all) = read("sparse-table/interleaved.csv") else { return };
    assert!(all[0].warnings.iter().any(|w| w.text.contains("the clock is that of")), "{:?}", all[0].warnings);
}

#[test]
fn spreadsheet_marks() {
    for file in ["sep_line.csv", "latin1.csv", "summary_below.csv"] {
        is_the_drawer(&format!("spreadsheet-marks/{file}"));
    }
}

#[test]
fn tare_jump() {
    let Some(found) = diagnosis("tare-jump/one_step.csv") else { return };
    assert_eq!(ids(&found), ["force-step"]);
    let values: Vec<f64> = found.causes[0].parameters.iter().map(|p| p.value).collect();
    let has = |right: f64, off: f64| values.iter().any(|v| (v - right).abs() < off);
    assert!(has(-3.1, 0.1) && has(21.37, 0.05), "{values:?}");
    is("tare-jump/one_step.csv", [1.2, 5.0, 1.5]);
}

#[test]
fn thousands_points() {
    is_the_drawer("thousands-points/semicolon.csv");
}

#[test]
fn unit_suffix_taken_as_si() {
    is_the_drawer("unit-suffix-taken-as-si/load_g.csv");
    is_the_drawer("unit-suffix-taken-as-si/torque_Ncm.csv");
}

#[test]
fn units_in_brackets() {
    is_the_drawer("units-in-brackets/brackets.csv");
    is_the_drawer("units-in-brackets/parentheses_kN.csv");
}

#[test]
fn unused_columns() {
    is_the_drawer("unused-columns/late_column.csv");
    is_the_drawer("unused-columns/words_in_an_unused_column.csv");
}

#[test]
fn wrapped_angle() {
    for file in ["wrapped.csv", "unwrapped.csv"] {
        is(&format!("wrapped-angle/{file}"), [0.05, 0.2, 0.3]);
    }
}
