//! Ways in which people lay a table out: matrices, structures, runs, and several tables in one file.

use super::*;

#[test]
fn a_matrix_is_as_many_columns_as_it_has() {
    let upright = V::Doubles(vec![6, 2], [Q, F].concat());
    let lying = V::Doubles(vec![2, 6], Q.iter().zip(F).flat_map(|(q, f)| [*q, f]).collect());
    let stacked = V::Doubles(vec![2, 1, 6], Q.iter().zip(F).flat_map(|(q, f)| [*q, f]).collect());
    for matrix in [upright, lying, stacked] {
        let read = log(&[("t_s", column(&clock())), ("x", matrix.clone())], "{}");
        assert_eq!(names(&read), ["x_1", "x_2"]);
        assert_eq!((read.channel("x_1"), read.channel("x_2")), (Some(Q.as_slice()), Some(F.as_slice())));
        let names_of = texts(&["q_mm", "f_N"]);
        let named = log(&[("t_s", column(&clock())), ("data", matrix.clone()), ("colheaders", names_of)], "{}");
        assert_eq!(names(&named), ["q_m", "f_N"]);
        assert_eq!(named.channel("f_N"), Some(F.as_slice()));
        let inside = one(vec![
            ("data", matrix),
            ("labels", V::Chars(vec!["position", "force"])),
            ("units", texts(&["mm", "kN"])),
            ("time", column(&clock())),
        ]);
        let meta = r#"{"columns": {"t_s": "time", "q_m": "position", "f_N": "run.data.force"}}"#;
        let mapped = log(&[("run", inside)], meta);
        assert_eq!(mapped.channel("f_N").map(|f| f[1]), Some(2500.0));
        assert!(mapped.channel("q_m").is_some_and(|q| (q[1] + 2e-4).abs() < 1e-12));
    }
}

#[test]
fn one_matrix_with_names_is_a_whole_table() {
    let matrix = V::Doubles(vec![6, 3], [clock(), Q.to_vec(), F.to_vec()].concat());
    let read = log(
        &[
            ("data", matrix.clone()),
            ("names", V::Cells(vec![1, 3], ["t_s", "q_m", "f_N"].map(|n| V::Chars(vec![n])).to_vec())),
        ],
        "{}",
    );
    assert_eq!((read.time_s.as_deref(), names(&read)), (Some(clock().as_slice()), vec!["q_m", "f_N"]));
    // Two lists that could both be meant: numbers instead of a guess.
    let doubt = [("data", matrix), ("a", texts(&["t_s", "q_m", "f_N"])), ("b", texts(&["t_s", "f_N", "q_m"]))];
    assert_eq!(names(&log(&doubt, "{}")), ["data_1", "data_2", "data_3"]);
}

#[test]
fn fields_have_short_names_where_those_are_unique() {
    let arm = one(vec![("q_m", column(&Q)), ("temp", column(&F))]);
    let hand = one(vec![("f_N", column(&F)), ("temp", column(&Q))]);
    let read = log(&[("log", one(vec![("arm", arm), ("hand", hand), ("t_s", column(&clock()))]))], "{}");
    assert_eq!(names(&read), ["q_m", "log.arm.temp", "f_N", "log.hand.temp"]);
    assert_eq!(read.channel("log.hand.temp"), Some(Q.as_slice()));
    let meta = r#"{"columns": {"f_N": "log.arm.temp"}}"#;
    let pair = one(vec![("arm", one(vec![("temp", column(&F))])), ("t_s", column(&clock()))]);
    assert_eq!(log(&[("log", pair)], meta).channel("f_N"), Some(F.as_slice()), "a full name maps a short one");
}

