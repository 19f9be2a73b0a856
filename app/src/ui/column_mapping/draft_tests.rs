//! Conversion from a sidecar to the dialog and back: edits are stored, everything else stays unchanged.

use crate::ui::column_mapping::draft::{Draft, Role};
use crate::ui::column_mapping::facts::{FileFacts, look};
use crate::ui::column_mapping::file_units::spelled;
use haptics::recording::{Meta, Recording};

struct Table {
    folder: tempfile::TempDir,
    facts: FileFacts,
}

impl Table {
    fn new(text: &str) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("log.csv");
        std::fs::write(&path, text).expect("writable");
        let facts = look(&path).expect("a table");
        Self { folder, facts }
    }

    fn draft(&self, meta: &str) -> Draft {
        Draft::new(&self.facts, serde_json::from_str(meta).expect("a sidecar"))
    }

    fn load(&self, meta: &Meta) -> Result<Vec<Recording>, String> {
        let path = self.folder.path().join("log.csv");
        estimator::log::load_with_meta(&path, meta).map_err(|e| e.to_string())
    }
}

fn json(meta: &Meta) -> serde_json::Value {
    serde_json::to_value(meta).expect("JSON")
}

#[test]
fn guesses_are_read_as_they_were_meant() {
    let table = Table::new("Zeit [ms];Weg (in);Kraft_kN;Fx1_lbf\n0;1;2;1\n10;2;3;1\n20;3;4;1\n");
    let draft = table.draft("{}");
    let log = table.load(&draft.sidecar()).expect("loads").remove(0);
    let close = |name: &str, first: f64| (log.channel(name).expect(name)[0] - first).abs() < 1e-12;
    assert_eq!(log.time_s.as_deref().map(|t| t[1]), Some(0.01));
    assert!(close("q_m", 0.0254) && close("f_N", 2_000.0), "{:?}", json(&draft.sidecar()));
    // A quantity of the program in a unit that the reader refuses is kept as an extra channel.
    assert!(log.channel("extra_Fx1_lbf").is_some() || log.channel("Fx1_lbf").is_some());
}

#[test]
fn nothing_of_a_sidecar_is_lost() {
    let table = Table::new("time_s,position_m,command_V,torque_Nm,device\n0,1,2,3,a\n0.1,2,3,4,a\n0.2,3,4,5,b\n");
    let full = r#"{"task":"mechanism","gravity_m_s2":9.8,"up":"-z","hand":{"link_m":0.1},
        "columns":{"q_m":"position_m","f_N":"command_V","gone_m":"not there","copy_m":"position_m"},
        "scale":{"f_N":35.15065,"torque_Nm":2.0},"sign":{"f_N":-1.0,"q_m":1.0},
        "select":{"device":"a"},"known":{"mass_kg":0.1},"operator":"K","notes":[1,2]}"#;
    let meta: Meta = serde_json::from_str(full).expect("a sidecar");
    let mut draft = table.draft(full);
    assert_eq!(draft.strays(), [("gone_m".to_owned(), "not there".to_owned())]);
    let (before, mut after) = (json(&meta), json(&draft.sidecar()));
    // A sign of +1 is the default and may be dropped.
    assert!(after["sign"].get("q_m").is_none());
    after["sign"]["q_m"] = 1.0.into();
    assert_eq!(after, before);
    // One edit changes one thing.
    draft.rows[2].negative = false;
    let edited = json(&draft.sidecar());
    assert!(edited.get("sign").is_none() && edited["scale"]["f_N"] == before["scale"]["f_N"]);
}

