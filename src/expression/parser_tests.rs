use super::*;

/// The tree as text with every parenthesis written, numbers in SI.
fn tree(e: &Expr) -> String {
    let all = |v: &[Expr], sep: &str| v.iter().map(tree).collect::<Vec<_>>().join(sep);
    let chain = |first: &Expr, rest: &[(bool, Expr)], [plus, minus]: [&str; 2]| {
        let rest: String = rest.iter().map(|(inverse, e)| format!(" {} {}", if *inverse { minus } else { plus }, tree(e))).collect();
        format!("({}{rest})", tree(first))
    };
    match &e.kind {
        Kind::Number(x) => x.to_string(),
        Kind::Quantity(x, d, _) => format!("[{x} {}]", d.si()),
        Kind::Path(p) => p.clone(),
        Kind::Call(name, _, arguments) => format!("{name}({})", all(arguments, ", ")),
        Kind::Negate(a) => format!("(-{})", tree(a)),
        Kind::Not(a) => format!("(not {})", tree(a)),
        Kind::Sum(first, rest) => chain(first, rest, ["+", "-"]),
        Kind::Product(first, rest) => chain(first, rest, ["*", "/"]),
        Kind::Power(a, b) => format!("({} ^ {})", tree(a), tree(b)),
        Kind::Compare(op, a, b) => format!("({op:?} {} {})", tree(a), tree(b)),
        Kind::And(v) => format!("({})", all(v, " and ")),
        Kind::Or(v) => format!("({})", all(v, " or ")),
    }
}

fn parsed(text: &str) -> String {
    tree(&parse(text).unwrap_or_else(|e| panic!("{text}: {e:?}")))
}

fn error(text: &str) -> SyntaxError {
    parse(text).expect_err(text)
}

#[test]
fn precedence_of_the_format() {
    for (text, expected) in [
        ("-2^2", "(-(2 ^ 2))"),
        ("2^3^2", "(2 ^ (3 ^ 2))"),
        ("2^-3", "(2 ^ (-3))"),
        ("a - b - c", "(a - b - c)"),
        ("a/b*c", "(a / b * c)"),
        ("a + b*c^d", "(a + (b * (c ^ d)))"),
        ("--a", "(-(-a))"),
        ("+a", "a"),
        ("a < b or not c == d and e", "((Less a b) or ((not (Equal c d)) and e))"),
        ("(a < b) == (c < d)", "(Equal (Less a b) (Less c d))"),
        ("if(a, b, c)", "if(a, b, c)"),
        ("f()", "f()"),
        ("crank.angle.x*t", "(crank.angle.x * t)"),
        ("73/12", "(73 / 12)"),
    ] {
        assert_eq!(parsed(text), expected, "{text}");
    }
}

#[test]
fn a_quantity_binds_tighter_than_every_operator() {
    for (text, expected) in [
        ("2 m^2", "[2 m^2]"),
        ("1/2 m", "(1 / [2 m])"),
        ("-2 m^2", "(-[2 m^2])"),
        ("2 m/k", "([2 m] / k)"),
        ("2 m/s", "[2 m/s]"),
        ("2 m/s.x", "([2 m] / s.x)"),
        ("2 m/min(a, b)", "([2 m] / min(a, b))"),
        ("2 m*A.fx", "([2 m] * A.fx)"),
        ("2 N*m + x", "([2 N m] + x)"),
        ("3 s and a", "([3 s] and a)"),
        ("(2 m)^2", "([2 m] ^ 2)"),
        ("4.26 N m s/rad", "[4.26 N m s]"),
    ] {
        assert_eq!(parsed(text), expected, "{text}");
    }
}

#[test]
fn spans_cover_what_they_name() {
    let text = " a + (b*c) ";
    let Expr { at, kind: Kind::Sum(_, rest) } = parse(text).unwrap() else { panic!() };
    assert_eq!(&text[at], "a + (b*c)");
    assert_eq!(&text[rest[0].1.at.clone()], "(b*c)");
    assert_eq!((parse("-3.5").unwrap().number(), parse("x.y").unwrap().path()), (Some(-3.5), Some("x.y")));
    assert!(!parse("3 m").unwrap().is_number());
}

#[test]
fn a_missing_star_is_named() {
    for (text, help) in [
        ("2(a)", "`2*(..)`"),
        ("2 k", "`2*k`"),
        ("a b", "`a*b`"),
        ("(a)(b)", "`(..)*(..)`"),
        ("(a) b", "`(..)*b`"),
        ("a 2", "`a*2`"),
        ("2 m k", "`m*k`"),
        ("a.b(c)", "`a.b*(..)`"),
        ("2 A.fx", "`2*A.fx`"),
        ("3 min(a, b)", "`3*min(..)`"),
    ] {
        let error = error(text);
        assert!(error.help.as_ref().is_some_and(|h| h.contains(help)), "{text}: {error:?}");
    }
}

#[test]
fn unbalanced_parentheses_tell_of_the_comma_trap() {
    for text in ["if(a", "max(a", "(a + b", "c)", "a, b)"] {
        let e = error(text);
        let trapped = e.help.as_ref().is_some_and(|h| h.contains("`{ }`"));
        assert!(trapped || text == "a, b)", "{text}: {e:?}");
    }
    assert_eq!(error("if(a").found, "the end of the expression");
    assert_eq!(error("if(a").at, 4..4);
    assert!(error("0,5").help.unwrap().contains("`0.5`"));
}

#[test]
fn comparisons_do_not_chain() {
    assert!(error("a < b < c").help.unwrap().contains("chain"));
    assert!(error("a + not b").help.unwrap().contains("(not a)"));
    assert!(error("and b").help.is_some());
}

#[test]
fn incomplete_texts() {
    for (text, found) in
        [("", "nothing"), ("  ", "nothing"), ("2 +", "the end of the expression"), ("*2", "`*`"), ("f(,)", "`,`"), ("()", "`)`")]
    {
        assert_eq!(error(text).found, found, "{text}");
    }
}

#[test]
fn size_and_depth_are_bounded() {
    for text in ["(".repeat(60_000), "-".repeat(60_000), "2^".repeat(30_000), "f(".repeat(30_000), "not ".repeat(15_000)] {
        assert!(parse(&text).is_err());
    }
    assert!(error(&"(".repeat(100)).expected.contains("64"));
    assert!(error(&"x".repeat(70_000)).expected.contains("65536"));
    let depth = "(".repeat(64) + "x" + &")".repeat(64);
    assert_eq!(parsed(&depth), "x");
    // long chains are flat
    assert!(parse(&("x".to_owned() + &"+x".repeat(32_000))).is_ok());
}

#[test]
fn no_text_panics() {
    let pieces = [
        "a", "2", "1e5", "0.5", " ", "(", ")", ",", "+", "-", "*", "/", "^", "<", "<=", "==", "!", "=", "and ", " or ", "not ", "m", "kg",
        "N", "s", "min", "min(", "if(", "%", ".", "..", "x.y", "é", "π", "Hz", "Nm", "e", "_", "0x", "1_0", ":", "~", "\"", "\n", "\u{0}",
        "mm2", "rad", "deg", "🦀", "012", "|",
    ];
    let mut seed: u64 = 7;
    let mut next = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as usize
    };
    for _ in 0..40_000 {
        let text: String = (0..next() % 12).map(|_| pieces[next() % pieces.len()]).collect();
        match parse(&text) {
            Ok(e) => assert!(text.get(e.at).is_some(), "{text}"),
            Err(e) => assert!(text.get(e.at.clone()).is_some() && !e.expected.is_empty(), "{text}: {e:?}"),
        }
    }
}
