//! What is known of missions, wrong ones among them.

use super::*;
use crate::syntax::parse;

/// A mission with its facts; places in it are looked up by their text.
struct Case {
    text: String,
    file: ast::File,
    facts: Facts,
    codes: Vec<&'static str>,
}

fn case(rest: &str) -> Case {
    let text = format!(
        "dosm 1
         workspace box (0, 0) .. (10, 10)
         region depot = box (6, 6) .. (9, 9)
         base mast at (1, 1)
         dynamics Rover {{ step 0.5 s  integrator 2  bound ax, ay in [-2, 2] m/s^2 }}
         robot R1: Rover at (2, 2)
         {rest}"
    );
    let source = SourceFile::new("test.dosm", text.as_str());
    let mut diagnostics = Diagnostics::new();
    let file = parse(&source, &mut diagnostics).expect("something");
    let (_, facts) = check_with_facts(&file, &source, &[], &mut diagnostics);
    Case { text, file, facts, codes: diagnostics.iter().map(|d| d.code).collect() }
}

impl Case {
    /// The place of a piece of the text.
    fn span(&self, piece: &str) -> Span {
        let start = self.text.find(piece).unwrap_or_else(|| panic!("no `{piece}`"));
        Span::new(start, start + piece.len())
    }

    /// The item in which a piece of the text stands.
    fn item(&self, piece: &str) -> usize {
        let at = self.span(piece);
        let holds = |i: &ast::Item| i.span.start <= at.start && at.end <= i.span.end;
        self.file.items.iter().position(holds).expect("an item")
    }

    fn value(&self, piece: &str) -> Option<String> {
        self.facts.value(self.span(piece)).map(shown)
    }

    fn place(&self, piece: &str) -> Option<String> {
        self.facts.place(self.span(piece)).map(shown)
    }

    fn steps(&self, piece: &str) -> Option<Vec<(u32, u32)>> {
        self.facts.steps(self.span(piece)).map(|s| s.listed.clone())
    }
}

fn shown(values: &Values) -> String {
    let list: Vec<String> = values.listed.iter().map(|v| v.to_f64().to_string()).collect();
    let dots = if values.more { " …" } else { "" };
    format!("{}{dots} {}", list.join(" "), values.dimension)
}

#[test]
fn constants_have_values() {
    let case = case("param n = 3 let d = 2 * n cm let t = [1, 2; n, 4] m let bad = 1 m + 1");
    let item = |name: &str| case.facts.constant(case.item(name));
    let quantity = |n: Rational, dimension| Quantity { number: n, dimension };
    assert_eq!(item("n = 3"), Some(&Known::Scalar(quantity(Rational::from(3), Dimension::NONE))));
    // `2 * n cm` is no name with a unit: the parser says so, and the rest is known all the same.
    assert_eq!(case.codes.iter().filter(|c| c.contains("syntax")).count(), 1, "{:?}", case.codes);
    let Some(Known::Table(rows)) = item("t = [") else { panic!("no table") };
    assert_eq!(rows[1][0], quantity(Rational::from(3), Dimension::LENGTH));
    assert_eq!(item("bad"), None);
}

#[test]
fn parts_of_expressions_have_values() {
    let case = case("let d = 2 m let far = 3 * (d + 50 cm) ^ 2 goal g: always eventually R1 in depot");
    assert_eq!(case.value("d + 50 cm").as_deref(), Some("2.5 m"));
    assert_eq!(case.value("(d + 50 cm) ^ 2").as_deref(), Some("6.25 m^2"));
    assert_eq!(case.value("3 * (d + 50 cm) ^ 2").as_deref(), Some("18.75 m^2"));
    assert_eq!(case.value("50 cm"), None, "a number says itself what it is");
    let all: Vec<Span> =
        case.facts.values_in(case.span("far = 3 * (d + 50 cm) ^ 2")).map(|(s, _)| s).collect();
    assert_eq!(all.len(), 4, "{all:?}");
}

