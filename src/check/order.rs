//! The order in which declarations that need each other can be worked through.

/// How far the search is with a node.
#[derive(Clone, Copy, PartialEq)]
enum State {
    New,
    Open,
    Done,
}

/// All nodes with those that they need first, and the circles among them, each in order of need.
///
/// `needs[i]` are the nodes that node i needs. A node on a circle is in the order too.
pub(super) fn dependency_order(needs: &[Vec<usize>]) -> (Vec<usize>, Vec<Vec<usize>>) {
    let mut states = vec![State::New; needs.len()];
    let mut order = Vec::with_capacity(needs.len());
    let mut circles = Vec::new();
    for root in 0..needs.len() {
        if states[root] != State::New {
            continue;
        }
        states[root] = State::Open;
        // The path from the root, each node with how many of its needs are done with.
        let mut path: Vec<(usize, usize)> = vec![(root, 0)];
        while let Some((node, done)) = path.last_mut() {
            let node = *node;
            match needs[node].get(*done) {
                None => {
                    states[node] = State::Done;
                    order.push(node);
                    path.pop();
                }
                Some(&next) => {
                    *done += 1;
                    match states[next] {
                        State::New => {
                            states[next] = State::Open;
                            path.push((next, 0));
                        }
                        State::Open => {
                            let start = path.iter().position(|(n, _)| *n == next).unwrap_or(0);
                            circles.push(path[start..].iter().map(|(n, _)| *n).collect());
                        }
                        State::Done => {}
                    }
                }
            }
        }
    }
    (order, circles)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn needs_come_first() {
        let (order, circles) = dependency_order(&[vec![2], vec![0], vec![]]);
        assert_eq!((order, circles.len()), (vec![2, 0, 1], 0));
    }

    #[test]
    fn circles_are_found() {
        let (order, circles) = dependency_order(&[vec![1], vec![2], vec![1], vec![3]]);
        assert_eq!(order.len(), 4);
        assert_eq!(circles, [vec![1, 2], vec![3]]);
    }

    #[test]
    fn a_long_chain_needs_no_stack() {
        let needs: Vec<Vec<usize>> =
            (0..100_000).map(|i| if i + 1 < 100_000 { vec![i + 1] } else { vec![] }).collect();
        assert_eq!(dependency_order(&needs).0[0], 99_999);
    }
}
