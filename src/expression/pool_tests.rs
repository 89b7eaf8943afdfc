use super::*;

#[test]
fn equal_expressions_are_one_node_and_one_switch() {
    let mut p = Pool::new();
    let (x, y) = (p.input(0), p.input(1));
    let a = p.compare(Compare::Less, x, y, "x < y");
    let b = p.compare(Compare::Greater, y, x, "y > x");
    assert_eq!(a, b);
    assert_eq!(p.min(x, y, "min(x, y)"), p.min(y, x, "min(y, x)"));
    let _ = (p.max(x, y, "max(x, y)"), p.abs(x, "abs(x)"), p.sign(x, "sign(x)"), p.table(0, 0, x, "f(x)"), p.table(0, 1, x, "f'"));
    let texts: Vec<&str> = p.switches().iter().map(|s| s.text.as_str()).collect();
    assert_eq!(texts, ["x < y", "min(x, y)", "abs(x)", "f(x)"]);
}

#[test]
fn leaves_are_sorted_and_distinct() {
    let mut p = Pool::new();
    let (x, y, k) = (p.input(5), p.input(2), p.parameter(1));
    let a = p.mul(x, k);
    let b = p.min(a, y, "");
    let c = p.add(b, a);
    assert_eq!((p.inputs_of(&[c, x]), p.parameters_of(&[c]), p.switches_of(&[c])), (vec![2, 5], vec![1], vec![0]));
    assert_eq!((p.inputs_of(&[]), p.inputs_of(&[k])), (vec![], vec![]));
    // a comparison depends on what it compares
    let d = p.compare(Compare::Less, x, y, "");
    assert_eq!(p.inputs_of(&[d]), [2, 5]);
    let t = p.table(3, 0, x, "");
    assert_eq!(p.tables_of(&[t, a]), [3]);
}

#[test]
fn operands_come_before_their_users() {
    let mut p = Pool::new();
    let x = p.input(0);
    let s = p.sin(x);
    let a = p.add(s, x);
    let order = p.reach(&[a]);
    assert_eq!(order, [x, s, a]);
    assert!(p.clone().len() == p.len() && !p.is_empty());
    assert_eq!(p.constant_value(x), None);
}

#[test]
fn conditions_are_known_as_such() {
    let mut p = Pool::new();
    let (x, y) = (p.input(0), p.input(1));
    let a = p.compare(Compare::Less, x, y, "");
    let b = p.condition(x, "");
    assert!(p.is_condition(a) && p.is_condition(b) && !p.is_condition(x));
    let (both, either) = (p.choose(a, b, a), p.choose(a, b, x));
    assert!(p.is_condition(both) && !p.is_condition(either));
}
