//! The example that drives the command line from Python runs as it stands. Skipped with a word without Python or matplotlib.

use tests::{touchstone, workspace};

#[test]
fn the_python_example_fits_replays_and_plots() {
    let folder = tempfile::tempdir().expect("a folder");
    for (log, wanted) in [("crank.csv", "fx1_N"), ("stack.csv", "fy1_N")] {
        let path = workspace().join("assets/recordings").join(log);
        // `TOUCHSTONE_PICTURES` keeps the pictures for the eye.
        let kept = std::env::var_os("TOUCHSTONE_PICTURES").map(std::path::PathBuf::from);
        let out = kept.as_deref().unwrap_or(folder.path()).join(format!("{log}.png"));
        let arguments = [&path, &"--out".into(), &out, &"--touchstone".into(), &touchstone().to_path_buf()];
        let arguments: Vec<&str> = arguments.iter().map(|a| a.to_str().expect("a plain path")).collect();
        let Some(said) = tests::python::output_of("examples/python/fit_and_plot.py", &arguments) else { return };
        assert!(said.contains(wanted) && said.contains("predicted within"), "{said}");
        let picture = image::open(&out).expect("a picture").to_rgb8();
        let drawn = picture.pixels().filter(|pixel| pixel.0 != [255, 255, 255]).count();
        assert!(picture.width() > 800 && drawn > 5000, "{drawn} of {} pixels are drawn", picture.len() / 3);
    }
}
