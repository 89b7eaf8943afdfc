//! `grashof watch`: what it serves and to whom, and how it follows the file. Browsers are in `tests/browser`.

#![cfg(unix)]

use serde_json::{Value, json};
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::PathBuf;
use std::process::{Child, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

const MODEL: &str = "\
# a comment: ü
grashof: 1
name: pendulum
space: planar
gravity: [0, -9.81 m/s^2]
parameters:
  length:   50 cm   # of the rod
  mass: 2 kg
ground: { O: [0, 0] }
bodies: { rod: { bar: { length: length, mass: mass } } }
joints: { O: { revolute: [ground.O, rod.start] } }
start: { O.angle: -60 deg }   # it falls
measures: { phi: O.angle }
studies:
  swing: { dynamics: { until: 1 s, every: 0.1 s }, columns: [phi], scalars: { far: max(phi) } }
  rest: { statics: { from: start } }
  lengths:
    dynamics: { until: 1 s, every: 0.5 s }
    scalars: { far: max(phi) }
    sweep: { length: [20 cm, 40 cm, 80 cm] }
";
/// Slow machines, and builds without optimisation.
const PATIENCE: Duration = Duration::from_secs(30);

/// A watch of a model in a directory of its own; ended and removed at the end.
struct Watch {
    directory: PathBuf,
    child: Child,
    /// Kept open: nobody reads on, but a closed pipe is an event.
    _out: BufReader<ChildStdout>,
    port: u16,
    token: String,
}

/// An answer: code, head and body.
struct Answer(u16, String, String);

impl Watch {
    fn new(name: &str, more: &[&str]) -> Self {
        let directory = std::env::temp_dir().join(format!("grashof-watch-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&directory);
        fs::create_dir_all(&directory).unwrap();
        fs::write(directory.join("model.yaml"), MODEL).unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_grashof"));
        command.args(["watch", "model.yaml", "-q", "-j", "1"]).args(more).current_dir(&directory);
        let mut child = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
        let mut out = BufReader::new(child.stdout.take().unwrap());
        let mut line = String::new();
        out.read_line(&mut line).unwrap();
        let rest = line.trim().strip_prefix("http://127.0.0.1:").unwrap();
        let (port, token) = rest.split_once("/?token=").unwrap();
        assert!(token.len() == 32 && token.bytes().all(|c| c.is_ascii_hexdigit()), "{token}");
        Self { directory, child, _out: out, port: port.parse().unwrap(), token: token.into() }
    }

    fn put(&self, text: &str) {
        fs::write(self.directory.join("model.yaml"), text).unwrap();
    }

    fn text(&self) -> String {
        fs::read_to_string(self.directory.join("model.yaml")).unwrap()
    }

    /// Sends a request as it is, with lines of its head.
    fn raw(&self, method: &str, target: &str, head: &[&str], body: &str) -> Answer {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        let mut text = format!("{method} {target} HTTP/1.1\r\nConnection: close\r\nContent-Length: {}\r\n", body.len());
        head.iter().for_each(|line| text.push_str(&format!("{line}\r\n")));
        stream.write_all(format!("{text}\r\n{body}").as_bytes()).unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        let answer = String::from_utf8_lossy(&answer).into_owned();
        let (head, body) = answer.split_once("\r\n\r\n").unwrap();
        Answer(head.split(' ').nth(1).unwrap().parse().unwrap(), head.to_lowercase(), body.into())
    }

    fn own(&self) -> String {
        format!("Host: 127.0.0.1:{}", self.port)
    }

    fn with_token(&self, path: &str) -> String {
        format!("{path}{}token={}", if path.contains('?') { "&" } else { "?" }, self.token)
    }

    fn get(&self, path: &str) -> Answer {
        // without chunks the body stands as it is
        self.raw("GET", &self.with_token(path), &[&self.own(), "TE: identity"], "")
    }

    fn post(&self, path: &str, message: &Value) -> Answer {
        self.raw("POST", &self.with_token(path), &[&self.own()], &message.to_string())
    }

    fn state(&self, after: u64) -> Value {
        let Answer(code, _, body) = self.get(&format!("/state?after={after}"));
        assert_eq!(code, 200, "{body}");
        body_of(&body)
    }

    /// The first state for which something holds.
    #[track_caller]
    fn until(&self, what: &str, holds: impl Fn(&Value) -> bool) -> Value {
        let begun = Instant::now();
        let mut state = self.state(0);
        while !holds(&state) {
            assert!(begun.elapsed() < PATIENCE, "{what}: {state}");
            state = self.state(state["version"].as_u64().unwrap());
        }
        state
    }

    fn until_done(&self) -> Value {
        self.until("all is computed", |state| studies(state).iter().all(|s| s["stale"] == false) && no_fault(state))
    }

    /// The largest angle of the swing.
    fn far(&self) -> f64 {
        let study = body_of(&self.get("/study?name=swing").2)["study"].clone();
        study["scalars"].as_array().unwrap().iter().find(|s| s["name"] == "far").unwrap()["value"].as_f64().unwrap()
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
        let _ = fs::remove_dir_all(&self.directory);
    }
}

/// JSON of a body, whole or in chunks.
fn body_of(body: &str) -> Value {
    if let Ok(value) = serde_json::from_str(body) {
        return value;
    }
    let (mut rest, mut whole) = (body, String::new());
    while let Some((length, behind)) = rest.split_once("\r\n") {
        let length = usize::from_str_radix(length.trim(), 16).unwrap();
        whole.push_str(&behind[..length]);
        rest = behind.get(length + 2..).unwrap_or_default();
    }
    serde_json::from_str(&whole).unwrap()
}

fn studies(state: &Value) -> &Vec<Value> {
    state["studies"].as_array().unwrap()
}

fn study<'a>(state: &'a Value, name: &str) -> &'a Value {
    studies(state).iter().find(|s| s["name"] == name).unwrap()
}

fn no_fault(state: &Value) -> bool {
    state["away"].is_null() && state["broken"].as_array().unwrap().is_empty()
}

fn value<'a>(state: &'a Value, place: &str) -> &'a Value {
    state["values"].as_array().unwrap().iter().find(|v| v["place"] == place).unwrap()
}

