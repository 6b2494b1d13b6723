//! Regions, obstacles and jammers: their size, and what a tube leaves of it or adds to it.

use super::model::widths;
use super::symbol::{family, list};
use super::{Page, View};
use crate::check::{Facts, typed};
use crate::exact::Rational;
use crate::geometry::{HalfSpace, Polytope};
use crate::ir::{BlockerKind, Piece};
use crate::lsp::index::{Symbol, SymbolKind};
use crate::lsp::number::{self, half_width, measure, point, size};
use crate::lsp::tubes::{ModelTube, moving};

/// The most models whose robots are spoken of.
const MOST_MODELS: usize = 4;
/// The most members of a family that are spoken of one by one.
const MOST_MEMBERS: usize = 4;

/// The most members of a family whose sizes are computed.
const MOST_SIZED: usize = 8;

/// A member of a family, or the only one.
struct Member<'f> {
    name: &'f str,
    shape: &'f typed::Shape,
    /// What is certain of an uncertain region.
    sure: &'f typed::Shape,
}

impl View<'_> {
    /// A region, an obstacle or a jammer; of a family all members, or one.
    pub(super) fn set(
        &self,
        page: &mut Page,
        symbol: &Symbol,
        facts: &Facts,
        item: usize,
        member: Option<&str>,
    ) {
        let region = symbol.kind == SymbolKind::Region;
        let mut members: Vec<Member> = if region {
            facts.regions(Some(item)).map(|(_, r)| Member::of_region(r)).collect()
        } else {
            facts
                .blockers(Some(item))
                .map(|(_, b)| Member { name: &b.name, shape: &b.shape, sure: &b.shape })
                .collect()
        };
        members.retain(|m| member.is_none_or(|member| member == m.name));
        let opaque = facts.blockers(Some(item)).any(|(_, b)| b.kind == BlockerKind::OpaqueObstacle);
        let noun = if opaque { "opaque obstacle" } else { symbol.kind.noun() };
        page.say(format!("**{noun}**{}", family(facts, item, noun)));
        if members.is_empty() {
            page.say("It has errors, or no member.");
        }
        for member in members.iter().take(MOST_MEMBERS) {
            page.say(described(member));
        }
        if members.len() > MOST_MEMBERS {
            page.say(format!("and {} more", members.len() - MOST_MEMBERS));
        }
        for id in moving(facts).into_iter().take(MOST_MODELS) {
            let Some(tube) = self.tubes.of(facts, id, self.document.float()) else { continue };
            let text = if region { left(&members, &tube, facts) } else { inflated(&members, &tube) };
            page.say(text);
        }
    }
}

