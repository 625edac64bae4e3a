//! The equations of a block on modes while some of its contacts slip.
//!
//! With A = 1/kt − G the forces of the slipping contacts L need E = A_LL⁻¹. A contact that begins or ends to slip changes E
//! and Ω² − R_Lᴴ E R_L by one rank: with b = A_Lj, u = E b, s = A_jj − bᴴu and ρ = R_j − uᴴR_L,
//!
//! > E ← [E + u uᴴ/s, −u/s; −uᴴ/s, 1/s],  E R ← [E R − u ρ/s; ρ/s],  Ω² − RᴴER ← Ω² − RᴴER − ρᴴρ/s,
//!
//! and the other way round. After some changes E is factorised anew, which ends the growth of rounding.

use crate::error::{Result, fail, try_push};
use crate::interrupt::Interrupt;
use crate::linalg::dense::fallible_matrix::{
    add_product, adjoint, filled, invert_definite, product, zero_vector, zeros,
};
use crate::linalg::factors::lu::Scalar;
use crate::linalg::libraries::{DMatrix, DVector};
use crate::stability::modal_ring::ModalRing;
use crate::time_integration::Number;

const CONTEXT: &str = "the slipping contacts";

/// Changes after which the inverse is computed anew.
/// Kind: tuned; measured on: not recorded.
const SLIPPING_MOST_CHANGES: usize = 48;

/// Share of its own entry below which a pivot of a change is rounding, and the inverse is computed anew.
/// Kind: rounding.
const SLIPPING_LEAST_PIVOT: f64 = 1e-8;

/// The equations of a block while some contacts slip.
pub(crate) struct Slipping<T: Number> {
    /// The slipping contacts, in the order of E.
    pub list: Vec<usize>,
    /// Inverse E = A_LL⁻¹ over the slipping contacts.
    pub inverse: DMatrix<T>,
    /// Product E R_L.
    pub rows: DMatrix<T>,
    /// Stiffness Ω² − R_Lᴴ E R_L of the coordinates.
    pub stiffness: DMatrix<T>,
    changes: usize,
}

