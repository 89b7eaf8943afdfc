//! How the program ends.

use super::{code, print_out, terminal};

/// The exit code, after errors are printed as JSON where that was asked for and nothing else was printed.
pub(crate) fn end(code: u8, errors: Vec<serde_json::Value>) -> u8 {
    // what could not be parsed is asked for all the same
    let asked = |word: &str| std::env::args_os().any(|argument| argument == word);
    if code != code::DONE && asked("--json") && !terminal::has_said() {
        let failure = terminal::failure_json(None, errors);
        print_out(&if asked("run") { json_list(&[failure]) } else { failure });
    }
    if terminal::output_failed() { code.max(code::INPUT) } else { code }
}

/// JSON texts as one list, their numbers untouched: reading them back could change a last digit.
pub(super) fn json_list(texts: &[String]) -> String {
    let items: Vec<String> = texts.iter().map(|text| format!("\n  {}", text.trim_end().replace('\n', "\n  "))).collect();
    format!("[{}{}]", items.join(","), if items.is_empty() { "" } else { "\n" })
}
