//! The server: its own page and data on the loopback address, and nothing else.

use super::board::Board;
use super::http::{Answer, Connection, Refusal, Request};
use super::request::{Asked, asked, number, text};
use super::writing::write;
use grashof::output::{LIVE_POLICY, live_page};
use grashof::par;
use serde_json::{Value, json};
use std::net::{TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

/// Between looks whether the watch is to end.
const LOOK: Duration = Duration::from_millis(20);
/// What an answer waits for news; then the page asks again.
const PATIENCE: Duration = Duration::from_secs(20);
/// Connections at once; a page keeps two or three.
const MOST_AT_ONCE: usize = 128;
const HTML: &str = "text/html; charset=utf-8";
const JSON: &str = "application/json";
const PLAIN: &str = "text/plain; charset=utf-8";

/// The server of a watch.
pub(super) struct Server {
    desk: Arc<Desk>,
}

/// What answers need.
struct Desk {
    board: Arc<Board>,
    port: u16,
    token: String,
    at_once: AtomicUsize,
}

impl Server {
    /// On a socket; none if there is no room for its thread.
    pub(super) fn new(listener: TcpListener, board: Arc<Board>, port: u16, token: String) -> Option<Self> {
        let desk = Arc::new(Desk { board, port, token, at_once: AtomicUsize::new(0) });
        let own = Arc::clone(&desk);
        par::background("server", move || listener.incoming().flatten().for_each(|stream| own.take(stream))).then_some(Self { desk })
    }

    /// The address of the page.
    pub(super) fn address(&self) -> String {
        format!("http://127.0.0.1:{}/?token={}", self.desk.port, self.desk.token)
    }

    /// Serves until `stop` says so.
    pub(super) fn serve(&self, stop: &dyn Fn() -> bool) {
        while !stop() {
            std::thread::sleep(LOOK);
        }
    }
}

impl Desk {
    /// Takes a connection, in a thread of its own: one that waits for news, or for a page that does not read on, holds up nobody else.
    fn take(self: &Arc<Self>, stream: TcpStream) {
        let Some(mut connection) = Connection::new(stream) else { return };
        if self.at_once.fetch_add(1, Ordering::SeqCst) >= MOST_AT_ONCE {
            self.at_once.fetch_sub(1, Ordering::SeqCst);
            send(&mut connection, &(503, PLAIN, "too many connections at once".into()), false);
            return connection.close();
        }
        let desk = Arc::clone(self);
        let begun = par::background("answers", move || {
            desk.answers(connection);
            desk.at_once.fetch_sub(1, Ordering::SeqCst);
        });
        if !begun {
            self.at_once.fetch_sub(1, Ordering::SeqCst);
        }
    }

    /// Answers the requests of a connection.
    fn answers(&self, mut connection: Connection) {
        loop {
            match connection.next() {
                Ok(None) => return,
                Ok(Some(request)) => {
                    if !send(&mut connection, &self.answer(&request), request.keeps) || !request.keeps {
                        return connection.close();
                    }
                }
                Err((code, why)) => {
                    send(&mut connection, &(code, PLAIN, why.into()), false);
                    return connection.close();
                }
            }
        }
    }

    fn answer(&self, request: &Request) -> Answer {
        let answer = asked(request, self.port, &self.token).and_then(|asked| match asked {
            Asked::Page | Asked::Model | Asked::State(_) | Asked::Study(_) => self.get(&asked),
            _ => self.post(&asked, &serde_json::from_slice(&request.body).map_err(|_| (400, "the message is no JSON"))?),
        });
        answer.unwrap_or_else(|(code, why)| (code, PLAIN, why.into()))
    }

    fn get(&self, asked: &Asked) -> Result<Answer, Refusal> {
        Ok(match asked {
            Asked::Model => (200, JSON, self.board.head().to_string()),
            Asked::State(known) => (200, JSON, self.board.newer(known, PATIENCE)),
            Asked::Study(name) => {
                let (version, json) = self.board.result(name).ok_or((404, "there is no result of this study"))?;
                (200, JSON, format!("{{\"version\":{version},\"study\":{json}}}"))
            }
            _ => (200, HTML, live_page(self.board.model())),
        })
    }

    fn post(&self, asked: &Asked, message: &Value) -> Result<Answer, Refusal> {
        let done = (200, JSON, "{}".to_string());
        let place = text(message, "place");
        match asked {
            Asked::View => {
                let known = text(message, "study").is_some_and(|study| self.board.view(study));
                if known { Ok(done) } else { Err((404, "there is no such study")) }
            }
            Asked::Move => {
                let (Some(place), Some(to)) = (place, number(message, "value")) else {
                    return Err((400, "a place and a number are needed"));
                };
                let known = self.board.move_values(|values| values.place(place, to));
                if known { Ok(done) } else { Err((404, "there is no number at this place")) }
            }
            Asked::Write => {
                let Some(place) = place else { return Err((400, "a place is needed")) };
                match write(&self.board, place, number(message, "value")) {
                    Ok(()) => Ok(done),
                    Err(why) => Ok((409, JSON, json!({ "why": why }).to_string())),
                }
            }
            _ => {
                self.board.move_values(|values| {
                    values.back(place);
                    true
                });
                Ok(done)
            }
        }
    }
}

/// Sends an answer; false if the page is gone.
fn send(connection: &mut Connection, answer: &Answer, keeps: bool) -> bool {
    let policy = format!("{}; frame-ancestors 'none'", LIVE_POLICY.trim());
    let lines = [
        ("Cache-Control", "no-store"),
        ("Content-Security-Policy", policy.as_str()),
        ("Cross-Origin-Resource-Policy", "same-origin"),
        ("Referrer-Policy", "no-referrer"),
        ("X-Content-Type-Options", "nosniff"),
    ];
    connection.send(answer, &lines, keeps)
}
