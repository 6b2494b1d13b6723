//! Exact Gaussian elimination.

use crate::exact::Rational;

/// Reduces rows to reduced echelon form and returns the pivot columns.
fn reduce(rows: &mut [Vec<Rational>], columns: usize) -> Vec<usize> {
    let mut pivots = Vec::new();
    for column in 0..columns {
        let top = pivots.len();
        let Some(pivot) = (top..rows.len()).find(|&r| !rows[r][column].is_zero()) else { continue };
        rows.swap(top, pivot);
        let inverse = Rational::ONE / &rows[top][column];
        rows[top].iter_mut().for_each(|x| *x *= &inverse);
        let pivot_row = rows[top].clone();
        for (r, row) in rows.iter_mut().enumerate() {
            if r != top && !row[column].is_zero() {
                subtract_multiple(row, &pivot_row, column);
            }
        }
        pivots.push(column);
    }
    pivots
}

/// Clears `row[column]` with a row whose entry there is 1.
fn subtract_multiple(row: &mut [Rational], pivot_row: &[Rational], column: usize) {
    let factor = row[column].clone();
    for (x, p) in row.iter_mut().zip(pivot_row) {
        if !p.is_zero() {
            *x -= &factor * p;
        }
    }
}

/// The rank of a matrix that is given by its rows, all of the same length.
pub fn rank(rows: &[Vec<Rational>]) -> usize {
    let columns = rows.first().map_or(0, Vec::len);
    reduce(&mut rows.to_vec(), columns).len()
}

/// A basis of {x : row · x = 0 for every row} in `columns` dimensions.
pub fn null_space(rows: &[Vec<Rational>], columns: usize) -> Vec<Vec<Rational>> {
    let mut rows = rows.to_vec();
    let pivots = reduce(&mut rows, columns);
    let free = (0..columns).filter(|c| !pivots.contains(c));
    free.map(|f| {
        let mut vector = vec![Rational::ZERO; columns];
        vector[f] = Rational::ONE;
        for (row, &pivot) in rows.iter().zip(&pivots) {
            vector[pivot] = -&row[f];
        }
        vector
    })
    .collect()
}

/// The one x with row · x = value for each (row, value); `None` when there is none or more than one.
pub fn solve(rows: &[(&[Rational], &Rational)]) -> Option<Vec<Rational>> {
    let columns = rows.first()?.0.len();
    let mut augmented: Vec<Vec<Rational>> =
        rows.iter().map(|(row, value)| row.iter().chain([*value]).cloned().collect()).collect();
    let pivots = reduce(&mut augmented, columns + 1);
    let unique = pivots.len() == columns && !pivots.contains(&columns);
    unique.then(|| augmented.iter_mut().take(columns).map(|row| row[columns].clone()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(entries: &[i64]) -> Vec<Rational> {
        entries.iter().map(|&x| Rational::from(x)).collect()
    }

    #[test]
    fn rank_counts_independent_rows() {
        assert_eq!(rank(&[row(&[1, 2]), row(&[2, 4])]), 1);
        assert_eq!(rank(&[row(&[0, 2, 1]), row(&[2, 4, 0]), row(&[2, 6, 1])]), 2);
        assert_eq!(rank(&[]), 0);
    }

    #[test]
    fn solve_finds_the_one_solution_and_refuses_others() {
        let (a, b, c) = (row(&[1, 1]), row(&[1, -1]), row(&[2, 2]));
        let (one, three) = (Rational::ONE, Rational::from(3));
        assert_eq!(solve(&[(&a, &three), (&b, &one)]), Some(row(&[2, 1])));
        assert_eq!(solve(&[(&a, &three), (&c, &one)]), None);
        assert_eq!(solve(&[(&a, &three)]), None);
    }

    #[test]
    fn null_space_is_orthogonal_and_complete() {
        let rows = [row(&[1, 2, 3]), row(&[2, 4, 6])];
        let basis = null_space(&rows, 3);
        assert_eq!(basis.len(), 2);
        assert!(basis.iter().all(|v| crate::exact::dot(v, &rows[0]).is_zero()));
        assert_eq!(rank(&basis), 2);
    }
}
