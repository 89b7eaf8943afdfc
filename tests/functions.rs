//! Functions from outside in the expressions of a model: their results are those of the expressions that compute the same.

use grashof::api::ExternalFunction;
use grashof::{Error, Model, Results};

/// Two bars with a load, a spring, a driver's law and columns that call functions.
const BARS: &str = "
grashof: 1
name: bars
space: planar
gravity: [0, -9.81 m/s^2]
parameters: { push: 3 N }
ground: { post: [1.2 m, 0.4 m] }
bodies: { upper: { bar: { length: 1 m, mass: 1 kg } }, lower: { bar: { length: 1 m, mass: 2 kg } } }
joints: { P: { revolute: [ground, upper.start] }, Q: { revolute: [upper.end, lower.start] } }
springs: { s: { stretch: Q.angle, stiffness: 20 N*m/rad } }
loads: { wind: { at: lower.end, force: ['LOAD', 0] } }
start: { P.angle: -80 deg, P.omega: 0, Q.angle: 20 deg, Q.omega: 0 }
studies:
  swing:
    dynamics: { until: 1 s, every: 50 ms, tolerance: 1e-9, integrator: SCHEME }
    columns: [P.angle, Q.angle, P.fx]
    scalars: { work: integral(P.fx*lower.end.vx) }
  rest: { statics: { from: start }, columns: [P.angle, Q.angle] }
  ring: { modes: { at: statics } }
";

fn results(text: &str, functions: Vec<ExternalFunction>, study: &str) -> Result<Results, Error> {
    Model::parse(text)?.with_functions(functions)?.study(study)?.run()
}

fn got(text: &str, functions: Vec<ExternalFunction>, study: &str) -> Results {
    results(text, functions, study).unwrap_or_else(|error| panic!("{error}"))
}

/// push·(1 + sin(2 angle)) − 0.4 speed.
fn wind() -> ExternalFunction {
    ExternalFunction::new("wind_force", &["push", "angle", "speed"], |a| a[0] * (1.0 + (2.0 * a[1]).sin()) - 0.4 * a[2])
}

fn bars(load: &str, scheme: &str) -> String {
    BARS.replace("LOAD", load).replace("SCHEME", scheme)
}

const OUTSIDE: &str = "wind_force(push, lower.angle, lower.end.vx)";
const INSIDE: &str = "push*(1 + sin(2*lower.angle)) - 0.4 N*s/m*lower.end.vx";

#[test]
fn a_load_from_outside_is_that_of_the_file() {
    for scheme in ["dop853", "radau5", "bdf"] {
        let [inside, outside] =
            [(INSIDE, Vec::new()), (OUTSIDE, vec![wind().switches(&[])])].map(|(load, f)| got(&bars(load, scheme), f, "swing"));
        for name in ["P.angle", "Q.angle", "P.fx"] {
            let off = inside
                .column(name)
                .unwrap()
                .iter()
                .zip(outside.column(name).unwrap())
                .fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
            // explicit steps see the same forces; implicit ones have derivatives by differences
            assert!(off <= if scheme == "dop853" { 1e-11 } else { 1e-6 }, "{scheme} {name}: {off:e}");
        }
        let steps = [&inside, &outside].map(|r| r.certificate.march.as_ref().unwrap().counts.steps);
        assert!(steps[0].abs_diff(steps[1]) <= 2, "{scheme}: {steps:?}");
    }
    let push = |load: &str| load.replace(" - 0.4 N*s/m*lower.end.vx", "").replace("lower.end.vx", "0");
    for study in ["rest", "ring"] {
        let [inside, outside] =
            [(INSIDE, Vec::new()), (OUTSIDE, vec![wind()])].map(|(load, f)| got(&bars(&push(load), "dop853"), f, study));
        let numbers = |r: &Results| {
            r.table.columns.iter().flat_map(|c| c.values.clone()).chain(r.lists.iter().flat_map(|l| l.values.clone())).collect::<Vec<f64>>()
        };
        let [a, b] = [numbers(&inside), numbers(&outside)];
        assert!(!a.is_empty() && a.len() == b.len(), "{study}: {a:?} {b:?}");
        assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() <= 1e-8 * (1.0 + a.abs())), "{study}: {a:?} {b:?}");
    }
}