#[test]
fn only_its_own_page_is_served_and_to_itself() {
    let watch = Watch::new("who", &[]);
    let Answer(code, head, body) = watch.get("/");
    assert_eq!(code, 200);
    assert!(head.contains("cache-control: no-store") && head.contains("connect-src 'self'") && head.contains("frame-ancestors 'none'"));
    assert!(body.contains("<div id=\"page\">"));
    let own = watch.own();
    let with = |host: &str, more: &[&str]| watch.raw("GET", &watch.with_token("/model"), &[&[host], more].concat(), "").0;
    let origin = |host: &str| format!("Origin: http://{host}:{}", watch.port);
    assert_eq!([with(&own, &[]), with(&format!("Host: localhost:{}", watch.port), &[&origin("localhost")])], [200; 2]);
    let foreign = ["Host: 127.0.0.1".into(), format!("Host: evil.example:{}", watch.port), "X-Nothing: 1".into()];
    foreign.iter().for_each(|host| assert_eq!(with(host, &[]), 403, "{host}"));
    for foreign in
        ["Origin: null", "Origin: http://evil.example", &origin("evil.example"), &format!("Origin: https://127.0.0.1:{}", watch.port)]
    {
        assert_eq!(with(&own, &[foreign]), 403, "{foreign}");
    }
    for target in ["/", "/model", "/state?after=0", "/?token=", "/?token=00000000000000000000000000000000", "/study?name=swing"] {
        assert_eq!(watch.raw("GET", target, &[&own], "").0, 403, "{target}");
    }
    assert_eq!(watch.raw("POST", "/move", &[&own], "{}").0, 403);
    for path in ["/../etc/passwd", "/..", "/model.yaml", "/%2e%2e/model.yaml", "/study?name=..", "/study?name=nobody"] {
        assert_eq!(watch.get(path).0, 404, "{path}");
    }
    assert_eq!([watch.get("/move").0, watch.post("/", &json!({})).0], [405; 2]);
    let bad = [json!({ "place": "parameters.length", "value": "1" }), json!({ "value": 1 }), json!(null)];
    bad.iter().for_each(|message| assert_eq!(watch.post("/move", message).0, 400, "{message}"));
    assert_eq!(watch.raw("POST", &watch.with_token("/move"), &[&own], &" ".repeat(20_000)).0, 413);
    assert_eq!(watch.raw("POST", &watch.with_token("/back"), &[&own, "Transfer-Encoding: chunked"], "0\r\n\r\n").0, 400);
    assert_eq!(watch.text(), MODEL);
}

