//! A small simplex for feasibility, with bounds that come and go and a certificate when there is no
//! point (the general simplex of Dutertre and de Moura 2006, dense and in doubles).
//!
//! *Columns* are free unknowns; *forms* are linear functions of them, each with a lower and an upper
//! bound. Forms are scaled so that their largest coefficient is 1. A basis is kept from one call to
//! the next, so that a small change of bounds costs few pivots.

use nalgebra::DMatrix;

/// How far a form may be outside its bounds; the search moves all bounds inwards by far more.
pub const TOLERANCE: f64 = 1e-9;

/// How far a form may be from the only value that it may have. Nothing is moved inwards there: what
/// a loop does not close is a disturbance, of which a tube has room for 1e-9 of a state's extent.
const EXACTNESS: f64 = TOLERANCE / 16.0;

/// Entries of a row below this share of its largest one (or of 1) are not pivoted on: they may be
/// rounding, and the tableau grows by their inverse.
const PIVOT: f64 = 1e-7;

/// Entries of a row below this share of its largest one are taken for rounding in a certificate;
/// the certificate is checked against the dynamics afterwards.
const NOISE: f64 = 1e-12;

/// After this many pivots the tableau is computed anew from the forms.
const REFACTOR: usize = 50;

/// A form of a simplex.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Form(usize);

impl Form {
    /// The form's place in the order in which forms were added.
    pub fn index(self) -> usize {
        self.0
    }
}

/// The answer of a feasibility check.
#[derive(Clone, Debug)]
pub enum Answer {
    /// There is a point.
    Feasible,
    /// There is none: the sum of these multiples (≥ 0) of bounds is contradictory. The flag says
    /// whether it is the form's upper bound.
    Infeasible(Vec<(Form, bool, f64)>),
    /// Numbers ran out.
    Undecided,
}

/// Where a variable stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    Basic(usize),
    Nonbasic(usize),
}

/// A feasibility problem over free columns.
#[derive(Clone, Debug)]
pub struct Simplex {
    columns: usize,
    /// The forms as they were given, scaled.
    forms: Vec<Vec<f64>>,
    /// The factor by which each form was multiplied.
    scales: Vec<f64>,
    /// Variables are the columns, then the forms.
    lower: Vec<f64>,
    upper: Vec<f64>,
    value: Vec<f64>,
    place: Vec<Place>,
    basic: Vec<usize>,
    nonbasic: Vec<usize>,
    /// One row a basic variable, one entry a nonbasic one.
    tableau: Vec<Vec<f64>>,
    pivots: usize,
    /// All pivots ever made.
    pub total_pivots: u64,
}

impl Simplex {
    /// A simplex with this many free columns and no forms.
    pub fn new(columns: usize) -> Simplex {
        Simplex {
            columns,
            forms: Vec::new(),
            scales: Vec::new(),
            lower: vec![f64::NEG_INFINITY; columns],
            upper: vec![f64::INFINITY; columns],
            value: vec![0.0; columns],
            place: (0..columns).map(Place::Nonbasic).collect(),
            basic: Vec::new(),
            nonbasic: (0..columns).collect(),
            tableau: Vec::new(),
            pivots: 0,
            total_pivots: 0,
        }
    }

    /// Adds a form, without bounds.
    pub fn add_form(&mut self, mut coefficients: Vec<f64>) -> Form {
        let largest = coefficients.iter().fold(0.0f64, |a, c| a.max(c.abs()));
        let scale = if largest > 0.0 { 1.0 / largest } else { 1.0 };
        coefficients.iter_mut().for_each(|c| *c *= scale);
        let row = self.in_basis(&coefficients);
        let variable = self.columns + self.forms.len();
        self.place.push(Place::Basic(self.basic.len()));
        self.basic.push(variable);
        self.tableau.push(row);
        self.forms.push(coefficients);
        self.scales.push(scale);
        self.lower.push(f64::NEG_INFINITY);
        self.upper.push(f64::INFINITY);
        self.value.push(0.0);
        Form(variable - self.columns)
    }

    /// A form over the columns as a row over the nonbasic variables.
    fn in_basis(&self, coefficients: &[f64]) -> Vec<f64> {
        let mut row = vec![0.0; self.columns];
        for (column, &coefficient) in coefficients.iter().enumerate() {
            if coefficient == 0.0 {
                continue;
            }
            match self.place[column] {
                Place::Nonbasic(at) => row[at] += coefficient,
                Place::Basic(at) => {
                    for (entry, t) in row.iter_mut().zip(&self.tableau[at]) {
                        *entry += coefficient * t;
                    }
                }
            }
        }
        row
    }