#[test]
fn units_beside_the_numbers_are_those_of_the_columns() {
    let units = one(vec![("f", V::Chars(vec!["kN"])), ("time", V::Chars(vec!["ms"]))]);
    let fields = vec![("time", column(&clock())), ("f", column(&F)), ("units", units)];
    let read = log(&[("log", one(fields))], "{}");
    assert_eq!(read.channel("f_N").map(|f| f[0]), Some(1000.0));
    assert!(read.time_s.as_ref().is_some_and(|t| (t[1] - 5e-4).abs() < 1e-12));
    let one_unit = |name| one(vec![("value", column(&F)), ("unit", V::Chars(vec![name]))]);
    let meta = r#"{"columns": {"f_N": "force.value"}}"#;
    let read = log(&[("t_s", column(&clock())), ("force", one_unit("mN"))], meta);
    assert!(read.channel("f_N").is_some_and(|f| (f[1] - 2.5e-3).abs() < 1e-12));
    let text = loaded(&Form::ALL[0].file(&[("force", one_unit("mm"))]), meta).expect_err("a length").to_string();
    assert!(text.contains("measures something else"), "{text}");
    // A unit that could be that of either vector is none, and it is named.
    let unclear = one(vec![("t_s", column(&clock())), ("load", column(&F)), ("unit", V::Chars(vec!["kN"]))]);
    let read = log(&[("log", unclear)], "{}");
    assert!(
        read.channel("load") == Some(F.as_slice())
            && said(&read, "`log.unit` is not read: it states kN and not for which columns")
    );
}

#[test]
fn elements_of_arrays_are_trials() {
    let run = |rows: usize, at: f64| {
        let shifted: Vec<f64> = Q[..rows].iter().map(|q| q + at).collect();
        one(vec![("t_s", column(&clock()[..rows])), ("q_m", column(&shifted)), ("mass", column(&[at]))])
    };
    let (V::Structs(_, fields, first), V::Structs(_, _, second)) = (run(6, 0.0), run(4, 1.0)) else { panic!("one") };
    let array = V::Structs(vec![1, 2], fields, [first, second].concat());
    let cells = V::Cells(vec![2, 1], vec![run(6, 0.0), run(4, 1.0)]);
    let pair = |of: &dyn Fn(usize) -> Vec<f64>| V::Cells(vec![1, 2], vec![column(&of(0)), column(&of(1))]);
    let times = pair(&|at| clock()[..6 - 2 * at].to_vec());
    let places = pair(&|at| Q[..6 - 2 * at].iter().map(|q| q + at as f64).collect());
    let nested = one(vec![("runs", array.clone())]);
    for variables in
        [vec![("run", array)], vec![("run", cells)], vec![("t_s", times), ("q_m", places)], vec![("log", nested)]]
    {
        let logs = loaded(&Form::ALL[3].file(&variables), "{}").unwrap_or_else(|e| panic!("{e}"));
        let trials: Vec<_> = logs.iter().map(|log| (log.trial.as_deref(), log.len())).collect();
        assert_eq!(trials, [(Some("1"), 6), (Some("2"), 4)]);
        assert_eq!((logs[0].channel("q_m"), logs[1].channel("q_m").map(|q| q[3])), (Some(Q.as_slice()), Some(1.3)));
        assert_eq!(logs[1].time_s.as_deref(), Some(&clock()[..4]));
    }
}

#[test]
fn an_element_a_sample_is_one_table() {
    let samples = (0..6).flat_map(|i| [column(&[clock()[i]]), column(&[Q[i]])]).collect();
    let read = log(&[("sample", V::Structs(vec![1, 6], vec!["t_s", "q_m"], samples))], "{}");
    assert_eq!((read.trial.as_deref(), read.time_s.as_deref()), (None, Some(clock().as_slice())));
    assert_eq!(read.channel("q_m"), Some(Q.as_slice()));
}

#[test]
fn runs_that_lack_a_field_or_change_its_unit_do_not_slip() {
    // `a` lacks in the first run, `b` in the last: both have two runs of three rows, of different trials.
    let empty = || V::Doubles(vec![0, 0], Vec::new());
    let object = || V::Object("timeseries");
    let three = |at: f64| column(&[at, at + 1.0, at + 2.0]);
    let runs = vec![
        three(0.0),
        object(),
        three(10.0),
        three(0.0),
        three(20.0),
        three(11.0),
        three(0.0),
        three(21.0),
        object(),
    ];
    let logs = loaded(&Form::ALL[0].file(&[("r", V::Structs(vec![3, 1], vec!["t_s", "a", "b"], runs))]), "{}");
    let text = logs.expect_err("only a clock is whole").to_string();
    assert!(text.contains("no column holds numbers beside the time"), "{text}");
    let with_unit = |name| {
        one(vec![
            ("t_s", column(&clock())),
            ("f", column(&F)),
            ("q_m", column(&Q)),
            ("units", one(vec![("f", V::Chars(vec![name]))])),
        ])
    };
    let logs = loaded(&Form::ALL[0].file(&[("r", V::Cells(vec![2, 1], vec![with_unit("N"), with_unit("kN")]))]), "{}");
    let logs = logs.unwrap_or_else(|e| panic!("{e}"));
    assert!(names(&logs[0]) == ["q_m"] && said(&logs[0], "`r.f` is not read: a unit that changes from run to run"));
    let short = V::Cells(
        vec![2, 1],
        vec![one(vec![("t_s", column(&clock())), ("q_m", column(&Q))]), one(vec![("t_s", empty()), ("q_m", empty())])],
    );
    let logs = loaded(&Form::ALL[0].file(&[("r", short)]), "{}").unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((logs.len(), logs[0].len()), (1, 6), "an empty run has no rows");
}

