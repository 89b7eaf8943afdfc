//! glTF and DXF: their numbers beside those of the motion.

use super::{Place, SLIDER_CRANK, shot};
use grashof::output::Pace;
use serde_json::Value;

/// A top whose quaternion goes round, on a spring.
const TOP: &str = "grashof: 1
name: spinning-top
space: spatial
gravity: [0, 0, -9.81 m/s^2]
ground: { S: [0, 0, 1 m] }
bodies: { top: { disc: { radius: 0.3 m, mass: 1 kg }, points: { foot: [0, 0, -0.5 m], rim: [0.3 m, 0, 0] } } }
joints: { P: { spherical: [ground, top.foot] } }
springs: { coil: { between: [ground.S, top.rim], stiffness: 1 N/m, length: 0.5 m } }
start: { top.rotation: { axis: [1, 0, 0], angle: 40 deg }, top.wz: 30 rad/s }
studies: { spin: { dynamics: { until: 1 s, every: 10 ms } } }
";

/// A glTF document with its numbers.
struct Document {
    json: Value,
    bytes: Vec<u8>,
}

impl Document {
    /// Of the form `.glb`.
    fn packed(file: &[u8]) -> Self {
        let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
        assert_eq!((&file[..4], word(4), word(8)), (&b"glTF"[..], 2, file.len()));
        let text = word(12);
        assert_eq!((&file[16..20], text % 4, &file[24 + text..28 + text]), (&b"JSON"[..], 0, &b"BIN\0"[..]));
        assert_eq!(28 + text + word(20 + text), file.len());
        Self { json: serde_json::from_slice(&file[20..20 + text]).unwrap(), bytes: file[28 + text..].to_vec() }
    }

