//! A mechanism in motion as glTF 2.0: a node for each body with a mesh of its shapes, and an animation of places and turns.
//!
//! Lengths are metres. The root turns the upward direction of the scene to y, as viewers have it. A mechanism of the plane is given
//! thickness, its bodies in layers one over the other.

mod buffer;
mod links;
mod mesh;
mod shapes;
mod solids;

use super::report::base64;
use super::scene::Color;
use super::sheet::body_color;
use super::{Shot, posed};
use crate::results::Scene;
use buffer::Buffer;
use mesh::Mesh;
use serde_json::{Value, json};
use shapes::Builder;

/// Colours of joints, and of springs, dampers and rods.
const JOINT: Color = [70, 70, 76];
const LINK: Color = [150, 60, 20];

/// Most that a body turns between two keys, rad: the middle of a chord is then half a hundredth of its radius off.
const LARGEST_TURN: f64 = 0.2;

/// The bytes of a glTF file of a motion; `binary` for the form `.glb`, else text with its numbers within.
#[must_use]
pub fn write_gltf(model: &str, study: &str, name: &str, scene: &Scene, shot: &Shot, binary: bool) -> Vec<u8> {
    let mut file = File { buffer: Buffer::default(), nodes: Vec::new(), meshes: Vec::new(), channels: Vec::new(), samplers: Vec::new() };
    // viewers turn the shorter way between two keys, and shift along a straight line
    let keys = shot.keys(LARGEST_TURN, |from, to| turned(scene, from, to));
    let frames: Vec<Vec<f64>> = keys.iter().map(|(_, x)| scene.frames.at(*x, scene.dimensions)).collect();
    file.nodes.push(Value::Null);
    let seconds: Vec<[f64; 1]> = keys.iter().map(|(part, _)| [part * shot.exact]).collect();
    let times = file.buffer.floats(&seconds, None, true);
    file.bodies(scene, &frames, times);
    let unit = file.meshes.len();
    let moving = links::moving(scene, &frames);
    if let (false, Some(first)) = (moving.is_empty(), frames.first()) {
        let builder = Builder::new(scene, first);
        file.mesh("link", &[(&links::unit(&builder), scene.bodies.len() + 1)]);
        if moving.iter().any(|link| link.coil) {
            file.mesh("spring", &[(&links::unit_coil(&builder), scene.bodies.len() + 1)]);
        }
    }
    for link in moving {
        let tracks =
            [("translation", file.floats(&link.places)), ("rotation", file.floats(&link.turns)), ("scale", file.floats(&link.scales))];
        let mesh = unit + usize::from(link.coil);
        let node = json!({ "name": link.name, "mesh": mesh, "translation": link.places[0], "rotation": link.turns[0],
            "scale": link.scales[0] });
        file.moving(node, times, &tracks);
    }
    let children: Vec<usize> = (1..file.nodes.len()).collect();
    file.nodes[0] = json!({ "name": model, "rotation": links::arc(scene.up, [0.0, 1.0, 0.0]), "children": children });
    let title = posed::title("", study, name, &scene.caption);
    file.bytes(&title, materials(scene), binary)
}

/// By how much the body that turns most does so between two values of the independent variable, rad: from frame to frame in between.
fn turned(scene: &Scene, from: f64, to: f64) -> f64 {
    let [low, high] = [from.min(to), from.max(to)];
    let at = &scene.frames.at;
    let between = at.partition_point(|x| *x <= low)..at.partition_point(|x| *x < high);
    let places = [low].into_iter().chain(at.get(between).unwrap_or_default().iter().copied()).chain([high]);
    let all: Vec<Vec<f64>> = places.map(|x| scene.frames.at(x, scene.dimensions)).collect();
    let stride = scene.stride();
    let of_body = |body: usize| {
        let pose = body * stride..(body + 1) * stride;
        all.windows(2).map(|pair| posed::traces::turned(&pair[0][pose.clone()], &pair[1][pose.clone()])).sum::<f64>()
    };
    (0..scene.width() / stride).map(of_body).fold(0.0, f64::max)
}

/// One colour for each body, then those of joints and links.
fn materials(scene: &Scene) -> Vec<Value> {
    let bodies = scene.bodies.iter().enumerate().map(|(index, body)| (body.name.as_str(), body_color(index)));
    let all = bodies.chain([("joints", JOINT), ("links", LINK)]);
    // files have light, not the numbers of screens
    let linear = |c: u8| ((f64::from(c) / 255.0).powf(2.2) * 1e4).round() / 1e4;
    let material = |(name, [r, g, b]): (&str, Color)| {
        let color = [linear(r), linear(g), linear(b), 1.0];
        json!({ "name": name, "pbrMetallicRoughness": { "baseColorFactor": color, "metallicFactor": 0.1, "roughnessFactor": 0.7 } })
    };
    all.map(material).collect()
}

/// A file while it is made.
struct File {
    buffer: Buffer,
    nodes: Vec<Value>,
    meshes: Vec<Value>,
    channels: Vec<Value>,
    samplers: Vec<Value>,
}

