//! Units and headers as people write them.

use super::spellings::TURN_RAD;
use super::*;
use Dimension::{Acceleration, Angle, AngularVelocity, Force, Length, Other, Time, Torque, Velocity};

fn close(written: Written, dimension: Dimension, factor: f64) -> bool {
    matches!(written, Written::Known(d, f) if d == dimension && (f / factor - 1.0).abs() < 1e-12)
}

#[test]
fn units_are_read_as_people_write_them() {
    for (text, dimension, factor) in [
        ("mm", Length, 1e-3),
        ("MM", Length, 1e-3),
        ("[mm]", Length, 1e-3),
        ("µm", Length, 1e-6),
        ("nm", Length, 1e-9),
        ("Millimeter", Length, 1e-3),
        ("inches", Length, 0.0254),
        ("kN", Force, 1e3),
        ("KN", Force, 1e3),
        ("mN", Force, 1e-3),
        ("MN", Force, 1e6),
        ("Newton", Force, 1.0),
        ("lbf", Force, 4.448_221_615_260_5),
        ("kgf", Force, 9.806_65),
        ("kg m/s²", Force, 1.0),
        ("Nm", Torque, 1.0),
        ("N*m", Torque, 1.0),
        ("N·cm", Torque, 1e-2),
        ("Ncm", Torque, 1e-2),
        ("mN·m", Torque, 1e-3),
        ("mNm", Torque, 1e-3),
        ("N-mm", Torque, 1e-3),
        ("ozf·in", Torque, 0.007_061_551_814_226_043),
        ("lbf.ft", Torque, 1.355_817_948_331_400_4),
        ("in-lbf", Torque, 0.112_984_829_027_616_7),
        ("kgf.cm", Torque, 0.098_066_5),
        ("°", Angle, std::f64::consts::PI / 180.0),
        ("turns", Angle, TURN_RAD),
        ("m/s", Velocity, 1.0),
        ("mm/min", Velocity, 1e-3 / 60.0),
        ("um_s", Velocity, 1e-6),
        ("km/h", Velocity, 1.0 / 3.6),
        ("m s^-1", Velocity, 1.0),
        ("rpm", AngularVelocity, TURN_RAD / 60.0),
        ("deg/s", AngularVelocity, TURN_RAD / 360.0),
        ("°/s", AngularVelocity, TURN_RAD / 360.0),
        ("rev/min", AngularVelocity, TURN_RAD / 60.0),
        ("mm/s^2", Acceleration, 1e-3),
        ("ns", Time, 1e-9),
        ("sec", Time, 1.0),
        ("MSEC", Time, 1e-3),
        ("Minutes", Time, 60.0),
        ("kPa", Other, 1e3),
        ("N/mm2", Other, 1e6),
        ("daN", Force, 10.0),
        ("µin", Length, 2.54e-8),
        ("in/min", Velocity, 0.0254 / 60.0),
        ("кН", Force, 1e3),
        ("мм", Length, 1e-3),
        ("см", Length, 1e-2),
        ("мкм", Length, 1e-6),
        ("мм/с", Velocity, 1e-3),
        ("Н·м", Torque, 1.0),
        ("об/мин", AngularVelocity, TURN_RAD / 60.0),
        ("千牛", Force, 1e3),
        ("毫米", Length, 1e-3),
        ("度/秒", AngularVelocity, TURN_RAD / 360.0),
        ("ｋＮ", Force, 1e3),
        ("㎜", Length, 1e-3),
        ("㎏ m/s²", Force, 1.0),
        ("10^-3 m", Length, 1e-3),
        ("10⁻³ m", Length, 1e-3),
        ("10³ N", Force, 1e3),
        ("×10³ N", Force, 1e3),
        ("x1000 N", Force, 1e3),
        ("0.1 N", Force, 0.1),
        ("1/10 mm", Length, 1e-4),
        ("m*1e-3", Length, 1e-3),
        ("0.1 ms", Time, 1e-4),
        ("m s⁻²", Acceleration, 1.0),
        ("psi", Other, 6_894.757_293_168_361),
    ] {
        let found = parse(text, &[]);
        assert!(close(found, dimension, factor), "{text}: {found:?}");
    }
}

#[test]
fn rarer_units_are_read() {
    for (text, dimension, factor) in [
        ("kilogram-force", Force, 9.806_65),
        ("pound-force", Force, 4.448_221_615_260_5),
        ("mdeg", Angle, TURN_RAD / 360_000.0),
        ("yd", Length, 0.9144),
        ("krpm", AngularVelocity, 1e3 * TURN_RAD / 60.0),
        ("radps", AngularVelocity, 1.0),
        ("mph", Velocity, 0.447_04),
    ] {
        assert!(close(parse(text, &[]), dimension, factor), "{text}");
    }
}

