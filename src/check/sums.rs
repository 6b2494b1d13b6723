//! Comparisons of sums: counts, single atoms and constants with whole factors.

use crate::check::expression::Scope;
use crate::check::names::Kind;
use crate::check::{Binding, Checker, Entry, messages, typed};
use crate::diag::Reported;
use crate::entity::EntityId;
use crate::ir::{Atom, RegionId, RobotId};
use crate::syntax::ast::{Comparison, Expr, Name, Reference, Sum, Term, TermKind};

/// The largest factor or constant of a sum; a million terms of that size still fit a machine integer.
const MAX_FACTOR: i64 = 1_000_000_000_000;

/// The atoms of a sum with their factors, and its constant part.
#[derive(Default)]
struct Linear {
    terms: Vec<(Atom, i64)>,
    constant: i64,
}

impl Checker<'_> {
    /// A comparison with all atoms on the left and one constant on the right.
    pub(super) fn comparison(
        &mut self,
        left: &Sum,
        op: Comparison,
        right: &Sum,
        scope: &Scope,
    ) -> Result<typed::Formula, Reported> {
        let mut linear = Linear::default();
        let a = self.sum(left, 1, scope, &mut linear);
        let b = self.sum(right, -1, scope, &mut linear);
        a.and(b)?;
        self.grow(linear.terms.len(), left.span.to(right.span))?;
        Ok(typed::Formula::Compare { terms: linear.terms, op, bound: -linear.constant })
    }

    fn sum(&mut self, sum: &Sum, sign: i64, scope: &Scope, linear: &mut Linear) -> Result<(), Reported> {
        let mut failed = None;
        for term in &sum.terms {
            let sign = if term.negative { -sign } else { sign };
            failed = failed.or(self.term(term, sign, scope, linear).err());
        }
        failed.map_or(Ok(()), Err)
    }

    fn term(&mut self, term: &Term, sign: i64, scope: &Scope, linear: &mut Linear) -> Result<(), Reported> {
        let factor = match &term.factor {
            Some(expr) => self.factor(expr, scope)?,
            None => 1,
        };
        match &term.kind {
            TermKind::Constant(expr) => {
                let constant = self.factor(expr, scope)?;
                let product = constant.checked_mul(factor).and_then(|p| p.checked_mul(sign));
                let total = product.and_then(|p| p.checked_add(linear.constant));
                match total.filter(|t| t.abs() <= MAX_FACTOR) {
                    Some(total) => linear.constant = total,
                    None => return Err(self.report(messages::number_out_of_range(term.span))),
                }
            }
            TermKind::In { robot, region } => {
                let atom = self.atom(robot, region, scope)?;
                linear.terms.push((atom, sign * factor));
            }
            TermKind::Count { variable, set, member, region } => {
                let atoms = self.count(variable, set, member, region, scope)?;
                self.grow(atoms.len(), term.span)?;
                linear.terms.extend(atoms.into_iter().map(|atom| (atom, sign * factor)));
            }
        }
        Ok(())
    }

    fn factor(&mut self, expr: &Expr, scope: &Scope) -> Result<i64, Reported> {
        let factor = self.whole(expr, scope)?;
        if factor.unsigned_abs() > MAX_FACTOR as u64 {
            return Err(self.report(messages::number_out_of_range(expr.span)));
        }
        Ok(factor)
    }

    /// The atoms that a count adds up, one for each robot of its set.
    fn count(
        &mut self,
        variable: &Name,
        set: &[Reference],
        member: &Reference,
        region: &Reference,
        scope: &Scope,
    ) -> Result<Vec<Atom>, Reported> {
        self.check_variable(variable, scope)?;
        let robots = self.set(set, scope);
        if member.name.text != variable.text || !member.indices.is_empty() {
            return Err(self.report(messages::count_of_another(variable, member)));
        }
        let region = self.region_of(region, scope)?;
        Ok(robots?.into_iter().map(|robot| Atom { robot, region }).collect())
    }

    /// The atom `ROBOT in REGION`.
    pub(super) fn atom(
        &mut self,
        robot: &Reference,
        region: &Reference,
        scope: &Scope,
    ) -> Result<Atom, Reported> {
        let robot = self.robot_of(robot, scope);
        let region = self.region_of(region, scope);
        Ok(Atom { robot: robot?, region: region? })
    }

    fn robot_of(&mut self, reference: &Reference, scope: &Scope) -> Result<RobotId, Reported> {
        if let Some(Binding::Robot(id)) = scope.binding(&reference.name.text) {
            if !reference.indices.is_empty() {
                return Err(self.report(messages::wrong_member_indices(reference, 0)));
            }
            return Ok(id);
        }
        if let Some(symbol) = self.names.get(&reference.name.text)
            && symbol.kind == Kind::Team
            && scope.binding(&reference.name.text).is_none()
        {
            self.names.mark_used(&reference.name.text);
            return Err(self.report(messages::team_as_robot(reference, symbol)));
        }
        let item = self.resolve(&reference.name, &[Kind::Robot], "robot", scope)?;
        let family = self.family_of(item, reference)?;
        Ok(RobotId::new(self.member(&family, reference, scope, "robot")?))
    }

    fn region_of(&mut self, reference: &Reference, scope: &Scope) -> Result<RegionId, Reported> {
        let item = self.resolve(&reference.name, &[Kind::Region], "region", scope)?;
        let family = self.family_of(item, reference)?;
        Ok(RegionId::new(self.member(&family, reference, scope, "region")?))
    }

    fn family_of(
        &mut self,
        item: usize,
        reference: &Reference,
    ) -> Result<crate::check::families::Family, Reported> {
        match &self.entries[item] {
            Entry::Family(family) => family.clone(),
            _ => Err(self.reported(|| messages::unknown_name(&reference.name, "robot", None))),
        }
    }
}
