//! Operator chains into trees: an operator-precedence parser with its own stack.
//!
//! Expressions and formulas share it. It recurses nowhere, and it refuses trees deeper than [`MAX_LEVELS`],
//! so that whoever walks a tree later may recurse.

/// The most levels of an expression or a formula (language reference, lexical matters).
pub(super) const MAX_LEVELS: usize = 2_000;

/// The chain has more than [`MAX_LEVELS`] levels.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct TooDeep;

/// A tree with the number of its levels.
pub(super) struct Deep<T> {
    /// The tree.
    pub(super) tree: T,
    /// The nodes on its longest path.
    pub(super) levels: usize,
}

impl<T> Deep<T> {
    /// A tree without subtrees.
    pub(super) fn leaf(tree: T) -> Deep<T> {
        Deep { tree, levels: 1 }
    }
}

/// An operator that still waits for its right operand.
struct Waiting<O> {
    level: u8,
    prefix: bool,
    operator: O,
}

/// Reads a chain from left to right.
pub(super) struct Climber<O, T> {
    operands: Vec<Deep<T>>,
    waiting: Vec<Waiting<O>>,
    /// Applies an operator to its left operand (none for a prefix) and its right one.
    apply: fn(O, Option<T>, T) -> T,
}

impl<O, T> Climber<O, T> {
    /// An empty chain.
    pub(super) fn new(apply: fn(O, Option<T>, T) -> T) -> Climber<O, T> {
        Climber { operands: Vec::new(), waiting: Vec::new(), apply }
    }

    /// Reads a prefix operator; a higher `level` binds tighter.
    pub(super) fn prefix(&mut self, operator: O, level: u8) -> Result<(), TooDeep> {
        self.wait(Waiting { level, prefix: true, operator })
    }

    /// Reads an operand.
    pub(super) fn operand(&mut self, operand: Deep<T>) {
        self.operands.push(operand);
    }

    /// Reads an infix operator; a higher `level` binds tighter.
    pub(super) fn infix(&mut self, operator: O, level: u8, right: bool) -> Result<(), TooDeep> {
        while self.waiting.last().is_some_and(|w| w.level > level || (w.level == level && !right)) {
            self.reduce()?;
        }
        self.wait(Waiting { level, prefix: false, operator })
    }

    /// The tree of the whole chain; `None` for an empty one.
    pub(super) fn finish(mut self) -> Result<Option<Deep<T>>, TooDeep> {
        while !self.waiting.is_empty() {
            self.reduce()?;
        }
        Ok(self.operands.pop())
    }

    fn wait(&mut self, waiting: Waiting<O>) -> Result<(), TooDeep> {
        if self.waiting.len() >= MAX_LEVELS {
            return Err(TooDeep);
        }
        self.waiting.push(waiting);
        Ok(())
    }

    /// Applies the operator that was read last.
    fn reduce(&mut self) -> Result<(), TooDeep> {
        let (Some(last), Some(right)) = (self.waiting.pop(), self.operands.pop()) else {
            return Ok(());
        };
        let left = if last.prefix { None } else { self.operands.pop() };
        let levels = 1 + right.levels.max(left.as_ref().map_or(0, |l| l.levels));
        if levels > MAX_LEVELS {
            return Err(TooDeep);
        }
        let tree = (self.apply)(last.operator, left.map(|l| l.tree), right.tree);
        self.operands.push(Deep { tree, levels });
        Ok(())
    }
}
