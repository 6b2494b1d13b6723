//! Columns of a known length, so that the compiler can unroll what is done with them.

use crate::law::tracking::{Column, Real};

/// How many entries a column has.
pub(super) trait Size: Send + Sync + 'static {
    /// A column of so many numbers.
    type Of<R: Real + Send + Sync + 'static>: Column<Entry = R> + Send + Sync;

    /// The column of some entries, of which there are so many.
    fn column<R: Real + Send + Sync + 'static>(entries: &[R]) -> Self::Of<R>;
}

/// A number of entries that is known when this is compiled.
pub(super) struct Fixed<const N: usize>;

impl<const N: usize> Size for Fixed<N> {
    type Of<R: Real + Send + Sync + 'static> = [R; N];

    fn column<R: Real + Send + Sync + 'static>(entries: &[R]) -> [R; N] {
        let mut column = [R::ZERO; N];
        column.iter_mut().zip(entries).for_each(|(to, from)| *to = *from);
        column
    }
}

/// Any number of entries.
pub(super) struct Any;

impl Size for Any {
    type Of<R: Real + Send + Sync + 'static> = Vec<R>;

    fn column<R: Real + Send + Sync + 'static>(entries: &[R]) -> Vec<R> {
        entries.to_vec()
    }
}

/// A floating-point type that measurements and inputs can be converted to and from.
pub(super) trait Number: Real + Send + Sync + 'static {
    /// The nearest number of this type.
    fn nearest(value: f64) -> Self;

    /// The same number as a double.
    fn double(self) -> f64;
}

impl Number for f64 {
    fn nearest(value: f64) -> f64 {
        value
    }

    fn double(self) -> f64 {
        self
    }
}

impl Number for f32 {
    #[allow(clippy::cast_possible_truncation, reason = "rounding is what is asked")]
    fn nearest(value: f64) -> f32 {
        value as f32
    }

    fn double(self) -> f64 {
        self.into()
    }
}
