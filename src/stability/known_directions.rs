//! Perturbations that return unchanged by construction.
//!
//! A contact whose slider never moves keeps the slider where it is put: its row of the map is that of the identity,
//! and its multiplier is exactly 1. A displacement that strains neither the structure nor a contact other than the
//! sliders that move, such as the rotation of a ring that friction alone holds, takes these sliders along and satisfies
//! the variational equations as a constant. The rate of an autonomous motion is a perturbation that returns as itself.

use crate::error::{Error, Result, Status};
use crate::linalg::libraries::{ColPivQR, ComplexField, DMatrix, DVector, SVD};
use crate::linalg::sparse_storage::sparse::Csc;
use crate::stability::perturbations::Perturbations;
use crate::stability::ring::Row;
use num_complex::Complex64;

/// Singular values below this share of the largest are rounding: the displacement strains nothing.
/// Kind: rounding.
const KNOWN_DIRECTIONS_NO_STRAIN: f64 = 1e-12;

/// Last pivot over the first one above which no singular value is rounding. Chosen: pivots are larger than singular values by a
/// few powers of ten at most.
/// Kind: rounding.
const NO_DOUBT_OF_RANK: f64 = 1e-8;

/// Iterations of the singular values, far above what converging cases need.
/// Kind: cap.
const KNOWN_DIRECTIONS_MOST_ITERATIONS: usize = 100_000;

impl Perturbations<'_> {
    /// Sliders of the ring that never move; `moved` tells whether that of an element of the structure in time moves.
    pub(super) fn stuck_sliders(&self, moved: &dyn Fn(usize) -> bool) -> Vec<usize> {
        let sliders = self.ring.elements.iter().filter(|e| !moved(e.source));
        sliders.filter_map(|e| e.slider).collect()
    }

    /// Constant perturbations (δx, 0, δw) that strain nothing, one per column.
    pub(super) fn unstrained(&self, stuck: &[usize]) -> Result<DMatrix<Complex64>> {
        let ring = &self.ring;
        let n = ring.order;
        let mut rows: Vec<&Row> = Vec::new();
        for e in &ring.elements {
            let held = e.slider.is_none_or(|s| stuck.contains(&s));
            rows.extend(e.rows.iter().skip(usize::from(!held)));
        }
        let mut strain = DMatrix::<Complex64>::zeros(n + rows.len(), n);
        let unit = 1.0 / ring.stiffness.max_abs().max(f64::MIN_POSITIVE);
        put(&ring.stiffness, unit, &mut strain);
        for (i, row) in rows.iter().enumerate() {
            for &(dof, a) in row.iter().flatten() {
                strain[(n + i, dof)] += a;
            }
        }
        let empty = DMatrix::zeros(ring.states(), 0);
        if is_regular(&strain) {
            return Ok(empty);
        }
        let Some(svd) = SVD::try_new(strain, false, true, f64::EPSILON, KNOWN_DIRECTIONS_MOST_ITERATIONS) else {
            return Err(Error::new(
                Status::NoConvergence,
                format_args!("displacements without strain"),
            ));
        };
        let largest = svd.singular_values.max();
        let Some(v) = svd.v_t else { return Ok(empty) };
        let free: Vec<usize> = (0..n)
            .filter(|&i| svd.singular_values[i] <= KNOWN_DIRECTIONS_NO_STRAIN * largest)
            .collect();
        let mut found = DMatrix::zeros(ring.states(), free.len());
        for (c, &i) in free.iter().enumerate() {
            for dof in 0..n {
                found[(dof, c)] = v[(i, dof)].conj();
            }
            for e in &ring.elements {
                if let Some(slider) = e.slider.filter(|s| !stuck.contains(s)) {
                    let w = e.rows[0].iter().flatten().map(|&(dof, a)| a * v[(i, dof)].conj()).sum();
                    found[(2 * n + slider, c)] = w;
                }
            }
        }
        Ok(found)
    }

    /// Rate (x′, v′, w′) of the motion in this block; `rates` holds those of all sectors in time.
    pub(super) fn rate(&self, (v, a, w): (&[f64], &[f64], &[f64])) -> DVector<Complex64> {
        let n = self.ring.order;
        let mut rate = DVector::zeros(self.ring.states());
        for i in 0..n {
            rate[i] = v[i].into();
            rate[n + i] = a[i].into();
        }
        for e in &self.ring.elements {
            if let Some(slider) = e.slider {
                rate[2 * n + slider] = w[e.source].into();
            }
        }
        rate
    }
}

/// Whether the columns are clearly independent, so that singular values, which take longer, are not needed.
fn is_regular(strain: &DMatrix<Complex64>) -> bool {
    fn least<T: ComplexField<RealField = f64>>(a: DMatrix<T>) -> bool {
        let r = ColPivQR::new(a).unpack_r();
        let size = |i: usize| r[(i, i)].clone().modulus();
        let last = r.ncols().min(r.nrows());
        last > 0 && size(last - 1) > NO_DOUBT_OF_RANK * size(0)
    }
    if strain.iter().all(|z| z.im == 0.0) {
        least(strain.map(|z| z.re))
    } else {
        least(strain.clone())
    }
}

fn put(a: &Csc, unit: f64, dense: &mut DMatrix<Complex64>) {
    for j in 0..a.cols {
        for (i, v) in a.column(j) {
            dense[(i, j)] += unit * v;
        }
    }
}