impl File {
    /// Nodes and meshes of all bodies.
    fn bodies(&mut self, scene: &Scene, frames: &[Vec<f64>], times: usize) {
        let Some(first) = frames.first() else { return };
        let builder = Builder::new(scene, first);
        for (index, body) in scene.bodies.iter().enumerate() {
            let (own, pins) = (builder.body(index), builder.pins(index));
            let parts: Vec<(&Mesh, usize)> =
                [(&own, index), (&pins, scene.bodies.len())].into_iter().filter(|(mesh, _)| !mesh.is_empty()).collect();
            let mut node = json!({ "name": body.name });
            if !parts.is_empty() {
                node["mesh"] = self.mesh(&body.name, &parts).into();
            }
            let Some(before) = index.checked_sub(1) else {
                self.nodes.push(node);
                continue;
            };
            let stride = scene.stride();
            let poses = || frames.iter().map(|poses| &poses[before * stride..(before + 1) * stride]);
            let places: Vec<[f64; 3]> = poses().map(place).collect();
            let turns: Vec<[f64; 4]> = poses().map(turn).collect();
            node["translation"] = json!(places[0]);
            node["rotation"] = json!(turns[0]);
            let tracks = [("translation", self.floats(&places)), ("rotation", self.floats(&turns))];
            self.moving(node, times, &tracks);
        }
    }

    fn floats<const N: usize>(&mut self, values: &[[f64; N]]) -> usize {
        self.buffer.floats(values, None, false)
    }

    /// A mesh of parts with their materials; gives its number.
    fn mesh(&mut self, name: &str, parts: &[(&Mesh, usize)]) -> usize {
        let primitives: Vec<Value> = parts
            .iter()
            .map(|(mesh, material)| {
                let position = self.buffer.floats(&mesh.positions, Some(buffer::VERTICES), true);
                let normal = self.buffer.floats(&mesh.normals, Some(buffer::VERTICES), false);
                let indices = self.buffer.indices(&mesh.indices);
                json!({ "attributes": { "POSITION": position, "NORMAL": normal }, "indices": indices, "material": material })
            })
            .collect();
        self.meshes.push(json!({ "name": name, "primitives": primitives }));
        self.meshes.len() - 1
    }

    /// Adds a node that moves by tracks: what each moves, and the accessor of its values.
    fn moving(&mut self, node: Value, times: usize, tracks: &[(&str, usize)]) {
        for (path, output) in tracks {
            self.channels.push(json!({ "sampler": self.samplers.len(), "target": { "node": self.nodes.len(), "path": path } }));
            self.samplers.push(json!({ "input": times, "output": output, "interpolation": "LINEAR" }));
        }
        self.nodes.push(node);
    }

    fn bytes(self, title: &str, materials: Vec<Value>, binary: bool) -> Vec<u8> {
        let data = self.buffer.bytes;
        let mut whole = json!({
            "asset": { "version": "2.0", "generator": concat!("Grashof ", env!("CARGO_PKG_VERSION")) },
            "scene": 0,
            "scenes": [{ "nodes": [0] }],
            "nodes": self.nodes,
            "materials": materials,
            "accessors": self.buffer.accessors,
            "bufferViews": self.buffer.views,
            "buffers": [{ "byteLength": data.len() }],
        });
        if !self.meshes.is_empty() {
            whole["meshes"] = self.meshes.into();
        }
        if !self.channels.is_empty() {
            whole["animations"] = json!([{ "name": title, "channels": self.channels, "samplers": self.samplers }]);
        }
        if binary {
            return packed(&whole, data);
        }
        whole["buffers"][0]["uri"] = format!("data:application/octet-stream;base64,{}", base64(&data)).into();
        (whole.to_string() + "\n").into_bytes()
    }
}

/// The form `.glb`: text and numbers in one file, each filled up to whole words.
fn packed(whole: &Value, mut data: Vec<u8>) -> Vec<u8> {
    let mut text = whole.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    data.resize(data.len().next_multiple_of(4), 0);
    let word = |n: usize| (n as u32).to_le_bytes();
    let mut out = b"glTF".to_vec();
    out.extend(word(2));
    out.extend(word(12 + 8 + text.len() + 8 + data.len()));
    for (name, chunk) in [(b"JSON", text), (b"BIN\0", data)] {
        out.extend(word(chunk.len()));
        out.extend(name);
        out.extend(chunk);
    }
    out
}

/// The place of a pose, m.
fn place(pose: &[f64]) -> [f64; 3] {
    if let [x, y, _] = *pose { [x, y, 0.0] } else { [pose[0], pose[1], pose[2]] }
}

/// The turn of a pose as a unit quaternion x, y, z, w.
fn turn(pose: &[f64]) -> [f64; 4] {
    if let [_, _, angle] = *pose {
        let (s, c) = (0.5 * angle).sin_cos();
        return [0.0, 0.0, s, c];
    }
    [pose[4], pose[5], pose[6], pose[3]]
}