#[test]
fn places_have_units_and_families_have_several_values() {
    let case = case("region r[i in 1..3] = box (2 * i, 20 cm) .. (2 * i + 1, 3) separation 30 cm");
    assert_eq!(case.value("2 * i").as_deref(), Some("2 4 6 1"));
    assert_eq!(case.place("2 * i").as_deref(), Some("2 4 6 m"));
    assert_eq!(case.place("2 * i + 1").as_deref(), Some("3 5 7 m"));
    assert_eq!(case.place("30 cm").as_deref(), Some("0.3 m"));
    assert_eq!(case.place("-2").as_deref(), Some("-2 m/s^2"));
    let members = case.facts.members(case.item("r[i in")).unwrap();
    assert_eq!((members.places.clone(), members.is_family), (1..4, true));
    assert!(!case.facts.members(case.item("depot =")).unwrap().is_family);
    let names: Vec<&str> =
        case.facts.regions(Some(case.item("r[i in"))).map(|(_, r)| r.name.as_str()).collect();
    assert_eq!(names, ["r[1]", "r[2]", "r[3]"]);
}

#[test]
fn long_lists_are_cut() {
    let case = case("region r[i in 1..30] = box (i / 10, 1) .. (i / 10 + 1, 3)");
    let values = case.facts.value(case.span("i / 10")).unwrap();
    assert_eq!((values.listed.len(), values.more), (MOST_LISTED, true));
    assert_eq!((&values.least, &values.most), (&Rational::ratio(1, 10), &Rational::from(3)));
}

#[test]
fn windows_have_steps() {
    let case = case(
        "connectivity { every 2 s }
         goal g: always[0, 4] R1 in depot or eventually[1 s, 20 s] R1 in depot
         goal h: forall i in 1..2: eventually[i, 10 * i] R1 in depot",
    );
    assert_eq!(case.steps("[0, 4]"), Some(vec![(0, 4)]));
    assert_eq!(case.steps("[1 s, 20 s]"), Some(vec![(2, 40)]));
    assert_eq!(case.steps("[i, 10 * i]"), Some(vec![(1, 10), (2, 20)]));
    assert_eq!(case.steps("2 s"), Some(vec![(4, 4)]));
    assert_eq!(case.steps("2 s }"), None);
    assert_eq!(case.facts.steps_in(Span::new(0, case.text.len())).count(), 4);
}

#[test]
fn a_wrong_declaration_leaves_the_others_their_facts() {
    let case = case(
        "region bad = box (1, 1) .. (1, 2)
         jammer lost = bal (1, 1) radius 2
         dynamics Worse { step 0.5 s }
         robot R2: Worse at (1, 1)
         team both = R1
         goal g: always R1 in depot goal h: R9 in depot",
    );
    assert!(case.codes.len() >= 4, "{:?}", case.codes);
    let (_, rover) = case.facts.model(case.item("dynamics Rover")).unwrap();
    assert_eq!(rover.states.len(), 4);
    assert!(case.facts.model(case.item("dynamics Worse")).is_none());
    assert_eq!(case.facts.regions(None).count(), 1);
    assert_eq!(case.facts.robots(None).count(), 1);
    assert_eq!(case.facts.team(case.item("team both")).map(<[RobotId]>::len), Some(1));
    assert_eq!(case.facts.root(case.item("goal h")), None);
    let root = case.facts.root(case.item("goal g")).unwrap();
    assert_eq!(case.facts.concerned(root), (vec![0], vec![0]));
    assert!(case.facts.workspace.is_some());
}

#[test]
fn shared_formulas_are_looked_at_once() {
    let mut text = String::from("define d0 = R1 in depot\n");
    for i in 1..60 {
        text += &format!("define d{i} = d{} and d{}\n", i - 1, i - 1);
    }
    let case = case(&text);
    let root = case.facts.root(case.item("define d59")).unwrap();
    assert_eq!(case.facts.concerned(root), (vec![0], vec![0]));
}
