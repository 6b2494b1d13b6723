//! Who hands messages on to whom: the shortest chains of a step's links to a base.

use std::collections::BTreeMap;

use super::{Link, Plan};

/// The next link on a robot's way to a base.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hop<'a> {
    /// The robot or base that the robot talks to.
    pub to: &'a str,
    /// How many links there are to a base, this one included.
    pub links: usize,
}

impl Plan {
    /// By robot, the first link of a shortest chain to a base over the links that the plan relies on at
    /// a step: the first in their order among equals. A robot without a chain is left out.
    pub fn next_hops(&self, step: usize) -> BTreeMap<&str, Hop<'_>> {
        let links = self.links.as_ref().and_then(|all| all.get(step)).map_or(&[][..], Vec::as_slice);
        hops(links, |name| self.robots.iter().any(|r| r.name == name))
    }
}

/// Walks from the bases outwards. Links between robots go both ways; what is no robot is a base.
fn hops<'a>(links: &'a [Link], is_robot: impl Fn(&str) -> bool) -> BTreeMap<&'a str, Hop<'a>> {
    let mut found: BTreeMap<&str, Hop<'_>> = BTreeMap::new();
    for count in 1.. {
        let mut farther: BTreeMap<&str, Hop<'_>> = BTreeMap::new();
        for link in links {
            for (near, far) in [(&link.to, &link.from), (&link.from, &link.to)] {
                let reached = if count == 1 { !is_robot(near) } else { found.contains_key(near.as_str()) };
                if reached && is_robot(far) && !found.contains_key(far.as_str()) {
                    farther.entry(far).or_insert(Hop { to: near, links: count });
                }
            }
        }
        if farther.is_empty() {
            break;
        }
        found.extend(farther);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn link(from: &str, to: &str) -> Link {
        Link { from: from.into(), to: to.into(), hops: 0, separators: Vec::new() }
    }

    #[test]
    fn chains_are_shortest_and_links_go_both_ways() {
        // a - base, a - b (written from a), b - c, and a pair that reaches nobody.
        let links = [
            link("b", "c"),
            link("a", "b"),
            link("a", "base"),
            link("x", "y"),
            link("c", "a"),
            link("y", "x"),
        ];
        let found = hops(&links, |name| name != "base");
        let said: Vec<String> =
            found.iter().map(|(from, hop)| format!("{from} {} {}", hop.to, hop.links)).collect();
        assert_eq!(said, ["a base 1", "b a 2", "c a 2"]);
    }

    #[test]
    fn a_direct_link_is_better_than_a_chain() {
        let links = [link("a", "b"), link("b", "base"), link("a", "tower")];
        let found = hops(&links, |name| name.len() == 1);
        assert_eq!(found["a"], Hop { to: "tower", links: 1 });
    }
}
