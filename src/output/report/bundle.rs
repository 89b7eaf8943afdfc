//! What the report and the live page have in common.

/// Looks of the page.
pub(super) const STYLE: &str = include_str!("../../../viewer/dist/page.css");
/// Mechanisms in space.
pub(super) const SPACE: &str = include_str!("../../../viewer/dist/space.js");

/// Text as it stands in HTML.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
