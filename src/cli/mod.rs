//! The commands: what is printed, what is written, and the exit code. Nothing else of the program prints, reads a clock or exits.

mod adhoc;
mod animate;
mod check;
mod code;
mod common;
mod compare;
mod completions;
mod end;
mod export;
mod files;
mod gather;
mod import;
mod interrupt;
mod kept;
mod modes;
mod moving;
mod new;
mod progress;
mod ray;
mod report;
mod run;
mod schema;
mod shard;
mod statics;
mod study;
mod sweep;
mod terminal;
mod video;
mod watch;

use clap::{CommandFactory, Parser, Subcommand};
pub(crate) use common::Common;
use end::end;
use std::io::Write;
use std::process::ExitCode;
use terminal::take_errors;
pub(crate) use terminal::{print_error, print_note, print_out};

const CODES: &str = "Exit codes:
  0    done (rows of a sweep that failed for a stated reason included)
  1    an `expect:` is not met, `run --verify` finds no digit that stands, or `check --strict` has findings
  2    usage, file or model: nothing was computed; or results or standard output cannot be written
  3    numerical failure of a study, or of all runs of a sweep; rows up to there are kept
  130  interrupted";

/// Mechanisms from a text file to motion, forces and pictures.
#[derive(Parser)]
#[command(name = "grashof", version, about, after_help = CODES, disable_help_subcommand = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    #[command(flatten)]
    common: Common,
}

#[derive(Subcommand)]
enum Command {
    /// Run the studies of a model and write tables and figures
    #[command(
        after_help = "Examples:\n  grashof run models/crank_rocker.yaml\n  grashof run models/crank_rocker.yaml --study one-turn --set \"l3=60 cm\" -o out"
    )]
    Run(run::Arguments),
    /// Show the report of a model in a browser while it is edited, with sliders for its values
    #[command(
        after_help = "Examples:\n  grashof watch models/crank_rocker.yaml\n  grashof watch my.yaml --study swing --port 9000\n\nOpen the address that is printed. Ctrl-C ends it."
    )]
    Watch(watch::Arguments),
    /// Run a study for many values of parameters: one row for each
    #[command(
        after_help = "Examples:\n  grashof sweep models/crank_rocker.yaml --study one-turn --over l3=0.3..0.8:26\n  grashof sweep models/crank_rocker.yaml --study one-turn --over \"l3=50cm..80cm:4\" --over speed=100rpm,200rpm -o out\n  grashof sweep my.yaml --over k=10..1000:5:log"
    )]
    Sweep(sweep::Arguments),
    /// Put the shards of a sweep together: the results are those of one run, byte for byte
    #[command(
        after_help = "Examples:\n  grashof run my.yaml --study lengths --shard 1/2 -o one\n  grashof run my.yaml --study lengths --shard 2/2 -o two\n  grashof gather my.yaml --study lengths --from one --from two -o out"
    )]
    Gather(gather::Arguments),
    /// Run a motion in time by several integrators and compare error, time and work
    #[command(
        after_help = "Examples:\n  grashof compare models/pendulum.yaml --study swing\n  grashof compare models/andrews.yaml --study squeeze --integrators dop853,radau5,bdf --tolerances 1e-3..1e-10\n  grashof compare my.yaml --study swing --integrators rk4,newmark --steps 1e-2..1e-4"
    )]
    Compare(compare::Arguments),
    /// Show the motion of a study: GIF, SVG that moves, film or single pictures
    #[command(
        after_help = "Examples:\n  grashof animate models/crank_rocker.yaml --study one-turn --speed 0.1 -o turn.gif\n  grashof animate models/four_bar_spatial.yaml --study one-turn --view 30,20 -o turn.mp4\n  grashof animate my.yaml --study swing --duration 5 --size 600 -o frames/"
    )]
    Animate(animate::Arguments),
    /// Write a mechanism for other programs: glTF with its motion, DXF of its first position
    #[command(
        after_help = "Examples:\n  grashof export models/four_bar_spatial.yaml --study one-turn --gltf turn.glb\n  grashof export models/crank_rocker.yaml --study one-turn --dxf linkage.dxf"
    )]
    Export(export::Arguments),
    /// Eigenvalues, frequencies and shapes of the motions about a pose, with no study in the file
    #[command(
        after_help = "Examples:\n  grashof modes models/crank_rocker.yaml --variant motor --variant elastic\n  grashof modes my.yaml --at statics --damped"
    )]
    Modes(modes::Arguments),
    /// Equilibria of a model and their stability, with no study in the file
    #[command(
        after_help = "Examples:\n  grashof statics models/pendulum.yaml\n  grashof statics my.yaml --variant unloaded --set \"load=20 N\""
    )]
    Statics(statics::Arguments),
    /// Look a model over: topology, freedom, redundant rows, masses, start
    #[command(after_help = "Examples:\n  grashof check models/crank_rocker.yaml\n  grashof check my.yaml --strict --json")]
    Check(check::Arguments),
    /// Write a commented model that runs
    #[command(after_help = "Examples:\n  grashof new four-bar my_linkage.yaml\n  grashof new --list")]
    New(new::Arguments),
    /// Make a model of a URDF, with remarks on what it does not use
    #[command(
        after_help = "Examples:\n  grashof import robot.urdf -o robot.yaml\n  grashof import robot.urdf --free --stops | grashof check -"
    )]
    Import(import::Arguments),
    /// Print the JSON Schema of model files, or of results
    #[command(after_help = "Examples:\n  grashof schema > grashof.schema.json\n  grashof schema --results > results.schema.json")]
    Schema(schema::Arguments),
    /// Print a completion script for a shell
    #[command(
        after_help = "Examples:\n  grashof completions bash > /etc/bash_completion.d/grashof\n  grashof completions fish > ~/.config/fish/completions/grashof.fish"
    )]
    Completions(completions::Arguments),
}

