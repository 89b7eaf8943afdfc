//! `grashof check`: a look at a model before it moves.

use super::{Common, code, files, print_out};
use grashof::api::explained;
use grashof::expression::{Id, Node, parse_unit};
use grashof::kinematics::mobility::Grashof;
use grashof::kinematics::survey::{Survey, survey};
use grashof::model::{Document, Kind, Model, Quantity};
use grashof::output::{json_number, json_numbers};
use grashof::studies::common::case::parameters;
use grashof::studies::loader::quickly;
use grashof::studies::rehearsal::{Hindrance, rehearse};
use serde_json::{Value, json};
use std::collections::HashSet;

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Model file, or `-` for stdin
    model: String,
    /// Exit with 1 if there is any finding
    #[arg(long)]
    strict: bool,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
}

/// Checks a model.
pub(super) fn check(arguments: &Arguments, common: &Common) -> u8 {
    let Some((document, selection, report)) = files::sound(&arguments.model, common) else { return code::INPUT };
    let model = match document.model(&selection) {
        Ok(model) => model,
        Err(report) => {
            files::print(&report, common);
            return code::INPUT;
        }
    };
    let survey = match survey(&model, &parameters(&model)) {
        Ok(survey) => survey,
        Err(failure) => return files::explain(&document, &failure, "", common),
    };
    let mut findings: Vec<String> = report.diagnostics.iter().map(|d| d.message.clone()).collect();
    findings.extend(remarks(&survey, model.drivers.len()));
    if let names @ [_, ..] = &document.unused_parameters()[..] {
        let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
        let (word, it) = if names.len() == 1 { ("parameter", "it") } else { ("parameters", "them") };
        findings.push(format!("nothing uses the {word} {}: no result changes with {it}", names.join(", ")));
    }
    findings.extend(document.study_names().iter().filter_map(|study| hindered(&document, study, common)));
    if arguments.json {
        let mut all = as_json(&model, &survey, &findings);
        all["notes"] = document.notes().into();
        print_out(&serde_json::to_string_pretty(&all).unwrap_or_default());
    } else {
        print(&model, &survey, &findings, &document);
        print_notes(&document.notes());
    }
    if arguments.strict && !findings.is_empty() { code::UNMET } else { code::DONE }
}

/// What would keep a study from running; none for a study whose parameters others have long to compute.
fn hindered(document: &Document, study: &str, common: &Common) -> Option<String> {
    let selection = files::selection(common, Some(study))?;
    let model = match quickly(document, &selection) {
        Ok(model) => model?,
        Err(hindrance) => return Some(hindrance),
    };
    let asked = model.study.as_ref()?;
    if let Err(Hindrance { at, failure }) = rehearse(&model, asked) {
        let at: Vec<String> = at.iter().map(|(name, x)| format!("{name} = {x}")).collect();
        let at = if at.is_empty() { String::new() } else { format!(" at {}", at.join(", ")) };
        let help = explained(document, study, &failure).diagnostics.into_iter().find_map(|diagnostic| diagnostic.help);
        let help = help.filter(|help| !help.is_empty()).map_or_else(String::new, |help| format!("; {help}"));
        return Some(format!("study `{study}`{at}: {}{help}", failure.reason()));
    }
    let values = parameters(&model);
    let pulls = !(model.loads.is_empty() && model.springs.is_empty() && model.motors.is_empty());
    if !matches!(asked.kind, Kind::Inverse(_)) || pulls {
        return None;
    }
    let massless =
        survey(&model, &values).ok()?.bodies.iter().all(|(_, mass, _, inertia)| *mass == 0.0 && inertia.iter().all(|i| *i == 0.0));
    massless.then(|| format!("study `{study}`: no body has a mass and nothing pulls, so that all forces are zero"))
}

