//! Guesses for the headers of the project's real reference recordings, and for invented ones.

use crate::ui::column_mapping::facts::ColumnFacts;
use crate::ui::column_mapping::guess::guess;

/// A column of a table that makes sense for its name: `name`, or `name:first:last` where the numbers matter.
fn column(text: &str) -> ColumnFacts {
    let mut parts = text.split('|');
    let header = parts.next().unwrap_or_default().to_owned();
    let numbers: Vec<f64> = parts.map(|p| p.parse().expect("a number")).collect();
    let (low, high) = (numbers.first().copied().unwrap_or(-0.5), numbers.get(1).copied().unwrap_or(0.5));
    let counts = numbers.get(2).copied();
    ColumnFacts {
        header,
        numeric: true,
        range: Some((low, high)),
        increasing: high > low,
        whole: counts.is_some(),
        step: counts.or(Some(1e-3)),
        changes: if counts == Some(0.0) { 2 } else { 999 },
        distinct: (counts == Some(0.0)).then(|| vec!["0".to_owned(), "1".to_owned(), "2".to_owned()]),
        ..ColumnFacts::default()
    }
}

/// List of `name unit` for every column that gets a name, in the order of the table.
fn guessed(columns: &[&str]) -> Vec<String> {
    let facts: Vec<ColumnFacts> = columns.iter().map(|c| column(c)).collect();
    guess(&facts)
        .into_iter()
        .zip(&facts)
        .filter_map(|(guess, facts)| {
            let unit = guess.unit.map_or("", |u| u.shown);
            Some(format!("{} = {} {unit}", guess.name?, facts.header).trim_end().to_owned())
        })
        .collect()
}

#[test]
fn real_recordings() {
    for (headers, expected) in [
        (
            "time_s,position_m,reference_m,command_V,force_N",
            &["t_s = time_s s", "q_m = position_m m", "f_N = force_N N"][..],
        ),
        (
            "run|0|2|0,frequency_Hz,load_setting_percent,time_s,motor_side_angle_rad,spindle_angle_rad,spindle_torque_Nm,\
             motor_current_A,jaw_side_angle_rad,jaw_side_torque_Nm",
            &["trial = run", "t_s = time_s s", "q_rad = jaw_side_angle_rad rad", "tau_Nm = jaw_side_torque_Nm N·m"],
        ),
        (
            "sample|0|920|1,tip_x_m,tip_y_m,tip_z_m,equilibrium_x_m,equilibrium_y_m,equilibrium_z_m,fx_wrist_sensor_N,\
             fy_wrist_sensor_N,fz_wrist_sensor_N,fx_joint_estimate_N,fy_joint_estimate_N,fz_joint_estimate_N",
            &[
                "x_m = tip_x_m m",
                "y_m = tip_y_m m",
                "z_m = tip_z_m m",
                "fx_N = fx_wrist_sensor_N N",
                "fy_N = fy_wrist_sensor_N N",
                "fz_N = fz_wrist_sensor_N N",
            ],
        ),
        (
            "toss|0|2|0,time_s,x_m,y_m,z_m,qw,qx,qy,qz,vx_m_s,vy_m_s,vz_m_s,wx_rad_s,wy_rad_s,wz_rad_s",
            &[
                "trial = toss",
                "t_s = time_s s",
                "x_m = x_m m",
                "y_m = y_m m",
                "z_m = z_m m",
                "vx_m_s = vx_m_s m/s",
                "vy_m_s = vy_m_s m/s",
                "vz_m_s = vz_m_s m/s",
            ],
        ),
        (
            "run|0|2|0,time_s,q1_rad,q2_rad,v1_rad_s,v2_rad_s,torque1_command_Nm,torque2_command_Nm,\
             torque1_measured_Nm,torque2_measured_Nm",
            &["trial = run", "t_s = time_s s"],
        ),
        ("trial|0|2|0,sample|0|900|1,x_m,y_m,z_m", &["trial = trial", "x_m = x_m m", "y_m = y_m m", "z_m = z_m m"]),
    ] {
        let columns: Vec<&str> = headers.split(',').map(str::trim).collect();
        assert_eq!(guessed(&columns), expected, "{headers}");
    }
}

