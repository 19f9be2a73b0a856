//! A drawer in files of every habit: 1.5 kg with 4 N s/m and 2 N of dry friction. A hand moves it along a sum of waves, whose
//! derivatives are exact; no formula is the estimator's.

use estimator::log;
use estimator::pipeline::{Options, analyse};
use haptics::recording::Recording;

/// Mass of the drawer, kg.
pub const MASS_KG: f64 = 1.5;
/// Its viscous friction, N s/m.
pub const VISCOUS_N_S_M: f64 = 4.0;
/// Its dry friction, N.
pub const DRY_N: f64 = 2.0;

/// Time, position and force of one sample: s, m, N.
pub type Sample = [f64; 3];

/// Samples of its motion under a hand.
pub fn drawer(count: usize, rate_hz: f64) -> Vec<Sample> {
    let waves = [(0.055, 1.9, 0.3), (0.03, 4.4, 1.1), (0.012, 8.3, 2.0)];
    let of = |k: usize| {
        let t = k as f64 / rate_hz;
        let sum = |of: &dyn Fn(f64, f64, f64) -> f64| waves.iter().map(|(a, w, p)| of(*a, *w, w * t + p)).sum::<f64>();
        let velocity = sum(&|a, w, x| a * w * x.cos());
        let acceleration = sum(&|a, w, x| -a * w * w * x.sin());
        let force = MASS_KG * acceleration + VISCOUS_N_S_M * velocity + DRY_N * (velocity / 1e-3).tanh();
        [t, sum(&|a, _, x| a * x.sin()), force]
    };
    (0..count).map(of).collect()
}

/// A log with its sidecar in a folder of its own.
pub struct File(pub tempfile::TempDir);

impl File {
    /// Writes both.
    pub fn new(content: impl AsRef<[u8]>, sidecar: &str) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("log.csv"), content).expect("written");
        std::fs::write(folder.path().join("log.meta.json"), sidecar).expect("written");
        Self(folder)
    }

    /// Reads the log; the error as a sentence.
    pub fn load(&self) -> Result<Vec<Recording>, String> {
        log::load(&self.0.path().join("log.csv"), None).map_err(|error| error.to_string())
    }
}

/// Loads and fits; panics unless it is the drawer.
pub fn is_the_drawer(name: &str, content: impl AsRef<[u8]>, sidecar: &str) -> Recording {
    let recordings = File::new(content, sidecar).load().unwrap_or_else(|error| panic!("{name}: {error}"));
    let fit = analyse(&recordings, &Options::default()).unwrap_or_else(|error| panic!("{name}: {error}")).fit;
    let value = |starts: &str| fit.parameters.iter().find(|p| p.name.starts_with(starts)).and_then(|p| p.value);
    let mass = value("mass").or_else(|| value("inertia")).unwrap_or(f64::NAN);
    let (viscous, dry) = (value("viscous").unwrap_or(f64::NAN), value("coulomb").unwrap_or(f64::NAN));
    let close = |found: f64, truth: f64| (found / truth - 1.0).abs() < 0.03;
    assert!(
        close(mass, MASS_KG) && close(viscous, VISCOUS_N_S_M) && close(dry, DRY_N),
        "{name}: {mass} kg, {viscous} N s/m, {dry} N; {:?}",
        recordings[0].warnings
    );
    recordings.into_iter().next().expect("one")
}