#[test]
fn a_changed_file_is_computed_again() {
    let watch = Watch::new("changed", &["--study", "rest"]);
    let state = watch.until_done();
    assert_eq!((&state["first"], studies(&state).len()), (&json!("rest"), 3));
    assert_eq!(study(&state, "lengths")["bad"], false);
    let before = watch.far();
    // the same bytes again change nothing
    watch.put(MODEL);
    watch.put(&MODEL.replace("-60 deg", "-80 deg"));
    watch.until("the start is another", |state| value(state, "start.O.angle")["number"] == -80.0);
    watch.until_done();
    assert!((watch.far() - before).abs() > 0.1);
    // a study more, by an editor that renames
    let longer = format!("{MODEL}  again: {{ statics: {{ from: start }} }}\n");
    fs::write(watch.directory.join("model.yaml~"), longer).unwrap();
    fs::rename(watch.directory.join("model.yaml~"), watch.directory.join("model.yaml")).unwrap();
    watch.until("there is a study more", |state| studies(state).len() == 4 && study(state, "again")["version"].as_u64() > Some(0));
    // by one that deletes and writes
    fs::remove_file(watch.directory.join("model.yaml")).unwrap();
    watch.put(MODEL);
    watch.until("there is a study less", |state| studies(state).len() == 3);
    watch.until_done();
    assert_eq!(watch.far(), before);
}

#[test]
fn a_broken_file_is_told_and_the_last_result_stays() {
    let watch = Watch::new("broken", &[]);
    watch.until_done();
    let before = watch.far();
    watch.put(&MODEL.replace("parameters:", "parameters: ["));
    let state = watch.until("it does not read", |state| !no_fault(state));
    let finding = &state["broken"][0];
    assert!(finding["text"].as_str().unwrap().contains("model.yaml:") && finding["line"].as_u64() > Some(5), "{finding}");
    assert_eq!(watch.far(), before);
    // it reads, but says nothing of sense
    watch.put(&MODEL.replace("max(phi) } }", "max(psi) } }"));
    let state = watch.until("the study is wrong", |state| no_fault(state) && study(state, "swing")["bad"] == true);
    assert!(study(&state, "swing")["findings"][0]["text"].as_str().unwrap().contains("psi"));
    assert_eq!(watch.far(), before);
    fs::remove_file(watch.directory.join("model.yaml")).unwrap();
    watch.until("it is away", |state| !state["away"].is_null());
    assert_eq!(watch.far(), before);
    watch.put(MODEL);
    let state = watch.until_done();
    assert_eq!((&study(&state, "swing")["findings"], &state["findings"]), (&json!([]), &json!([])));
}

#[test]
fn a_hundred_saves_leave_the_last_one() {
    let watch = Watch::new("hundred", &[]);
    watch.until_done();
    let memory = || {
        let status = fs::read_to_string(format!("/proc/{}/status", watch.child.id())).unwrap_or_default();
        let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap_or("0 kB").trim().to_string();
        line.split(' ').next().unwrap().parse::<u64>().unwrap()
    };
    let mut early = 0;
    for i in 1..=100 {
        watch.put(&MODEL.replace("-60 deg", &format!("-{i} deg")));
        std::thread::sleep(Duration::from_millis(100));
        if i == 20 {
            early = memory();
        }
    }
    watch.until("the last one is read", |state| value(state, "start.O.angle")["number"] == -100.0);
    watch.until_done();
    assert!(memory() < early + 32_000, "{early} kB at the beginning, {} kB at the end", memory());
}

#[test]
fn values_are_moved_and_written_back() {
    let watch = Watch::new("values", &[]);
    let state = watch.until_done();
    let before = watch.far();
    let length = value(&state, "parameters.length");
    // the sweep says how far it may go
    let near = |x: &Value, wanted: f64| (x.as_f64().unwrap() - wanted).abs() < 1e-9;
    assert!(length["unit"] == "cm" && near(&length["low"], 20.0) && near(&length["high"], 80.0), "{length}");
    assert_eq!([&value(&state, "parameters.mass")["low"], &value(&state, "parameters.mass")["high"]], [&json!(1.0), &json!(4.0)]);
    let moved = |place: &str, to: f64| assert_eq!(watch.post("/move", &json!({ "place": place, "value": to })).0, 200);
    moved("parameters.length", 62.5);
    moved("start.O.angle", -30.0);
    let state = watch.until_done();
    assert_eq!([&value(&state, "parameters.length")["value"], &state["moved"]], [&json!(62.5), &json!(true)]);
    assert!((watch.far() - before).abs() > 0.1);
    assert_eq!((watch.text().as_str(), watch.post("/move", &json!({ "place": "parameters.l", "value": 1 })).0), (MODEL, 404));
    // one is written: all other bytes stay
    assert_eq!(watch.post("/write", &json!({ "place": "parameters.length" })).0, 200);
    let wanted = MODEL.replace("  50 cm", "  62.5 cm");
    assert_eq!(watch.text(), wanted);
    let state = watch.until("it was read", |state| value(state, "parameters.length")["number"] == 62.5);
    assert_eq!(value(&state, "start.O.angle")["value"], -30.0);
    // a file that has changed under the page is left alone
    let other = wanted.replace("-60 deg", "-61 deg");
    watch.put(&other);
    let Answer(code, _, body) = watch.post("/write", &json!({ "place": "start.O.angle", "value": -20.0 }));
    assert_eq!((code, watch.text()), (409, other), "{body}");
    assert!(body.contains("changed meanwhile"), "{body}");
    // what the file says anew counts
    watch.until("it was read", |state| value(state, "start.O.angle")["value"] == -61.0 && state["moved"] == false);
    moved("parameters.mass", 3.0);
    assert_eq!(watch.post("/back", &json!({})).0, 200);
    watch.until("all is back", |state| state["moved"] == false);
}

