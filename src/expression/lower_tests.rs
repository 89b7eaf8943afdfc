use super::super::parser::parse;
use super::super::scope::Symbol;
use super::*;

/// Parameters l1, l3 (m), k and m (kg); inputs t, x (m), v (m/s), f (N); table curve: rad/s → N m; functionals.
#[derive(Default)]
struct Names {
    inside: bool,
    over_study: bool,
    calls: Vec<String>,
}

impl Scope for Names {
    fn name(&mut self, pool: &mut Pool, path: &str) -> Result<Symbol, Unknown> {
        let (id, dimension) = match path {
            "l1" => (pool.parameter(0), Dimension::LENGTH),
            "l3" => (pool.parameter(1), Dimension::LENGTH),
            "k" => (pool.parameter(2), Dimension::NONE),
            "m" => (pool.parameter(3), Dimension::MASS),
            "t" => (pool.input(0), Dimension::TIME),
            "slide.x" => (pool.input(1), Dimension::LENGTH),
            "slide.vx" => (pool.input(2), Dimension::SPEED),
            "hinge.angle" => (pool.input(6), Dimension::ANGLE),
            "slide.f" => (pool.input(3), Dimension::FORCE),
            "column" if self.inside => (pool.input(4), Dimension::FORCE),
            _ => return Err(Unknown { found: format!("`{path}`"), expected: "a name of this model".to_owned(), help: None }),
        };
        Ok(Symbol { id, dimension })
    }
    fn has_value(&self, word: &str) -> bool {
        matches!(word, "l1" | "l3" | "k" | "m" | "t")
    }
    fn table(&mut self, name: &str) -> Option<(u32, Dimension, Dimension)> {
        (name == "curve").then_some((0, Dimension::ANGULAR_SPEED, Dimension::TORQUE))
    }
    fn rate(&mut self, pool: &mut Pool, input: u32) -> Option<Id> {
        match input {
            0 => Some(pool.constant(1.0)),
            1 => Some(pool.input(2)),
            _ => None,
        }
    }
    fn enter_functional(&mut self, name: &str) -> Result<(), Unknown> {
        self.inside = self.over_study;
        let found = format!("`{name}(..)`");
        if self.inside { Ok(()) } else { Err(Unknown { found, expected: "no functional here".to_owned(), help: None }) }
    }
    fn leave_functional(&mut self) {
        self.inside = false;
    }
    fn functional(&mut self, pool: &mut Pool, name: &str, of: Lowered, at: Option<Lowered>, text: &str) -> Result<Symbol, Unknown> {
        self.calls.push(text.to_owned());
        assert!(at.is_some() == (name == "value") && (of.boolean || name != "first"));
        Ok(Symbol { id: pool.input(5), dimension: of.dimension })
    }
}

fn lowered(pool: &mut Pool, text: &str) -> Result<Lowered, Vec<Fault>> {
    lower(pool, &parse(text).unwrap_or_else(|e| panic!("{text}: {e:?}")), text, &mut Names::default())
}

/// Value (parameters l1 = 1, l3 = 3, k = 5, m = 7) and dimension.
fn value(text: &str) -> (f64, Dimension) {
    let mut pool = Pool::new();
    let l = lowered(&mut pool, text).unwrap_or_else(|e| panic!("{text}: {e:?}"));
    (pool.value(l.id, &[1.0, 3.0, 5.0, 7.0]), l.dimension)
}

fn faults(text: &str) -> Vec<Fault> {
    lowered(&mut Pool::new(), text).expect_err(text)
}