/// What is worth a remark about freedom and rows.
fn remarks(survey: &Survey, drivers: usize) -> Vec<String> {
    let m = &survey.mobility;
    let mut out = Vec::new();
    if !m.redundant.is_empty() {
        out.push(format!(
            "redundant constraints (harmless but for friction by a coefficient; rigid bodies do not determine how the joints share forces there: such reactions are one way of many, another one in other `coordinates`): {}",
            m.redundant.join("; ")
        ));
    }
    out.extend(survey.findings.iter().map(|finding| finding.message.clone()));
    if m.freedom < drivers {
        let drivers = counted(drivers, "driver", "drivers");
        out.push(format!("{drivers} for {}", counted(m.freedom, "degree of freedom", "degrees of freedom")));
    }
    if let [first, ..] = &survey.forgotten[..] {
        let names: Vec<String> = survey.forgotten.iter().map(|name| format!("`{name}`")).collect();
        let them = if names.len() == 1 {
            format!("body `{first}` is in no joint and moves freely")
        } else {
            format!("bodies {} are in no joint and move freely", names.join(", "))
        };
        out.push(format!("{them}: give it a joint, or say in `start` where it begins"));
    }
    if m.freedom == 0 {
        out.push("the mechanism has no freedom: it is a structure at its start".into());
    }
    out
}

/// Part of the size of a body that is round-off of its places and inertias.
const ROUND_OFF: f64 = 1e-14;

/// A number of a unit of SI, and a list of such, in the unit in which the model asks for results.
struct In<'m> {
    unit: &'m str,
    size: f64,
}

impl<'m> In<'m> {
    fn of(model: &'m Model, si: &'m str) -> Self {
        let dimension = parse_unit(si).map(|(_, dimension)| dimension);
        let asked = dimension.and_then(|dimension| model.units.iter().find(|unit| unit.dimension.is_shown_as(dimension)));
        match asked {
            Some(asked) => Self { unit: &asked.name, size: asked.size },
            // as in all messages
            None if si == "rad" => Self { unit: "deg", size: std::f64::consts::PI / 180.0 },
            None => Self { unit: si, size: 1.0 },
        }
    }

    /// Where 1e-14 of the unit is round-off of zero.
    fn number(&self, x: f64) -> String {
        short(x / self.size, 1e-14)
    }

    /// As the file has it, however small.
    fn whole(&self, x: f64) -> String {
        short(x / self.size, 0.0)
    }

    /// Values that are round-off of zero beside a size.
    fn list(&self, values: &[f64], size: f64) -> String {
        values.iter().map(|x| short(x / self.size, ROUND_OFF * size / self.size)).collect::<Vec<_>>().join(", ")
    }
}

fn print(model: &Model, survey: &Survey, findings: &[String], document: &Document) {
    let name = &model.name;
    let [mass_in, length_in, inertia_in] = ["kg", "m", "kg m^2"].map(|si| In::of(model, si));
    let m = &survey.mobility;
    let (nq, nv, rows) = survey.sizes;
    let (bodies, joints) = (counted(survey.bodies.len(), "body", "bodies"), counted(survey.joints.len(), "joint", "joints"));
    print_out(&format!("{name}: {bodies}, {joints}, {}", counted(document.study_names().len(), "study", "studies")));
    print_out("\nmasses");
    for (name, mass, com, inertia) in &survey.bodies {
        print_out(&format!(
            "  {name:<14} {:>12} {}   com ({}) {}   inertia {} {}",
            mass_in.whole(*mass),
            mass_in.unit,
            length_in.list(com, reach(*mass, com, inertia)),
            length_in.unit,
            inertia_in.list(inertia, largest(inertia)),
            inertia_in.unit
        ));
    }
    print_out("\ntopology");
    for (name, kind, a, b, tree) in &survey.joints {
        print_out(&format!("  {name:<14} {kind:<12} {a} - {b}{}", if *tree { "" } else { "   (cut: closes a loop)" }));
    }
    for path in &survey.loops {
        print_out(&format!("  loop: {path}"));
    }
    print_out("\nfreedom");
    let without = if m.undriven < m.freedom { "drivers and couplings that time moves" } else { "drivers" };
    print_out(&format!("  degrees of freedom        {} (without {without}; Grübler's count: {})", m.freedom, m.grubler));
    print_out(&format!("  left by the drivers       {}", m.left));
    print_out(&format!("  coordinates, velocities   {nq}, {nv}"));
    print_out(&format!("  constraint rows, rank     {rows}, {}", m.rank));
    if let Some(g) = &survey.grashof {
        let lengths: Vec<String> = g.links.iter().map(|(n, l)| format!("{n} {}", length_in.whole(*l))).collect();
        print_out("\nfour-bar");
        print_out(&format!("  Grashof class             {}", g.class));
        print_out(&format!("  {:<25} {}", format!("links [{}]", length_in.unit), lengths.join(", ")));
        print_out(&format!("  range of the input        {}", range_of_the_input(model, g)));
    }
    print_start(model, survey);
    if !survey.lengths.is_empty() {
        print_out("\ndistances as at the start");
        for (name, length) in &survey.lengths {
            print_out(&format!("  {name:<22} {:>14} {}", length_in.whole(*length), length_in.unit));
        }
    }
    if !findings.is_empty() {
        print_out("\nfindings");
        for finding in findings {
            print_out(&format!("  {finding}"));
        }
    }
}