#[test]
fn it_ends_at_once_and_ports_are_its_own() {
    let taken = TcpListener::bind(("127.0.0.1", 0)).unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    let mut watch = Watch::new("ends", &[]);
    let refused = |more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_grashof"));
        let output = command.arg("watch").args(more).current_dir(&watch.directory).output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    let (code, text) = refused(&["model.yaml", "--port", &port]);
    assert!(code == Some(2) && text.contains(&port) && text.contains("help: name another port"), "{text}");
    for wrong in [&["-"][..], &["nothing.yaml"], &["model.yaml", "--study", "nobody"], &["model.yaml", "--set", "mass"]] {
        assert_eq!(refused(wrong).0, Some(2), "{wrong:?}");
    }
    // beside one that waits for news
    let mut waiting = TcpStream::connect(("127.0.0.1", watch.port)).unwrap();
    write!(waiting, "GET {} HTTP/1.1\r\n{}\r\n\r\n", watch.with_token("/state?after=1000000"), watch.own()).unwrap();
    std::thread::sleep(Duration::from_millis(200));
    let sent = Instant::now();
    assert!(Command::new("kill").args(["-INT", &watch.child.id().to_string()]).status().unwrap().success());
    let status = watch.child.wait().unwrap();
    assert_eq!(status.code(), Some(130));
    assert!(sent.elapsed() < PATIENCE, "{:?}", sent.elapsed());
}

#[test]
fn answers_bring_what_a_page_lacks_over_one_connection() {
    let watch = Watch::new("brings", &["--study", "swing"]);
    let state = watch.until_done();
    let (model, swing) = (state["model"].as_u64().unwrap(), study(&state, "swing")["version"].as_u64().unwrap());
    let mut stream = TcpStream::connect(("127.0.0.1", watch.port)).unwrap();
    stream.set_read_timeout(Some(PATIENCE)).unwrap();
    let mut reader = BufReader::new(stream.try_clone().unwrap());
    let mut asked = |model: u64, swing: u64| -> Value {
        let target = watch.with_token(&format!("/state?after=0&model={model}&study=swing&has={swing}"));
        write!(stream, "GET {target} HTTP/1.1\r\n{}\r\n\r\n", watch.own()).unwrap();
        let mut length = 0;
        loop {
            let mut line = String::new();
            reader.read_line(&mut line).unwrap();
            if let Some(value) = line.to_lowercase().strip_prefix("content-length:") {
                length = value.trim().parse().unwrap();
            }
            if line.trim().is_empty() {
                break;
            }
        }
        let mut body = vec![0; length];
        reader.read_exact(&mut body).unwrap();
        serde_json::from_slice(&body).unwrap()
    };
    let all = asked(0, 0);
    assert_eq!((&all["result"]["study"], &all["head"]["model"]["source"]), (&json!("swing"), &json!(MODEL)));
    let none = asked(model, swing);
    assert!(none.get("result").is_none() && none.get("head").is_none(), "{none}");
}

#[test]
fn requests_that_could_be_read_in_two_ways_are_refused() {
    let watch = Watch::new("two-ways", &[]);
    let (own, target) = (watch.own(), watch.with_token("/back"));
    for line in ["Content-Length: 2", "Content-Length: 3", "Transfer-Encoding: chunked", "Content-Length : 2"] {
        assert_eq!(watch.raw("POST", &target, &[&own, line], "{}").0, 400, "{line}");
    }
    assert_eq!(watch.raw("GET", &watch.with_token("/model"), &[&own, &format!("X: {}", "a".repeat(20_000))], "").0, 431);
}
