use super::*;
use haptics::Vec2;
use haptics::law::{CATALOGUE, Coordinate, EccentricMass, Effect, Inertia, ReturnSpring, Weight};
use haptics::world::{Mechanism, MechanismPath, presets};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::collections::BTreeMap;
use strum::IntoEnumIterator as _;

/// Every element with its attributes and the text in it, in the order of the file.
struct Read(Vec<(String, BTreeMap<String, String>, String)>);

impl Read {
    fn of(text: &str) -> Self {
        let mut reader = Reader::from_str(text);
        reader.config_mut().check_comments = true;
        let mut all = Vec::new();
        loop {
            match reader.read_event().expect("well-formed") {
                Event::Start(start) | Event::Empty(start) => all.push(Self::element(&start)),
                Event::Text(said) => {
                    let said = said.decode().expect("UTF-8").trim().to_owned();
                    if let (false, Some((_, _, text))) = (said.is_empty(), all.last_mut()) {
                        *text = said;
                    }
                }
                Event::Eof => return Self(all),
                _ => {}
            }
        }
    }

    fn element(start: &BytesStart<'_>) -> (String, BTreeMap<String, String>, String) {
        let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).expect("UTF-8");
        let attributes = start.attributes().map(|attribute| {
            let attribute = attribute.expect("an attribute");
            let value = quick_xml::escape::unescape(&text(&attribute.value)).expect("known entities").into_owned();
            (text(attribute.key.as_ref()), value)
        });
        (text(start.name().as_ref()), attributes.collect(), String::new())
    }

    fn all<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a BTreeMap<String, String>> {
        self.0.iter().filter(move |(own, _, _)| own == name).map(|(_, attributes, _)| attributes)
    }

    fn number(&self, element: &str, attribute: &str) -> f64 {
        let found = self.all(element).find_map(|attributes| attributes.get(attribute));
        found.unwrap_or_else(|| panic!("{element} has no {attribute}")).parse().expect("a number")
    }

    fn text(&self, element: &str) -> f64 {
        let found = self.0.iter().find(|(own, _, _)| own == element);
        found.unwrap_or_else(|| panic!("no {element}")).2.parse().expect("a number")
    }
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * b.abs().max(1e-12)
}

#[test]
fn every_format_has_the_crank_s_numbers() {
    // At 22 mm: c = 1 N s/m is 0.000484 N m s, Fc = 0.02 N is 0.00044 N m. A weight of 0.16 N is 16.31 g at the handle,
    // and the other 13.69 g of its inertia of 30 g rotate with the arm.
    let world = presets::crank();
    let (damping, dry, mass) = (0.000_484, 0.000_44, 0.16 / 9.81);
    let inertia = (0.03 - mass) * 0.022 * 0.022;
    let file = Read::of(&export(&world, Format::Mjcf, false).text);
    assert!(near(file.number("joint", "damping"), damping) && near(file.number("joint", "frictionloss"), dry));
    assert!(near(file.number("inertial", "mass"), mass));
    let diagonal = &file.all("inertial").next().expect("a body")["diaginertia"];
    assert!(near(diagonal.split(' ').next().expect("a number").parse().expect("a number"), inertia), "{diagonal}");
    let file = Read::of(&export(&world, Format::Urdf, false).text);
    assert!(near(file.number("dynamics", "damping"), damping) && near(file.number("dynamics", "friction"), dry));
    assert!(near(file.number("mass", "value"), mass) && near(file.number("inertia", "iyy"), inertia));
    let file = Read::of(&export(&world, Format::Sdf, false).text);
    assert!(near(file.text("damping"), damping) && near(file.text("friction"), dry));
    assert!(near(file.text("mass"), mass) && near(file.text("iyy"), inertia));
}

