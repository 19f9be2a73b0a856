//! Messages as sentences.

use super::format::capitalised;

/// Capital first, full stop last. A column's name in front stays as it is: `f_N` is no `F_N`.
pub fn sentence(text: &str) -> String {
    let text = text.trim();
    let named = text.split(' ').next().is_some_and(|word| word.contains('_'));
    let text = if named { text.to_owned() } else { capitalised(text) };
    if text.ends_with(['.', '!', '?']) { text } else { format!("{text}.") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sentences_are_sentences() {
        assert_eq!(sentence("the file is empty"), "The file is empty.");
        assert_eq!(sentence("f_N stops changing"), "f_N stops changing.");
    }
}
