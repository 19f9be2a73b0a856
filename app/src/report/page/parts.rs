//! Parts that several sections have.

use maud::{Markup, html};

/// Message about a failed stage.
pub(crate) fn failed(what: &str, why: &str) -> Markup {
    html! { p class="failed" { (what) ": " (why.trim_end_matches('.')) "." } }
}

/// Fact with its name.
pub(crate) fn fact(name: &str, value: &str) -> Markup {
    html! { div { dt { (name) } dd { (value) } } }
}