    /// The values of an accessor, flat, and its numbers to a value.
    fn values(&self, accessor: &Value) -> (Vec<f64>, usize) {
        let accessor = &self.json["accessors"][accessor.as_u64().unwrap() as usize];
        let view = &self.json["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
        let from = view["byteOffset"].as_u64().unwrap() as usize;
        let bytes = &self.bytes[from..from + view["byteLength"].as_u64().unwrap() as usize];
        let words = bytes.chunks_exact(4).map(|b| b.try_into().unwrap());
        let float = accessor["componentType"] == 5126;
        let values: Vec<f64> =
            words.map(|b| if float { f64::from(f32::from_le_bytes(b)) } else { f64::from(u32::from_le_bytes(b)) }).collect();
        let width = match accessor["type"].as_str().unwrap() {
            "SCALAR" => 1,
            "VEC3" => 3,
            "VEC4" => 4,
            other => panic!("{other}"),
        };
        assert_eq!(accessor["count"].as_u64().unwrap() as usize * width, values.len());
        for (key, pick) in [("min", f64::min as fn(f64, f64) -> f64), ("max", f64::max)] {
            for (i, bound) in accessor[key].as_array().into_iter().flatten().enumerate() {
                let found = values.iter().skip(i).step_by(width).copied().reduce(pick).unwrap();
                assert_eq!(found as f32, bound.as_f64().unwrap() as f32);
            }
        }
        (values, width)
    }

    /// The track of a node: its times and its values.
    fn track(&self, node: usize, path: &str) -> (Vec<f64>, Vec<f64>) {
        let animation = &self.json["animations"][0];
        let channels = animation["channels"].as_array().unwrap();
        let of = |c: &&Value| c["target"]["node"] == node && c["target"]["path"] == path;
        let channel = channels.iter().find(of).unwrap_or_else(|| panic!("no {path} of node {node}"));
        let sampler = &animation["samplers"][channel["sampler"].as_u64().unwrap() as usize];
        (self.values(&sampler["input"]).0, self.values(&sampler["output"]).0)
    }

    /// The node of a body or link; the root, which comes first, may have the same name.
    fn node(&self, name: &str) -> usize {
        self.json["nodes"].as_array().unwrap().iter().rposition(|node| node["name"] == name).unwrap()
    }
}

#[test]
fn a_motion_in_space_is_that_of_its_frames() {
    let place = Place::new("glb", TOP);
    let file = Document::packed(&place.made("export --study spin --rate 50 --gltf out.glb", "out.glb"));
    let (scene, _) = shot(TOP, "spin", Pace::Speed(1.0), 50.0, false);
    let top = file.node("top");
    let (times, places) = file.track(top, "translation");
    let (_, turns) = file.track(top, "rotation");
    assert_eq!((times[0], times[times.len() - 1]), (0.0, 1.0));
    assert!((0..=50).all(|k| times.iter().any(|t| (t - 0.02 * f64::from(k)).abs() < 1e-6)), "a key for each picture: {times:?}");
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]));
    for (k, (place, turn)) in places.chunks_exact(3).zip(turns.chunks_exact(4)).enumerate() {
        let pose = scene.frames.at(times[k], 3);
        assert!(place.iter().zip(&pose[..3]).all(|(a, b)| (a - b).abs() < 1e-6));
        // x, y, z, w there; w, x, y, z here
        assert!((0..4).all(|i| (turn[i] - pose[3 + (i + 1) % 4]).abs() < 2e-6), "{turn:?} {pose:?}");
        assert!((turn.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-6);
    }
    // the spring reaches from the ground to the rim
    let coil = file.node("coil");
    let (_, scales) = file.track(coil, "scale");
    let poses = scene.frames.at(times[20], 3);
    let [a, b] = [&scene.links[0].a, &scene.links[0].b].map(|end| scene.world(&poses, end));
    let length = (0..3).map(|i| (b[i] - a[i]).powi(2)).sum::<f64>().sqrt();
    assert!((scales[62] - length).abs() < 1e-6);
    // z becomes y
    let turn: Vec<f64> = file.json["nodes"][0]["rotation"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    assert!((turn[0] + 0.5_f64.sqrt()).abs() < 1e-12 && (turn[3] - 0.5_f64.sqrt()).abs() < 1e-12);
}

/// Between keys a viewer turns the shorter way: of a wheel at 1200 rpm they are so near that it turns as often as it does, and in its time.
#[test]
fn a_fast_wheel_turns_as_often_as_it_does() {
    let text = "grashof: 1
name: fast wheel
space: planar
gravity: none
bodies: { wheel: { disc: { radius: 0.1 m, mass: 1 kg } } }
joints: { O: { revolute: [ground, wheel.origin] } }
drivers: { drive: { joint: O, speed: 1200 rpm } }
studies:
  short: { kinematics: { over: 10 ms, samples: 10 } }
  long: { kinematics: { over: 1.05 s, samples: 10 } }
  whole: { kinematics: { over: 15 s, samples: 10 } }
  untimed: { kinematics: { over: 1 turn, samples: 10 }, columns: [O.angle] }
";
    let place = Place::new("fast", text);
    // at last with whole turns from picture to picture
    for (study, rate, duration) in [("short", 30, 0.01), ("long", 30, 1.05), ("whole", 10, 15.0)] {
        let words = format!("export --study {study} --rate {rate} --gltf {study}.glb");
        let file = Document::packed(&place.made(&words, &format!("{study}.glb")));
        let (times, turns) = file.track(file.node("wheel"), "rotation");
        assert!(times[0] == 0.0 && (times[times.len() - 1] - duration).abs() < 1e-6, "{study}: {times:?}");
        let turns: Vec<&[f64]> = turns.chunks_exact(4).collect();
        let step = |a: &[f64], b: &[f64]| 2.0 * (b[2] * a[3] - b[3] * a[2]).atan2(a[2] * b[2] + a[3] * b[3]);
        let steps = turns.windows(2).map(|pair| step(pair[0], pair[1]));
        let largest = steps.clone().fold(0.0, |m: f64, x| m.max(x.abs()));
        let turned = steps.sum::<f64>() / std::f64::consts::TAU;
        assert!(largest < 0.21 && (turned - duration * 20.0).abs() < 1e-4, "{study}: {turned} turns, by {largest} rad");
    }
    let run = place.run("export --study untimed --gltf untimed.glb");
    let said = String::from_utf8_lossy(&run.stderr);
    assert!(run.status.success() && said.contains("list `time` in `columns`"), "{said}");
}

/// A weight on a winch in space, whose drum turns about y.
const WINCH: &str = "grashof: 1
name: winch
space: spatial
gravity: none
ground: { O: [0, 0, 0], W: [-0.1 m, 0, -1 m] }
bodies: { drum: { disc: { radius: 0.1 m } }, weight: { mass: 1 kg } }
joints:
  S: { revolute: [ground.O, drum], axis: [0, 1, 0], to: [0, 0, 1] }
  W: { slider: [ground.W, weight], axis: [0, 0, 1] }
couplings: { rope: { rope: [S, W], radius: 0.1 m } }
drivers: { drive: { joint: S, speed: 1 rad/s } }
studies: { lift: { kinematics: { over: 2 s, samples: 10 } } }
";

#[test]
fn a_rope_reaches_from_its_drum_to_its_end() {
    let place = Place::new("rope", WINCH);
    let file = Document::packed(&place.made("export --study lift --rate 10 --gltf out.glb", "out.glb"));
    let rope = file.node("rope");
    let (times, places) = file.track(rope, "translation");
    let (_, scales) = file.track(rope, "scale");
    for (k, (place, scale)) in places.chunks_exact(3).zip(scales.chunks_exact(3)).enumerate() {
        // it leaves the drum on its left, and the weight rises by 0.1 m/s
        assert!((place[0] + 0.1).hypot(place[1]).hypot(place[2]) < 1e-6, "{place:?}");
        assert!((scale[2] - (1.0 - 0.1 * times[k])).abs() < 1e-6, "{} at {}", scale[2], times[k]);
    }
}

#[test]
fn meshes_have_bounds_and_unit_normals() {
    let place = Place::new("mesh", SLIDER_CRANK);
    let file = Document::packed(&place.made("export --study turn --gltf out.glb", "out.glb"));
    let meshes = file.json["meshes"].as_array().unwrap();
    assert!(meshes.len() >= 3);
    for primitive in meshes.iter().flat_map(|mesh| mesh["primitives"].as_array().unwrap()) {
        let (positions, _) = file.values(&primitive["attributes"]["POSITION"]);
        let (normals, _) = file.values(&primitive["attributes"]["NORMAL"]);
        let (indices, _) = file.values(&primitive["indices"]);
        assert_eq!(positions.len(), normals.len());
        assert!(normals.chunks_exact(3).all(|n| (n.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-5));
        assert!(indices.len() % 3 == 0 && indices.iter().all(|i| (*i as usize) < positions.len() / 3));
    }
    // a whole turn of the crank, clockwise: minus the unit quaternion at its end
    let (_, turns) = file.track(file.node("crank"), "rotation");
    let last = &turns[turns.len() - 4..];
    assert!(turns[..4].iter().zip(last).all(|(a, b)| (a + b).abs() < 1e-5), "{:?} {last:?}", &turns[..4]);
}

#[test]
fn text_has_the_same_numbers() {
    let place = Place::new("gltf", SLIDER_CRANK);
    place.made("export --study part --gltf out.gltf --dxf out.dxf", "out.gltf");
    let text: Value = serde_json::from_slice(&std::fs::read(place.0.join("out.gltf")).unwrap()).unwrap();
    let packed = Document::packed(&place.made("export --study part --gltf out.glb", "out.glb"));
    assert_eq!(text["accessors"], packed.json["accessors"]);
    let uri = text["buffers"][0]["uri"].as_str().unwrap();
    let data = uri.strip_prefix("data:application/octet-stream;base64,").unwrap();
    let length = text["buffers"][0]["byteLength"].as_u64().unwrap() as usize;
    assert_eq!(data.len(), length.div_ceil(3) * 4);
}

#[test]
fn a_drawing_has_its_layers_and_its_size() {
    let place = Place::new("dxf", SLIDER_CRANK);
    let text = String::from_utf8(place.made("export --study turn --dxf out.dxf", "out.dxf")).unwrap();
    let pairs: Vec<(&str, &str)> = text.lines().zip(text.lines().skip(1)).step_by(2).map(|(code, value)| (code.trim(), value)).collect();
    assert_eq!((pairs[0], pairs[pairs.len() - 1]), (("0", "SECTION"), ("0", "EOF")));
    for layer in ["GROUND", "BODIES", "JOINTS", "LINKS", "PATHS", "NAMES"] {
        assert!(pairs.windows(2).any(|w| w[0].0 == "0" && w[0].1 != "LAYER" && w[1] == ("8", layer)), "nothing on {layer}");
    }
    // the straight sides of the crank, 300 mm long
    let number = |pair: &(&str, &str)| pair.1.parse::<f64>().unwrap();
    let lines = pairs.windows(8).filter(|w| w[0] == ("0", "LINE") && w[1] == ("8", "BODIES"));
    let lengths: Vec<f64> = lines.map(|w| (number(&w[5]) - number(&w[2])).hypot(number(&w[6]) - number(&w[3]))).collect();
    assert_eq!(lengths.iter().filter(|length| (**length - 300.0).abs() < 1e-3).count(), 2, "{lengths:?}");
}

/// A bar of 400 mm along x, seen along it and across.
#[test]
fn a_drawing_in_space_is_seen_from_where_it_is_asked() {
    let arm = "grashof: 1
name: arm
space: spatial
gravity: none
bodies: { arm: { bar: { length: 40 cm, mass: 1 kg, width: 2 cm, height: 2 cm } } }
joints: { P: { revolute: [ground, arm.start], axis: [1, 0, 0] } }
drivers: { drive: { joint: P, speed: 60 rpm } }
studies: { turn: { kinematics: { over: 1 turn, samples: 36 }, columns: [arm.end.y] } }
";
    let place = Place::new("seen", arm);
    // along the arm, and across it
    for (view, long) in [("side", false), ("front", true), ("-90,0", true)] {
        let file = format!("from{}.dxf", view.replace(',', "_"));
        let text = String::from_utf8(place.made(&format!("export --study turn --dxf {file} --view {view}"), &file)).unwrap();
        let pairs: Vec<(&str, &str)> =
            text.lines().zip(text.lines().skip(1)).step_by(2).map(|(code, value)| (code.trim(), value)).collect();
        // how far it reaches to the right, mm
        let right = pairs.windows(2).find(|w| w[0] == ("9", "$EXTMAX")).map(|w| w[1].1.parse::<f64>().unwrap());
        assert_eq!(right.is_some_and(|right| right > 399.0), long, "{view}: {right:?}");
    }
}