/// Entry of A = 1/kt − G.
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
    /// `Unsupported` where nothing but these contacts holds a motion; `OutOfMemory`; `StoppedByCaller`.
    pub fn new(ring: &ModalRing<T>, list: Vec<usize>, interrupt: &Interrupt<'_>) -> Result<Self> {
        let (order, count) = (ring.order(), list.len());
        let mut inverse = filled(count, count, CONTEXT, |i, j| entry(ring, list[i], list[j]))?;
        if !invert_definite(&mut inverse, CONTEXT, interrupt)? {
            return fail!(
                Unsupported,
                "nothing but slipping contacts holds a motion of the structure"
            );
        }
        let selected = filled(count, order, CONTEXT, |i, j| ring.rows[(list[i], j)])?;
        let rows = product(&inverse, &selected, CONTEXT, interrupt)?;
        let mut stiffness = zeros(order, order, CONTEXT)?;
        for (i, &square) in ring.square.iter().enumerate() {
            stiffness[(i, i)] = T::of(square.into());
        }
        let selected = adjoint(&selected, CONTEXT)?;
        add_product(&mut stiffness, T::of((-1.0).into()), (&selected, &rows), interrupt)?;
        Ok(Self {
            list,
            inverse,
            rows,
            stiffness,
            changes: 0,
        })
    }

    /// Position of a contact in the list; `None` if it sticks.
    pub fn place(&self, contact: usize) -> Option<usize> {
        self.list.iter().position(|&e| e == contact)
    }

    /// Lets a contact begin to slip, or stop slipping.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn change(
        &mut self,
        ring: &ModalRing<T>,
        contact: usize,
        slips: bool,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let (count, order) = (self.list.len(), ring.order());
        interrupt.check_before((2 * (count + order) * (count + order)) as u64)?;
        let done = match (self.place(contact), slips) {
            (None, true) => self.add(ring, contact)?,
            (Some(at), false) => self.remove(at)?,
            _ => return Ok(()),
        };
        self.changes += 1;
        if !done || self.changes > SLIPPING_MOST_CHANGES {
            *self = Self::new(ring, core::mem::take(&mut self.list), interrupt)?;
        }
        Ok(())
    }

    /// Adds a contact to the slipping ones; `false` where only the list was changed, not the matrices.
    fn add(&mut self, ring: &ModalRing<T>, contact: usize) -> Result<bool> {
        let (count, order) = (self.list.len(), ring.order());
        let mut b = zero_vector::<T>(count, CONTEXT)?;
        for (b, &e) in b.iter_mut().zip(&self.list) {
            *b = entry(ring, e, contact);
        }
        let mut u = zero_vector::<T>(count, CONTEXT)?;
        u.gemv(T::one(), &self.inverse, &b, T::NONE);
        let own = entry(ring, contact, contact);
        try_push(&mut self.list, contact, CONTEXT)?;
        let pivot = own.complex().re - b.dotc(&u).complex().re;
        if pivot <= SLIPPING_LEAST_PIVOT * Scalar::size(own) {
            return Ok(false);
        }
        let share = T::of((1.0 / pivot).into());
        let mut rho = zero_vector::<T>(order, CONTEXT)?;
        for (j, rho) in rho.iter_mut().enumerate() {
            *rho = ring.rows[(contact, j)] - b.dotc(&self.rows.column(j));
        }
        self.inverse.gerc(share, &u, &u, T::one());
        self.inverse = filled(count + 1, count + 1, CONTEXT, |i, j| match (i == count, j == count) {
            (false, false) => self.inverse[(i, j)],
            (false, true) => -u[i] * share,
            (true, false) => (-u[j] * share).conjugated(),
            (true, true) => share,
        })?;
        self.rows.ger(-share, &u, &rho, T::one());
        self.rows = filled(count + 1, order, CONTEXT, |i, j| {
            if i < count { self.rows[(i, j)] } else { rho[j] * share }
        })?;
        conjugate(&mut rho);
        self.stiffness.gerc(-share, &rho, &rho, T::one());
        Ok(true)
    }

    /// Removes a contact from the slipping ones; `false` where only the list was changed, not the matrices.
    fn remove(&mut self, at: usize) -> Result<bool> {
        self.list.remove(at);
        let (count, order) = (self.list.len(), self.stiffness.nrows());
        let pivot = self.inverse[(at, at)].complex().re;
        let whole = self
            .inverse
            .column(at)
            .iter()
            .fold(0.0_f64, |m, z| m.max(Scalar::size(*z)));
        if pivot <= SLIPPING_LEAST_PIVOT * whole {
            return Ok(false);
        }
        let share = T::of((1.0 / pivot).into());
        let other = |i: usize| if i < at { i } else { i + 1 };
        let mut column = zero_vector::<T>(count, CONTEXT)?;
        for (i, value) in column.iter_mut().enumerate() {
            *value = self.inverse[(other(i), at)];
        }
        let mut own = zero_vector::<T>(order, CONTEXT)?;
        for (j, value) in own.iter_mut().enumerate() {
            *value = self.rows[(at, j)];
        }
        self.rows = filled(count, order, CONTEXT, |i, j| self.rows[(other(i), j)])?;
        self.rows.ger(-share, &column, &own, T::one());
        self.inverse = filled(count, count, CONTEXT, |i, j| self.inverse[(other(i), other(j))])?;
        self.inverse.gerc(-share, &column, &column, T::one());
        conjugate(&mut own);
        self.stiffness.gerc(share, &own, &own, T::one());
        Ok(true)
    }
}

fn conjugate<T: Number>(x: &mut DVector<T>) {
    for z in x.iter_mut() {
        *z = z.conjugated();
    }
}
