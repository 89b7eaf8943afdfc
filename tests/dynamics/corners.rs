//! Couplings whose laws have kinks and steps: velocities behind a corner that is rounded ever less, in closed form.

use crate::common::study;
use crate::reference::Verdict;
use crate::reference::program::run_text;
use grashof::mechanism::Coordinates;

/// A cam with straight flanks over a quarter turn each that lifts a follower by 10 mm.
fn cam(of_cam: &str, drivers: &str, settings: &str, columns: &str) -> String {
    format!(
        "grashof: 1
name: cam with straight flanks
space: planar
gravity: none
tables: {{ lift: {{ points: [[0 deg, 0 mm], [90 deg, 0 mm], [180 deg, 10 mm], [270 deg, 10 mm], [360 deg, 0 mm]], beyond: periodic }} }}
bodies: {{ cam: {{ mass: 1 kg, inertia: 1e-3 kg m^2 }}, follower: {{ mass: 2 kg }} }}
joints: {{ O: {{ revolute: [ground, cam.origin] }}, F: {{ slider: [ground, follower.origin], axis: [0, 1] }} }}
couplings: {{ c: {{ zero: F.position - lift(O.angle) }} }}
{drivers}start: {{ O.angle: 10 deg{of_cam} }}
studies: {{ run: {{ dynamics: {{ until: 1 s, every: 10 ms, {settings} }}, columns: [{columns}], scalars: {{ done: work_drivers }} }} }}
"
    )
}

#[test]
fn a_cam_keeps_its_energy_at_the_corners_of_its_flanks() {
    let mut verdict = Verdict::default();
    let slope = 0.02 / std::f64::consts::PI;
    let on_flank = 20.0 * (1e-3_f64 / (1e-3 + 2.0 * slope * slope)).sqrt();
    for coordinates in ["joint", "cartesian", "minimal"] {
        for (scheme, tolerance) in [("dop853, tolerance: 1e-10", 1e-9), ("radau5, tolerance: 1e-10", 1e-8), ("bdf, tolerance: 1e-9", 1e-6)]
        {
            let settings = format!("integrator: {scheme}, coordinates: {coordinates}");
            let text = cam(", O.omega: 20 rad/s", "", &settings, "O.angle, O.omega, F.velocity, energy.total");
            let outcome = study(&text, "run", Coordinates::Joint);
            verdict.holds(outcome.findings.iter().any(|f| f.code == "velocity-jump"), settings.as_str());
            for row in &outcome.rows {
                let [angle, omega, speed, energy] = row[..] else { panic!("four columns") };
                let (quarter, past) = ((angle / std::f64::consts::FRAC_PI_2).floor() as i64 % 4, angle % std::f64::consts::FRAC_PI_2);
                if !(1e-6..std::f64::consts::FRAC_PI_2 - 1e-6).contains(&past) {
                    continue;
                }
                let (right, lift) = match quarter {
                    1 => (on_flank, slope * on_flank),
                    3 => (on_flank, -slope * on_flank),
                    _ => (20.0, 0.0),
                };
                verdict.close("omega", &settings, omega, right, 20.0 * tolerance);
                verdict.close("speed of the follower", &settings, speed, lift, 20.0 * tolerance);
                verdict.close("energy", &settings, energy, 0.2, tolerance);
            }
        }
    }
    verdict.give("a cam");
}

/// A driver gives the follower ½ m v² at each flank and takes it back.
#[test]
fn the_driver_of_a_cam_works_at_its_corners() {
    let mut verdict = Verdict::default();
    let speed = 20.0 * 0.02 / std::f64::consts::PI;
    for coordinates in ["joint", "cartesian", "minimal"] {
        let settings = format!("tolerance: 1e-10, coordinates: {coordinates}");
        let drivers = "drivers: { d: { joint: O, speed: 20 rad/s } }\n";
        for (until, done) in [("1 s", 0.0), ("0.1 s", speed * speed)] {
            let text = cam("", drivers, &settings, "O.angle, F.velocity, energy.total").replace("until: 1 s", &format!("until: {until}"));
            let outcome = study(&text, "run", Coordinates::Joint);
            let place = format!("{coordinates}, until {until}");
            verdict.close("work", &place, outcome.scalars[0], done, 1e-12);
            verdict.close("energy", &place, outcome.rows.last().expect("a row")[2] - 0.2, done, 1e-12);
        }
    }
    verdict.give("a driven cam");
}

/// A point mass on a roof: its speed along the ridge stays, and so does that across it, up one side and down the other.
#[test]
fn a_mass_crosses_a_ridge_at_the_angle_at_which_it_has_come() {
    let mut verdict = Verdict::default();
    for coordinates in ["joint", "cartesian", "minimal"] {
        let text = format!(
            "grashof: 1
name: mass on a roof
space: spatial
gravity: none
bodies: {{ m: {{ mass: 3 kg, inertia: 1 kg m^2 }} }}
couplings: {{ roof: {{ zero: m.z + 0.75*abs(m.x) }} }}
start: {{ m.x: -1 m, m.y: 0 m, m.vx: 4 m/s, m.vy: 2 m/s, m.vz: ~3 m/s, m.z: ~-0.75 m, m.wx: 0 rad/s, m.wy: 0 rad/s, m.wz: 0 rad/s }}
studies: {{ run: {{ dynamics: {{ until: 1 s, coordinates: {coordinates} }}, columns: [m.vx, m.vy, m.vz] }} }}
"
        );
        let outcome = study(&text, "run", Coordinates::Joint);
        let last = outcome.rows.last().expect("a row");
        for (what, found, right) in [("along x", last[0], 4.0), ("along the ridge", last[1], 2.0), ("down", last[2], -3.0)] {
            verdict.close(what, coordinates, found, right, 1e-9);
        }
    }
    verdict.give("a ridge");
}

