//! The server: its own page and data on the loopback address, and nothing else.

use super::board::Board;
use super::request::{Asked, Refusal, asked, number, text};
use super::writing::write;
use grashof::output::{LIVE_POLICY, live_page};
use grashof::par;
use serde_json::{Value, json};
use std::io::Read;
use std::net::TcpListener;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;
use tiny_http::{Header, Request, Response};

/// Between looks whether the watch is to end.
const LOOK: Duration = Duration::from_millis(20);
/// What an answer waits for news; then the page asks again.
const PATIENCE: Duration = Duration::from_secs(20);
/// Requests at once, and bytes of a message.
const MOST_AT_ONCE: usize = 64;
const MOST_BYTES: u64 = 16 << 10;
const HTML: &str = "text/html; charset=utf-8";
const JSON: &str = "application/json";
const PLAIN: &str = "text/plain; charset=utf-8";

/// The server of a watch.
pub(super) struct Server {
    http: tiny_http::Server,
    desk: Arc<Desk>,
}

/// What answers need.
struct Desk {
    board: Arc<Board>,
    port: u16,
    token: String,
    at_once: AtomicUsize,
}

/// An answer: code, type and text.
type Answer = (u16, &'static str, String);

impl Server {
    /// On a socket; none if the system refuses.
    pub(super) fn new(listener: TcpListener, board: Arc<Board>, port: u16, token: String) -> Option<Self> {
        let http = tiny_http::Server::from_listener(listener, None).ok()?;
        Some(Self { http, desk: Arc::new(Desk { board, port, token, at_once: AtomicUsize::new(0) }) })
    }

    /// The address of the page.
    pub(super) fn address(&self) -> String {
        format!("http://127.0.0.1:{}/?token={}", self.desk.port, self.desk.token)
    }

    /// Answers until `stop` says so.
    pub(super) fn serve(&self, stop: &dyn Fn() -> bool) {
        while !stop() {
            let Ok(Some(request)) = self.http.recv_timeout(LOOK) else { continue };
            let desk = Arc::clone(&self.desk);
            if desk.at_once.fetch_add(1, Ordering::SeqCst) >= MOST_AT_ONCE {
                desk.at_once.fetch_sub(1, Ordering::SeqCst);
                send(request, (503, PLAIN, "too many requests at once".into()));
                continue;
            }
            // what waits for news, or for a page that does not read on, holds up nobody else
            par::background("answer", move || {
                desk.answer(request);
                desk.at_once.fetch_sub(1, Ordering::SeqCst);
            });
        }
    }
}

impl Desk {
    fn answer(&self, mut request: Request) {
        let answer = asked(&request, self.port, &self.token).and_then(|asked| match asked {
            Asked::Page | Asked::Model | Asked::State(_) | Asked::Study(_) => self.get(&asked),
            _ => self.post(&asked, &message(&mut request)?),
        });
        send(request, answer.unwrap_or_else(|(code, why)| (code, PLAIN, why.into())));
    }

    fn get(&self, asked: &Asked) -> Result<Answer, Refusal> {
        Ok(match asked {
            Asked::Model => (200, JSON, self.board.head().to_string()),
            Asked::State(after) => (200, JSON, self.board.newer(*after, PATIENCE)),
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

/// What a page says with its request.
fn message(request: &mut Request) -> Result<Value, Refusal> {
    if request.body_length().is_none_or(|length| length as u64 > MOST_BYTES) {
        return Err((413, "the message is too long"));
    }
    let mut bytes = Vec::new();
    request.as_reader().take(MOST_BYTES).read_to_end(&mut bytes).map_err(|_| (400, "the message is cut off"))?;
    serde_json::from_slice(&bytes).map_err(|_| (400, "the message is no JSON"))
}

/// Sends an answer; a page that is gone needs none.
fn send(request: Request, (code, kind, text): Answer) {
    let mut response = Response::from_string(text).with_status_code(code);
    let policy = format!("{}; frame-ancestors 'none'", LIVE_POLICY.trim());
    let headers = [
        ("Content-Type", kind),
        ("Cache-Control", "no-store"),
        ("Content-Security-Policy", &policy),
        ("Cross-Origin-Resource-Policy", "same-origin"),
        ("Referrer-Policy", "no-referrer"),
        ("X-Content-Type-Options", "nosniff"),
    ];
    for (name, value) in headers {
        if let Ok(header) = Header::from_bytes(name, value) {
            response.add_header(header);
        }
    }
    let _ = request.respond(response);
}
