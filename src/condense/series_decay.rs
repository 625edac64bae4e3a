//! Decay of the series of a panel: sizes of its coefficients against the samples where these are smallest.
//!
//! The series interpolates d·H, whose size varies along a panel by many orders where d divides many resonances out. An error e of
//! d·H is one of e/|d·H| of the flexibility at the same frequency, so that the smallest samples decide. Each column of a table is
//! compared with itself, as are the rows of the response, which may be small: at the least of its samples, each taken for as large
//! as its neighbours, because a single number vanishes at antiresonances.

use crate::condense::table_layout::TableLayout;
use crate::error::{Result, try_push, try_vec};
use num_complex::Complex64;

/// Last coefficients that must be small.
const TAIL: usize = 2;

/// Last coefficients that show whether the series still converges, against as many before them.
const TREND: usize = 3;

/// Rounding of a sum of terms over the largest of them.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

const CONTEXT: &str = "the interpolated flexibility";

/// Sizes of the coefficients of the series tried last, relative to the least samples.
pub struct SeriesDecay {
    layout: TableLayout,
    sizes: Vec<f64>,
}

impl SeriesDecay {
    /// Decay of series of tables of this layout.
    #[must_use]
    pub fn new(layout: TableLayout) -> Self {
        Self {
            layout,
            sizes: Vec::new(),
        }
    }

    /// Notes the sizes of coefficients c₀, c₁, … of the series through `samples`, which are in the order of frequency.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn note<'a>(
        &mut self,
        samples: impl Iterator<Item = &'a [Complex64]>,
        coefficients: impl Iterator<Item = &'a [Complex64]>,
    ) -> Result<()> {
        let parts = self.layout.parts();
        let mut of_samples = Vec::new();
        for sample in samples {
            try_push(&mut of_samples, self.squares(sample)?, CONTEXT)?;
        }
        let mut least = try_vec(parts, f64::INFINITY, CONTEXT)?;
        for j in 0..of_samples.len() {
            let beside = &of_samples[j.saturating_sub(1)..(j + 2).min(of_samples.len())];
            for (part, least) in least.iter_mut().enumerate() {
                *least = least.min(beside.iter().fold(0.0, |most, sizes| most.max(sizes[part])));
            }
        }
        let never = |part: usize| of_samples.iter().all(|sizes| sizes[part] == 0.0);
        for (part, least) in least.iter_mut().enumerate() {
            if *least == 0.0 && never(part) {
                *least = f64::INFINITY;
            }
        }
        self.sizes.clear();
        for of_degree in coefficients {
            let squares = self.squares(of_degree)?;
            let relative = squares.iter().zip(&least).map(|(size, least)| size / least);
            try_push(&mut self.sizes, relative.fold(0.0, f64::max).sqrt(), CONTEXT)?;
        }
        Ok(())
    }

    /// Relative error of the series: its last coefficients, or the rounding of its sum where this is more.
    #[must_use]
    pub fn tail(&self) -> f64 {
        self.largest(0, TAIL).max(ROUNDING * self.largest(0, self.sizes.len()))
    }

    /// Whether the last coefficients do not fall any more.
    #[must_use]
    pub fn is_level(&self) -> bool {
        self.largest(0, TREND) > 0.3 * self.largest(TREND, TREND)
    }

    /// Number of terms up to the last one whose coefficients are above `least`.
    #[must_use]
    pub fn terms_above(&self, least: f64) -> usize {
        let last = self.sizes.iter().rposition(|d| *d > least);
        last.map_or(1, |last| last + 1)
    }

    /// Largest of so many coefficients behind which there are so many more.
    fn largest(&self, behind: usize, count: usize) -> f64 {
        let end = self.sizes.len() - behind;
        self.sizes[end - count..end]
            .iter()
            .fold(0.0_f64, |most, d| most.max(*d))
    }

    /// Squares of the largest numbers of the parts of a table: the contacts of each column, the response under contact forces,
    /// the response under the excitation.
    fn squares(&self, table: &[Complex64]) -> Result<Vec<f64>> {
        let parts = self.layout.parts();
        let outputs = parts - 2;
        let mut squares = try_vec(parts, 0.0_f64, CONTEXT)?;
        let most = |part: &[Complex64], least: f64| part.iter().fold(least, |most, z| most.max(z.norm_sqr()));
        let mut rest = table;
        for (j, from) in self.layout.columns() {
            let (column, others) = rest.split_at(outputs - from);
            rest = others;
            let (contacts, response) = column.split_at(column.len() - 1);
            squares[j] = most(contacts, 0.0);
            let of_response = outputs + usize::from(j + 1 == outputs);
            squares[of_response] = most(response, squares[of_response]);
        }
        Ok(squares)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_are_measured_by_the_least_sample_but_not_by_a_single_zero() {
        let table = |x: f64| vec![Complex64::new(x, 0.0)];
        let mut decay = SeriesDecay::new(TableLayout::new(0, false));
        let mut tail = |samples: &[f64]| {
            let samples: Vec<_> = samples.iter().map(|x| table(*x)).collect();
            let coefficients: Vec<_> = [1.0, 1e-3, 1e-6, 1e-9].into_iter().map(table).collect();
            let slices = samples.iter().map(Vec::as_slice);
            decay.note(slices, coefficients.iter().map(Vec::as_slice)).unwrap();
            decay.tail()
        };
        assert!((tail(&[1.0, 1.0, 1.0, 1.0, 1.0]) / 1e-6 - 1.0).abs() < 1e-12);
        assert!((tail(&[1e-2, 1e-2, 1.0, 1.0, 1.0]) / 1e-4 - 1.0).abs() < 1e-12);
        assert!((tail(&[1.0, 1.0, 0.0, 0.5, 1.0]) / 1e-6 - 1.0).abs() < 1e-12);
        // Rounding of the sum alone.
        assert!(tail(&[1e-12, 1e-12, 1.0, 1.0, 1.0]) >= 1e6 && tail(&[0.0; 5]) == 0.0);
        // Terms above a limit, in units of the least sample.
        tail(&[1e-2, 1e-2, 1.0, 1.0, 1.0]);
        assert_eq!((decay.terms_above(1e-2), decay.terms_above(1e3)), (2, 1));
    }
}