/// Most coordinates of joints that are shown though nothing was asked of them.
const SHOWN: usize = 12;

/// The start as it was asked for and found, and where joints stand in it of which nothing was asked.
fn print_start(model: &Model, survey: &Survey) {
    let asked: HashSet<&str> = survey.start.iter().map(|f| f.name.split_once('.').map_or(&*f.name, |(of, _)| of)).collect();
    // where a joint stands follows from its bodies as well
    let silent = |joint: usize| {
        let (name, _, a, b, _) = &survey.joints[joint];
        [name, a, b].iter().all(|of| !asked.contains(of.as_str()))
    };
    let others: Vec<_> = survey.stands.iter().filter(|(joint, ..)| silent(*joint)).collect();
    if survey.start.is_empty() && others.is_empty() {
        return;
    }
    print_out("\nstart                        asked            found");
    for f in &survey.start {
        let tilde = if f.guess { "~" } else { " " };
        let of = In::of(model, f.unit);
        print_out(&format!("  {:<22} {tilde}{:>14}   {:>14} {}", f.name, of.number(f.asked), of.number(f.found), of.unit));
    }
    for (joint, coordinate, x, unit) in others.iter().take(SHOWN) {
        let (name, of) = (format!("{}.{coordinate}", survey.joints[*joint].0), In::of(model, unit));
        print_out(&format!("  {name:<22} {:>15}   {:>14} {}", "-", short(x / of.size, AT_START), of.unit));
    }
    if let Some(more) = others.len().checked_sub(SHOWN + 1) {
        print_out(&format!("  and {} of other joints; `--json` has all", counted(more + 1, "value", "values")));
    }
}

/// Part of a unit that is round-off of zero where nothing was asked for.
const AT_START: f64 = 1e-10;

/// The range of a four-bar's input, in the measure of the user that follows it, else in the angle of its joint.
fn range_of_the_input(model: &Model, grashof: &Grashof) -> String {
    if grashof.angles.is_empty() {
        return "full turn".to_owned();
    }
    let values = parameters(model);
    let measured = model.measures.iter().filter(|m| m.dimension.is_angle()).find_map(|m| {
        let (slope, offset) = along(model, &values, m.value, grashof.input)?;
        (slope.abs() == 1.0).then_some((m.name.clone(), slope, offset))
    });
    let (name, slope, offset) = measured.unwrap_or_else(|| (format!("{}.angle", model.joints[grashof.input].name), 1.0, 0.0));
    let angle_in = In::of(model, "rad");
    let mut ranges: Vec<[f64; 2]> = grashof.angles.iter().map(|range| range.map(|x| slope * x + offset)).collect();
    ranges.iter_mut().for_each(|range| range.sort_by(f64::total_cmp));
    let told: Vec<String> = ranges.iter().map(|[a, b]| format!("{} to {}", angle_in.number(*a), angle_in.number(*b))).collect();
    format!("{name} {} {}", told.join(" or "), angle_in.unit)
}