/// Parses the command line and does what it says.
pub(crate) fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            // help and version go to stdout and are no errors
            let failed = error.use_stderr();
            let printed = error.print();
            if failed {
                let message = error.to_string();
                return ended(code::INPUT, vec![serde_json::json!({ "message": message.trim_end() })]);
            }
            terminal::told_if_failed(printed.and_then(|()| std::io::stdout().flush()));
            return ended(code::DONE, Vec::new());
        }
    };
    let to_file =
        matches!(cli.command, Command::Import(_) | Command::Animate(_) | Command::New(_) | Command::Schema(_) | Command::Completions(_));
    if !to_file && cli.common.output.as_ref().is_some_and(|path| path.as_os_str() == "-") {
        print_error("`-o -` names no directory", "write `-o DIR`; `--json` prints results on stdout without it");
        return ended(code::INPUT, take_errors());
    }
    let code = match &cli.command {
        Command::Run(arguments) => run::run(arguments, &cli.common),
        Command::Watch(arguments) => watch::watch(arguments, &cli.common),
        Command::Sweep(arguments) => match &arguments.ray {
            Some(address) => ray::sweep(arguments, address, &cli.common),
            None => sweep::sweep(arguments, &cli.common),
        },
        Command::Gather(arguments) => gather::gather(arguments, &cli.common),
        Command::Compare(arguments) => compare::compare(arguments, &cli.common),
        Command::Animate(arguments) => animate::animate(arguments, &cli.common),
        Command::Export(arguments) => export::export(arguments, &cli.common),
        Command::Modes(arguments) => modes::modes(arguments, &cli.common),
        Command::Statics(arguments) => statics::statics(arguments, &cli.common),
        Command::Check(arguments) => check::check(arguments, &cli.common),
        Command::New(arguments) => new::new(arguments, &cli.common),
        Command::Import(arguments) => import::import(arguments, &cli.common),
        Command::Schema(arguments) => schema::print(arguments, &cli.common),
        Command::Completions(arguments) => completions::print(arguments, &mut Cli::command(), &cli.common),
    };
    ended(code, take_errors())
}

fn ended(code: u8, errors: Vec<serde_json::Value>) -> ExitCode {
    ExitCode::from(end(code, errors))
}
