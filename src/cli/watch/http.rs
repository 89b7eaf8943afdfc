//! HTTP/1.1 as far as the live page needs it: connections that are kept, messages of a stated length, answers in one piece.
//!
//! Heads are read by `httparse`. What could be read in two ways is refused, and the connection closed behind it, since nobody could say
//! where the next request begins: lengths that are no plain number or stand there twice, and bodies in chunks.

use std::io::{ErrorKind, Read, Write};
use std::net::{Shutdown, TcpStream};
use std::time::{Duration, Instant};

/// Bytes of a head and of a message at most, and lines of a head.
const HEAD: usize = 16 << 10;
const BODY: usize = 16 << 10;
const LINES: usize = 64;
/// What a connection may rest between requests, and what a request may take to arrive.
const REST: Duration = Duration::from_secs(60);
const ARRIVAL: Duration = Duration::from_secs(10);
/// What is read of a request that is refused before it is whole, so that the answer is not lost with it.
const SWALLOWED: usize = 1 << 20;

/// A reason to refuse, with the code of HTTP and a sentence.
pub(super) type Refusal = (u16, &'static str);

/// An answer: code, type and text.
pub(super) type Answer = (u16, &'static str, String);

/// A request that is whole.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Request {
    /// `GET`, `POST`, ...
    pub(super) method: String,
    /// Path and query as they stand there.
    pub(super) target: String,
    /// Names and values of the head.
    headers: Vec<(String, String)>,
    /// Its message.
    pub(super) body: Vec<u8>,
    /// Whether the connection is kept behind it.
    pub(super) keeps: bool,
}

impl Request {
    /// All values of a line of the head.
    pub(super) fn header<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a str> {
        self.headers.iter().filter(move |(known, _)| known.eq_ignore_ascii_case(name)).map(|(_, value)| value.as_str())
    }

    /// Reads the head of a request: its length and the request without its body; none if it is not there as a whole.
    fn head(bytes: &[u8]) -> Result<Option<(usize, Self)>, Refusal> {
        let mut lines = [httparse::EMPTY_HEADER; LINES];
        let mut parsed = httparse::Request::new(&mut lines);
        let length = match parsed.parse(bytes) {
            Ok(httparse::Status::Complete(length)) => length,
            Ok(httparse::Status::Partial) if bytes.len() < HEAD => return Ok(None),
            Ok(httparse::Status::Partial) | Err(httparse::Error::TooManyHeaders) => return Err((431, "the head is too long")),
            Err(_) => return Err((400, "this is no request of HTTP")),
        };
        let text = |value: &[u8]| String::from_utf8_lossy(value).into_owned();
        let mut request = Self {
            method: parsed.method.unwrap_or_default().into(),
            target: parsed.path.unwrap_or_default().into(),
            headers: parsed.headers.iter().map(|line| (line.name.to_string(), text(line.value))).collect(),
            ..Self::default()
        };
        let closes = request.header("Connection").any(|value| value.to_ascii_lowercase().contains("close"));
        request.keeps = parsed.version == Some(1) && !closes && ["GET", "POST"].contains(&request.method.as_str());
        Ok(Some((length, request)))
    }

    /// Bytes of the message behind the head.
    fn length(&self) -> Result<usize, Refusal> {
        // pages of ours say how long a message is
        if self.header("Transfer-Encoding").next().is_some() {
            return Err((400, "the length of a message is needed"));
        }
        let mut lengths = self.header("Content-Length");
        let Some(length) = lengths.next() else {
            return if self.method == "POST" { Err((411, "the length of a message is needed")) } else { Ok(0) };
        };
        if lengths.next().is_some() || length.is_empty() || !length.bytes().all(|c| c.is_ascii_digit()) {
            return Err((400, "the length of the message is not clear"));
        }
        length.parse().ok().filter(|length| *length <= BODY).ok_or((413, "the message is too long"))
    }
}

/// A connection with a page.
pub(super) struct Connection {
    stream: TcpStream,
    /// What has arrived and was not taken.
    held: Vec<u8>,
}

impl Connection {
    /// Takes a connection; none if the system refuses. Answers go out at once: with Nagle's algorithm the end of one would wait until the
    /// page acknowledges its beginning.
    pub(super) fn new(stream: TcpStream) -> Option<Self> {
        stream.set_nodelay(true).ok()?;
        stream.set_write_timeout(Some(REST)).ok()?;
        Some(Self { stream, held: Vec::new() })
    }

    /// The next request; none if there will be no more.
    pub(super) fn next(&mut self) -> Result<Option<Request>, Refusal> {
        let mut until = (!self.held.is_empty()).then(|| Instant::now() + ARRIVAL);
        loop {
            if let Some((head, mut request)) = Request::head(&self.held)? {
                let whole = head + request.length()?;
                if self.held.len() >= whole {
                    request.body = self.held[head..whole].to_vec();
                    self.held.drain(..whole);
                    return Ok(Some(request));
                }
            }
            let left = until.map_or(REST, |until| until.saturating_duration_since(Instant::now()));
            if left.is_zero() {
                return Err((408, "the request did not arrive"));
            }
            match self.receive(left) {
                Received::Some => {}
                Received::Nothing if until.is_some() => return Err((408, "the request did not arrive")),
                Received::Nothing | Received::End => return Ok(None),
            }
            until.get_or_insert_with(|| Instant::now() + ARRIVAL);
        }
    }

    fn receive(&mut self, patience: Duration) -> Received {
        let mut bytes = [0; 4096];
        if self.stream.set_read_timeout(Some(patience)).is_err() {
            return Received::End;
        }
        match self.stream.read(&mut bytes) {
            Ok(0) => Received::End,
            Ok(count) => {
                self.held.extend(&bytes[..count]);
                Received::Some
            }
            Err(error) if error.kind() == ErrorKind::Interrupted => Received::Some,
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => Received::Nothing,
            Err(_) => Received::End,
        }
    }

    /// Sends an answer with lines for its head; false if the page is gone.
    pub(super) fn send(&mut self, (code, kind, text): &Answer, lines: &[(&str, &str)], keeps: bool) -> bool {
        let end = if keeps { "keep-alive" } else { "close" };
        let mut out =
            format!("HTTP/1.1 {code} {}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nConnection: {end}\r\n", reason(*code), text.len());
        lines.iter().for_each(|(name, value)| out.push_str(&format!("{name}: {value}\r\n")));
        out.push_str("\r\n");
        out.push_str(text);
        self.stream.write_all(out.as_bytes()).is_ok()
    }

    /// Closes behind an answer to a request that may not have been read to its end.
    pub(super) fn close(mut self) {
        if self.stream.shutdown(Shutdown::Write).is_err() {
            return;
        }
        let until = Instant::now() + Duration::from_secs(1);
        let mut swallowed = 0;
        while swallowed < SWALLOWED && Instant::now() < until {
            self.held.clear();
            match self.receive(Duration::from_millis(200)) {
                Received::Some => swallowed += self.held.len(),
                Received::Nothing | Received::End => return,
            }
        }
    }
}

/// What has come of waiting for bytes.
enum Received {
    Some,
    Nothing,
    End,
}

/// What a code means.
fn reason(code: u16) -> &'static str {
    match code {
        200 => "OK",
        400 => "Bad Request",
        403 => "Forbidden",
        404 => "Not Found",
        405 => "Method Not Allowed",
        408 => "Request Timeout",
        409 => "Conflict",
        411 => "Length Required",
        413 => "Content Too Large",
        431 => "Request Header Fields Too Large",
        _ => "Service Unavailable",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Option<(usize, usize, bool)>, u16> {
        let whole = |(head, request): (usize, Request)| Ok((head, request.length()?, request.keeps));
        Request::head(text.as_bytes()).and_then(|found| found.map(whole).transpose()).map_err(|(code, _): Refusal| code)
    }

    #[test]
    fn heads_are_read_in_one_way_or_refused() {
        let post = |lines: &str| read(&format!("POST /move HTTP/1.1\r\nHost: a\r\n{lines}\r\n"));
        assert_eq!(read("GET / HTTP/1.1\r\nHost: a\r\n\r\n"), Ok(Some((27, 0, true))));
        assert_eq!(read("GET / HTTP/1.1\r\nHost: a\r\n"), Ok(None));
        assert_eq!(read("GET / HTTP/1.0\r\n\r\n"), Ok(Some((18, 0, false))));
        assert_eq!(post("Content-Length: 12\r\n").map(|found| found.map(|(_, length, _)| length)), Ok(Some(12)));
        let refused = [
            ("Content-Length: 12\r\nContent-Length: 12\r\n", 400),
            ("Content-Length: 12, 12\r\n", 400),
            ("Content-Length: +12\r\n", 400),
            ("Content-Length: 0x1\r\n", 400),
            ("Content-Length : 12\r\n", 400),
            ("Content-Length: 99999\r\n", 413),
            ("Content-Length: 99999999999999999999999\r\n", 413),
            ("Content-Length: 5\r\nTransfer-Encoding: chunked\r\n", 400),
            ("Transfer-Encoding: identity\r\n", 400),
            (" folded: 1\r\n", 400),
            ("", 411),
        ];
        refused.iter().for_each(|(lines, code)| assert_eq!(post(lines), Err(*code), "{lines}"));
        assert_eq!(read("hello\r\n\r\n"), Err(400));
        assert_eq!(read(&format!("GET /{} HTTP/1.1\r\n", "a".repeat(HEAD))), Err(431));
        assert_eq!(read(&format!("GET / HTTP/1.1\r\n{}\r\n", "a: b\r\n".repeat(LINES + 1))), Err(431));
    }
}