#[test]
fn every_part_of_every_world_is_accounted_for() {
    for format in Format::iter() {
        for mut world in presets::all() {
            let mut effects: Vec<Effect> = CATALOGUE.iter().map(|law| Effect::new(*law, &[0.3; 5])).collect();
            if let Some(crank) = &mut world.crank {
                effects.extend(crank.effects.clone());
                crank.effects.clone_from(&effects);
            }
            let exported = export(&world, format, true);
            let said = |object: &str, what: &str| {
                exported.remarks.iter().any(|remark| remark.object == object && remark.what.contains(what))
            };
            Read::of(&exported.text);
            for block in &world.blocks {
                assert!(exported.bodies.contains(&block.name) && said(&block.name, "mass"), "{}", block.name);
                assert_eq!(block.cable.is_some(), said(&block.name, "cable"));
                assert_eq!(block.wall.is_some(), said(&block.name, "wall"));
                assert_eq!(block.guide.is_some(), said(&block.name, "guide"));
            }
            if world.crank.is_some() {
                for &law in CATALOGUE {
                    assert!(said("crank", law.id()), "{} in {}", law.id(), format.name());
                }
            }
            assert_eq!(world.membrane.is_some(), said("membrane", "all of it"));
            assert_eq!(world.switch.is_some(), said("switch", "snap") && said("switch", "stops"));
            for remark in exported.of(Fate::LeftOut).chain(exported.of(Fate::Approximate)) {
                assert!(exported.text.contains(&remark.how.replace("--", "\u{2013}")), "the file says so: {remark:?}");
            }
        }
    }
}

#[test]
fn a_switch_is_a_lever_between_its_stops() {
    let world = presets::switch();
    let switch = world.switch.as_ref().expect("a switch");
    let lever_m = switch.lever_m;
    let file = Read::of(&export(&world, Format::Mjcf, false).text);
    let joint = file.all("joint").next().expect("a joint");
    // To the right is clockwise for the viewer, who looks along y.
    assert_eq!((joint["type"].as_str(), joint["axis"].as_str()), ("hinge", "0 1 0"));
    let ends: Vec<f64> = joint["range"].split(' ').map(|end| end.parse().expect("a number")).collect();
    let points = &switch.curve.points;
    assert!(near(ends[0] * lever_m, points[0].at_m) && near(ends[1] * lever_m, points[points.len() - 1].at_m));
    assert!(near(file.number("joint", "damping"), switch.damping_n_s_m * lever_m.powi(2)));
    assert!(near(file.number("inertial", "mass"), switch.mass_kg));
    // A stop is a spring: stiffness over mass.
    let of = |name: &str| -> f64 { joint[name].split(' ').next().and_then(|n| n.parse().ok()).expect("a number") };
    let spring_1_s2 = -of("solreflimit");
    assert!((spring_1_s2 * switch.mass_kg / switch.curve.stop_n_m - 1.0).abs() < 1e-3, "{spring_1_s2}");
    assert_eq!(file.all("inertial").next().expect("a mass")["pos"], format!("0 0 {lever_m}"));
    // The work of a full cycle is the area between the branches: twice the friction over twice the travel.
    let between_j: f64 = points
        .windows(2)
        .map(|p| {
            let gap_n = |k: usize| p[k].forward_n - p[k].backward_n;
            0.5 * (gap_n(0) + gap_n(1)) * (p[1].at_m - p[0].at_m)
        })
        .sum();
    let friction_n_m = file.number("joint", "frictionloss");
    assert!(near(2.0 * friction_n_m * (ends[1] - ends[0]), between_j), "{friction_n_m}");
    for format in [Format::Urdf, Format::Sdf] {
        assert_eq!(export(&world, format, false).bodies, ["switch"]);
    }
    // Fingers touch its knob with its own friction.
    let touched = Read::of(&export(&world, Format::Mjcf, true).text);
    let pairs: Vec<_> = touched.all("pair").filter(|pair| pair["geom2"] == "switch").collect();
    assert!(
        pairs.len() == 2 && pairs.iter().all(|pair| pair["friction"].starts_with(&switch.finger_friction.to_string()))
    );
}

