//! The equations of a block on modes while some of its contacts slip.
//!
//! With A = 1/kt − G the forces of the slipping contacts L need E = A_LL⁻¹. A contact that begins or ends to slip changes E
//! and Ω² − R_Lᴴ E R_L by one rank: with b = A_Lj, u = E b, s = A_jj − bᴴu and ρ = R_j − uᴴR_L,
//!
//! > E ← [E + u uᴴ/s, −u/s; −uᴴ/s, 1/s],  E R ← [E R − u ρ/s; ρ/s],  Ω² − RᴴER ← Ω² − RᴴER − ρᴴρ/s,
//!
//! and the other way round. After some changes E is factorised anew, which ends the growth of rounding.

use crate::error::{Result, check_memory, fail, try_push};
use crate::linalg::lu::Scalar;
use crate::stability::modal_ring::ModalRing;
use crate::time_integration::Number;
use nalgebra::{Cholesky, DMatrix, RowDVector};

const CONTEXT: &str = "the slipping contacts";

/// Changes after which the inverse is computed anew.
const SLIPPING_MOST_CHANGES: usize = 48;

/// Share of its own entry below which a pivot of a change is rounding, and the inverse is computed anew.
const SLIPPING_LEAST_PIVOT: f64 = 1e-8;

/// The equations.
pub(crate) struct Slipping<T: Number> {
    /// The slipping contacts.
    pub list: Vec<usize>,
    /// E
    pub inverse: DMatrix<T>,
    /// E R_L
    pub rows: DMatrix<T>,
    /// Ω² − R_Lᴴ E R_L
    pub stiffness: DMatrix<T>,
    changes: usize,
}

/// A = 1/kt − G.
fn entry<T: Number>(ring: &ModalRing<T>, i: usize, j: usize) -> T {
    let g = -ring.residual[(i, j)];
    if i == j {
        g + T::of((1.0 / ring.stiffness[i]).into())
    } else {
        g
    }
}

impl<T: Number> Slipping<T> {
    /// The equations while the contacts of a list slip.
    ///
    /// # Errors
    /// `Unsupported` where nothing but these contacts holds a motion; `OutOfMemory`.
    pub fn new(ring: &ModalRing<T>, list: Vec<usize>) -> Result<Self> {
        let (order, count) = (ring.order(), list.len());
        check_memory::<T>(count * (2 * count + 2 * order) + order * order, CONTEXT)?;
        let own = DMatrix::from_fn(count, count, |i, j| entry(ring, list[i], list[j]));
        let Some(factor) = Cholesky::new(own) else {
            return fail!(
                Unsupported,
                "nothing but slipping contacts holds a motion of the structure"
            );
        };
        let selected = DMatrix::from_fn(count, order, |i, j| ring.rows[(list[i], j)]);
        let inverse = factor.inverse();
        let rows = &inverse * &selected;
        let mut stiffness = DMatrix::zeros(order, order);
        for (i, &square) in ring.square.iter().enumerate() {
            stiffness[(i, i)] = T::of(square.into());
        }
        stiffness.gemm(T::of((-1.0).into()), &selected.adjoint(), &rows, T::one());
        Ok(Self {
            list,
            inverse,
            rows,
            stiffness,
            changes: 0,
        })
    }

    /// Place of a contact in the list.
    pub fn place(&self, contact: usize) -> Option<usize> {
        self.list.iter().position(|&e| e == contact)
    }

    /// Lets a contact begin to slip, or end.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn change(&mut self, ring: &ModalRing<T>, contact: usize, slips: bool) -> Result<()> {
        let done = match (self.place(contact), slips) {
            (None, true) => self.add(ring, contact)?,
            (Some(at), false) => self.remove(at),
            _ => return Ok(()),
        };
        self.changes += 1;
        if !done || self.changes > SLIPPING_MOST_CHANGES {
            *self = Self::new(ring, core::mem::take(&mut self.list))?;
        }
        Ok(())
    }

    /// `false`: only the list has changed.
    fn add(&mut self, ring: &ModalRing<T>, contact: usize) -> Result<bool> {
        let count = self.list.len();
        let b = DMatrix::from_fn(count, 1, |i, _| entry(ring, self.list[i], contact));
        let own = entry(ring, contact, contact);
        try_push(&mut self.list, contact, CONTEXT)?;
        let u = &self.inverse * &b;
        let pivot = own.complex().re - b.dotc(&u).complex().re;
        if pivot <= SLIPPING_LEAST_PIVOT * Scalar::size(own) {
            return Ok(false);
        }
        check_memory::<T>((count + 1) * (count + 1 + ring.order()), CONTEXT)?;
        let real = |x: f64| T::of(x.into());
        let mut rho: RowDVector<T> = ring.rows.row(contact).into_owned();
        rho -= b.adjoint().row(0) * &self.rows;
        let share = real(1.0 / pivot);
        self.inverse.gerc(share, &u.column(0), &u.column(0), T::one());
        let mut inverse = core::mem::take(&mut self.inverse).resize(count + 1, count + 1, T::NONE);
        for i in 0..count {
            inverse[(i, count)] = -u[(i, 0)] * share;
            inverse[(count, i)] = inverse[(i, count)].conjugated();
        }
        inverse[(count, count)] = share;
        self.inverse = inverse;
        let scaled = &rho * share;
        self.rows -= &u * &scaled;
        let mut rows = core::mem::take(&mut self.rows).resize(count + 1, ring.order(), T::NONE);
        rows.row_mut(count).copy_from(&scaled);
        self.rows = rows;
        self.stiffness -= rho.adjoint() * scaled;
        Ok(true)
    }

    fn remove(&mut self, at: usize) -> bool {
        self.list.remove(at);
        let pivot = self.inverse[(at, at)].complex().re;
        let whole = self
            .inverse
            .column(at)
            .iter()
            .fold(0.0_f64, |m, z| m.max(Scalar::size(*z)));
        if pivot <= SLIPPING_LEAST_PIVOT * whole {
            return false;
        }
        let share = T::of((1.0 / pivot).into());
        let column = self.inverse.column(at).remove_row(at);
        let own: RowDVector<T> = self.rows.row(at).into_owned();
        self.stiffness += own.adjoint() * (&own * share);
        let rows = core::mem::take(&mut self.rows).remove_row(at);
        self.rows = rows - &column * (&own * share);
        let inverse = core::mem::take(&mut self.inverse);
        let mut inverse = inverse.remove_row(at).remove_column(at);
        inverse.gerc(-share, &column, &column, T::one());
        self.inverse = inverse;
        true
    }
}
