//! How far the law in floating-point numbers can be from the law in real ones: a proved bound.
//!
//! The proof that robots stay in their tubes (theory.md §2) counts everything that the model does not
//! explain as disturbance, the controller's rounding included, for which each tube keeps a `reserve`.
//! Here is what it has to hold. Let ŵ be what the controller remembers and u what it gives out, and
//!
//! ```text
//! ρ ≥ |ŵ_{t−1} − ((x_t − z_t) − Σ_{i≥1} D_i ŵ_{t−1−i})|,   σ ≥ |u_t − (v_t + Σ_i M_i ŵ_{t−1−i})|
//! ```
//!
//! with the plan's z, v, D, M as they stand. With e' = Σ_i D_i ŵ_{t−1−i} the state is x = z + e' − ρ_t,
//! and putting both into x⁺ = A x + B u + c + w leaves
//!
//! ```text
//! ŵ_t = r_t + w_t − Σ_i R_i ŵ_{t−1−i} + ρ_{t+1} − A ρ_t + B σ_t.
//! ```
//!
//! So a reserve of ρ + |A| ρ + |B| σ keeps ŵ in Θ' for ever; and since ŵ_t − ρ_{t+1} is in Θ' too, x − z
//! itself is in Ω, not only e'.
//!
//! The bounds are those of numerical analysis for inner products (N. J. Higham, *Accuracy and Stability
//! of Numerical Algorithms*, §3.1): with unit roundoff u, a sum of T products, added in whatever order, is
//! off by at most γ_T = T u / (1 − T u) times the sum of their sizes. To them come the rounding of the measured state
//! and of the tables to the type, the bounds that are rounded inwards, and what gets lost in products
//! below the least normal number, which hardware may take for 0.

use crate::exact::{Rational, RationalMatrix};
use crate::ir::Model;

use super::tracking::Bounds;
use super::{Feedback, Float, TubeTables};

/// The largest nominal numbers that the law meets.
#[derive(Clone, Debug, PartialEq)]
pub struct Magnitudes {
    /// The largest |z_i|, n entries.
    pub state: Vec<Rational>,
    /// The largest |v_k|, m entries.
    pub input: Vec<Rational>,
}

/// Bounds on the law's rounding while ŵ is in Θ'; all of them are exact upper bounds.
#[derive(Clone, Debug, PartialEq)]
pub struct Rounding {
    /// ρ: on what is remembered of a step, n entries.
    pub disturbance: Vec<Rational>,
    /// σ: on the input that is given out, m entries.
    pub input: Vec<Rational>,
    /// What the reserve has to hold, n entries.
    pub needed: Vec<Rational>,
}

impl Rounding {
    /// The bounds for a feedback, its tables in the float type, and nominal numbers; `None` when a
    /// number is not finite, or sums are so long that nothing is left of them.
    pub fn new(
        float: Float,
        model: &Model,
        feedback: &Feedback<'_>,
        tables: &TubeTables,
        magnitudes: &Magnitudes,
    ) -> Option<Rounding> {
        let type_ = Type::new(float);
        let center = exact(feedback.center)?;
        let half_width = exact(feedback.half_width)?;
        let size: Vec<_> = center.iter().zip(&half_width).map(|(c, h)| c.abs() + h).collect();
        let errors = Terms::new(feedback.d.get(1..)?, &tables.errors, &size)?;
        let gains = Terms::new(feedback.m, &tables.gains, &size)?;
        if type_.drowns(errors.count.max(gains.count)) {
            return None;
        }
        let disturbance: Vec<_> = (0..model.n())
            .map(|i| {
                let reach = &size[i] + &errors.nominal[i];
                type_.disturbance(&magnitudes.state[i], &reach, &size[i], &errors, i)
            })
            .collect();
        let ends = |k: usize| (&model.input_bounds[k].lo, &model.input_bounds[k].hi);
        let input = (0..model.m())
            .map(|k| Some(type_.input(&magnitudes.input[k], &gains, k) + loss(ends(k), &tables.input, k)?))
            .collect::<Option<Vec<_>>>()?;
        let needed = (0..model.n())
            .map(|i| {
                let (lo, hi) = (&center[i] - &half_width[i], &center[i] + &half_width[i]);
                let carried = row(&model.a, model.enclosure.as_ref().map(|e| &e.a), i, &disturbance)
                    + row(&model.b, model.enclosure.as_ref().map(|e| &e.b), i, &input);
                Some(&disturbance[i] + carried + loss((&lo, &hi), &tables.disturbance, i)?)
            })
            .collect::<Option<Vec<_>>>()?;
        Some(Rounding { disturbance, input, needed })
    }
}