#[test]
fn a_step_of_a_coupling_ends_the_run_before_it() {
    for law in [
        "if(O.angle > 90 deg, 3 mm, 0 mm)",
        "3 mm*floor(O.angle/90 deg)",
        "0.01 mm/deg*mod(O.angle, 90 deg)",
        "3 mm*sign(O.angle - 90 deg)",
    ] {
        for coordinates in ["joint", "cartesian", "minimal"] {
            let settings = format!("coordinates: {coordinates}");
            let text = cam(", O.omega: 20 rad/s", "", &settings, "O.angle, F.position").replace("lift(O.angle)", law);
            let text = text.replace("zero: F.position", "zero: \"F.position").replace(&format!("{law} }}"), &format!("{law}\" }}"));
            let run = run_text(&text, &["--no-plots"]);
            assert_eq!(run.code, 3, "{law}");
            let told = &run.stderr;
            assert!(told.contains("the law of coupling `c` jumps, by") && told.contains("t = 0.069813 s"), "{law}, {coordinates}: {told}");
        }
    }
}

#[test]
fn kinks_of_drivers_are_told_and_smooth_laws_are_not() {
    // a slide whose driver begins at once, stops at once, or neither; once with a work that is ½ m v² at each jump
    for (law, jumps) in [
        ("position: '0.4 m/s*max(0 s, t - 0.5 s)'", 1),
        ("position: '0.2 m*clamp((t - 0.2 s)/0.4 s, 0, 1)'", 2),
        ("speed: 0.3 m/s", 0),
        ("rise: { by: 0.2 m, during: 0.5 s, law: cycloidal }", 0),
        ("rise: { by: 0.2 m, during: 0.5 s, law: poly5 }", 0),
        ("position: '0.1 m*sin(7 rad/s*t)'", 0),
        ("position: 'way(t)'", 0),
    ] {
        let text = format!(
            "grashof: 1
name: slide
space: planar
gravity: none
tables: {{ way: {{ points: [[0 s, 0 mm], [0.2 s, 5 mm], [0.5 s, 10 mm], [0.8 s, 5 mm], [1 s, 0 mm]], between: cubic, beyond: periodic }} }}
bodies: {{ a: {{ mass: 1 kg }}, b: {{ bar: {{ length: 0.3 m, mass: 2 kg }} }} }}
joints: {{ A: {{ slider: [ground, a.origin], axis: [1, 0] }}, B: {{ revolute: [a.origin, b.start] }} }}
drivers: {{ d: {{ joint: A, {law} }} }}
start: {{ B.angle: -60 deg }}
studies: {{ run: {{ dynamics: {{ until: 1 s, every: 0.1 s }}, columns: [A.velocity] }} }}
"
        );
        let outcome = study(&text, "run", Coordinates::Joint);
        let told: Vec<&str> = outcome.findings.iter().filter(|f| f.code == "velocity-jump").map(|f| f.message.as_str()).collect();
        assert_eq!(told.len(), usize::from(jumps > 0), "{law}: {told:?}");
        assert!(jumps < 1 || told[0].contains("the law of driver `d`") || told[0].contains("the law of `d`"), "{told:?}");
        assert_eq!(told.iter().filter(|m| m.contains("and once more")).count(), usize::from(jumps == 2), "{law}: {told:?}");
    }
}

#[test]
fn a_smooth_table_in_a_coupling_has_no_jumps() {
    // over many segments at a speed that falls to a steady one
    let text = "grashof: 1
name: smooth cam
space: planar
gravity: none
tables: { lift: { points: [[0 deg, 0 mm], [90 deg, 5 mm], [180 deg, 10 mm], [270 deg, 5 mm], [360 deg, 0 mm]], between: cubic, beyond: periodic } }
bodies: { w: { disc: { radius: 50 mm, mass: 2 kg } }, f: { mass: 0.1 kg } }
joints: { O: { revolute: [ground, w.origin], damping: 0.1 N m s/rad }, F: { slider: [ground, f.origin], axis: [0, 1] } }
couplings: { c: { zero: F.position - lift(O.angle) } }
loads: { tq: { joint: O, torque: 2 N m } }
start: { O.angle: 0 deg, O.omega: 20 rad/s }
studies: { run: { dynamics: { until: 20 s, every: 0.1 s }, columns: [O.angle] } }
";
    let outcome = study(text, "run", Coordinates::Joint);
    assert!(outcome.findings.iter().all(|f| f.code != "velocity-jump"), "{:?}", outcome.findings);
}
