//! `src/links.rs`: who talks to whom, from the links that the plan relies on.

use std::fmt::Write;

use super::Contents;
use super::words::{code, literal};
use crate::plan::Link;

/// What the file begins with.
const HEAD: &str = "\
//! Who talks to whom at each moment of the plan: links that no jammer crosses, whatever the admissible
//! disturbances do.

// Hashes are long.
#![allow(clippy::unreadable_literal)]

";

/// The whole file.
pub(super) fn file(contents: &Contents<'_>) -> String {
    let nodes: Vec<(&String, &String)> = nodes(contents).collect();
    let robots = contents.robots.len();
    let moments = contents.plan.length + 1;
    let mut text = HEAD.to_owned();
    text.push_str(&contents.stamp());
    text.push_str("\n/// A robot or a base station.\n");
    text.push_str("#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]\npub enum Node {\n");
    for (at, (name, node)) in nodes.iter().enumerate() {
        let what = if at < robots { "The robot" } else { "The base station" };
        let _ = writeln!(text, "    /// {what} {}.\n    {node},", code(name));
    }
    let list: Vec<String> = nodes.iter().map(|(_, node)| format!("Node::{node}")).collect();
    let names: Vec<String> =
        nodes.iter().map(|(name, node)| format!("            Node::{node} => {},", literal(name))).collect();
    let _ = write!(
        text,
        "\
}}

impl Node {{
    /// All robots, then all base stations, in the mission's order.
    pub const ALL: [Node; {count}] = [{list}];

    /// Its name in the mission.
    #[must_use]
    pub fn name(self) -> &'static str {{
        match self {{
{names}
        }}
    }}

    /// Whether it is a base station.
    #[must_use]
    pub fn is_base(self) -> bool {{
        self as usize >= ROBOTS
    }}
}}

/// How many robots there are; they are the first of [`Node::ALL`].
pub const ROBOTS: usize = {robots};

/// How many moments the plan has.
pub const MOMENTS: usize = {moments};

/// A link between two nodes, to be used in both directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Link {{
    /// A robot.
    pub from: Node,
    /// A robot or a base station.
    pub to: Node,
}}

/// The node that a robot sends to at a moment, one hop nearer to a base station. `None` for base
/// stations, for moments that the plan does not have, and where it asks for no link.
#[must_use]
pub fn next_hop(moment: usize, node: Node) -> Option<Node> {{
    *NEXT_HOP.get(moment)?.get(node as usize)?
}}

/// The next hop of each robot at each moment.
#[rustfmt::skip]
pub static NEXT_HOP: [[Option<Node>; ROBOTS]; MOMENTS] = [
",
        count = nodes.len(),
        list = list.join(", "),
        names = names.join("\n"),
    );
    for moment in 0..moments {
        let hops: Vec<String> = next_hops(contents, moment)
            .into_iter()
            .map(|hop| hop.map_or("None".into(), |hop| format!("Some({})", list[hop])))
            .collect();
        let _ = writeln!(text, "    [{}],", hops.join(", "));
    }
    text.push_str("];\n\n/// All links that the plan relies on at each moment.\n#[rustfmt::skip]\n");
    text.push_str("pub static LINKS: [&[Link]; MOMENTS] = [\n");
    for moment in 0..moments {
        let links: Vec<String> = ends(contents, moment)
            .into_iter()
            .map(|(from, to)| format!("Link {{ from: {}, to: {} }}", list[from], list[to]))
            .collect();
        let _ = writeln!(text, "    &[{}],", links.join(", "));
    }
    text.push_str("];\n");
    text
}

/// The nodes: their names in the mission and in the crate.
fn nodes<'a>(contents: &'a Contents<'_>) -> impl Iterator<Item = (&'a String, &'a String)> {
    let problem = contents.problem;
    let robots = problem.robots.values().map(|robot| &robot.name).zip(&contents.names.robots);
    let bases = problem.bases.iter().map(|(_, base)| &base.name).zip(&contents.names.bases);
    robots.chain(bases)
}

/// The links of a moment, as places among the nodes.
fn ends(contents: &Contents<'_>, moment: usize) -> Vec<(usize, usize)> {
    let names: Vec<&String> = nodes(contents).map(|(name, _)| name).collect();
    let place = |name: &String| names.iter().position(|other| *other == name);
    let links: &[Link] =
        contents.plan.links.as_ref().and_then(|links| links.get(moment)).map_or(&[], Vec::as_slice);
    links.iter().filter_map(|link| Some((place(&link.from)?, place(&link.to)?))).collect()
}

/// Each robot's neighbour that is one hop nearer to a base; the first that the plan names.
fn next_hops(contents: &Contents<'_>, moment: usize) -> Vec<Option<usize>> {
    let found = contents.plan.next_hops(moment);
    let place = |wanted: &str| nodes(contents).position(|(name, _)| name == wanted);
    let robots = contents.problem.robots.values();
    robots.map(|robot| place(found.get(robot.name.as_str())?.to)).collect()
}
