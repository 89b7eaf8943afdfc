//! What a request asks for, and whether it may.

use super::http::{Refusal, Request};
use serde_json::Value;

/// What a page knows.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Known {
    /// Number of the last change.
    pub(super) after: u64,
    /// Number of the model, if it wants a newer one with the answer.
    pub(super) model: Option<u64>,
    /// The study that it has in view, with the number of its result, if it wants a newer one with the answer.
    pub(super) study: Option<(String, u64)>,
}

/// What a page asks for.
#[derive(Debug, PartialEq)]
pub(super) enum Asked {
    /// The page itself.
    Page,
    /// What there is to know of the model.
    Model,
    /// What is newer than what it knows.
    State(Known),
    /// A study.
    Study(String),
    /// It has a study in view.
    View,
    /// A value is moved.
    Move,
    /// Values are taken back.
    Back,
    /// A value is written into the file.
    Write,
}

/// What a request asks for, if it comes from a page of ours.
pub(super) fn asked(request: &Request, port: u16, token: &str) -> Result<Asked, Refusal> {
    let own = [format!("127.0.0.1:{port}"), format!("localhost:{port}")];
    let host: Vec<&str> = request.header("Host").collect();
    if host.len() != 1 || !own.iter().any(|own| host[0].eq_ignore_ascii_case(own)) {
        return Err((403, "this address is served to 127.0.0.1 and localhost alone"));
    }
    let is_own = |origin: &str| origin.strip_prefix("http://").is_some_and(|host| own.iter().any(|own| host.eq_ignore_ascii_case(own)));
    if !request.header("Origin").all(is_own) {
        return Err((403, "another page may not ask"));
    }
    route(&request.method, &request.target, token)
}

/// What a method and an address ask for.
fn route(method: &str, url: &str, token: &str) -> Result<Asked, Refusal> {
    let (path, query) = url.split_once('?').unwrap_or((url, ""));
    let value = |name: &str| query.split('&').find_map(|part| part.split_once('=').filter(|(key, _)| *key == name)).map(|(_, value)| value);
    let gets = ["/", "/model", "/state", "/study"];
    let posts = ["/view", "/move", "/back", "/write"];
    match method {
        "GET" if gets.contains(&path) => {}
        "POST" if posts.contains(&path) => {}
        _ if gets.contains(&path) || posts.contains(&path) => return Err((405, "it is asked for otherwise")),
        _ => return Err((404, "there is nothing here")),
    }
    if !value("token").is_some_and(|given| is_equal(given.as_bytes(), token.as_bytes())) {
        return Err((403, "the token of the address is missing or wrong; take the whole address that `grashof watch` printed"));
    }
    Ok(match path {
        "/" => Asked::Page,
        "/model" => Asked::Model,
        "/state" => {
            let number = |name: &str| value(name).and_then(|number| number.parse().ok()).unwrap_or(0);
            let study = value("study").and_then(decoded).map(|study| (study, number("has")));
            Asked::State(Known { after: number("after"), model: value("model").and_then(|number| number.parse().ok()), study })
        }
        "/study" => Asked::Study(value("name").and_then(decoded).ok_or((404, "there is no such study"))?),
        "/view" => Asked::View,
        "/move" => Asked::Move,
        "/back" => Asked::Back,
        _ => Asked::Write,
    })
}

/// Whether two texts are equal, in a time that does not tell where they differ.
fn is_equal(a: &[u8], b: &[u8]) -> bool {
    a.len() == b.len() && a.iter().zip(b).fold(0, |differs, (x, y)| differs | (x ^ y)) == 0
}

/// Text of an address without its percent signs.
fn decoded(text: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((&first, behind)) = rest.split_first() {
        if first == b'%' {
            let digits = std::str::from_utf8(behind.get(..2)?).ok().filter(|digits| digits.bytes().all(|c| c.is_ascii_hexdigit()))?;
            bytes.push(u8::from_str_radix(digits, 16).ok()?);
            rest = &behind[2..];
        } else {
            bytes.push(first);
            rest = behind;
        }
    }
    String::from_utf8(bytes).ok()
}

/// A text of a page's message.
pub(super) fn text<'a>(message: &'a Value, name: &str) -> Option<&'a str> {
    message.get(name)?.as_str()
}

/// A finite number of a page's message.
pub(super) fn number(message: &Value, name: &str) -> Option<f64> {
    message.get(name)?.as_f64().filter(|number| number.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_known_and_secret() {
        let get = |url: &str| route("GET", url, "abc").map_err(|(code, _)| code);
        assert_eq!(get("/?token=abc"), Ok(Asked::Page));
        assert_eq!(get("/state?after=7&token=abc"), Ok(Asked::State(Known { after: 7, ..Known::default() })));
        let known = Known { after: 7, model: Some(3), study: Some(("a b".into(), 5)) };
        assert_eq!(get("/state?after=7&model=3&study=a%20b&has=5&token=abc"), Ok(Asked::State(known)));
        assert_eq!(get("/study?name=a%20b%C3%BC&token=abc"), Ok(Asked::Study("a bü".into())));
        assert_eq!([get("/"), get("/?token=abd"), get("/model?token=abcd"), get("/?token=")].map(Result::err), [Some(403); 4]);
        let missing =
            ["/../etc/passwd?token=abc", "/model/..?token=abc", "/%2e%2e/x?token=abc", "//?token=abc", "/study?name=%zz&token=abc"];
        missing.iter().for_each(|url| assert_eq!(get(url), Err(404), "{url}"));
        assert_eq!(get("/move?token=abc"), Err(405));
        assert_eq!(route("POST", "/move?token=abc", "abc"), Ok(Asked::Move));
    }
}
