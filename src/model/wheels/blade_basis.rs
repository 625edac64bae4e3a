//! The motions of a blade that follow the rest of its sector, or are cantilever modes: x_b = D (x_r, q), see `blade_modes`.

use crate::error::{Result, fail, try_copy, try_extend, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::factors::factor::Factor;
use crate::linalg::sparse_storage::kept_matrix::KeptMatrix;
use crate::linalg::sparse_storage::sparse::{Csc, Symmetry};
use crate::model::Model;
use crate::model::matrices::structure::{MatrixKind, Structure};
use crate::model::natural_modes::linear_modes::{ContactState, LinearModes};
use crate::model::wheels::wheel::symmetrised;
use num_complex::Complex64;

const CONTEXT: &str = "the modes of a blade";

/// Length of a real or imaginary part of a mode of unit mass below which it is rounding, or a mode that is there already.
/// Kind: rounding.
const BLADE_PART_IS_ROUNDING: f64 = 1e-6;

/// Difference of mirrored entries, relative to the largest, that is rounding.
/// Kind: rounding.
const BLADE_MIRROR_ROUNDING: f64 = 1e-10;

/// Basis D of a blade's motion x_b = D (x_r, q).
#[derive(Debug)]
pub(crate) struct Basis {
    /// For each independent degree of freedom, its position in the blade; `None` outside.
    pub place: Vec<Option<usize>>,
    /// For each independent degree of freedom of the rest, its number in the reduced sector; `None` in the blade.
    pub number: Vec<Option<usize>>,
    /// Number of degrees of freedom of the blade.
    pub blade: usize,
    /// Columns of D: their numbers in the reduced sector; and their values, column after column.
    pub columns: Vec<usize>,
    pub values: Vec<Complex64>,
    /// Squared frequencies of the cantilever modes; and that of the first mode that is left out.
    pub squares: Vec<f64>,
    pub next_square: f64,
    /// Number of degrees of freedom of the reduced sector.
    pub order: usize,
}

/// Index among the independent degrees of freedom of one that must move in its own sector.
pub(crate) fn independent(model: &Model, dof: usize) -> Result<usize> {
    let degrees = model.structure().degrees();
    if dof >= degrees.given() {
        return fail!(Index, "dof = {dof}, needs 0 .. {}", degrees.given() - 1);
    }
    match degrees.number(dof) {
        Some(number) if degrees.image(dof).0 == 0 => Ok(number),
        _ => fail!(
            Argument,
            "dof = {dof} is fixed, or on the right face, which the next sector moves"
        ),
    }
}

impl Basis {
    pub fn new(model: &Model, dofs: &[usize], modes: usize, interrupt: &Interrupt<'_>) -> Result<Self> {
        let structure = model.structure();
        let n = structure.ndof();
        let mut place = try_vec(n, None, CONTEXT)?;
        let mut blade = Vec::new();
        for (k, &dof) in dofs.iter().enumerate() {
            let number = independent(model, dof).map_err(|e| e.at(format_args!("dofs[{k}]")))?;
            if place[number].is_some() {
                return fail!(Argument, "dofs[{k}] = {dof} is there twice");
            }
            place[number] = Some(blade.len());
            try_push(&mut blade, number, CONTEXT)?;
        }
        let nb = blade.len();
        if modes == 0 || modes >= nb {
            return fail!(
                Argument,
                "modes = {modes} of a blade of {nb} degrees of freedom, needs 1 .. {}",
                nb.saturating_sub(1)
            );
        }
        let mut number = try_vec(n, None, CONTEXT)?;
        let mut rest = 0;
        for (number, _) in number.iter_mut().zip(&place).filter(|(_, place)| place.is_none()) {
            *number = Some(rest);
            rest += 1;
        }
        let (stiffness, attached) = of_blade(structure, MatrixKind::Stiffness, &place, nb)?;
        let (mass, _) = of_blade(structure, MatrixKind::Mass, &place, nb)?;
        let (_, _, gap) = stiffness.worst_pair(Symmetry::Plain);
        if gap > BLADE_MIRROR_ROUNDING * stiffness.max_abs() {
            return fail!(Unsupported, "the stiffness of the blade is not symmetric");
        }
        // Columns −K_bb⁻¹K_br.
        let mut root: Vec<usize> = Vec::new();
        for &(_, r, _) in &attached {
            try_push(&mut root, r, CONTEXT)?;
        }
        root.sort_unstable();
        root.dedup();
        let mut values = try_vec(nb * root.len(), Complex64::ZERO, CONTEXT)?;
        for &(b, r, v) in &attached {
            if let Ok(r) = root.binary_search(&r) {
                values[r * nb + b] -= v;
            }
        }
        let mut factor = Factor::new(&stiffness, root.len().max(1))?;
        factor.factor(&stiffness, interrupt)?;
        factor.solve(&mut values, false, interrupt)?;
        let mut alone = Model::new(nb)?;
        alone.structure.blocks_mut(MatrixKind::Stiffness)?.own = Some(KeptMatrix::new(stiffness)?);
        alone.structure.blocks_mut(MatrixKind::Mass)?.own = Some(KeptMatrix::new(mass.try_clone()?)?);
        let found = alone.lowest_modes_with(0, ContactState::Stuck, modes + 1, interrupt)?;
        let squares = add_real_modes(&found, modes, &mass, &mut values)?;
        if squares.len() < modes {
            return fail!(
                Argument,
                "modes = {modes}, needs 1 .. {}: the blade has no more with mass",
                squares.len()
            );
        }
        let mut columns = Vec::new();
        for &r in &root {
            try_push(&mut columns, number[r].unwrap_or_default(), CONTEXT)?;
        }
        for j in 0..modes {
            try_push(&mut columns, rest + j, CONTEXT)?;
        }
        Ok(Self {
            place,
            number,
            blade: nb,
            columns,
            values,
            squares,
            next_square: found.omega.get(modes).map_or(f64::INFINITY, |omega| omega * omega),
            order: rest + modes,
        })
    }

    /// Number of columns that follow the rest of the sector.
    fn static_columns(&self) -> usize {
        self.columns.len() - self.squares.len()
    }

    /// Reduced matrix: DᵀAD among the columns, and A for the rest.
    pub fn reduced(&self, a: &KeptMatrix, kind: MatrixKind, interrupt: &Interrupt<'_>) -> Result<Csc> {
        let (nb, nc) = (self.blade, self.columns.len());
        let mut entries = Vec::new();
        let mut product = try_vec(nb * nc, Complex64::ZERO, CONTEXT)?;
        let stiff = kind == MatrixKind::Stiffness;
        let columns = if stiff { self.static_columns() } else { nc };
        for j in 0..a.order() {
            interrupt.check()?;
            for (i, v) in a.column(j) {
                match (self.number[i], self.number[j], self.place[i], self.place[j]) {
                    (Some(i), Some(j), ..) => try_push(&mut entries, (i, j, v), CONTEXT)?,
                    (Some(i), None, _, Some(b)) => {
                        for c in 0..columns {
                            try_push(&mut entries, (i, self.columns[c], v * self.values[c * nb + b]), CONTEXT)?;
                        }
                    }
                    (None, Some(j), Some(b), _) => {
                        for c in 0..columns {
                            try_push(&mut entries, (self.columns[c], j, self.values[c * nb + b] * v), CONTEXT)?;
                        }
                    }
                    (None, None, Some(p), Some(q)) => {
                        for c in 0..columns {
                            product[c * nb + p] += v * self.values[c * nb + q];
                        }
                    }
                    _ => {}
                }
            }
        }
        for c in 0..columns {
            for d in 0..columns {
                let pairs = self.values[c * nb..(c + 1) * nb]
                    .iter()
                    .zip(&product[d * nb..(d + 1) * nb]);
                let v: Complex64 = pairs.map(|(x, y)| x * y).sum();
                if v != Complex64::ZERO {
                    try_push(&mut entries, (self.columns[c], self.columns[d], v), CONTEXT)?;
                }
            }
        }
        if stiff {
            // Between modes and the rest there is nothing but rounding.
            for (c, square) in (self.static_columns()..).zip(&self.squares) {
                try_push(
                    &mut entries,
                    (self.columns[c], self.columns[c], Complex64::from(*square)),
                    CONTEXT,
                )?;
            }
        }
        symmetrised(
            Csc::from_triplets(self.order, self.order, entries)?,
            BLADE_MIRROR_ROUNDING,
        )
    }

    /// Renumbers a coupling to another sector, in which no blade has entries.
    pub fn renumbered(&self, a: &KeptMatrix, kind: MatrixKind) -> Result<Csc> {
        let mut entries = Vec::new();
        for j in 0..a.order() {
            for (i, v) in a.column(j) {
                let (Some(row), Some(column)) = (self.number[i], self.number[j]) else {
                    return fail!(
                        Argument,
                        "{}[{i},{j}] couples the blade to another sector; leave the degrees of freedom out of dofs",
                        kind.name()
                    );
                };
                try_push(&mut entries, (row, column, v), CONTEXT)?;
            }
        }
        Csc::from_triplets(self.order, self.order, entries)
    }

    /// Largest relative error of a frequency by the modes that are left out, with all contacts stuck and with all of them free: a contact
    /// lies between both. See [`Self::lowered`].
    pub fn left_out(&self, given: &Model, reduced: &Model, families: usize, interrupt: &Interrupt<'_>) -> Result<f64> {
        let nb = self.blade;
        let structure = given.structure();
        let (stiffness, k_attached) = of_blade(structure, MatrixKind::Stiffness, &self.place, nb)?;
        let (mass, m_attached) = of_blade(structure, MatrixKind::Mass, &self.place, nb)?;
        let mut factor = Factor::new(&stiffness, 1)?;
        factor.factor(&stiffness, interrupt)?;
        let states = [ContactState::Stuck, ContactState::Free];
        let states = if reduced.contacts().is_empty() {
            &states[..1]
        } else {
            &states
        };
        let mut largest = 0.0_f64;
        for diameter in 0..=structure.sectors() / 2 {
            for &state in states {
                let found = reduced.lowest_modes_with(diameter as i64, state, families, interrupt)?;
                for (omega, shape) in found.omega.iter().zip(found.shapes.chunks_exact(self.order)) {
                    let square = omega * omega;
                    if square >= self.next_square {
                        return Ok(f64::INFINITY);
                    }
                    let mut x = try_vec(nb, Complex64::ZERO, CONTEXT)?;
                    for (column, &at) in self.values.chunks_exact(nb).zip(&self.columns) {
                        for (x, d) in x.iter_mut().zip(column) {
                            *x += d * shape[at];
                        }
                    }
                    let mut residual = stiffness.times(&x, CONTEXT)?;
                    mass.multiply_add(Complex64::from(-square), &x, &mut residual);
                    for (entries, factor) in [(&k_attached, 1.0), (&m_attached, -square)] {
                        for &(b, r, v) in entries {
                            residual[b] += factor * v * shape[self.number[r].unwrap_or_default()];
                        }
                    }
                    let mut solved = try_copy(&residual, CONTEXT)?;
                    factor.solve(&mut solved, false, interrupt)?;
                    let energy: f64 = residual.iter().zip(&solved).map(|(r, s)| (r.conj() * s).re).sum();
                    largest = largest.max(self.lowered(square, energy));
                }
            }
        }
        Ok(largest)
    }

    /// Relative error of a frequency ω of the reduced sector by the modes that are left out. Its mode of unit modal mass has the residual
    /// r = (K − ω²M) x at the blade, and E = rᴴK_bb⁻¹r. Only the mass couples it to these modes, so that their share of r at another
    /// square s is s/ω² times as large. Eliminated there, they lower ω² by at most
    ///
    /// > d = ω² − s = E (s/ω²)²/(1 − s/Λ_next).
    ///
    /// With ω² in place of s the denominator would vanish where ω² comes near Λ_next, from which the true square stays away.
    fn lowered(&self, square: f64, energy: f64) -> f64 {
        if square <= 0.0 || energy <= 0.0 {
            return 0.0;
        }
        // The positive root d/ω² of the quadratic equation, without cancellation.
        let (gap, share) = (1.0 - square / self.next_square, energy / square);
        let lower = 2.0 * share / (gap + 2.0 * share + (gap * gap + 4.0 * share).sqrt());
        1.0 / (1.0 - lower).sqrt() - 1.0
    }
}

/// Appends real modes of unit mass to the columns, and returns their squared frequencies. The phase of a mode is
/// arbitrary, as is the mixture of modes of one frequency: real and imaginary parts are taken as modes, unless they
/// are combinations of former ones.
fn add_real_modes(found: &LinearModes, count: usize, mass: &Csc, columns: &mut Vec<Complex64>) -> Result<Vec<f64>> {
    let (n, first) = (mass.rows, columns.len());
    let mut squares = Vec::new();
    for (omega, shape) in found.omega.iter().zip(found.shapes.chunks_exact(n)) {
        for is_imaginary in [false, true] {
            if squares.len() == count {
                return Ok(squares);
            }
            let mut part = try_vec(n, Complex64::ZERO, CONTEXT)?;
            for (part, z) in part.iter_mut().zip(shape) {
                *part = if is_imaginary { z.im } else { z.re }.into();
            }
            let product =
                |x: &[Complex64], heavy: &[Complex64]| x.iter().zip(heavy).map(|(x, y)| x.re * y.re).sum::<f64>();
            for _ in 0..2 {
                let heavy = mass.times(&part, CONTEXT)?;
                for before in columns[first..].chunks_exact(n) {
                    let share = product(before, &heavy);
                    for (part, x) in part.iter_mut().zip(before) {
                        *part -= share * x;
                    }
                }
            }
            let length = product(&part, &mass.times(&part, CONTEXT)?).max(0.0).sqrt();
            if length < BLADE_PART_IS_ROUNDING {
                continue;
            }
            for part in &mut part {
                *part /= length;
            }
            try_extend(columns, &part, CONTEXT)?;
            try_push(&mut squares, omega * omega, CONTEXT)?;
        }
    }
    Ok(squares)
}

/// A matrix on the degrees of freedom of a blade; and its entries between blade and rest: position in the blade,
/// independent degree of freedom of the rest, value.
#[allow(clippy::type_complexity)]
fn of_blade(
    structure: &Structure,
    kind: MatrixKind,
    place: &[Option<usize>],
    nb: usize,
) -> Result<(Csc, Vec<(usize, usize, Complex64)>)> {
    let (mut within, mut attached) = (Vec::new(), Vec::new());
    if let Some(own) = &structure.blocks[kind as usize].own {
        for j in 0..own.order() {
            for (i, v) in own.column(j) {
                match (place[i], place[j]) {
                    (Some(p), Some(q)) => try_push(&mut within, (p, q, v), CONTEXT)?,
                    (Some(p), None) => try_push(&mut attached, (p, j, v), CONTEXT)?,
                    _ => {}
                }
            }
        }
    }
    Ok((Csc::from_triplets(nb, nb, within)?, attached))
}
