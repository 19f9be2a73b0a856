//! Any bytes as a log, of every format: a recording or a sentence. `cargo +nightly fuzz run log ../tests/corpus/log`.

#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let folder = std::env::temp_dir().join(format!("touchstone-fuzz-{}", std::process::id()));
    let _ = std::fs::create_dir(&folder);
    let path = folder.join("log.csv");
    std::fs::write(&path, bytes).expect("the temporary folder is writable");
    if let Err(error) = estimator::log::load(&path, None) {
        let text = error.to_string();
        assert!(!text.is_empty() && text.ends_with("log.csv"), "{text:?}");
    }
});
