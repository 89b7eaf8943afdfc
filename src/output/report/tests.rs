use super::*;
use crate::results::{Column, Results, Table};
use flate2::read::GzDecoder;
use serde_json::Value;
use std::io::Read;

/// What stands in a page between two texts.
fn between<'a>(page: &'a str, from: &str, to: &str) -> &'a str {
    page.split_once(from).unwrap().1.split_once(to).unwrap().0
}

/// The bytes of base64 text.
fn bytes(text: &str) -> Vec<u8> {
    let value = |c: u8| match c {
        b'A'..=b'Z' => c - b'A',
        b'a'..=b'z' => c - b'a' + 26,
        b'0'..=b'9' => c - b'0' + 52,
        b'+' => 62,
        _ => 63,
    };
    let mut out = Vec::new();
    for group in text.trim_end_matches('=').as_bytes().chunks(4) {
        let bits = group.iter().fold(0u32, |bits, c| bits << 6 | u32::from(value(*c))) << (6 * (4 - group.len()));
        out.extend(bits.to_be_bytes()[1..group.len()].iter());
    }
    out
}

fn page() -> String {
    let column = |name: &str, values: Vec<f64>| Column { name: name.into(), values, ..Column::default() };
    let results = Results {
        study: "turn".into(),
        independent: column("t", vec![0.0, 0.5, 1.0]),
        table: Table { columns: vec![column("y", vec![1.0, f64::NAN, 3.0])], ..Table::default() },
        ..Results::default()
    };
    let overview = [("bodies".to_string(), "3".to_string())];
    let model = ReportModel { name: "a < b & \"c\"", path: "a.yaml", source: "name: </script>", about: " ", overview: &overview };
    let mut report = Report::new(&model);
    report.add(&ReportStudy::of(&results, "two\n words "));
    report.add(&ReportStudy::of(&results, ""));
    String::from_utf8(report.html()).unwrap()
}

#[test]
fn the_data_of_a_page_read_back() {
    let page = page();
    let data = bytes(between(&page, "id=\"data\">", "</script>"));
    let mut text = String::new();
    GzDecoder::new(&data[..]).read_to_string(&mut text).unwrap();
    let data: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(data["model"]["source"], "name: </script>");
    assert_eq!((&data["model"]["about"], &data["overview"][0]["label"]), (&Value::Null, &json!("bodies")));
    assert_eq!(data["studies"].as_array().unwrap().len(), 2);
    assert_eq!(data["studies"][0]["about"], "two words");
    assert_eq!(data["studies"][0]["table"]["columns"][0]["values"], json!([1, null, 3]));
    assert_eq!(data["studies"][0]["rows"]["breaks"], json!([0, 1]));
}

#[test]
fn scenes_have_the_colours_faces_and_view_of_the_figures() {
    use crate::results::Scene;
    use crate::results::scene::{Body, Shape};
    let points = (0..8).map(|k| vec![f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2)]).collect();
    let bodies = vec![Body::default(), Body { name: "b".into(), shapes: vec![Shape::Hull { points }] }];
    let scene = Scene { dimensions: 3, up: [0.0, 0.0, 2.0], bodies, ..Scene::default() };
    let results = Results { scenes: vec![("mechanism".into(), scene)], ..Results::default() };
    let study: Value = serde_json::from_str(ReportStudy::of(&results, "").json()).unwrap();
    let scene = &study["scenes"][0][1];
    assert_eq!(scene["bodies"][1]["color"], "#a3beda");
    assert_eq!(scene["bodies"][1]["shapes"][0]["faces"].as_array().map(Vec::len), Some(6));
    assert_eq!(scene["view"]["level"], json!([[1, 0, 0], [0, 1, 0]]));
    assert_eq!(scene["view"]["azimuth"], json!(std::f64::consts::FRAC_PI_4));
}

#[test]
fn a_page_is_whole_and_asks_for_nothing() {
    let page = page();
    assert_eq!(between(&page, "<title>", "</title>"), "a &lt; b &amp; &quot;c&quot;");
    // names of XML vocabularies are no addresses
    let page = page.replace("http://www.w3.org/2000/svg", "");
    for request in ["http://", "https://", "@import", "src=", "<base", "<iframe"] {
        assert!(!page.contains(request), "{request}");
    }
    assert!(page.contains("Content-Security-Policy\" content=\"default-src 'none'"));
    assert_eq!(page.matches("<script").count(), 2, "no scripts of space without a mechanism in space");
}
