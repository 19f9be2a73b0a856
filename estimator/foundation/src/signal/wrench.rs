//! Columns of a force/torque sensor that is turned: its orientation, its wrench, and the frame of the wrench.

use haptics::recording::{Recording, WrenchFrame};
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

/// Columns of an orientation as a quaternion, sensor to base, the scalar last.
pub const QUATERNION: [&str; 4] = ["qx", "qy", "qz", "qw"];
/// Columns of an orientation as a rotation matrix, sensor to base, row by row.
pub const MATRIX: [&str; 9] = ["r11", "r12", "r13", "r21", "r22", "r23", "r31", "r32", "r33"];
/// Largest distance of a quaternion's norm, or of the length of a matrix row, from 1 that is rounding.
/// Choice: two digits behind the point. A tenth of it would doubt quaternions with two digits.
const UNIT_TOLERANCE: f64 = 0.02;

/// Orientations of the sensor in the base frame, one a sample; none without columns of one.
///
/// Quaternions are normalised, matrices replaced by the next rotation. A sample without an orientation (zeros, not a
/// number) has none.
pub fn orientations(recording: &Recording) -> Option<Vec<Option<UnitQuaternion<f64>>>> {
    if let Some(q) = columns(recording, QUATERNION) {
        let at = |i: usize| {
            let raw = Quaternion::new(q[3][i], q[0][i], q[1][i], q[2][i]);
            let unit = UnitQuaternion::try_new(raw, f64::EPSILON)?;
            raw.norm().is_finite().then_some(unit)
        };
        return Some((0..recording.len()).map(at).collect());
    }
    let m = columns(recording, MATRIX)?;
    let at = |i: usize| {
        let matrix = Matrix3::from_row_iterator(m.iter().map(|column| column[i]));
        // Singular or left-handed matrices are no rotations.
        (matrix.determinant() > 0.0).then(|| UnitQuaternion::from_matrix(&matrix))
    };
    Some((0..recording.len()).map(at).collect())
}

/// One sentence if orientations of a recording are none: quaternions far from length 1, matrices that do not turn.
pub fn doubtful_orientation(recording: &Recording) -> Option<String> {
    let (kind, lengths) = if let Some(q) = columns(recording, QUATERNION) {
        let length = |i: usize| q.iter().map(|c| c[i] * c[i]).sum::<f64>().sqrt();
        ("quaternion qx, qy, qz, qw", (0..recording.len()).map(length).collect::<Vec<f64>>())
    } else {
        let m = columns(recording, MATRIX)?;
        // The determinant is 1 if all rows are orthonormal, and −1 if the axes are left-handed.
        let volume = |i: usize| Matrix3::from_row_iterator(m.iter().map(|column| column[i])).determinant();
        ("rotation matrix r11 to r33", (0..recording.len()).map(volume).collect())
    };
    let is_off = |length: &f64| length.is_nan() || (length - 1.0).abs() > UNIT_TOLERANCE;
    let first = lengths.iter().position(is_off)?;
    let off = lengths.iter().filter(|length| is_off(length)).count();
    let what = if kind.starts_with('q') { "length" } else { "determinant" };
    Some(format!(
        "the {kind} of row {} has the {what} {:.3} instead of 1 ({off} of {} rows): it is no orientation; check the order of the columns and their units",
        first + 1,
        lengths[first],
        lengths.len()
    ))
}

/// Force and torque columns of a sensor.
pub struct Wrench<'a> {
    /// Frame that the names or the sidecar state; none if nothing does.
    pub frame: Option<WrenchFrame>,
    /// Names of the force columns.
    pub force_names: [String; 3],
    /// Forces, N.
    pub force: [&'a [f64]; 3],
    /// Names of the torque columns, if there are any.
    pub torque_names: [String; 3],
    /// Torques about the sensor's origin, N m.
    pub torque: Option<[&'a [f64]; 3]>,
}

/// The wrench columns of a recording: `fx_sensor_N`, `fx_base_N`, or `fx_N` with the frame in the sidecar. Of several, the
/// sidecar's frame chooses, else the sensor's comes first.
pub fn wrench(recording: &Recording) -> Option<Wrench<'_>> {
    let stated = recording.meta.wrench_frame;
    let frames = match stated {
        Some(frame) => [frame, frame.other()],
        None => [WrenchFrame::Sensor, WrenchFrame::Base],
    };
    let named = |frame: WrenchFrame| of_names(recording, &format!("_{}", frame.name()), Some(frame));
    let plain = || of_names(recording, "", stated);
    if stated.is_some() {
        return named(frames[0]).or_else(plain).or_else(|| named(frames[1]));
    }
    named(frames[0]).or_else(|| named(frames[1])).or_else(plain)
}

fn of_names<'a>(recording: &'a Recording, place: &str, frame: Option<WrenchFrame>) -> Option<Wrench<'a>> {
    let force_names = ["x", "y", "z"].map(|axis| format!("f{axis}{place}_N"));
    let torque_names = ["x", "y", "z"].map(|axis| format!("t{axis}{place}_Nm"));
    let force = columns(recording, force_names.each_ref().map(String::as_str))?;
    let torque = columns(recording, torque_names.each_ref().map(String::as_str));
    Some(Wrench { frame, force_names, force, torque_names, torque })
}