#[test]
fn values_of_the_format() {
    let none = Dimension::NONE;
    for (text, x, dimension) in [
        ("-2^2", -4.0, none),
        ("2^3^2", 512.0, none),
        ("2 m^2", 2.0, Dimension::AREA),
        ("1/2 m", 0.5, Dimension::LENGTH.pow(-1)),
        ("4.26 N m s/rad", 4.26, Dimension::ANGULAR_DAMPING),
        ("73/12", 73.0 / 12.0, none),
        ("8 - 3 - 2", 3.0, none),
        ("8/4/2", 1.0, none),
        ("180 deg - pi", 0.0, none),
        ("sqrt(l3^2 + 16*l1^2)", 5.0, Dimension::LENGTH),
        ("(l3/l1)^0.5*l1", 3.0_f64.sqrt(), Dimension::LENGTH),
        ("k^k", 3125.0, none),
        ("sqrt(l3)^2", 3.0_f64.sqrt().powi(2), Dimension::LENGTH),
        ("min(l3, 2 m, l1)", 1.0, Dimension::LENGTH),
        ("max(0, l3)", 3.0, Dimension::LENGTH),
        ("clamp(k, -1, 1)", 1.0, none),
        ("if(l3 > l1 and k, l3, 0)", 3.0, Dimension::LENGTH),
        ("if(k - 5, 1/0, 7)", 7.0, none),
        ("not k == 5 or l1 != l3", 1.0, none),
        ("3*(k >= 5) + 1", 4.0, none),
        ("atan2(l3, l1) + abs(-k)*sign(-l1)", 3.0_f64.atan2(1.0) - 5.0, none),
        ("log(exp(2)) + sin(0) + asin(1)*2/pi", 3.0, none),
        ("l3 + 0", 3.0, Dimension::LENGTH),
        ("floor(k/2) + 10*floor(-k/2)", 2.0 - 30.0, none),
        ("ceil(k/2) + 10*ceil(-k/2)", 3.0 - 20.0, none),
        ("round(k/2) + 10*round(-k/2) + 100*round(k/3)", 3.0 - 20.0 + 200.0, none),
        ("floor(1e12 + 0.5)", 1e12, none),
        ("mod(7.5 m, l3)", 1.5, Dimension::LENGTH),
        ("mod(-7.5 m, l3)", 1.5, Dimension::LENGTH),
        ("mod(7.5 m, -l3)", -1.5, Dimension::LENGTH),
        ("mod(400 deg, 1 turn)/1 deg", 40.0, none),
        ("hypot(l3, 4 m)", 5.0, Dimension::LENGTH),
        ("log10(1000) - 3", 0.0, none),
        ("cosh(k)^2 - sinh(k)^2", 1.0, none),
        ("tanh(1e-9) - 1e-9", 0.0, none),
        ("tanh(800) + tanh(-800)", 0.0, none),
        ("tanh(1) - (exp(2) - 1)/(exp(2) + 1)", 0.0, none),
    ] {
        let (found, unit) = value(text);
        assert!((found - x).abs() < 1e-14 * x.abs().max(if text.contains("cosh") { 1e3 } else { 1.0 }), "{text}: {found}");
        assert_eq!(unit, dimension, "{text}");
    }
}

#[test]
fn whole_numbers_are_undefined_where_they_cannot_be_counted() {
    let mut pool = Pool::new();
    let floor = lowered(&mut pool, "floor(slide.x/1 m)").unwrap().id;
    let program = pool.program(&[floor], &[], &std::sync::Arc::default());
    let at = |x: f64| {
        let (mut registers, mut modes, mut out) = (vec![0.0; program.registers()], vec![0; pool.switches().len()], [0.0]);
        program.set_modes(&[0.0, x], &mut registers, &mut modes);
        program.eval(&[0.0, x], &modes, &mut registers, &mut out);
        out[0]
    };
    assert_eq!((at(-2.5), at(2.0e9)), (-3.0, 2.0e9));
    for x in [3e9, -3e9, f64::NAN, f64::INFINITY] {
        assert!(at(x).is_nan(), "{x}");
    }
}

