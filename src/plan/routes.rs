//! Who hands messages on to whom: the shortest chains of a step's links to a base.

use std::collections::{BTreeMap, VecDeque};

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
    /// For each robot, in the plan's order, the first link of a shortest chain to a base over the links
    /// that the plan relies on at a step: the first in their order among equals. None without a chain.
    pub fn next_hops(&self, step: usize) -> Vec<Option<Hop<'_>>> {
        let links = self.links.as_ref().and_then(|all| all.get(step)).map_or(&[][..], Vec::as_slice);
        let found = hops(links, |name| self.robots.iter().any(|r| r.name == name));
        self.robots.iter().map(|robot| found.get(robot.name.as_str()).copied()).collect()
    }
}

/// Walks from the bases outwards. Links between robots go both ways; what is no robot is a base.
fn hops<'a>(links: &'a [Link], is_robot: impl Fn(&str) -> bool) -> BTreeMap<&'a str, Hop<'a>> {
    let mut found: BTreeMap<&str, Hop<'_>> = BTreeMap::new();
    let mut queue = VecDeque::new();
    for link in links.iter().filter(|link| !is_robot(&link.to)) {
        if !found.contains_key(link.from.as_str()) {
            found.insert(&link.from, Hop { to: &link.to, links: 1 });
            queue.push_back(link.from.as_str());
        }
    }
    while let Some(near) = queue.pop_front() {
        let links_from_near = found.get(near).map_or(0, |hop| hop.links);
        for link in links.iter().filter(|link| is_robot(&link.to)) {
            let far = match (link.from.as_str(), link.to.as_str()) {
                (from, to) if to == near => from,
                (from, to) if from == near => to,
                _ => continue,
            };
            if !found.contains_key(far) {
                found.insert(far, Hop { to: near, links: links_from_near + 1 });
                queue.push_back(far);
            }
        }
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
