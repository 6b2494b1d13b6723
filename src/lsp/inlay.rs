//! What an editor shows between the words: values of computed constants, steps of windows given as times,
//! sizes of families.

use lsp_types::{InlayHint, InlayHintLabel, InlayHintTooltip, Range};

use super::Document;
use super::number;
use crate::check::typed::Signal;
use crate::check::{Facts, Known};
use crate::exact::Rational;
use crate::quantity::Unit;
use crate::source::Span;
use crate::syntax::ast::{DynamicsItem, DynamicsKind, Expr, ExprKind, FamilyName, Item, ItemKind};

/// The hints in a range, in the order of their places.
pub fn hints(document: &Document, range: Range) -> Vec<InlayHint> {
    let asked = document.lines.span_of(range);
    let (Some(file), Some(facts)) = (document.file(), document.facts()) else { return Vec::new() };
    let first = file.items.partition_point(|item| item.span.end < asked.start);
    let last = file.items.partition_point(|item| item.span.start <= asked.end);
    let items = file.items.iter().enumerate().take(last).skip(first);
    let mut found: Vec<Hint> =
        items.flat_map(|(place, item)| of_item(document, facts, place, item)).collect();
    found.retain(|hint| asked.start <= hint.at && hint.at <= asked.end);
    found.sort_by_key(|hint| hint.at);
    found.into_iter().map(|hint| hint.shown(document)).collect()
}

/// A hint behind a place.
struct Hint {
    at: u32,
    label: String,
    tooltip: String,
}

impl Hint {
    fn shown(self, document: &Document) -> InlayHint {
        InlayHint {
            position: document.lines.position(self.at),
            label: InlayHintLabel::String(self.label),
            kind: None,
            text_edits: None,
            tooltip: Some(InlayHintTooltip::String(self.tooltip)),
            padding_left: Some(true),
            padding_right: Some(false),
            data: None,
        }
    }
}

fn of_item(document: &Document, facts: &Facts, place: usize, item: &Item) -> Vec<Hint> {
    match &item.kind {
        ItemKind::Param { value, .. } | ItemKind::Let { value, .. } => {
            constant(facts, place, value).into_iter().collect()
        }
        ItemKind::Region { name, .. } => family(document, facts, place, name, "region"),
        ItemKind::Obstacle { name, .. } => family(document, facts, place, name, "obstacle"),
        ItemKind::Jammer { name, .. } => family(document, facts, place, name, "jammer"),
        ItemKind::Base { name, .. } => family(document, facts, place, name, "base"),
        ItemKind::Robot { name, .. } => family(document, facts, place, name, "robot"),
        ItemKind::Dynamics { items, .. } => signals(facts, place, items).into_iter().collect(),
        ItemKind::Goal { .. } | ItemKind::Define { .. } | ItemKind::Connectivity(_) => {
            windows(document, facts, item.span)
        }
        _ => Vec::new(),
    }
}

/// The value of a constant that isn't a plain number.
fn constant(facts: &Facts, place: usize, value: &Expr) -> Option<Hint> {
    let known = facts.constant(place).filter(|known| matches!(known, Known::Scalar(_)))?;
    let Known::Scalar(quantity) = known else { return None };
    // A parameter that the command line overrides says another number than it has.
    let plain = plain(value).is_some_and(|number| number == quantity.number);
    (!plain).then(|| Hint {
        at: value.span.end,
        label: number::equals(&number::known(known)),
        tooltip: format!("The value: exactly {}{}", quantity.number, number::unit(quantity.dimension)),
    })
}

/// The value of a number with or without sign and unit.
fn plain(expr: &Expr) -> Option<Rational> {
    let (mut expr, mut scale) = (expr, Rational::ONE);
    loop {
        match &expr.kind {
            ExprKind::Number(number) => return Some(number * &scale),
            ExprKind::WithUnit(inner, unit) => {
                scale *= &Unit::from_factors(&unit.factors).ok()?.scale;
                expr = inner;
            }
            ExprKind::Negate(inner) => (expr, scale) = (inner, -scale),
            ExprKind::Parenthesised(inner) => expr = inner,
            _ => return None,
        }
    }
}

/// The names of the states and inputs that an `integrator` brings along.
fn signals(facts: &Facts, place: usize, items: &[DynamicsItem]) -> Option<Hint> {
    let item = items.iter().find(|item| matches!(item.kind, DynamicsKind::Integrator(_)))?;
    let (_, model) = facts.model(place)?;
    let names = |list: &[Signal]| list.iter().map(|s| s.name.as_str()).collect::<Vec<_>>().join(", ");
    let (states, inputs) = (names(&model.states), names(&model.inputs));
    Some(Hint {
        at: item.span.end,
        label: format!("{states}; {inputs}"),
        tooltip: format!("The states {states} and the inputs {inputs}"),
    })
}