#[test]
fn a_word_is_the_unit_behind_a_number_and_the_name_elsewhere() {
    for (text, x, dimension) in [
        ("m*9.81 m/s^2", 7.0 * 9.81, Dimension::FORCE),
        ("2*m", 14.0, Dimension::MASS),
        ("2 m", 2.0, Dimension::LENGTH),
        ("200 N/m", 200.0, Dimension::STIFFNESS),
        ("200 N/(m)", 200.0 / 7.0, Dimension::ACCELERATION),
        ("(9.81 m/s^2)*m", 9.81 * 7.0, Dimension::FORCE),
        ("9.81 m/s^2*1 m", 9.81, Dimension::ACCELERATION.mul(Dimension::LENGTH)),
        ("m^2/m", 7.0, Dimension::MASS),
        ("k/m", 5.0 / 7.0, Dimension::MASS.pow(-1)),
        ("3 N*s", 3.0, Dimension::FORCE.mul(Dimension::TIME)),
    ] {
        let (found, unit) = value(text);
        assert!((found - x).abs() < 1e-13 * x.abs(), "{text}: {found}");
        assert_eq!(unit, dimension, "{text}");
    }
    for (text, at, help) in [
        ("9.81 m/s^2*m", 11..12, "write `(9.81 m/s^2)*m` for the name, `9.81 m/s^2*1 m` for the unit"),
        ("l1 + 2 N * m^2/s", 11..12, "write `(2 N)*m^2/s` for the name, `2 N*1 m^2/s` for the unit"),
    ] {
        let [fault] = &faults(text)[..] else { panic!("{text}") };
        assert_eq!((fault.at.clone(), fault.help.as_deref()), (at, Some(help)), "{text}");
    }
}

#[test]
fn angles_are_carried_beside_numbers_and_time() {
    let mut pool = Pool::new();
    let mut names = Names { over_study: true, ..Names::default() };
    for (text, unit) in [
        ("hinge.angle", "rad"),
        ("-abs(hinge.angle)", "rad"),
        ("hinge.angle/1 deg", ""),
        ("hinge.angle*k", "rad"),
        ("k/5*hinge.angle", "rad"),
        ("hinge.angle + 0.5", "rad"),
        ("0.5 - hinge.angle", "rad"),
        ("pi + k", ""),
        ("hinge.angle*1 m/(2*1 m)", ""),
        ("l1*hinge.angle", "m"),
        ("l1*hinge.angle/t", "m/s"),
        ("hinge.angle/t", "rad/s"),
        ("hinge.angle/t*t", "rad"),
        ("(hinge.angle/t)^2", "rad^2/s^2"),
        ("sqrt((hinge.angle/t)^2)", "rad/s"),
        ("1/t", "1/s"),
        ("slide.vx/l1", "1/s"),
        ("240 rpm", "rad/s"),
        ("3 turn", "rad"),
        ("sin(hinge.angle)", ""),
        ("asin(k/5)", "rad"),
        ("atan2(l1, l3)", "rad"),
        ("max(0, hinge.angle)", "rad"),
        ("clamp(k, -hinge.angle, 1)", "rad"),
        ("if(k > 3, k, hinge.angle)", "rad"),
        ("sign(hinge.angle)", ""),
        ("hinge.angle > 1", ""),
        ("1 N m/rad*hinge.angle", "N m"),
        ("hinge.angle^k", ""),
        ("mean(hinge.angle)/1 turn", ""),
        ("max(hinge.angle) - min(hinge.angle)", "rad"),
    ] {
        let lowered = lower(&mut pool, &parse(text).unwrap(), text, &mut names).unwrap_or_else(|e| panic!("{text}: {e:?}"));
        assert_eq!(lowered.dimension.si(), unit, "{text}");
    }
    // rad = 1: an angle may stand where a number is wanted, and the other way round
    let angle = lowered(&mut pool, "3 deg").unwrap();
    assert_eq!((angle.expect(Dimension::NONE), lowered(&mut pool, "k").unwrap().expect(Dimension::ANGLE)), (Ok(()), Ok(())));
    assert_eq!(faults("l3 + 3 deg")[0].found, "angle (rad)");
}

