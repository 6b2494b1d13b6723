//! What is wrong with names.

use crate::check::names::{Kind, Symbol};
use crate::diag::{Diagnostic, Edit};
use crate::quantity::SYMBOLS;
use crate::source::Span;
use crate::syntax::ast::{Name, Reference};

fn did_you_mean(diagnostic: Diagnostic, near: Option<&str>) -> Diagnostic {
    match near {
        Some(near) => {
            let place = diagnostic.labels.first().map_or(Span::default(), |label| label.span);
            diagnostic.with_help(format!("did you mean `{near}`?")).meant(place, near)
        }
        None => diagnostic,
    }
}

pub(in crate::check) fn unknown_name(name: &Name, wanted: &str, near: Option<&str>) -> Diagnostic {
    let code = match wanted {
        "region" => "dosm::check::unknown_region",
        "robot" => "dosm::check::unknown_robot",
        "dynamics model" => "dosm::check::unknown_dynamics",
        "defined formula" => "dosm::check::unknown_formula",
        _ => "dosm::check::unknown_constant",
    };
    let message = format!("there is no {wanted} `{}`", name.text);
    let diagnostic = Diagnostic::error(code, message, name.span, "not declared");
    if wanted == "constant" && SYMBOLS.contains(&name.text.as_str()) {
        return diagnostic.with_help("a unit is written without blanks inside and follows a number: `2 m/s`");
    }
    did_you_mean(diagnostic, near)
}

/// A name in `where` that is neither a constant nor one of the things that inequalities are about.
pub(in crate::check) fn unknown_coordinate(
    name: &Name,
    coordinates: &[&str],
    near: Option<&str>,
) -> Diagnostic {
    let message = format!("there is no constant or coordinate `{}`", name.text);
    let known: Vec<String> = coordinates.iter().map(|c| format!("`{c}`")).collect();
    let diagnostic = Diagnostic::error("dosm::check::unknown_constant", message, name.span, "not declared");
    if near.is_some() {
        return did_you_mean(diagnostic, near);
    }
    diagnostic.with_help(format!("inequalities here are about {}", known.join(", ")))
}

pub(in crate::check) fn wrong_kind(name: &Name, wanted: &str, symbol: Symbol) -> Diagnostic {
    let message = format!("`{}` is {}, not a {wanted}", name.text, symbol.kind.a_noun());
    let diagnostic = Diagnostic::error(
        "dosm::check::wrong_kind",
        message,
        name.span,
        format!("a {wanted} is needed here"),
    )
    .with_label(symbol.span, format!("declared as {}", symbol.kind.a_noun()));
    match (wanted, symbol.kind) {
        ("defined formula", Kind::Robot) => diagnostic.with_help(format!("say where: `{} in …`", name.text)),
        ("defined formula", Kind::Region) => diagnostic.with_help(format!("say who: `… in {}`", name.text)),
        ("defined formula", Kind::Goal) => {
            diagnostic.with_help("formulas that others use are declared with `define`")
        }
        _ => diagnostic,
    }
}

pub(in crate::check) fn bound_variable(name: &Name, wanted: &str) -> Diagnostic {
    let message = format!("`{}` is a bound variable, not a {wanted}", name.text);
    Diagnostic::error("dosm::check::wrong_kind", message, name.span, format!("a {wanted} is needed here"))
}

pub(in crate::check) fn robot_as_number(name: &Name) -> Diagnostic {
    let message = format!("`{}` stands for a robot, not for a number", name.text);
    Diagnostic::error("dosm::check::wrong_kind", message, name.span, "a number is needed here")
}

pub(in crate::check) fn duplicate_name(name: &Name, kind: Kind, first: Symbol) -> Diagnostic {
    let message = format!("`{}` is declared twice", name.text);
    Diagnostic::error("dosm::check::duplicate", message, name.span, format!("again, as {}", kind.a_noun()))
        .with_label(first.span, format!("first declared here, as {}", first.kind.a_noun()))
        .perhaps_by(format!("call this one `{}_2`", name.text), another_name(name, "_2"))
}

/// A declared name with something behind it.
fn another_name(name: &Name, behind: &str) -> Vec<Edit> {
    vec![Edit::Replace(name.span, format!("{}{behind}", name.text))]
}

pub(in crate::check) fn repeated(what: &str, first: Span, second: Span) -> Diagnostic {
    let message = format!(
        "there may be only one {}",
        if what == "item" { "item of a kind".into() } else { format!("`{what}`") }
    );
    Diagnostic::error("dosm::check::duplicate", message, second, "the second one")
        .with_label(first, "the first one")
        .perhaps_by("remove the second one", vec![Edit::Remove(second)])
        .perhaps_by("remove the first one", vec![Edit::Remove(first)])
}

pub(in crate::check) fn predeclared_name(name: &Name) -> Diagnostic {
    let message = format!("`{}` is predeclared and may not be hidden", name.text);
    Diagnostic::error("dosm::check::predeclared", message, name.span, "choose another name")
}

