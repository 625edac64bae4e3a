//! The pattern of a wheel's matrices, sector by sector: their means around the ring as matrices of waves, and the differences.
//!
//! Wave p of the tuned wheel, x_s = x̂ e^(2πi ps/N), has the matrix Z_p = Σ_d g_d e^(−2πi pd/N) of the order of a sector.

use crate::error::{Result, try_push, try_room, try_vec};
use crate::linalg::sparse_storage::sparse::Csc;
use num_complex::Complex64;

const CONTEXT: &str = "the tuned wheel";

/// Entries of one pattern, sorted into kinds: those of a kind are equal in a tuned wheel.
#[derive(Debug)]
pub struct TunedRing {
    sectors: usize,
    /// Pattern of the whole wheel, without meaningful values.
    pattern: Csc,
    /// Kind of each stored entry, by its index.
    place: Vec<u32>,
    /// For each kind: distance of its sectors, row and column within a sector, position in the pattern of a wave, and
    /// number of stored entries.
    kinds: Vec<Kind>,
    /// Pattern of the matrix of a wave.
    wave: Csc,
}

#[derive(Clone, Copy, Debug)]
struct Kind {
    distance: usize,
    row: usize,
    column: usize,
    position: usize,
    count: usize,
}

impl TunedRing {
    /// Sorts the entries of a pattern into kinds; `None` where there are too many entries.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(pattern: &Csc, sectors: usize) -> Result<Option<Self>> {
        let n = pattern.rows / sectors;
        if u32::try_from(pattern.row_idx.len()).is_err() {
            return Ok(None);
        }
        let mut place = try_vec(pattern.row_idx.len(), 0_u32, CONTEXT)?;
        let mut kinds: Vec<Kind> = Vec::new();
        let mut entries = Vec::new();
        // Kind of (distance, row) in the current column, offset by one, and position of a row in the wave.
        let mut known = try_vec(sectors * n, 0_usize, CONTEXT)?;
        let mut position = try_vec(n, usize::MAX, CONTEXT)?;
        for j in 0..n {
            let first = kinds.len();
            for t in 0..sectors {
                let column = t * n + j;
                let of_column = pattern.col_ptr[column]..pattern.col_ptr[column + 1];
                for (row, place) in pattern.row_idx[of_column.clone()].iter().zip(&mut place[of_column]) {
                    let (distance, i) = ((row / n + sectors - t) % sectors, row % n);
                    let kind = &mut known[distance * n + i];
                    if *kind == 0 {
                        let new = Kind {
                            distance,
                            row: i,
                            column: j,
                            position: 0,
                            count: 0,
                        };
                        try_push(&mut kinds, new, CONTEXT)?;
                        *kind = kinds.len();
                        if position[i] == usize::MAX {
                            position[i] = 0;
                            try_push(&mut entries, (i, j, Complex64::ZERO), CONTEXT)?;
                        }
                    }
                    kinds[*kind - 1].count += 1;
                    *place = u32::try_from(*kind - 1).unwrap_or(u32::MAX);
                }
            }
            for kind in &kinds[first..] {
                known[kind.distance * n + kind.row] = 0;
                position[kind.row] = usize::MAX;
            }
        }
        let wave = Csc::from_triplets(n, n, entries)?;
        for j in 0..n {
            for at in wave.col_ptr[j]..wave.col_ptr[j + 1] {
                position[wave.row_idx[at]] = at;
            }
            // Kinds lie column after column.
            let of_column =
                kinds.partition_point(|kind| kind.column < j)..kinds.partition_point(|kind| kind.column <= j);
            for kind in &mut kinds[of_column] {
                kind.position = position[kind.row];
            }
        }
        let mut own = pattern.try_clone()?;
        own.values = Vec::new();
        Ok(Some(Self {
            sectors,
            pattern: own,
            place,
            kinds,
            wave,
        }))
    }

    /// Whether this ring was made for a pattern.
    pub fn is_of(&self, pattern: &Csc) -> bool {
        self.pattern.col_ptr == pattern.col_ptr && self.pattern.row_idx == pattern.row_idx
    }

    /// Number of kinds of entries.
    pub fn kinds(&self) -> usize {
        self.kinds.len()
    }

    /// An unfilled matrix with the pattern of a wave.
    pub fn wave(&self) -> Result<Csc> {
        self.wave.try_clone()
    }

    /// Means of a matrix around the ring, kind after kind. Equal entries are their own mean, without rounding, which
    /// soft motions of a stiff structure would feel.
    pub fn means(&self, values: &[Complex64]) -> Result<Vec<Complex64>> {
        let mut first = try_vec(self.kinds.len(), None, CONTEXT)?;
        let mut means = try_vec(self.kinds.len(), Complex64::ZERO, CONTEXT)?;
        for (v, &kind) in values.iter().zip(&self.place) {
            let first = first[kind as usize].get_or_insert(*v);
            means[kind as usize] += v - *first;
        }
        for ((mean, first), kind) in means.iter_mut().zip(&first).zip(&self.kinds) {
            let first = first.unwrap_or_default();
            *mean = if kind.count == self.sectors {
                first + *mean / self.sectors as f64
            } else {
                (*mean + first * kind.count as f64) / self.sectors as f64
            };
        }
        Ok(means)
    }

    /// Fills the matrix Z_p of wave p from the means; `roots` are e^(−2πi k/N).
    pub fn fill_wave(&self, means: &[Complex64], (p, roots): (usize, &[Complex64]), wave: &mut Csc) {
        wave.values.fill(Complex64::ZERO);
        for (kind, mean) in self.kinds.iter().zip(means) {
            wave.values[kind.position] += mean * roots[p * kind.distance % self.sectors];
        }
    }

    /// Means of the diagonal entries, for each degree of freedom of a sector.
    pub fn diagonal(&self, values: &[Complex64]) -> Result<Vec<Complex64>> {
        let mut diagonal = try_vec(self.wave.rows, Complex64::ZERO, CONTEXT)?;
        for (kind, mean) in self.kinds.iter().zip(self.means(values)?) {
            if kind.distance == 0 && kind.row == kind.column {
                diagonal[kind.row] += mean;
            }
        }
        Ok(diagonal)
    }

    /// Largest ratio of a diagonal entry of a matrix to the scale of its degree of freedom.
    pub fn largest_ratio(&self, values: &[Complex64], scale: &[f64]) -> Result<f64> {
        let diagonal = self.diagonal(values)?;
        let ratios = diagonal.iter().zip(scale).map(|(d, s)| d.norm() / s);
        Ok(ratios.fold(0.0, f64::max))
    }

    /// The entries that differ around the ring by more than the noise of their place and the rounding of the entry, less their mean.
    pub fn differences(
        &self,
        values: &[Complex64],
        (noise, rounding): (impl Fn(usize, usize) -> f64, f64),
    ) -> Result<Csc> {
        let (n, means) = (self.wave.rows, self.means(values)?);
        let mut differs = try_vec(means.len(), false, CONTEXT)?;
        for (v, &at) in values.iter().zip(&self.place) {
            let (kind, mean) = (&self.kinds[at as usize], means[at as usize]);
            if !differs[at as usize] && (v - mean).norm() > noise(kind.row, kind.column) + rounding * v.norm() {
                differs[at as usize] = true;
            }
        }
        for ((kind, mean), differs) in self.kinds.iter().zip(&means).zip(&mut differs) {
            *differs |= kind.count < self.sectors && mean.norm() > noise(kind.row, kind.column);
        }
        let count = self.sectors * differs.iter().filter(|differs| **differs).count();
        let mut found = Csc {
            rows: self.sectors * n,
            cols: self.sectors * n,
            col_ptr: try_vec(self.sectors * n + 1, 0, CONTEXT)?,
            row_idx: try_room(count, CONTEXT)?,
            values: try_room(count, CONTEXT)?,
        };
        let mut place = try_vec(self.kinds.len(), 0, CONTEXT)?;
        for column in 0..self.sectors * n {
            let (t, j) = (column / n, column % n);
            for k in self.of_column(j).filter(|&k| differs[k]) {
                place[k] = found.values.len();
                let kind = &self.kinds[k];
                found.row_idx.push((t + kind.distance) % self.sectors * n + kind.row);
                found.values.push(-means[k]);
            }
            let of_column = self.pattern.col_ptr[column]..self.pattern.col_ptr[column + 1];
            for (&k, value) in self.place[of_column.clone()].iter().zip(&values[of_column]) {
                if differs[k as usize] {
                    found.values[place[k as usize]] += value;
                }
            }
            found.col_ptr[column + 1] = found.values.len();
        }
        Ok(found)
    }

    /// Range of the kinds whose entries lie in column j of a wave's matrix.
    fn of_column(&self, j: usize) -> core::ops::Range<usize> {
        let first = |j: usize| self.kinds.partition_point(|kind| kind.column < j);
        first(j)..first(j + 1)
    }

    /// Whether a matrix equals its transpose: yᵀAx = xᵀAy for random x and y, relative to sums of their terms.
    pub fn is_symmetric(&self, values: &[Complex64], rounding: f64) -> Result<bool> {
        let all = self.sectors * self.wave.rows;
        let mut vectors = try_vec(2 * all, 0.0, CONTEXT)?;
        let mut random = Random::default();
        for x in &mut vectors {
            *x = random.next();
        }
        let (x, y) = vectors.split_at(all);
        let (mut gap, mut size) = (Complex64::ZERO, 0.0);
        for j in 0..all {
            let of_column = self.pattern.col_ptr[j]..self.pattern.col_ptr[j + 1];
            for (&i, value) in self.pattern.row_idx[of_column.clone()].iter().zip(&values[of_column]) {
                gap += value * (y[i] * x[j] - x[i] * y[j]);
                size += value.norm_sqr();
            }
        }
        Ok(gap.norm() <= rounding * size.sqrt())
    }
}

/// Numbers between −½ and ½ by the generator of Marsaglia 2003, doi:10.18637/jss.v008.i14: the same in each run.
pub(crate) struct Random(u64);

impl Default for Random {
    fn default() -> Self {
        Self(0x9E37_79B9_7F4A_7C15)
    }
}

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    }
}