#[test]
fn invented_ones() {
    for (headers, expected) in [
        // A test rig, in German, with units in brackets.
        (
            "Zeit [ms]|0|9000|1;Weg (mm)|0|300;Kraft [N]|-20|20;Öltemperatur [°C]|20|40",
            &["t_s = Zeit [ms] ms", "q_m = Weg (mm) mm", "f_N = Kraft [N] N"][..],
        ),
        // Two fingers by side, without units: lengths inferred from the range.
        (
            "stamp|1700000000000|1700000009000|1;left.pos.x|-40|40;left.pos.y|0|60;right.pos.x|-30|50;right.pos.y|0|60;\
             force_left_x;force_left_y;force_right_x;force_right_y",
            &[
                "t_s = stamp ms",
                "x1_m = left.pos.x mm",
                "y1_m = left.pos.y mm",
                "x2_m = right.pos.x mm",
                "y2_m = right.pos.y mm",
                "fx1_N = force_left_x N",
                "fy1_N = force_left_y N",
                "fx2_N = force_right_x N",
                "fy2_N = force_right_y N",
            ],
        ),
        // Numbered, camel case.
        (
            "t;tipX1;tipY1;tipX2;tipY2;Fx1 [N];Fy1 [N];Fx2 [N];Fy2 [N]",
            &[
                "t_s = t s",
                "x1_m = tipX1 m",
                "y1_m = tipY1 m",
                "x2_m = tipX2 m",
                "y2_m = tipY2 m",
                "fx1_N = Fx1 [N] N",
                "fy1_N = Fy1 [N] N",
                "fx2_N = Fx2 [N] N",
                "fy2_N = Fy2 [N] N",
            ],
        ),
        // A door: angle in degrees by its range, torque; the command column is ignored.
        (
            "time_ms|0|9000|1;theta|0|90;torque cmd;torque actual [N*m]",
            &["t_s = time_ms ms", "q_rad = theta °", "tau_Nm = torque actual [N*m] N·m"],
        ),
        // Half a vector has no meaning.
        ("time;pos.x;speed", &["t_s = time s", "dq_m_s = speed m/s"]),
        // A single finger's joints.
        (
            "time;bottom joint angle (deg)|0|90;top joint angle (deg)|0|90;Fx;Fy",
            &[
                "t_s = time s",
                "qb_rad = bottom joint angle (deg) °",
                "qt_rad = top joint angle (deg) °",
                "fx_N = Fx N",
                "fy_N = Fy N",
            ],
        ),
        // No recognizable column.
        ("a;b;voltage;comment", &[]),
        // Units that need a factor.
        (
            "time [ns]|0|9e9|1000000;pull_lbf|0|40;stroke (in)|0|9",
            &["t_s = time [ns] ns", "f_N = pull_lbf lbf", "q_m = stroke (in) in"],
        ),
    ] {
        let columns: Vec<&str> = headers.split(';').map(str::trim).collect();
        assert_eq!(guessed(&columns), expected, "{headers}");
    }
}

#[test]
fn a_clock_that_stands_or_goes_back_is_not_the_time() {
    let mut facts = column("time_s");
    facts.increasing = false;
    assert_eq!(guess(&[facts])[0].name, None);
}

#[test]
fn one_coordinate_a_shared_unit_and_open_factors() {
    for (headers, expected) in [
        ("t_s|0|9;slide/position;ft/force/x", &["t_s = t_s s", "q_m = slide/position m", "f_N = ft/force/x N"][..]),
        ("t_s|0|9;encoder_counts|0|65000|3;f_N", &["t_s = t_s s", "q_m = encoder_counts", "f_N = f_N N"]),
        (
            "%time|0|9;field.position0;field.effort0",
            &["t_s = %time s", "q_m = field.position0 m", "f_N = field.effort0 N"],
        ),
        // Beside a force without a direction.
        ("t|0|9;q;f", &["t_s = t s", "q_m = q m", "f_N = f N"][..]),
        ("t|0|9;x;F", &["t_s = t s", "q_m = x m", "f_N = F N"]),
        ("/encoder/position;/ft/force", &["q_m = /encoder/position m", "f_N = /ft/force N"]),
        ("Encoder|0|65000|3;Force (N)", &["q_m = Encoder", "f_N = Force (N) N"]),
        // Columns of one dimension have one unit, however far they reach.
        ("X|-80|90;Y|119|121;Z|4.9|5", &["x_m = X mm", "y_m = Y mm", "z_m = Z mm"]),
        // Only the user knows the period of a row and the factor of a volt.
        (
            "Time|0|2399|1;Load cell (V);Position (mm)|-9|9",
            &["t_s = Time", "f_N = Load cell (V)", "q_m = Position (mm) mm"],
        ),
        ("Speed (rpm)|-90|90;Torque (kg-cm)|-9|9", &["dq_rad_s = Speed (rpm) rpm", "tau_Nm = Torque (kg-cm)"]),
        (
            "Shaft position (rev)|-2|2;Torque (Nm)|-9|9",
            &["q_rad = Shaft position (rev) turns", "tau_Nm = Torque (Nm) N·m"],
        ),
    ] {
        assert_eq!(guessed(&headers.split(';').collect::<Vec<_>>()), expected, "{headers}");
    }
    let facts: Vec<ColumnFacts> = ["Force filtered (N)", "Force raw (N)"].map(column).into();
    let found = guess(&facts);
    assert_eq!(found[0].name, None);
    assert_eq!((found[1].name.as_deref(), found[1].rival.as_deref()), (Some("f_N"), Some("Force filtered (N)")));
}

#[test]
fn a_row_of_units_tells_what_a_name_does_not() {
    let with = |name: &str, unit: &str| ColumnFacts { stated_unit: unit.to_owned(), ..column(name) };
    let columns = [with("Time|0|9", "(sec)"), with("Extension|-99|90", "(mm)"), with("Load|-7|7", "(N)")];
    let found: Vec<_> = guess(&columns).into_iter().map(|g| (g.name, g.unit.map(|u| u.shown))).collect();
    let expected = [("t_s", "s"), ("q_m", "mm"), ("f_N", "N")];
    assert_eq!(found, expected.map(|(name, unit)| (Some(name.to_owned()), Some(unit))));
}

#[test]
fn the_position_of_a_load_is_a_rival_of_its_motors() {
    let facts = ["Time (s)|0|10", "Motor position (rad)", "Load position (rad)", "Torque (Nm)"].map(column);
    let guesses = guess(&facts);
    assert_eq!(guesses[1].name.as_deref(), Some("q_rad"));
    assert_eq!(guesses[1].rival.as_deref(), Some("Load position (rad)"), "{guesses:?}");
    assert_eq!(guesses[2].name, None);
}