/// Slope and offset of an expression that is a linear function of the angle of a joint alone.
fn along(model: &Model, values: &[f64], id: Id, joint: usize) -> Option<(f64, f64)> {
    let of = |id: Id| along(model, values, id, joint);
    match model.pool.node(id) {
        Node::Const(_) | Node::Parameter(_) => Some((0.0, model.pool.value(id, values))),
        Node::Input(i) => match model.inputs[i as usize] {
            Quantity::Joint { joint: j, slot: 0, order: 0 } if j == joint => Some((1.0, 0.0)),
            Quantity::Angle { body, order: 0 } if model.joints[joint].a.body == 0 && model.joints[joint].b.body == body => Some((1.0, 0.0)),
            _ => None,
        },
        Node::Neg(a) => of(a).map(|(slope, offset)| (-slope, -offset)),
        Node::Add(a, b) => of(a).zip(of(b)).map(|(a, b)| (a.0 + b.0, a.1 + b.1)),
        Node::Sub(a, b) => of(a).zip(of(b)).map(|(a, b)| (a.0 - b.0, a.1 - b.1)),
        _ => None,
    }
}

/// `1 study`, `2 studies`.
fn counted(n: usize, one: &str, more: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { more })
}

/// What included files hold beyond the model; nothing to be mended.
fn print_notes(notes: &[String]) {
    if !notes.is_empty() {
        print_out("\nnot used of included files");
        notes.iter().for_each(|note| print_out(&format!("  {note}")));
    }
}

fn as_json(model: &Model, survey: &Survey, findings: &[String]) -> Value {
    let m = &survey.mobility;
    let stand = |joint: usize| -> serde_json::Map<String, Value> {
        let own = survey.stands.iter().filter(|(j, ..)| *j == joint);
        own.map(|(_, coordinate, x, _)| ((*coordinate).to_owned(), json_number(*x))).collect()
    };
    json!({
        "name": model.name,
        "bodies": survey.bodies.iter().map(|(name, mass, com, inertia)| json!({
            "name": name, "mass": json_number(*mass), "com": json_numbers(com), "inertia": json_numbers(inertia),
        })).collect::<Vec<_>>(),
        "joints": survey.joints.iter().enumerate().map(|(i, (name, kind, a, b, tree))| json!({
            "name": name, "kind": kind, "bodies": [a, b], "cut": !tree, "start": stand(i),
        })).collect::<Vec<_>>(),
        "loops": survey.loops,
        "coordinates": survey.sizes.0,
        "velocities": survey.sizes.1,
        "rows": survey.sizes.2,
        "grubler": m.grubler,
        "degrees_of_freedom": m.freedom,
        "left_by_drivers": m.left,
        "rank": m.rank,
        "redundant": m.redundant,
        "grashof": survey.grashof.as_ref().map(|g| json!({
            "class": g.class,
            "links": g.links.iter().map(|(n, l)| json!({ "name": n, "length": json_number(*l) })).collect::<Vec<_>>(),
            "range": g.range.map(|(a, b)| json_numbers(&[a, b])),
            "input": model.joints[g.input].name,
            "angles": g.angles.iter().map(|range| json_numbers(range)).collect::<Vec<_>>(),
        })),
        "start": survey.start.iter().map(|f| json!({
            "name": f.name, "guess": f.guess, "asked": json_number(f.asked), "found": json_number(f.found),
        })).collect::<Vec<_>>(),
        "lengths": survey.lengths.iter().map(|(name, length)| json!({ "name": name, "length": json_number(*length) })).collect::<Vec<_>>(),
        "findings": findings,
    })
}

/// The largest magnitude.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, x| f64::max(m, x.abs()))
}

/// A length of a body, m: how far its centre of mass is, or its radius of gyration.
fn reach(mass: f64, com: &[f64], inertia: &[f64]) -> f64 {
    let gyration = (largest(inertia) / mass).sqrt();
    largest(com).max(if gyration.is_finite() { gyration } else { 0.0 })
}

/// Eight significant digits, without trailing zeros; 0 for what is round-off of a value that is zero.
fn short(x: f64, round_off: f64) -> String {
    let rounded: f64 = format!("{x:.7e}").parse().unwrap_or(x);
    grashof::output::number(if rounded.abs() < round_off { 0.0 } else { rounded })
}