    /// Sets a form's bounds, in the units in which it was given.
    pub fn set_bounds(&mut self, form: Form, lower: f64, upper: f64) {
        let variable = self.columns + form.0;
        self.lower[variable] = lower * self.scales[form.0];
        self.upper[variable] = upper * self.scales[form.0];
    }

    /// The columns' values after a feasible check.
    pub fn columns(&self) -> &[f64] {
        &self.value[..self.columns]
    }

    /// Looks for a point within all bounds.
    pub fn check(&mut self) -> Answer {
        if let Some(terms) = self.crossed() {
            return Answer::Infeasible(terms);
        }
        self.settle();
        let patience = 50 + 20 * self.columns;
        for round in 0..4 * patience {
            let Some((row, up)) = self.violated(round > patience) else {
                return Answer::Feasible;
            };
            match self.entering(row, up, round > patience) {
                Some(column) => {
                    let variable = self.basic[row];
                    let target = if up { self.lower[variable] } else { self.upper[variable] };
                    self.pivot(row, column, target);
                    if self.pivots >= REFACTOR && !self.refactor() {
                        return Answer::Undecided;
                    }
                }
                None => return Answer::Infeasible(self.certificate(row, up)),
            }
        }
        Answer::Undecided
    }

    /// A form whose lower bound lies above its upper one.
    fn crossed(&self) -> Option<Vec<(Form, bool, f64)>> {
        let crossed = |f: &usize| self.lower[self.columns + f] > self.upper[self.columns + f] + TOLERANCE;
        let form = (0..self.forms.len()).find(crossed)?;
        Some([false, true].map(|upper| (Form(form), upper, self.scales[form])).to_vec())
    }

    /// Puts nonbasic variables inside their bounds and computes the basic ones.
    fn settle(&mut self) {
        for &variable in &self.nonbasic {
            let value = self.value[variable].min(self.upper[variable]).max(self.lower[variable]);
            self.value[variable] = value;
        }
        self.compute_basic();
    }

    fn compute_basic(&mut self) {
        let values: Vec<f64> = self.nonbasic.iter().map(|&v| self.value[v]).collect();
        for (row, &variable) in self.tableau.iter().zip(&self.basic) {
            self.value[variable] = row.iter().zip(&values).map(|(a, b)| a * b).sum();
        }
    }

    /// The row that is farthest outside its bounds (or the one of the first variable), and whether
    /// it must rise.
    fn violated(&self, first: bool) -> Option<(usize, bool)> {
        let mut best: Option<(usize, bool, f64)> = None;
        for (row, &variable) in self.basic.iter().enumerate() {
            let value = self.value[variable];
            let (below, above) = (self.lower[variable] - value, value - self.upper[variable]);
            let by = below.max(above);
            let fixed = self.lower[variable] == self.upper[variable];
            if by <= if fixed { EXACTNESS } else { TOLERANCE } {
                continue;
            }
            let better = match best {
                None => true,
                Some((other, ..)) if first => variable < self.basic[other],
                Some((_, _, most)) => by > most,
            };
            if better {
                best = Some((row, below > above, by));
            }
        }
        best.map(|(row, up, _)| (row, up))
    }

    /// The nonbasic variable that lets a row move: of those that can, the one with the largest entry
    /// (or the first).
    fn entering(&self, row: usize, up: bool, first: bool) -> Option<usize> {
        let mut best: Option<(usize, f64)> = None;
        let least = PIVOT * largest(&self.tableau[row]).max(1.0);
        for (column, &entry) in self.tableau[row].iter().enumerate() {
            if entry.abs() <= least || !self.can_move(self.nonbasic[column], (entry > 0.0) == up) {
                continue;
            }
            let better = match best {
                None => true,
                Some((other, _)) if first => self.nonbasic[column] < self.nonbasic[other],
                Some((_, most)) => entry.abs() > most,
            };
            if better {
                best = Some((column, entry.abs()));
            }
        }
        best.map(|(column, _)| column)
    }

    fn can_move(&self, variable: usize, up: bool) -> bool {
        if up {
            self.value[variable] < self.upper[variable]
        } else {
            self.value[variable] > self.lower[variable]
        }
    }