#[test]
fn bare_numbers_adapt_to_fields_but_not_to_neighbours() {
    let mut pool = Pool::new();
    for (text, bare, any) in [
        ("0.1", true, false),
        ("2*pi", true, false),
        ("73/12", true, false),
        ("0", true, true),
        ("-0", true, true),
        ("k", false, false),
        ("2 m", false, false),
        ("0 m", false, false),
        ("0*l3", false, true),
        ("sqrt(2)", true, false),
    ] {
        let l = lowered(&mut pool, text).unwrap();
        assert_eq!((l.bare, l.any), (bare, any), "{text}");
        assert_eq!(l.expect(Dimension::SPEED).is_ok(), bare || any, "{text}");
    }
    let found = faults("l3 + 0.1");
    assert_eq!(
        found,
        [Fault {
            at: 5..8,
            found: "a number".into(),
            expected: "length (m)".into(),
            help: Some("write `0.1 m`".into()),
            wanted: Some(Dimension::LENGTH)
        }]
    );
    assert_eq!(faults("0.1 + l3")[0].at, 0..3);
    assert_eq!(faults("slide.vx < 2*3")[0].help.as_deref(), Some("write `(2*3)*1 m/s`"));
    assert_eq!(faults("1/t > 3")[0].help.as_deref(), Some("write `3 s^-1`"));
}

#[test]
fn dimensions_are_checked_everywhere() {
    for (text, at, found) in [
        ("l3 + t", 5..6, "time (s)"),
        ("l3 < t", 5..6, "time (s)"),
        ("max(l1, l3, t)", 12..13, "time (s)"),
        ("clamp(l1, -1 m, k)", 16..17, "a number"),
        ("if(k, l3, t)", 10..11, "time (s)"),
        ("atan2(l3, t)", 10..11, "time (s)"),
        ("sin(l3)", 4..6, "length (m)"),
        ("log(2 m)", 4..7, "length (m)"),
        ("k^l3", 2..4, "length (m)"),
        ("l3^k", 3..4, "an exponent that is not a constant"),
        ("l3^0.3", 0..2, "length (m)"),
        ("sqrt(sqrt(l3))", 5..13, "m^0.5"),
        ("curve(l3)", 6..8, "length (m)"),
        ("sin(k, k)", 0..9, "2 arguments"),
        ("clamp(k)", 0..8, "1 argument"),
        ("curve()", 0..7, "0 arguments"),
        ("rate(slide.f)", 0..13, "`slide.f`"),
        ("mean(k)", 0..4, "`mean(..)`"),
        ("max(k)", 0..3, "`max(..)`"),
        ("foo", 0..3, "`foo`"),
    ] {
        let all = faults(text);
        assert_eq!(all.len(), 1, "{text}: {all:?}");
        assert_eq!((all[0].at.clone(), all[0].found.as_str()), (at, found), "{text}");
    }
}

#[test]
fn all_faults_of_an_expression_come_at_once() {
    let all = faults("foo + sin(l3)*bar(l1 + t) + l1 + 2*cm");
    let found: Vec<&str> = all.iter().map(|f| f.found.as_str()).collect();
    assert_eq!(found, ["`foo`", "length (m)", "time (s)", "`bar(..)`", "`cm`"]);
    assert!(all[3].help.as_ref().unwrap().contains("`bar*(..)`"));
    assert!(all[4].help.as_ref().unwrap().contains("`1 cm`"));
}

#[test]
fn rates_follow_the_scope() {
    let mut pool = Pool::new();
    let rate = lowered(&mut pool, "rate(slide.x^2 + l3*slide.x)").unwrap();
    let direct = lowered(&mut pool, "2*slide.x*slide.vx + l3*slide.vx").unwrap();
    assert_eq!((rate.id, rate.dimension), (direct.id, direct.dimension));
    assert_eq!(lowered(&mut pool, "rate(t)").unwrap().id, pool.constant(1.0));
    assert!(lowered(&mut pool, "rate(rate(slide.x))").is_err());
}