fn columns<'a, const N: usize>(recording: &'a Recording, names: [&str; N]) -> Option<[&'a [f64]; N]> {
    let mut found = [&[][..]; N];
    for (to, name) in found.iter_mut().zip(names) {
        *to = recording.channel(name)?;
    }
    Some(found)
}

/// One vector of three columns.
pub fn vector(columns: &[&[f64]; 3], i: usize) -> Vector3<f64> {
    Vector3::new(columns[0][i], columns[1][i], columns[2][i])
}

/// True if the columns alone tell that a sensor was turned to see its load: an orientation and a force in space, and
/// neither a mechanism nor a hand.
///
/// A position beside plain force columns may as well be a tool in contact. It is the load of a sensor only if the frame of
/// the wrench is stated, or if the table has no clock.
pub fn is_payload(recording: &Recording) -> bool {
    let has = |name: &str| recording.channel(name).is_some();
    let is_turned = QUATERNION.iter().all(|name| has(name)) || MATRIX.iter().all(|name| has(name));
    let moves = ["q_m", "q_rad", "x1_m", "x2_m", "qb_rad", "qb1_rad", "qb2_rad"].iter().any(|name| has(name));
    let Some(wrench) = wrench(recording).filter(|_| is_turned && !moves) else { return false };
    wrench.frame.is_some() || recording.time_s.is_none() || !(has("x_m") && has("y_m"))
}

/// True if a recording has the columns of a turned sensor, in contact or not.
pub fn is_turned_sensor(recording: &Recording) -> bool {
    orientations(recording).is_some() && wrench(recording).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::recording::Channel;

    fn table(columns: &[(&str, &[f64])], sidecar: &str) -> Recording {
        let channel = |(name, values): &(&str, &[f64])| Channel {
            name: (*name).to_owned(),
            unit: String::new(),
            values: values.to_vec(),
        };
        let meta = serde_json::from_str(sidecar).expect("a sidecar");
        Recording { channels: columns.iter().map(channel).collect(), meta, ..Recording::default() }
    }

    /// Turned by 90 degrees about z: the sensor's x axis is the base's y axis.
    const TURNED: [(&str, &[f64]); 4] = [
        ("qx", &[0.0, 0.0]),
        ("qy", &[0.0, 0.0]),
        ("qz", &[0.0, std::f64::consts::FRAC_1_SQRT_2]),
        ("qw", &[1.0, std::f64::consts::FRAC_1_SQRT_2]),
    ];
    const FORCE: [(&str, &[f64]); 3] = [("fx_N", &[1.0, 2.0]), ("fy_N", &[3.0, 4.0]), ("fz_N", &[5.0, 6.0])];

    #[test]
    fn quaternion_and_matrix_turn_the_same_way() {
        let of = |columns: &[(&str, &[f64])]| orientations(&table(columns, "{}")).expect("an orientation");
        let matrix: Vec<(&str, &[f64])> = MATRIX
            .iter()
            .copied()
            .zip([
                &[1.0, 0.0][..],
                &[0.0, -1.0],
                &[0.0, 0.0],
                &[0.0, 1.0],
                &[1.0, 0.0],
                &[0.0, 0.0],
                &[0.0, 0.0],
                &[0.0, 0.0],
                &[1.0, 1.0],
            ])
            .collect();
        for turned in [of(&TURNED), of(&matrix)] {
            let x = turned[1].expect("a rotation") * Vector3::x();
            assert!((x - Vector3::y()).norm() < 1e-12, "{x}");
        }
    }

    #[test]
    fn what_is_no_orientation_is_doubted_by_its_row() {
        assert_eq!(doubtful_orientation(&table(&TURNED, "{}")), None);
        let mut columns = TURNED;
        columns[3].1 = &[1.0, 0.1];
        let said = doubtful_orientation(&table(&columns, "{}")).expect("a doubt");
        assert!(said.contains("row 2") && said.contains("0.714"), "{said}");
        columns[2].1 = &[0.0, 0.0];
        columns[3].1 = &[1.0, 0.0];
        assert_eq!(orientations(&table(&columns, "{}")).expect("columns")[1], None);
    }

    #[test]
    fn names_and_sidecar_state_the_frame_and_the_columns_the_task() {
        let all: Vec<_> = TURNED.iter().chain(&FORCE).copied().collect();
        let frame = |sidecar: &str| wrench(&table(&all, sidecar)).expect("a wrench").frame;
        assert_eq!(frame("{}"), None);
        assert_eq!(frame(r#"{"wrench_frame": "base"}"#), Some(WrenchFrame::Base));
        assert!(is_payload(&table(&all, "{}")));
        let mut on_surface = table(&all, "{}");
        for name in ["x_m", "y_m"] {
            on_surface.channels.push(Channel { name: name.to_owned(), unit: "m".to_owned(), values: vec![0.0, 1.0] });
        }
        on_surface.time_s = Some(vec![0.0, 0.1]);
        assert!(!is_payload(&on_surface), "it may be a tool in contact");
        on_surface.meta.wrench_frame = Some(WrenchFrame::Sensor);
        assert!(is_payload(&on_surface));
        on_surface.channels[4].name = "q_rad".to_owned();
        assert!(!is_payload(&on_surface));
    }
}