#[test]
fn a_driver_and_a_coupling_take_rates_of_functions() {
    let text = |law: &str, tie: &str| {
        format!(
            "
grashof: 1
name: cam
space: planar
gravity: none
bodies: {{ cam: {{ mass: 1 kg, inertia: 1 kg*m^2 }}, rod: {{ mass: 2 kg, inertia: 0 }} }}
joints: {{ O: {{ revolute: [ground, cam] }}, S: {{ slider: [ground, rod], axis: [0, 1] }} }}
drivers: {{ turn: {{ joint: O, angle: '{law}' }} }}
couplings: {{ lift: {{ zero: 'S.position - {tie}' }} }}
studies:
  turn: {{ inverse: {{ over: 2 s, samples: 20 }}, columns: [S.position, S.velocity, S.acceleration, turn.torque] }}
"
        )
    };
    let functions = || {
        vec![
            ExternalFunction::new("law", &["time"], |a| 1.5 * a[0] * a[0] + a[0].sin()).unit("rad").switches(&[]),
            ExternalFunction::new("profile", &["angle"], |a| 0.1 * a[0].cos() * a[0]).unit("m").switches(&[]),
        ]
    };
    let inside = got(&text("1.5 rad/s^2*t^2 + 1 rad*sin(t*1 rad/s)", "0.1 m*cos(O.angle)*O.angle/(1 rad)"), Vec::new(), "turn");
    let outside = got(&text("law(t)", "profile(O.angle)"), functions(), "turn");
    // the torque has second derivatives of both
    for (name, within) in [("S.position", 1e-12), ("S.velocity", 1e-9), ("S.acceleration", 1e-6), ("turn.torque", 1e-5)] {
        let [a, b] = [&inside, &outside].map(|r| r.column(name).unwrap());
        let size = a.iter().fold(0.0_f64, |most, a| most.max(a.abs()));
        let off = a.iter().zip(b).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        assert!(size > 0.05 && off <= within * size, "{name}: {off:e} of {size}");
    }
}

/// A mass on a soft spring that meets a hard one behind a gap.
fn bumper(function: &str) -> String {
    format!(
        "
grashof: 1
name: bumper
space: planar
gravity: none
bodies: {{ m: {{ mass: 1 kg, inertia: 0 }} }}
joints: {{ S: {{ slider: [ground, m], axis: [1, 0] }} }}
loads: {{ against: {{ joint: S, force: '{function}' }} }}
start: {{ S.position: 0, S.velocity: 1 m/s }}
studies:
  run: {{ dynamics: {{ until: 1 s, every: 10 ms, tolerance: 1e-9 }}, columns: [S.position, S.velocity] }}
"
    )
}

#[test]
fn declared_switches_are_located_and_others_are_told() {
    let contact = |a: &[f64], beyond: bool| -a[0] - if beyond { 1e4 * (a[0] - 0.1) } else { 0.0 };
    let with_side = ExternalFunction::new("bump", &["x"], move |a| contact(a, a[1] != 0.0)).switches(&[("beyond", "x > 10 cm")]);
    let by_itself = ExternalFunction::new("bump", &["x"], move |a| contact(a, a[0] > 0.1));
    let inside = got(&bumper("-1 N/m*S.position - if(S.position > 10 cm, 1e4 N/m*(S.position - 0.1 m), 0)"), Vec::new(), "run");
    let located = got(&bumper("bump(S.position)"), vec![with_side], "run");
    let hidden = got(&bumper("bump(S.position)"), vec![by_itself], "run");
    let last = |r: &Results| r.column("S.position").unwrap().last().copied().unwrap();
    assert!((last(&inside) - last(&located)).abs() < 1e-11, "{} {}", last(&inside), last(&located));
    assert_eq!(inside.certificate.switches, located.certificate.switches);
    let codes = |r: &Results| {
        r.findings.iter().map(|f| f.code.to_string()).filter(|c| c == "unresolved" || c == "from-outside").collect::<Vec<_>>()
    };
    assert_eq!(codes(&inside), Vec::<String>::new());
    assert_eq!(codes(&located), ["from-outside"]);
    assert_eq!(codes(&hidden), ["from-outside", "unresolved"]);
    assert_eq!([&inside, &located, &hidden].map(|r| r.certificate.undeclared), [0, 0, 1]);
}

#[test]
fn faults_have_their_places() {
    let told = |text: &str, functions: Vec<ExternalFunction>| match results(text, functions, "run") {
        Err(error) => error.to_string(),
        Ok(results) => results.stopped.unwrap_or_default(),
    };
    let bump = || ExternalFunction::new("bump", &["x"], |a| -a[0]);
    assert!(told(&bumper("bump(S.position)"), Vec::new()).contains("a function or a table"));
    assert!(told(&bumper("bump(S.position, 1)"), vec![bump()]).contains("`bump(x)`"));
    assert!(told(&bumper("bump(S.position)"), vec![bump().unit("m")]).contains("length (m)"));
    assert!(told(&bumper("bump(S.position)"), vec![bump().switches(&[("far", "x > 1 s")])]).contains("x > 1 s"));
    assert!(told(&bumper("bump(S.position)"), vec![ExternalFunction::new("m", &["x"], |_| 0.0)]).contains("already the name"));
    assert!(told(&bumper("0"), vec![ExternalFunction::new("sin", &["x"], |_| 0.0)]).contains("is a function"));
    assert!(told(&bumper("0"), vec![bump(), bump()]).contains("two functions"));
    let nowhere = ExternalFunction::new("bump", &["x"], |a| if a[0] > 0.3 { f64::NAN } else { 0.0 });
    let stopped = told(&bumper("bump(S.position)"), vec![nowhere]);
    assert!(stopped.contains("`bump`, which comes from outside"), "{stopped}");
}