#[test]
fn simulinks_structure_with_time_has_its_labels() {
    let signal = |label, values| vec![values, V::Chars(vec![label]), column(&[1.0]), V::Chars(vec!["m/In"])];
    let fields = vec!["values", "label", "dimensions", "blockName"];
    let wide = V::Doubles(vec![6, 2], [F, Q].concat());
    let signals = [signal("q_m", column(&Q)), signal("f_N", column(&F)), signal("", wide.clone())].concat();
    let signals = V::Structs(vec![1, 3], fields.clone(), signals);
    let read =
        log(&[("out", one(vec![("time", column(&clock())), ("signals", signals)]))], r#"{"columns": {"t_s": "time"}}"#);
    assert_eq!(names(&read), ["q_m", "f_N", "signals_3_1", "signals_3_2"]);
    assert_eq!((read.channel("q_m"), read.channel("signals_3_2")), (Some(Q.as_slice()), Some(Q.as_slice())));
    let bus = vec![wide, V::Chars(vec!["f_N", "q_m"]), column(&[2.0]), V::Chars(vec!["m/In"])];
    let bus = V::Structs(vec![1, 1], fields, bus);
    let read =
        log(&[("out", one(vec![("time", column(&clock())), ("signals", bus)]))], r#"{"columns": {"t_s": "time"}}"#);
    assert_eq!((names(&read), read.channel("q_m")), (vec!["f_N", "q_m"], Some(Q.as_slice())));
}

#[test]
fn of_several_tables_the_one_with_a_clock_and_most_columns_is_read() {
    let long = [0.0; 9];
    let variables = [
        ("a", column(&long)),
        ("b", column(&long)),
        ("c", column(&long)),
        ("t_s", column(&clock())),
        ("q_m", column(&Q)),
        ("cal", V::Doubles(vec![4, 2], vec![0.0; 8])),
    ];
    let read = log(&variables, "{}");
    assert_eq!(names(&read), ["q_m"]);
    assert!(
        said(
            &read,
            "the table of 6 rows is read, variables of other lengths are not: `a`, `b`, `c` (9 values), `cal_1`, `cal_2` (4 values)"
        ),
        "{:?}",
        read.warnings
    );
    assert_eq!(names(&log(&variables[..3], "{}")), ["a", "b", "c"]);
    // The last variable of a name holds, as in MATLAB.
    let twice = [("t_s", column(&clock())), ("q_m", column(&F)), ("q_m", column(&Q))];
    assert_eq!(log(&twice, "{}").channel("q_m"), Some(Q.as_slice()));
}

#[test]
fn a_rate_in_a_variable_of_its_own_is_suggested() {
    let table = [("q_m", column(&Q)), ("f_N", column(&F))];
    let with = |name: &'static str, value: f64| log(&[&table[..], &[(name, column(&[value]))]].concat(), "{}");
    for (name, value) in [("Fs", 200.0), ("dt", 0.005), ("isi_ms", 5.0)] {
        let read = with(name, value);
        let suggested = read.warnings.iter().find_map(|w| w.suggested.as_ref()?.get("rate_hz")?.as_f64());
        assert!(suggested.is_some_and(|rate_hz| (rate_hz - 200.0).abs() < 1e-9), "{name}: {:?}", read.warnings);
    }
    assert!(with("mass", 200.0).warnings.iter().all(|w| w.suggested.is_none()));
}