#[test]
fn the_wanted_quantity_decides_between_two_meanings() {
    assert!(close(parse("g", &[Force]), Force, 9.806_65e-3));
    assert!(close(parse("g", &[Acceleration]), Acceleration, 9.806_65));
    assert!(close(parse("kg", &[Force]), Force, 9.806_65));
    assert!(close(parse("kg·cm", &[Torque]), Torque, 0.098_066_5));
    assert!(close(parse("oz-in", &[Torque]), Torque, 0.007_061_551_814_226_043));
    assert!(close(parse("nm", &[Torque]), Torque, 1.0));
    assert!(close(parse("NM", &[Torque]), Torque, 1.0));
    assert!(close(parse("1/min", &[AngularVelocity]), AngularVelocity, TURN_RAD / 60.0));
    assert_eq!(parse("counts", &[Force]), Written::Counts);
    assert_eq!(
        (parse("stone", &[]), parse("10", &[]), parse("10^999 N", &[])),
        (Written::Unknown, Written::Unknown, Written::Unknown)
    );
}

#[test]
fn a_factor_behind_a_unit_has_two_meanings() {
    for text in ["N x10", "N*10", "Nm x100", "deg x10", "mm, x100", "N) x10"] {
        assert_eq!(parse(text, &[]), Written::Unknown, "{text}");
    }
}

#[test]
fn units_are_found_in_headers() {
    for (header, name, unit) in [
        ("Fx1 [N]", "Fx1", "N"),
        ("Weg (mm)", "Weg", "mm"),
        ("Kraft in kN", "Kraft", "kN"),
        ("theta_deg", "theta", "deg"),
        ("speed/rpm", "speed", "rpm"),
        ("v/m/s", "v", "m/s"),
        ("vx_mm_s", "vx", "mm_s"),
        ("Load, lbf", "Load", "lbf"),
        ("torque_Ncm", "torque", "Ncm"),
        ("load.kN", "load", "kN"),
        ("Winkel [°]", "Winkel", "°"),
        ("load lbf", "load", "lbf"),
        ("Load 0.1 N", "Load", "0.1 N"),
        ("Load.kPa", "Load", "kPa"),
        ("Load_bar", "Load_bar", ""),
        ("position[a]", "position[a]", ""),
        ("force[A]", "force", "A"),
        ("Winkel/mdeg", "Winkel", "mdeg"),
        ("Load_kilogram-force", "Load", "kilogram-force"),
        ("Load [stone]", "Load", "stone"),
        ("pos.x", "pos.x", ""),
        ("position[elbow]", "position[elbow]", ""),
        ("action[1]", "action[1]", ""),
        ("actual_TCP_pose_2", "actual_TCP_pose_2", ""),
        ("force_left_x", "force_left_x", ""),
        ("Force A", "Force A", ""),
        ("sensor V2", "sensor V2", ""),
        ("x_min", "x_min", ""),
        ("motor_t_s", "motor_t", "s"),
        ("[kN] Force", "Force", "kN"),
        ("(left) Force", "(left) Force", ""),
        ("Force 'kN'", "Force", "kN"),
        ("Force 'left'", "Force 'left'", ""),
        ("Force (N x10)", "Force", "N x10"),
        ("Force (N) x10", "Force", "(N) x10"),
        ("Load (kN) Test 1", "Load", "kN"),
        ("Position (cm) Run #1", "Position", "cm"),
        ("Force [N] (filtered)", "Force", "N"),
        ("Angle (deg) rate (deg/s)", "Angle (deg) rate", "deg/s"),
        ("変位（mm）", "変位", "mm"),
        ("Position|mm", "Position", "mm"),
        ("Motor (left) 1", "Motor (left) 1", ""),
        ("Force (left) (N) 2", "Force (left)", "N"),
        ("positionMm", "position", "Mm"),
        ("position_mm_raw", "position", "mm"),
        ("force kN filtered", "force", "kN"),
        ("pos_min_x", "pos_min_x", ""),
        ("ForceKilonewtons", "Force", "Kilonewtons"),
        ("torqueNm", "torque", "Nm"),
        ("forceLeftX", "forceLeftX", ""),
        ("tipMin", "tipMin", ""),
        ("Перемещение, мм", "Перемещение", "мм"),
        ("力(千牛)", "力", "千牛"),
        ("Speed mm/s", "Speed", "mm/s"),
        ("Speed_deg/s", "Speed", "deg/s"),
        ("Speed, rad/s", "Speed", "rad/s"),
        ("Acceleration mm/s^2", "Acceleration", "mm/s^2"),
        ("Stroke / mm", "Stroke", "mm"),
        ("Torque in lbf in", "Torque", "lbf in"),
    ] {
        assert_eq!(in_header(header, &[]), (name, unit), "{header}");
    }
    assert_eq!(in_header("load_g", &[Force]), ("load", "g"));
    assert_eq!(in_header("x_in", &[Length]), ("x", "in"));
    assert_eq!(in_header("x_in", &[]), ("x_in", ""));
}