#[test]
fn a_sidecar_comes_back_as_the_dialog_left_it() {
    let table = Table::new("a,b [mm],c_V,d_mm,e\n0,1,2,3,5\n1,2,3,4,6\n2,3,4,5,7\n");
    let mut draft = table.draft("{}");
    for (row, name, unit, scale) in [
        (0, "t_s", "ns", 1.0),
        (1, "x_m", "mm", 1.0),
        (2, "fx_N", "N", 12.5),
        (3, "y_m", "cm", 1.0),
        (4, "fy_N", "lbf", 2.0),
    ] {
        draft.rows[row].set_role(Role::Named(name.to_owned()));
        draft.rows[row].unit = spelled(unit);
        draft.rows[row].scale = scale;
    }
    draft.rows[4].negative = true;
    let saved = draft.sidecar();
    let again = Draft::new(&table.facts, saved.clone());
    for (a, b) in draft.rows.iter().zip(&again.rows) {
        let total = |r: &crate::ui::column_mapping::draft::Row| r.scale * r.unit.map_or(1.0, |u| u.factor);
        assert_eq!((&a.role, a.negative), (&b.role, b.negative));
        assert!((total(a) / total(b) - 1.0).abs() < 1e-12, "{a:?} {b:?}");
    }
    assert_eq!(json(&again.sidecar()), json(&saved));
    let log = table.load(&saved).expect("loads").remove(0);
    let first = |name: &str| log.channel(name).expect(name)[0];
    assert!((first("x_m") - 1e-3).abs() < 1e-15 && (first("fx_N") - 25.0).abs() < 1e-12);
    assert!((first("y_m") - 0.03).abs() < 1e-15, "the header says mm, the user says cm");
    assert!((first("fy_N") + 5.0 * 2.0 * 4.448_221_615_260_5).abs() < 1e-9);
}

#[test]
fn a_column_can_be_kept_from_being_what_its_name_says() {
    let table = Table::new("t_s,q_m,x_m\n0,1,2\n1,2,3\n2,3,4\n");
    let mut draft = table.draft("{}");
    draft.rows[2].set_role(Role::Extra);
    let log = table.load(&draft.sidecar()).expect("half a vector is an extra channel").remove(0);
    assert!(log.channel("x_m").is_none() && log.channel("extra_x_m").is_some());
    assert_eq!(Draft::new(&table.facts, draft.sidecar()).rows[2].role, Role::Extra);
}

#[test]
fn a_table_of_several_things_begins_with_the_first() {
    let table = Table::new("mechanism,trial,x_m,y_m\ndoor,1,0,1\ndoor,1,1,2\ndrawer,2,0,1\ndrawer,2,1,2\n");
    let draft = table.draft("{}");
    assert_eq!(draft.meta.select["mechanism"], "door");
    assert_eq!(draft.values_of("mechanism"), ["door", "drawer"]);
    assert_eq!(table.load(&draft.sidecar()).expect("loads").len(), 1);
}

/// A known unit that the dialog does not offer is left to the reader; an unknown one needs its factor.
#[test]
fn no_factor_of_a_stated_unit_is_guessed() {
    let table = Table::new("Zeit [s],Weg [mm],Kraft [cN]\n0,1,2\n0.01,2,3\n0.02,3,4\n");
    let log = table.load(&table.draft("{}").sidecar()).expect("loads").remove(0);
    assert!((log.channel("f_N").expect("a force")[0] - 0.02).abs() < 1e-12);
    let table = Table::new("Zeit [s],Weg [steps],Kraft [N]\n0,1000,2\n0.01,2000,3\n0.02,3000,4\n");
    for sidecar in ["{}", r#"{"columns":{"t_s":"Zeit [s]","q_m":"Weg [steps]","f_N":"Kraft [N]"}}"#] {
        let mut draft = table.draft(sidecar);
        assert!(draft.rows[1].needs_a_factor() && draft.sidecar().scale.is_empty(), "{sidecar}");
        assert!(table.load(&draft.sidecar()).is_err(), "{sidecar}");
        draft.rows[1].scale = 1e-5;
        let log = table.load(&draft.sidecar()).expect("loads").remove(0);
        assert!((log.channel("q_m").expect("a place")[0] - 0.01).abs() < 1e-12, "{sidecar}");
    }
}

/// Numbered objects are chosen from, and numbers of other things are not.
#[test]
fn the_first_of_several_objects_is_selected() {
    let table = |name: &str| {
        let rows = (0..90).fold(String::new(), |rows, k| rows + &format!("{},{k},{},1\n", 1 + k / 30, 2 * k));
        Table::new(&format!("{name},t_s,q_m,f_N\n{rows}"))
    };
    let selected = |name: &str| table(name).draft("{}").meta.select;
    assert_eq!(selected("Specimen No").get("Specimen No"), Some(&serde_json::json!("1")));
    assert!(selected("gear").is_empty());
}