/// Sums over the matrices of a law, row by row: of |entry| · |ŵ|.
struct Terms {
    /// How many products each row sums.
    count: usize,
    /// With the plan's entries.
    nominal: Vec<Rational>,
    /// With the tables' entries.
    rounded: Vec<Rational>,
    /// With the differences between the two.
    off: Vec<Rational>,
}

impl Terms {
    /// `matrices` row by row, `columns` of all of them in order; `size` bounds |ŵ|.
    fn new(matrices: &[Vec<Vec<f64>>], columns: &[Vec<f64>], size: &[Rational]) -> Option<Terms> {
        let rows = columns.first().map_or(size.len(), Vec::len);
        let zeros = vec![Rational::ZERO; rows];
        let mut terms =
            Terms { count: columns.len(), nominal: zeros.clone(), rounded: zeros.clone(), off: zeros };
        for (at, column) in columns.iter().enumerate() {
            let (matrix, j) = (matrices.get(at / size.len())?, at % size.len());
            for (i, entry) in column.iter().enumerate() {
                let (exact, rounded) = (Rational::from_f64(matrix[i][j])?, Rational::from_f64(*entry)?);
                if exact.is_zero() && rounded.is_zero() {
                    continue;
                }
                terms.nominal[i] += exact.abs() * &size[j];
                terms.rounded[i] += rounded.abs() * &size[j];
                terms.off[i] += (exact - rounded).abs() * &size[j];
            }
        }
        Some(terms)
    }
}

/// What matters of a float type.
struct Type {
    /// Whether the plan's doubles are numbers of it.
    holds_doubles: bool,
    /// u.
    unit: Rational,
    /// What an operation loses besides where its result is tiny.
    tiny: Rational,
}

impl Type {
    fn new(float: Float) -> Type {
        Type { holds_doubles: float == Float::F64, unit: float.unit_roundoff(), tiny: float.underflow() }
    }

    /// Whether rounding can take half of a sum of so many products.
    fn drowns(&self, count: usize) -> bool {
        Rational::from(2) * whole(count) * &self.unit >= Rational::ONE
    }

    /// On rounding a number of at most some size.
    fn rounding(&self, size: &Rational) -> Rational {
        &self.unit * size + &self.tiny
    }

    /// On rounding a number of the plan.
    fn table(&self, size: &Rational) -> Rational {
        if self.holds_doubles { Rational::ZERO } else { self.rounding(size) }
    }

    /// On a sum of products: γ_T times their sizes, the tables' own errors, and underflow
    /// (each product's, at most doubled by what comes after it).
    fn sum(&self, terms: &Terms, i: usize) -> Rational {
        let count = whole(terms.count);
        let tu = &count * &self.unit;
        let gamma = &tu / (Rational::ONE - &tu);
        gamma * &terms.rounded[i] + &terms.off[i] + Rational::from(2) * count * &self.tiny
    }

    /// ρ of one component: |z| ≤ `nominal`, |x − z| ≤ `reach`, |ŵ| ≤ `size`.
    fn disturbance(
        &self,
        nominal: &Rational,
        reach: &Rational,
        size: &Rational,
        errors: &Terms,
        i: usize,
    ) -> Rational {
        let measured = self.rounding(&(nominal + reach)) + self.table(nominal);
        let error = &measured + self.rounding(&(reach + &measured));
        let before = error + self.sum(errors, i);
        &before + self.rounding(&(size + &before))
    }

    /// σ of one component before it is kept in its bounds: |v| ≤ `nominal`.
    fn input(&self, nominal: &Rational, gains: &Terms, k: usize) -> Rational {
        let before = self.sum(gains, k) + self.table(nominal);
        let result = nominal + &gains.nominal[k] + &before;
        before + self.rounding(&result)
    }
}

/// What rounding the ends of an interval inwards takes of it, at its worse end.
fn loss(ends: (&Rational, &Rational), bounds: &Bounds<Vec<f64>>, i: usize) -> Option<Rational> {
    let low = Rational::from_f64(bounds.lo[i])? - ends.0;
    let high = ends.1 - Rational::from_f64(bounds.hi[i])?;
    Some(Rational::max_of(&low, &high).clone())
}

/// A row of |matrix| + |what is left open of it|, times a vector of sizes.
fn row(matrix: &RationalMatrix, open: Option<&RationalMatrix>, i: usize, sizes: &[Rational]) -> Rational {
    let entry = |j: usize| {
        let open = open.map_or(Rational::ZERO, |open| open[(i, j)].abs());
        matrix[(i, j)].abs() + open
    };
    sizes.iter().enumerate().map(|(j, size)| entry(j) * size).sum()
}

fn whole(count: usize) -> Rational {
    Rational::from(i64::try_from(count).unwrap_or(i64::MAX))
}

fn exact(values: &[f64]) -> Option<Vec<Rational>> {
    values.iter().map(|x| Rational::from_f64(*x)).collect()
}