#[test]
fn a_mechanism_lies_where_its_path_does() {
    let effects = vec![Effect::new(&Inertia, &[2.0]), Effect::new(&Weight, &[0.5 * 2.0 * 9.81])];
    // Upwards in a recording (y) is z in the file; half of the mass hangs on a counterweight.
    let path = MechanismPath::Prismatic { origin_m: [0.1, 0.2, 0.3], direction: [0.0, 1.0, 0.0] };
    let mut world = World::empty("lift");
    world.floor = None;
    world.mechanism =
        Some(Mechanism { coordinate: Coordinate::Linear, path: Some(path), effects, direction_blur: 0.0 });
    let file = Read::of(&export(&world, Format::Mjcf, false).text);
    let body = file.all("body").next().expect("a body");
    assert_eq!(body["pos"], "0.1 -0.3 0.2");
    assert_eq!(file.all("joint").next().expect("a joint")["axis"], "0 0 1");
    assert!(near(file.number("body", "gravcomp"), 0.5), "{body:?}");
    assert!(near(file.number("inertial", "mass"), 2.0));
}

#[test]
fn a_hinge_s_mass_lies_where_gravity_pulls_it() {
    // A pendulum of 0.5 N m whose zero hangs, on a spring that is at rest at 0.4 rad.
    let effects = vec![
        Effect::new(&Inertia, &[0.02]),
        Effect::new(&EccentricMass, &[0.5, 0.0, 0.0]),
        Effect::new(&ReturnSpring, &[0.25, -0.1]),
    ];
    let mut world = World::empty("pendulum");
    world.mechanism = Some(Mechanism { coordinate: Coordinate::Angular, path: None, effects, direction_blur: 0.0 });
    let file = Read::of(&export(&world, Format::Mjcf, false).text);
    let inertial = file.all("inertial").next().expect("a body");
    let at: Vec<f64> = inertial["pos"].split(' ').map(|n| n.parse().expect("a number")).collect();
    assert!(at[0].abs() < 1e-12 && at[2] < 0.0, "it hangs: {at:?}");
    assert!(near(file.number("inertial", "mass") * -at[2] * 9.81, 0.5));
    assert!(near(file.number("joint", "stiffness"), 0.25) && near(file.number("joint", "springref"), 0.4));
}

#[test]
fn a_tilted_world_hangs_its_crank_as_an_upright_one() {
    // The crank's laws know nothing of the tilt, so its mass must lie a tilt further on.
    let mut world = presets::crank();
    world.tilt_rad = 0.3;
    let file = Read::of(&export(&world, Format::Mjcf, false).text);
    let at: Vec<f64> =
        file.all("inertial").next().expect("a body")["pos"].split(' ').map(|n| n.parse().expect("a number")).collect();
    let angle = at[2].atan2(at[0]);
    assert!(near(angle, 0.3), "{angle}");
}

#[test]
fn hostile_names_make_no_other_file() {
    let mut world = presets::stacking();
    world.name = "--> <evil a=\"1\"/> \u{0}\u{1b} ]]>".to_owned();
    world.blocks[0].name = "floor\"><x/>".to_owned();
    world.blocks[1].name = "world".to_owned();
    let twin = world.blocks[1].clone();
    world.blocks.push(twin);
    world.blocks[2].start.center_m = Vec2::new(0.02, 0.1);
    for format in Format::iter() {
        let exported = export(&world, format, true);
        let file = Read::of(&exported.text);
        assert!(file.all("evil").next().is_none() && file.all("x").next().is_none(), "{}", exported.text);
        let mut names = exported.bodies.clone();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), 3, "{names:?}");
        assert!(!names.iter().any(|name| name == "world" || name == "floor"), "{names:?}");
    }
}

#[test]
fn endings_name_formats() {
    let of = |name: &str| Format::of_ending(std::path::Path::new(name));
    assert_eq!(of("a.XML"), Some(Format::Mjcf));
    assert_eq!(of("b.urdf"), Some(Format::Urdf));
    assert_eq!(of("c.sdf"), Some(Format::Sdf));
    assert_eq!(of("d.json"), None);
}