impl<'f> Member<'f> {
    fn of_region(region: &'f typed::Region) -> Member<'f> {
        let sure = region.sure.as_ref().unwrap_or(&region.shape);
        Member { name: &region.name, shape: &region.shape, sure }
    }
}

/// Where a set lies and how large it is.
fn described(member: &Member) -> String {
    let Some((lo, hi)) = bounding_box(&member.shape.pieces) else {
        return format!("`{}` is empty", member.name);
    };
    let mut text = format!("`{}` lies in {} .. {}: {}", member.name, point(&lo), point(&hi), size(&lo, &hi));
    match &member.shape.pieces[..] {
        [one] => text += &area(one).map_or_else(String::new, |a| format!(", area {} m²", measure(a))),
        pieces => text += &format!(", {}", number::counted(pieces.len(), "piece")),
    }
    text
}

/// What a model's tube leaves of regions for `in`.
fn left(members: &[Member], tube: &ModelTube, facts: &Facts) -> String {
    let name = &tube.model.name;
    let Some(errors) = &tube.errors else { return format!("For `{name}` there is no tube.") };
    let (mut rooms, mut nothing) = (Vec::new(), Vec::new());
    for member in members.iter().take(MOST_SIZED) {
        let room = member.sure.pieces.iter().filter_map(|p| room(p, errors.positions(), facts)).next();
        match room {
            Some(room) => rooms.push(format!("`{}`: {room}", member.name)),
            None => nothing.push(format!("`{}`", member.name)),
        }
    }
    let mut text = format!("With the tube of `{name}`, {}", widths(tube));
    if !rooms.is_empty() {
        text += &format!(", what is left for `in`: {}", list(&rooms));
    }
    if !nothing.is_empty() {
        text += &format!(
            "\n\n⚠ **Nothing is left** of {}: no robot of `{name}` is ever certainly in it. It would have to be wider than {}.",
            list(&nothing),
            sides(tube),
        );
    }
    text
}

/// Where the nominal position has to be for the tube to lie in a piece, as a size.
fn room(piece: &Piece, errors: &Polytope, facts: &Facts) -> Option<String> {
    match piece {
        Piece::Polytope(polytope) => {
            let workspace = facts.workspace.iter().flat_map(|w| &w.polytope.facets);
            let rows: Vec<HalfSpace> =
                polytope.facets.iter().chain(workspace).map(|f| shrunk(f, errors)).collect();
            let room = Polytope::from_half_spaces(&rows).ok()?;
            let (lo, hi) = room.bounding_box();
            Some(size(&lo, &hi))
        }
        Piece::Ball { radius, .. } => {
            let far =
                errors.vertices.iter().map(|v| v.iter().map(|x| x.to_f64().powi(2)).sum::<f64>().sqrt());
            let rest = radius.to_f64() - far.fold(0.0, f64::max);
            (rest > 0.0).then(|| format!("radius {} m at least", measure(rest)))
        }
    }
}

fn shrunk(facet: &HalfSpace, errors: &Polytope) -> HalfSpace {
    HalfSpace { normal: facet.normal.clone(), offset: &facet.offset - errors.support(&facet.normal) }
}

/// How large blockers are for a model's nominal position.
fn inflated(members: &[Member], tube: &ModelTube) -> String {
    let name = &tube.model.name;
    if tube.errors.is_none() {
        return format!("For `{name}` there is no tube.");
    }
    let grown = members.iter().take(MOST_SIZED).filter_map(|member| {
        let (lo, hi) = bounding_box(&member.shape.pieces)?;
        let sides: Vec<String> = (0..lo.len())
            .filter_map(|axis| Some((&hi[axis] - &lo[axis]).to_f64() + 2.0 * tube.half_width(axis)?))
            .map(|side| format!("{} m", measure(side)))
            .collect();
        Some(format!("`{}`: {}", member.name, sides.join(" × ")))
    });
    let grown: Vec<String> = grown.collect();
    format!("With the tube of `{name}` around it, {}: {}", widths(tube), list(&grown))
}

/// The tube's whole widths.
fn sides(tube: &ModelTube) -> String {
    let axes = (0..tube.model.position.len()).filter_map(|axis| tube.half_width(axis));
    axes.map(|w| format!("{} m", half_width(2.0 * w))).collect::<Vec<_>>().join(" × ")
}

/// The box around some pieces.
fn bounding_box(pieces: &[Piece]) -> Option<(Vec<Rational>, Vec<Rational>)> {
    let of_piece = |piece: &Piece| match piece {
        Piece::Polytope(polytope) => polytope.bounding_box(),
        Piece::Ball { center, spread, radius } => {
            let lo = center.iter().zip(spread).map(|(c, s)| c - s - radius).collect();
            let hi = center.iter().zip(spread).map(|(c, s)| c + s + radius).collect();
            (lo, hi)
        }
    };
    pieces.iter().map(of_piece).reduce(|(lo, hi), (a, b)| {
        let least = lo.into_iter().zip(a).map(|(x, y)| if x < y { x } else { y }).collect();
        let most = hi.into_iter().zip(b).map(|(x, y)| if x > y { x } else { y }).collect();
        (least, most)
    })
}

/// The area of a piece in the plane.
fn area(piece: &Piece) -> Option<f64> {
    match piece {
        Piece::Polytope(polytope) if polytope.dimension() == 2 => {
            let corners: Vec<[f64; 2]> =
                polytope.vertices.iter().map(|v| [v[0].to_f64(), v[1].to_f64()]).collect();
            let next = corners.iter().cycle().skip(1);
            Some(corners.iter().zip(next).map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum::<f64>() / 2.0)
        }
        Piece::Ball { center, spread, radius }
            if center.len() == 2 && spread.iter().all(Rational::is_zero) =>
        {
            Some(std::f64::consts::PI * radius.to_f64().powi(2))
        }
        _ => None,
    }
}