pub(in crate::check) fn hidden_name(variable: &Name, symbol: Symbol) -> Diagnostic {
    let message = format!("the variable `{}` hides {}", variable.text, symbol.kind.a_noun());
    Diagnostic::warning("dosm::check::hidden_name", message, variable.span, "means the variable from here on")
        .with_label(symbol.span, "hidden")
}

pub(in crate::check) fn hidden_variable(variable: &Name) -> Diagnostic {
    let message = format!("the variable `{0}` hides another variable `{0}`", variable.text);
    Diagnostic::warning(
        "dosm::check::hidden_name",
        message,
        variable.span,
        "means this variable from here on",
    )
}

pub(in crate::check) fn unused(name: &str, symbol: Symbol) -> Diagnostic {
    let message = format!("the {} `{name}` is never used", symbol.kind.noun());
    Diagnostic::warning("dosm::check::unused", message, symbol.span, "never used")
}

pub(in crate::check) fn misplaced_doc(span: Span) -> Diagnostic {
    Diagnostic::warning(
        "dosm::check::misplaced_doc",
        "this `///` comment documents nothing",
        span,
        "not directly before a declaration, an item or a state",
    )
    .with_help("write `//` for a plain comment")
    .mended_by("write `//`, a plain comment", plain_comment(span))
}

/// The slashes of `///` or `//!`, exchanged.
fn plain_comment(span: Span) -> Vec<Edit> {
    vec![Edit::Replace(Span { end: span.end.min(span.start + 3), ..span }, "//".into())]
}

pub(in crate::check) fn circle(what: &str, names: &[&Name]) -> Diagnostic {
    let list: Vec<&str> = names.iter().chain(names.first()).map(|n| n.text.as_str()).collect();
    let message = format!("the {what} `{}` is defined by itself: {}", list[0], list.join(" → "));
    let span = names.first().map_or(Span::default(), |n| n.span);
    let diagnostic = Diagnostic::error("dosm::check::circle", message, span, "the circle begins here");
    names.iter().skip(1).fold(diagnostic, |d, n| d.with_label(n.span, "and goes through here"))
}

pub(in crate::check) fn family_too_large(span: Span, len: i64) -> Diagnostic {
    let most = crate::check::families::MAX_FAMILY;
    let message = format!("{len} members are too many: a family or range has at most {most}");
    Diagnostic::error("dosm::check::family_too_large", message, span, "too many members")
}

pub(in crate::check) fn too_many_members(span: Span, most: usize) -> Diagnostic {
    let message = format!("the mission's families have more than {most} members together");
    Diagnostic::error("dosm::check::family_too_large", message, span, "too many with this one")
}

pub(in crate::check) fn family_as_member(reference: &Reference, wanted: &str) -> Diagnostic {
    let name = &reference.name.text;
    let message = format!("`{name}` is a family; one of its members is needed here");
    Diagnostic::error("dosm::check::family_as_member", message, reference.span, format!("which {wanted}?"))
        .with_help(format!("name a member, such as `{name}[1]`"))
}

pub(in crate::check) fn wrong_member_indices(reference: &Reference, wanted: usize) -> Diagnostic {
    let (name, found) = (&reference.name.text, reference.indices.len());
    let message = if wanted == 0 {
        format!("`{name}` has no members to choose by an index")
    } else {
        format!(
            "a member of `{name}` has {wanted} ind{}, not {found}",
            if wanted == 1 { "ex" } else { "ices" }
        )
    };
    Diagnostic::error("dosm::check::wrong_index_count", message, reference.span, "here")
}

pub(in crate::check) fn no_such_member(
    reference: &Reference,
    indices: &[i64],
    ranges: &[(i64, i64)],
) -> Diagnostic {
    let list = |items: Vec<String>| items.join(", ");
    let found = list(indices.iter().map(i64::to_string).collect());
    let wanted = list(ranges.iter().map(|(a, b)| format!("{a}..{b}")).collect());
    let message = format!("there is no member `{}[{found}]`", reference.name.text);
    let help = if ranges.iter().any(|(a, b)| a > b) {
        format!("`{}` has no members at all: the indices run over {wanted}", reference.name.text)
    } else {
        format!("the indices run over {wanted}")
    };
    Diagnostic::error("dosm::check::no_such_member", message, reference.span, "not a member").with_help(help)
}

pub(in crate::check) fn team_as_robot(reference: &Reference, symbol: Symbol) -> Diagnostic {
    let name = &reference.name.text;
    let message = format!("`{name}` is a team, not a robot");
    Diagnostic::error("dosm::check::wrong_kind", message, reference.span, "a robot is needed here")
        .with_label(symbol.span, "declared as a team")
        .with_help(format!("write `forall r in {name}: r in …` or `exists r in {name}: r in …`"))
}