    /// Exchanges a basic and a nonbasic variable and puts the one that leaves at a value.
    fn pivot(&mut self, row: usize, column: usize, target: f64) {
        let (leaving, entering) = (self.basic[row], self.nonbasic[column]);
        let pivot = self.tableau[row][column];
        let step = (target - self.value[leaving]) / pivot;
        self.value[leaving] = target;
        self.value[entering] += step;
        let mut own = std::mem::take(&mut self.tableau[row]);
        own.iter_mut().for_each(|a| *a /= -pivot);
        own[column] = 1.0 / pivot;
        for (at, other) in self.tableau.iter_mut().enumerate() {
            if at == row {
                continue;
            }
            let factor = other[column];
            if factor == 0.0 {
                continue;
            }
            self.value[self.basic[at]] += factor * step;
            other[column] = 0.0;
            for (a, b) in other.iter_mut().zip(&own) {
                *a += factor * b;
            }
        }
        self.tableau[row] = own;
        self.basic[row] = entering;
        self.nonbasic[column] = leaving;
        self.place[entering] = Place::Basic(row);
        self.place[leaving] = Place::Nonbasic(column);
        self.pivots += 1;
        self.total_pivots += 1;
    }

    /// The contradiction in a row that cannot move: its own bound against those of all others in it.
    fn certificate(&self, row: usize, up: bool) -> Vec<(Form, bool, f64)> {
        let mut terms = Vec::new();
        let mut term = |variable: usize, upper: bool, multiple: f64| {
            if let Some(form) = variable.checked_sub(self.columns) {
                terms.push((Form(form), upper, multiple * self.scales[form]));
            }
        };
        term(self.basic[row], !up, 1.0);
        let least = NOISE * largest(&self.tableau[row]);
        for (column, &entry) in self.tableau[row].iter().enumerate() {
            if entry.abs() > least {
                term(self.nonbasic[column], (entry > 0.0) == up, entry.abs());
            }
        }
        terms
    }

    /// Goes back to the basis of all forms, whose tableau is the forms themselves.
    pub fn restart(&mut self) {
        let n = self.columns;
        self.pivots = 0;
        self.tableau = self.forms.clone();
        self.basic = (n..n + self.forms.len()).collect();
        self.nonbasic = (0..n).collect();
        let places = (0..n).map(Place::Nonbasic).chain((0..self.forms.len()).map(Place::Basic));
        self.place = places.collect();
        self.value[..n].fill(0.0);
    }

    /// Computes the tableau anew for the present basis. False when the basis is numerically singular.
    pub fn refactor(&mut self) -> bool {
        self.pivots = 0;
        let n = self.columns;
        let row_of = |variable: usize| -> Vec<f64> {
            match variable.checked_sub(n) {
                Some(form) => self.forms[form].clone(),
                None => (0..n).map(|c| f64::from(u8::from(c == variable))).collect(),
            }
        };
        let rows: Vec<f64> = self.nonbasic.iter().flat_map(|&v| row_of(v)).collect();
        let Some(inverse) = DMatrix::from_row_slice(n, n, &rows).try_inverse() else {
            return false;
        };
        let basic: Vec<f64> = self.basic.iter().flat_map(|&v| row_of(v)).collect();
        let product = DMatrix::from_row_slice(self.basic.len(), n, &basic) * inverse;
        for (row, entries) in self.tableau.iter_mut().zip(product.row_iter()) {
            for (a, b) in row.iter_mut().zip(entries.iter()) {
                *a = if b.abs() < 1e-13 { 0.0 } else { *b };
            }
        }
        self.compute_basic();
        true
    }
}

fn largest(row: &[f64]) -> f64 {
    row.iter().fold(0.0, |a, x| a.max(x.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_has_points_until_a_side_is_moved_past_the_corner() {
        let mut simplex = Simplex::new(2);
        let x = simplex.add_form(vec![1.0, 0.0]);
        let y = simplex.add_form(vec![0.0, 1.0]);
        let sum = simplex.add_form(vec![2.0, 2.0]);
        simplex.set_bounds(x, 0.0, f64::INFINITY);
        simplex.set_bounds(y, 0.0, f64::INFINITY);
        simplex.set_bounds(sum, 1.0, 2.0);
        assert!(matches!(simplex.check(), Answer::Feasible));
        let point = simplex.columns();
        assert!(2.0 * (point[0] + point[1]) >= 1.0 - 1e-8);
        simplex.set_bounds(x, 1.5, f64::INFINITY);
        let Answer::Infeasible(terms) = simplex.check() else { panic!("no point is left") };
        // x ≥ 1.5, y ≥ 0, 2x + 2y ≤ 2: two of the first, two of the second, one of the third.
        let multiple = |form: Form| terms.iter().find(|t| t.0 == form).map_or(0.0, |t| t.2);
        assert!((multiple(x) - 2.0 * multiple(sum)).abs() < 1e-9);
        assert!((multiple(y) - 2.0 * multiple(sum)).abs() < 1e-9);
        simplex.set_bounds(x, 0.5, f64::INFINITY);
        assert!(matches!(simplex.check(), Answer::Feasible));
    }
}
