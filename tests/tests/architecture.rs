//! The arrows between the crates point one way: haptics ← estimator ← app, haptics ← render ← app.

use cargo_metadata::{DependencyKind, MetadataCommand};
use std::collections::BTreeSet;

/// Workspace members that `package` may depend on in its normal build.
const ALLOWED: [(&str, &[&str]); 5] = [
    ("haptics", &[]),
    ("estimator", &["haptics"]),
    ("render", &["haptics"]),
    ("app", &["haptics", "estimator", "render"]),
    ("tests", &["haptics", "estimator", "render", "app"]),
];

/// What must never come into a crate, directly or through others: the lower half has no window.
const FORBIDDEN_BELOW: [(&str, &[&str]); 3] = [
    ("haptics", &["egui", "eframe", "wgpu", "glam", "clap"]),
    ("estimator", &["egui", "eframe", "wgpu", "glam", "clap"]),
    ("render", &["egui", "eframe", "clap"]),
];

#[test]
fn arrows_point_one_way() {
    let metadata = MetadataCommand::new().no_deps().exec().expect("cargo describes the workspace");
    let members: BTreeSet<String> = metadata.packages.iter().map(|p| p.name.to_string()).collect();
    let known: BTreeSet<String> = ALLOWED.iter().map(|(name, _)| (*name).to_owned()).collect();
    assert_eq!(members, known, "a new crate needs its place in this test and in ARCHITECTURE.md");
    for package in &metadata.packages {
        let (_, allowed) = ALLOWED.iter().find(|(name, _)| package.name.as_str() == *name).expect("checked above");
        for dependency in package.dependencies.iter().filter(|d| members.contains(&d.name)) {
            assert!(
                allowed.contains(&dependency.name.as_str()),
                "{} must not depend on {}",
                package.name,
                dependency.name
            );
        }
    }
}

#[test]
fn nothing_graphical_below_the_app() {
    let metadata = MetadataCommand::new().exec().expect("cargo describes the workspace");
    let resolve = metadata.resolve.as_ref().expect("dependencies are resolved");
    let name = |id: &cargo_metadata::PackageId| {
        metadata.packages.iter().find(|p| p.id == *id).map_or(String::new(), |p| p.name.to_string())
    };
    for (root, forbidden) in FORBIDDEN_BELOW {
        let start = resolve.nodes.iter().find(|n| name(&n.id) == root).expect("a member");
        let mut seen = BTreeSet::new();
        let mut open = vec![start];
        while let Some(node) = open.pop() {
            for dependency in &node.deps {
                let normal = dependency.dep_kinds.iter().any(|k| k.kind == DependencyKind::Normal);
                if normal && seen.insert(dependency.pkg.clone()) {
                    open.extend(resolve.nodes.iter().find(|n| n.id == dependency.pkg));
                }
            }
        }
        let below: BTreeSet<String> = seen.iter().map(name).collect();
        for crate_name in forbidden {
            assert!(!below.contains(*crate_name), "{root} reaches {crate_name}");
        }
    }
}