#[test]
fn tables_take_bare_numbers() {
    let mut pool = Pool::new();
    assert_eq!(lowered(&mut pool, "k*curve(3)").unwrap().dimension, Dimension::TORQUE);
    assert_eq!(lowered(&mut pool, "curve(240 rpm)").unwrap().dimension, Dimension::TORQUE);
    assert_eq!(pool.switches()[0].text, "curve(3)");
}

#[test]
fn switches_quote_the_text() {
    let mut pool = Pool::new();
    let l = lowered(&mut pool, "if(slide.x <= l3 and slide.vx/(1 m/s), 2, abs(slide.vx - 2 m/s)*0)").unwrap();
    let texts: Vec<_> = pool.switches().iter().map(|s| s.text.as_str()).collect();
    assert_eq!(texts, ["slide.x <= l3", "slide.vx/(1 m/s) != 0", "abs(slide.vx - 2 m/s)"]);
    assert!(!l.boolean && lowered(&mut pool, "slide.x <= l3").unwrap().boolean);
}

#[test]
fn functionals_are_handed_to_the_scope() {
    let mut pool = Pool::new();
    let mut names = Names { over_study: true, ..Names::default() };
    for text in
        ["mean(column)", "max(column) - min(column)", "first(column > 3 N)", "first(k)", "value(column, 1 s)", "2*last(max(column, 0))"]
    {
        let l = lower(&mut pool, &parse(text).unwrap(), text, &mut names);
        assert!(l.is_ok(), "{text}: {l:?}");
    }
    assert_eq!(
        names.calls,
        ["mean(column)", "max(column)", "min(column)", "first(column > 3 N)", "first(k)", "value(column, 1 s)", "last(max(column, 0))"]
    );
    for text in ["mean(k) + column", "value(column)", "value(k, column)", "mean(column, k)"] {
        assert!(lower(&mut pool, &parse(text).unwrap(), text, &mut names).is_err(), "{text}");
        assert!(!names.inside);
    }
}

#[test]
fn no_tree_panics() {
    let pieces = [
        "l3", "k", "t", "slide.x", "slide.vx", "slide.f", "foo", "column", "0", "2", "0.5", "3 m", "1e300", "pi", "(", ")", ", ", " + ",
        " - ", "*", "/", "^", " < ", " == ", " and ", " or ", "not ", "sin(", "sqrt(", "min(", "if(", "rate(", "mean(", "curve(", "abs(",
        "bar(", "value(", "atan2(", "first(",
    ];
    let mut seed: u64 = 11;
    let mut next = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as usize
    };
    let mut pool = Pool::new();
    let (mut trees, mut good) = (0, 0);
    for _ in 0..60_000 {
        let text: String = (0..1 + next() % 10).map(|_| pieces[next() % pieces.len()]).collect();
        // closing what is open makes more of them trees
        let open = text.matches('(').count().saturating_sub(text.matches(')').count());
        let text = text + &")".repeat(open);
        let Ok(tree) = parse(&text) else { continue };
        trees += 1;
        match lower(&mut pool, &tree, &text, &mut Names { over_study: next() % 2 == 0, ..Names::default() }) {
            Ok(l) => {
                good += 1;
                let _ = pool.value(l.id, &[1.0, 2.0]);
                let _ = pool.program(&[l.id], &[1.0, 2.0, 3.0], &std::sync::Arc::default());
            }
            Err(all) => assert!(!all.is_empty() && all.iter().all(|f| text.get(f.at.clone()).is_some()), "{text}"),
        }
    }
    assert!(trees > 1000 && good > 200, "{trees} {good}");
}
