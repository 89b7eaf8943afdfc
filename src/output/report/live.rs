//! The page of `grashof watch`: the same page as the report, whose data come from the program that serves it.

use super::bundle::{SPACE, STYLE, escaped};

const LIVE: &str = include_str!("../../../viewer/dist/live.js");
const LIVE_STYLE: &str = include_str!("../../../viewer/dist/live.css");
/// What the live page may load and run: its parts by their checksums, and requests to where it comes from.
pub const LIVE_POLICY: &str = include_str!("../../../viewer/dist/live-policy.txt");

/// The live page of a model of this name.
#[must_use]
pub fn live_page(title: &str) -> String {
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n<title>{}</title>\n\
         <link rel=\"icon\" href=\"data:,\">\n<style>{STYLE}</style>\n<style>{LIVE_STYLE}</style>\n</head>\n<body>\n\
         <noscript>This page needs JavaScript.</noscript>\n\
         <div id=\"page\"></div>\n<script>{SPACE}</script>\n<script>{LIVE}</script>\n</body>\n</html>\n",
        escaped(title)
    )
}
