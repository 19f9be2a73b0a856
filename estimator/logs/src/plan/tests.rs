//! Uses of columns by their names, their units, and the sidecar.

use super::*;
use serde_json::Value;

fn headers(text: &str) -> Vec<String> {
    text.split(',').map(str::to_owned).collect()
}

fn meta(json: &str) -> Meta {
    serde_json::from_str(json).expect("a sidecar")
}

fn names(plan: &Plan) -> Vec<&str> {
    plan.targets.iter().map(|t| t.name.as_str()).collect()
}

#[test]
fn a_mapped_column_brings_its_own_unit() {
    let meta = meta(r#"{"columns":{"t_s":"time_ms","q_m":"position_mm","f_N":"pull"},"sign":{"f_N":-1}}"#);
    let plan = plan(&headers("time_ms,position_mm,pull"), &[], &meta, Path::new("a")).expect("plans");
    assert_eq!(plan.uses[0], Use::Number { required: true, factor: 1e-3 });
    assert_eq!(plan.uses[1], Use::Number { required: true, factor: 1e-3 });
    assert_eq!(plan.uses[2], Use::Number { required: true, factor: -1.0 });
    assert_eq!((names(&plan), plan.time), (vec!["q_m", "f_N"], Some(0)));
}

#[test]
fn names_that_the_user_gives_have_any_unit() {
    let meta = meta(r#"{"columns":{"t_min":"t","q_in":"p","f_lbf":"l"}}"#);
    let plan = plan(&headers("t,p,l"), &[], &meta, Path::new("a")).expect("plans");
    assert_eq!((names(&plan), plan.time), (vec!["q_m", "f_N"], Some(0)));
    let factor = |k: usize| if let Use::Number { factor, .. } = plan.uses[k] { factor } else { 0.0 };
    let off = [60.0, 0.0254, 4.448_221_6].into_iter().enumerate().map(|(k, wanted)| (factor(k) / wanted - 1.0).abs());
    assert!(off.fold(0.0, f64::max) < 1e-7, "{:?}", plan.uses);
}

#[test]
fn a_scale_turns_volts_into_newtons_and_without_it_they_are_refused() {
    let columns = headers("t_s,q_m,command_V");
    let scaled = meta(r#"{"columns":{"f_N":"command_V"},"scale":{"f_N":35.0}}"#);
    assert_eq!(
        plan(&columns, &[], &scaled, Path::new("a")).expect("plans").uses[2],
        Use::Number { required: true, factor: 35.0 }
    );
    let error = plan(&columns, &[], &meta(r#"{"columns":{"f_N":"command_V"}}"#), Path::new("a")).expect_err("volts");
    assert!(error.to_string().contains("`command_V`") && error.to_string().contains("scale"), "{error}");
}

#[test]
fn unknown_units_of_known_quantities_are_named() {
    for header in ["fx1_stone", "q_counts", "x", "x [foo]", "force_counts"] {
        let error = plan(&headers(&format!("t_s,{header}")), &[], &Meta::default(), Path::new("a")).expect_err(header);
        assert!(error.to_string().contains(&format!("`{header}`")), "{error}");
    }
    // Extra channels may carry any unit.
    let plan =
        plan(&headers("t_s,q_m,load_percent,oil_degC,q1_rad,fx_wrist_sensor_N"), &[], &Meta::default(), Path::new("a"))
            .expect("fine");
    assert_eq!(names(&plan), ["q_m", "load_percent", "oil_degC", "q1_rad", "fx_wrist_sensor_N"]);
}

#[test]
fn half_a_vector_and_a_clash_are_refused() {
    let no = |text: &str| plan(&headers(text), &[], &Meta::default(), Path::new("a")).expect_err(text).to_string();
    assert!(no("t_s,x1_m,y1_m,x2_m,y2_m,fy1_N,fx2_N,fy2_N").contains("`fx1_N` is missing"));
    assert!(no("t_s,x_m,x_mm,y_m").contains("two columns give `x_m`"));
    assert!(no("t_s,q_m,q_m").contains("two columns give `q_m`"));
}

#[test]
fn select_matches_text_and_numbers() {
    let one = Wanted::new(0, &Value::from("1"));
    assert!(one.matches(b"1") && one.matches(b"1.0") && !one.matches(b"10") && !one.matches(b"x"));
    assert!(Wanted::new(0, &Value::from(1)).matches(b"1.0"));
    assert!(Wanted::new(0, &Value::from("00")).matches(b"00"));
    assert!(Wanted::new(0, &Value::from("drawer")).matches(b"drawer"));
}

#[test]
fn parts_of_an_orientation_have_one_name() {
    let found = |text: &str| {
        let plan = plan(&headers(text), &[], &Meta::default(), Path::new("a")).expect("fine");
        names(&plan).into_iter().map(str::to_owned).collect::<Vec<_>>().join(",")
    };
    assert_eq!(found("quat_w,quat_x,quat_y,quat_z"), "qw,qx,qy,qz");
    assert_eq!(found("/tool.pose.orientation.x,/tool.pose.position.x,R11"), "qx,/tool.pose.position.x,r11");
    // Two topics with an orientation: neither is meant.
    assert_eq!(found("/a.orientation.x,/b.orientation.x"), "/a.orientation.x,/b.orientation.x");
    assert_eq!(found("ori_x,iq_x,box"), "qx,iq_x,box");
}
