//! `grashof watch`: the report page on the loopback address, which follows the model file and what is moved in the page.
//!
//! Three threads and one for each connection. The look-out ([`lookout`]) reads the file and tells the board of every change; the
//! bench ([`bench`]) computes the studies that are out of date, the one in view first; the server ([`server`]) answers pages. What
//! they share is the [`board`]: the file as it was last sound, the values that were moved, and for each study its last result.
//! Every change has a number; a page asks for what is newer than the number that it knows, and the answer waits until there is.

mod bench;
mod board;
mod entry;
mod http;
mod look;
mod lookout;
mod request;
mod server;
mod values;
mod writing;

use super::interrupt::{self, interrupted, watch_interrupts};
use super::terminal::escaped;
use super::{Common, code, files, print_error, print_note, print_out};
use board::Board;
use std::net::{Ipv4Addr, TcpListener};
use std::sync::Arc;

/// Where the search for a free port begins, and how many are tried before the system chooses.
const FIRST: u16 = 8417;
const TRIED: u16 = 32;

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Model file
    model: String,
    /// Study to be shown first
    #[arg(long, value_name = "S")]
    study: Option<String>,
    /// Port on 127.0.0.1 [default: the first free one from 8417]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    port: Option<u16>,
}

/// Serves the page of a model until it is interrupted.
pub(super) fn watch(arguments: &Arguments, common: &Common) -> u8 {
    watch_interrupts();
    interrupt::begins("the watch is ended".into(), false);
    let model = &arguments.model;
    if model == "-" {
        print_error("stdin cannot be watched", "name a model file");
        return code::INPUT;
    }
    if files::selection(common, None).is_none() {
        return code::INPUT;
    }
    let first = match look::read(model) {
        Ok(first) => first,
        Err(error) => {
            files::unreadable(model, &error, "a model file", "check the path, or write a new model with `grashof new four-bar`");
            return code::INPUT;
        }
    };
    let board = Arc::new(Board::new(model, common, arguments.study.clone()));
    board.read(first.clone());
    if let Some(study) = &arguments.study
        && !board.has_study(study)
    {
        print_error(&format!("there is no study `{study}` in `{model}`"), "name a study of the file, or none");
        return code::INPUT;
    }
    let (Some(listener), Some(token)) = (listener(arguments.port), token()) else { return code::INPUT };
    let Ok(port) = listener.local_addr().map(|address| address.port()) else { return code::INPUT };
    let begun = lookout::begin(Arc::clone(&board), first) && bench::begin(Arc::clone(&board));
    let Some(server) = server::Server::new(listener, board, port, token).filter(|_| begun) else {
        print_error("the page cannot be served", "end other programs, and try again");
        return code::INPUT;
    };
    print_out(&server.address());
    if !common.quiet {
        print_note(&format!("watching `{}`; Ctrl-C ends it", escaped(model)));
    }
    server.serve(&interrupted);
    interrupt::print_end("the watch is ended");
    code::INTERRUPTED
}

/// A socket of the loopback address; what is wrong was reported.
fn listener(port: Option<u16>) -> Option<TcpListener> {
    let bind = |port| TcpListener::bind((Ipv4Addr::LOCALHOST, port));
    match port {
        None => (FIRST..FIRST + TRIED).chain([0]).find_map(|port| bind(port).ok()).or_else(|| {
            print_error("no port of 127.0.0.1 is free", "end other programs that serve pages");
            None
        }),
        Some(port) => {
            let failed = |error| {
                let help = "name another port with `--port`, or none, and the next free one is taken";
                print_error(&format!("port {port} of 127.0.0.1 cannot be used: {error}"), help);
            };
            bind(port).map_err(failed).ok()
        }
    }
}

/// 128 bits of chance from the system, in hexadecimal digits; what is wrong was reported.
fn token() -> Option<String> {
    let mut bytes = [0; 16];
    match getrandom::fill(&mut bytes) {
        Ok(()) => Some(bytes.iter().map(|byte| format!("{byte:02x}")).collect()),
        Err(error) => {
            print_error(&format!("the system has no random numbers: {error}"), "the page is not served without a secret address");
            None
        }
    }
}
