//! The scale of the window on X, as the environment states it. The window library panics at a value that it cannot use.

/// Environment variable that states pixels per point.
pub const VARIABLE: &str = "WINIT_X11_SCALE_FACTOR";
/// Word in place of a number: the scale follows from the screen's size.
const FROM_THE_SCREEN: &str = "randr";
/// Scales at which a window can be shown.
/// Derived: at 0.25 the text is 3 pixels high; at 5, the largest screens (8192 pixels) are 1600 points wide.
const SCALES: std::ops::RangeInclusive<f64> = 0.25..=5.0;

/// A sentence if the value cannot be used.
pub fn complaint(text: &str) -> Option<String> {
    let is_usable = text.is_empty()
        || text.to_lowercase() == FROM_THE_SCREEN
        || text.parse().is_ok_and(|scale: f64| SCALES.contains(&scale));
    (!is_usable).then(|| {
        let text = haptics::text_file::one_line(text);
        format!(
            "{VARIABLE} is ignored: `{text}` is no scale; write a number from {} to {}",
            SCALES.start(),
            SCALES.end()
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scale_is_a_usual_number_or_the_word_for_the_screens_own() {
        for usable in ["1", "2.0", "1e0", "0.25", "5", "randr", "RandR", ""] {
            assert_eq!(complaint(usable), None, "{usable}");
        }
    }

    #[test]
    fn a_value_that_would_stop_the_window_library_is_named() {
        for wrong in ["abc", "0", "-1", "nan", "inf", "-0", "1e-320", "1e300", "100", " 2", "2x"] {
            let said = complaint(wrong).unwrap_or_default();
            assert!(said.contains(VARIABLE) && said.contains(&format!("`{wrong}`")), "{wrong}: {said}");
        }
    }
}
