//! Families: one declaration, many members.

use crate::check::expression::{Binding, Scope};
use crate::check::{Checker, messages};
use crate::diag::Reported;
use crate::source::Span;
use crate::syntax::ast::{FamilyName, IndexRange, Name, Reference};

/// The most members of one family and of one index range.
pub(super) const MAX_FAMILY: i64 = 10_000;
/// The most members of all families together.
const MAX_MEMBERS: usize = 50_000;

/// The members of a declaration, whose ids follow each other in one table.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Family {
    /// First and last value of each index; empty for a single member.
    ranges: Vec<(i64, i64)>,
    /// The first member's place in its table.
    pub(super) first: usize,
    /// How many members there are.
    pub(super) len: usize,
}

impl Family {
    /// Whether it was declared without indices.
    pub(super) fn is_single(&self) -> bool {
        self.ranges.is_empty()
    }

    /// The members' places in their table.
    pub(super) fn ids(&self) -> std::ops::Range<usize> {
        self.first..self.first + self.len
    }

    /// The place of the member with these indices.
    fn member(&self, indices: &[i64]) -> Option<usize> {
        if indices.len() != self.ranges.len() {
            return None;
        }
        let mut offset = 0;
        for (&index, &(from, to)) in indices.iter().zip(&self.ranges) {
            if index < from || index > to {
                return None;
            }
            offset = offset * (to - from + 1) + (index - from);
        }
        Some(self.first + offset as usize)
    }

    /// The indices of the `nth` member, the last index running fastest.
    fn indices(&self, nth: usize) -> Vec<i64> {
        let mut rest = nth as i64;
        let mut indices: Vec<i64> = Vec::new();
        for &(from, to) in self.ranges.iter().rev() {
            let size = (to - from + 1).max(1);
            indices.push(from + rest % size);
            rest /= size;
        }
        indices.reverse();
        indices
    }
}

/// A member to be declared: its name and the scope that its declaration is read in.
pub(super) struct Member {
    /// `fleet[1]`, or the plain name of a single member.
    pub(super) name: String,
    /// The values of the indices.
    pub(super) scope: Scope,
}

impl Checker<'_> {
    /// The family that a declared name stands for, with its members in order; their ids start at `first`.
    pub(super) fn family(
        &mut self,
        name: &FamilyName,
        first: usize,
    ) -> Result<(Family, Vec<Member>), Reported> {
        let mut ranges = Vec::new();
        let mut scope = Scope::default();
        for index in &name.indices {
            self.check_variable(&index.variable, &scope)?;
            let (from, to) = self.range(index, &Scope::default())?;
            ranges.push((from, to));
            self.bind(&mut scope, &index.variable, Binding::Index(from));
        }
        let sizes = ranges.iter().map(|(from, to)| (to - from + 1).max(0));
        let len = sizes.fold(1i64, |product, size| product.saturating_mul(size));
        self.count_members(len, name.name.span)?;
        let family = Family { ranges, first, len: len as usize };
        let members = (0..family.len).map(|nth| member(name, &family.indices(nth))).collect();
        Ok((family, members))
    }

    fn count_members(&mut self, len: i64, span: Span) -> Result<(), Reported> {
        if len > MAX_FAMILY {
            return Err(self.report(messages::family_too_large(span, len)));
        }
        self.members += len as usize;
        if self.members > MAX_MEMBERS {
            return Err(self.report(messages::too_many_members(span, MAX_MEMBERS)));
        }
        Ok(())
    }

    /// First and last value of an index.
    pub(super) fn range(&mut self, index: &IndexRange, scope: &Scope) -> Result<(i64, i64), Reported> {
        let from = self.whole(&index.from, scope)?;
        let to = self.whole(&index.to, scope)?;
        let size = i128::from(to) - i128::from(from) + 1;
        if size > i128::from(MAX_FAMILY) {
            let size = i64::try_from(size).unwrap_or(i64::MAX);
            return Err(self.report(messages::family_too_large(index.from.span.to(index.to.span), size)));
        }
        Ok((from, to.max(from.saturating_sub(1))))
    }

    /// The place in its table of the one member that a reference names.
    pub(super) fn member(
        &mut self,
        family: &Family,
        reference: &Reference,
        scope: &Scope,
        wanted: &'static str,
    ) -> Result<usize, Reported> {
        if reference.indices.is_empty() && !family.is_single() {
            return Err(self.report(messages::family_as_member(reference, wanted)));
        }
        let mut indices = Vec::new();
        for index in &reference.indices {
            indices.push(self.whole(index, scope)?);
        }
        if indices.len() != family.ranges.len() {
            return Err(self.report(messages::wrong_member_indices(reference, family.ranges.len())));
        }
        family
            .member(&indices)
            .ok_or_else(|| self.report(messages::no_such_member(reference, &indices, &family.ranges)))
    }
}

fn member(name: &FamilyName, indices: &[i64]) -> Member {
    let mut scope = Scope::default();
    for (range, &value) in name.indices.iter().zip(indices) {
        scope.bindings.push((range.variable.text.clone(), Binding::Index(value)));
    }
    Member { name: member_name(&name.name, indices), scope }
}

fn member_name(name: &Name, indices: &[i64]) -> String {
    if indices.is_empty() {
        return name.text.clone();
    }
    let list: Vec<String> = indices.iter().map(i64::to_string).collect();
    format!("{}[{}]", name.text, list.join(","))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn members_and_indices_are_inverse() {
        let family = Family { ranges: vec![(1, 3), (-1, 0)], first: 7, len: 6 };
        let all: Vec<Vec<i64>> = (0..6).map(|nth| family.indices(nth)).collect();
        assert_eq!(all[0], [1, -1]);
        assert_eq!(all[1], [1, 0]);
        assert_eq!(all[5], [3, 0]);
        for (nth, indices) in all.iter().enumerate() {
            assert_eq!(family.member(indices), Some(7 + nth));
        }
        assert_eq!(family.member(&[4, 0]), None);
        assert_eq!(family.member(&[1]), None);
    }
}
