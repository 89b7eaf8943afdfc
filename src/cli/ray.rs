//! `grashof sweep --ray`: the sweep on a Ray cluster, by the Python package, which knows Ray.

use super::sweep::Arguments;
use super::{Common, code, files, print_error};
use std::ffi::OsString;
use std::io;
use std::process::Command;

/// Prints the packages that Python has not.
const MISSING: &str = "import importlib.util as u; print(*[name for name in ('grashof', 'ray') if u.find_spec(name) is None])";

/// The interpreter, of the environment that is active.
const PYTHON: &str = "python3";

/// Hands the sweep over to Python, whose exit code is that of the program; what is wrong before was printed.
pub(super) fn sweep(arguments: &Arguments, address: &str, common: &Common) -> u8 {
    if let Err((message, help)) = ready(Command::new(PYTHON).args(["-c", MISSING]).output()) {
        print_error(&message, &help);
        return code::INPUT;
    }
    let Some(directory) = files::directory(&arguments.model, common) else { return code::INPUT };
    let mut command = Command::new(PYTHON);
    command.args(["-m", "grashof", "sweep"]).args(words(arguments, address, common)).arg("-o").arg(directory);
    let error = handed_over(&mut command);
    match error {
        Ok(code) => code,
        Err(error) => {
            print_error(&format!("`{PYTHON}` cannot be run: {error}"), "look after the Python of this machine");
            code::INPUT
        }
    }
}

/// Whether Python and its packages are there.
///
/// # Errors
/// What is not, and the remedy.
fn ready(asked: io::Result<std::process::Output>) -> Result<(), (String, String)> {
    let known = asked.map_err(|error| (format!("`{PYTHON}` cannot be run, by which sweeps on Ray go: {error}"), install("Python 3.9")))?;
    let missing = String::from_utf8_lossy(&known.stdout);
    let missing: Vec<&str> = missing.split_whitespace().collect();
    match missing[..] {
        _ if !known.status.success() => {
            Err((format!("`{PYTHON}` does not start: {}", String::from_utf8_lossy(&known.stderr).trim()), install("Python 3.9")))
        }
        [] => Ok(()),
        ["ray"] => Err((format!("`{PYTHON}` has no package `ray`"), "install it: pip install ray".to_owned())),
        _ => {
            let help = "install it from the repository of this program: pip install ./python ray";
            Err((format!("`{PYTHON}` has no package `{}`", missing.join("`, `")), help.to_owned()))
        }
    }
}

fn install(what: &str) -> String {
    format!("install {what} or later, and in it the packages `grashof` and `ray`")
}

/// The arguments of the Python package.
fn words(arguments: &Arguments, address: &str, common: &Common) -> Vec<OsString> {
    let mut words: Vec<OsString> = vec![(&arguments.model).into()];
    let mut add = |flag: &str, value: &str| words.push(format!("{flag}={value}").into());
    add("--ray", address);
    arguments.study.iter().for_each(|study| add("--study", study));
    arguments.over.iter().for_each(|over| add("--over", over));
    common.set.iter().for_each(|set| add("--set", set));
    common.variant.iter().for_each(|variant| add("--variant", variant));
    arguments.drawn.count().into_iter().for_each(|count| add("--samples", &count.to_string()));
    add("--seed", &arguments.drawn.seed().to_string());
    if common.quiet {
        words.push("--quiet".into());
    }
    words
}

/// Becomes the command, so that signals and the exit code are its own.
#[cfg(unix)]
fn handed_over(command: &mut Command) -> io::Result<u8> {
    use std::os::unix::process::CommandExt;
    Err(command.exec())
}

/// Runs the command, and gives its exit code.
#[cfg(not(unix))]
fn handed_over(command: &mut Command) -> io::Result<u8> {
    let code = command.status()?.code();
    Ok(code.and_then(|code| u8::try_from(code).ok()).unwrap_or(code::INTERRUPTED))
}