/// How many members a family has, where that isn't plain to see.
fn family(document: &Document, facts: &Facts, place: usize, name: &FamilyName, noun: &str) -> Vec<Hint> {
    let Some(members) = facts.members(place).filter(|members| members.is_family) else { return Vec::new() };
    let is_one = |expr: &Expr| matches!(&expr.kind, ExprKind::Number(n) if *n == 1);
    let is_number = |expr: &Expr| matches!(expr.kind, ExprKind::Number(_));
    if let [only] = &name.indices[..]
        && is_one(&only.from)
        && is_number(&only.to)
    {
        return Vec::new();
    }
    let Some(last) = name.indices.last() else { return Vec::new() };
    let behind = document.source.text.get(last.to.span.end as usize..).unwrap_or("");
    let bracket = behind.find(']').map_or(0, |at| at as u32 + 1);
    vec![Hint {
        at: last.to.span.end + bracket,
        label: number::counted(members.places.len(), noun),
        tooltip: "The members of the family".into(),
    }]
}

/// The steps of the windows and times in a declaration that aren't plain numbers of steps.
fn windows(document: &Document, facts: &Facts, range: Span) -> Vec<Hint> {
    let step = facts.step.as_ref().map_or_else(String::new, |s| format!("A step is {} s", number::number(s)));
    let is_plain =
        |span: Span| document.source.slice(span).bytes().all(|b| b"[], \t\n0123456789".contains(&b));
    let told = facts.steps_in(range).filter(|(span, _)| !is_plain(*span));
    told.map(|(span, steps)| {
        let one = matches!(steps.listed[..], [(1, 1)]) && !steps.more;
        let unit = if one { "step" } else { "steps" };
        Hint { at: span.end, label: format!("= {} {unit}", number::steps(steps)), tooltip: step.clone() }
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use lsp_types::Position;

    use super::*;
    use crate::driver::Overrides;
    use crate::lsp::Encoding;

    const MISSION: &str = "dosm 1
param n = 2
let far = 2 m + 150 cm
let near = -50 cm
let third = (1 / 3) s
let t = [1, n] m
workspace box (0, 0) .. (10, 10)
region cell[i in 1..n, j in 1..2] = box (i, j) .. (i + 0.5, j + 0.5)
jammer é[i in 1..3] = ball (5, i) radius 1
jammer J[i in 1..3] = ball (5, 2 * i) radius 1
base mast at (1, 1)
dynamics Rover { step 0.5 s integrator 1 bound vx, vy in [-2, 2] }
robot f[i in 2..n + 1]: Rover at (1, i)
connectivity { every 2 s }
goal g: /* 😀 */ eventually[1 s, 20 s] f[2] in cell[1, 1]
goal h: always[0, 9] forall k in 1..2: eventually[k, 2 * k] true
";

    fn document(text: &str, set: &[(&str, &str)]) -> Document {
        let uri = "file:///m.dosm".parse().expect("it is a URI");
        let set = set.iter().map(|(n, v)| (n.to_string(), v.to_string())).collect();
        let overrides = Overrides { set, ..Overrides::default() };
        Document::new(uri, 1, text.into(), Encoding::Utf16, overrides)
    }

    /// The hints in some lines: line, column and label.
    fn shown(document: &Document, from: u32, to: u32) -> Vec<String> {
        let range = Range::new(Position::new(from, 0), Position::new(to, 0));
        let text = |hint: InlayHint| match hint.label {
            InlayHintLabel::String(label) => {
                format!("{}:{} {label}", hint.position.line, hint.position.character)
            }
            InlayHintLabel::LabelParts(_) => String::new(),
        };
        hints(document, range).into_iter().map(text).collect()
    }

    #[test]
    fn what_is_not_plain_to_see_is_shown() {
        let all = shown(&document(MISSION, &[]), 0, 99);
        assert_eq!(
            all,
            [
                "2:22 = 3.5 m",
                "4:21 ≈ 0.333333 s",
                "7:33 4 regions",
                "11:40 px, py; vx, vy",
                "12:22 2 robots",
                "13:24 = 4 steps",
                "14:38 = 2..40 steps",
                "15:59 = 1..2, 2..4 steps",
            ]
        );
    }

    #[test]
    fn only_what_is_asked_for_is_shown() {
        let document = document(MISSION, &[]);
        assert_eq!(shown(&document, 7, 11), ["7:33 4 regions"]);
        assert_eq!(shown(&document, 0, 1), [""; 0]);
        assert_eq!(shown(&document, 14, 15), ["14:38 = 2..40 steps"]);
    }

    #[test]
    fn a_mission_with_errors_keeps_what_is_known() {
        let text = MISSION.replace("box (0, 0)", "bo (0, 0)").replace("radius 1\nbase", "radius -1\nbase");
        let all = shown(&document(&text, &[]), 0, 99);
        assert_eq!(all.len(), 8, "{all:?}");
        assert_eq!(shown(&document("goal", &[]), 0, 9), [""; 0]);
    }

    #[test]
    fn an_overridden_parameter_shows_its_value() {
        let all = shown(&document(MISSION, &[("n", "3")]), 0, 3);
        assert_eq!(all, ["1:11 = 3", "2:22 = 3.5 m"]);
    }
}
