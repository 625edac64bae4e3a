//! A sector whose blade moves in its cantilever modes: the reduction by which differences of blades have a low rank.
//!
//! The degrees of freedom b of a blade follow those of the rest, and modes q of the blade with its attachment held:
//! x_b = −K_bb⁻¹K_br x_r + Φ q with K_bbΦ = M_bbΦΛ and ΦᵀM_bbΦ = 1 (Craig & Bampton 1968, doi:10.2514/3.4741). The stiffness has no
//! entries between q and the rest and is Λ among the q, so that a pattern of the q is exactly one of the stiffness of the blade, of as
//! many terms as modes (Lim, Bladh, Castanier & Pierre 2007, doi:10.2514/1.13172).

use crate::contact::Contact;
use crate::error::{Result, fail, try_copy, try_extend, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::factor::Factor;
use crate::linalg::kept_matrix::KeptMatrix;
use crate::linalg::sparse::{Csc, Symmetry};
use crate::model::excitation::Force;
use crate::model::linear_modes::{ContactState, LinearModes};
use crate::model::spring::Spring;
use crate::model::structure::{MatrixKind, Structure};
use crate::model::wheel::symmetrised;
use crate::model::{Model, copy};
use num_complex::Complex64;

const CONTEXT: &str = "the modes of a blade";

/// Length of a real or imaginary part of a mode of unit mass below which it is rounding, or a mode that is there already.
const BLADE_PART_IS_ROUNDING: f64 = 1e-6;

/// Difference of mirrored entries, relative to the largest, that is rounding.
const BLADE_MIRROR_ROUNDING: f64 = 1e-10;

const KINDS: [MatrixKind; 6] = [
    MatrixKind::Mass,
    MatrixKind::Damping,
    MatrixKind::Stiffness,
    MatrixKind::Structural,
    MatrixKind::Gyroscopic,
    MatrixKind::StiffnessSpeed2,
];

/// A sector on modes of its blade.
#[derive(Debug)]
pub struct BladeModes {
    /// The reduced sector: first the degrees of freedom that are left, in their order, then the modes of the blade.
    pub model: Model,
    /// Number there of each degree of freedom of the given sector; `None` for those of the blade, of the right face, and fixed ones.
    pub numbers: Vec<Option<usize>>,
    /// Number of the first mode.
    pub first: usize,
    /// Largest relative error of a frequency that the modes which are left out cause, as estimated, in the tuned modes that were asked for
    /// of all nodal diameters. Infinite where one lies above the first mode that is left out.
    pub left_out: f64,
    basis: Basis,
}

/// x_b = D (x_r, q).
#[derive(Debug)]
struct Basis {
    /// Place in the blade of each independent degree of freedom.
    place: Vec<Option<usize>>,
    /// Number in the reduced sector of each independent degree of freedom of the rest.
    number: Vec<Option<usize>>,
    /// Degrees of freedom of the blade.
    blade: usize,
    /// Columns of D: their numbers in the reduced sector, and their values, column after column.
    columns: Vec<usize>,
    values: Vec<Complex64>,
    /// Squares of the frequencies of the modes, and that of the first mode that is left out.
    squares: Vec<f64>,
    next_square: f64,
    /// Order of the reduced sector.
    order: usize,
}

impl BladeModes {
    /// Weights of the degrees of freedom of the reduced sector that make the motion of one of the given sector.
    ///
    /// # Errors
    /// `Index`; `Argument` for a degree of freedom that does not move by itself.
    pub fn weights(&self, given: &Model, dof: usize) -> Result<Vec<f64>> {
        let number = independent(given, dof)?;
        let mut weights = try_vec(self.basis.order, 0.0, CONTEXT)?;
        match (self.basis.number[number], self.basis.place[number]) {
            (Some(same), _) => weights[same] = 1.0,
            (None, Some(b)) => {
                for (c, &column) in self.basis.columns.iter().enumerate() {
                    weights[column] += self.basis.values[c * self.basis.blade + b].re;
                }
            }
            (None, None) => {}
        }
        Ok(weights)
    }
}

/// Independent number of a degree of freedom that moves in its own sector.
fn independent(model: &Model, dof: usize) -> Result<usize> {
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

impl Model {
    /// The sector with the blade of `dofs` on its `modes` lowest cantilever modes: with everything else held. `dofs` are all degrees of
    /// freedom of the blade but those of its root and those with contacts and springs; forces may act on them. The error is that of
    /// `families` tuned modes of each nodal diameter.
    ///
    /// # Errors
    /// `Index` or `Argument` for degrees of freedom that cannot be in a blade, naming them, and for numbers of modes; `Unsupported` for
    /// matrices of single diameters, modal damping, aerodynamic forces, and a stiffness that is not symmetric; `Singular` for a blade
    /// that is not held; `StoppedByCaller`.
    pub fn on_blade_modes(
        &self,
        dofs: &[usize],
        (modes, families): (usize, usize),
        interrupt: &Interrupt<'_>,
    ) -> Result<BladeModes> {
        let structure = self.structure();
        let has_diameters = structure.blocks.iter().any(|blocks| !blocks.diameters.is_empty());
        if has_diameters || structure.has_modal_damping() || structure.has_aero() {
            return fail!(
                Unsupported,
                "a blade on its modes in a sector with matrices of single diameters, modal damping or aerodynamic forces"
            );
        }
        let basis = Basis::new(self, dofs, modes, interrupt)?;
        let mut reduced = Self::cyclic(basis.order, structure.sectors())?;
        for kind in KINDS {
            let blocks = &structure.blocks[kind as usize];
            if let Some(own) = &blocks.own {
                let own = basis.reduced(own, kind, interrupt)?;
                reduced.structure.blocks_mut(kind)?.own = Some(KeptMatrix::new(own)?);
            }
            for (coupling, is_next) in [(&blocks.next, true), (&blocks.previous, false)] {
                if let Some(coupling) = coupling {
                    let moved = Some(KeptMatrix::new(basis.renumbered(coupling, kind)?)?);
                    let blocks = reduced.structure.blocks_mut(kind)?;
                    *if is_next {
                        &mut blocks.next
                    } else {
                        &mut blocks.previous
                    } = moved;
                }
            }
        }
        copy_numbers(structure, &mut reduced.structure);
        basis.move_places(self, &mut reduced)?;
        let mut numbers = Vec::new();
        for dof in 0..structure.degrees().given() {
            let number = independent(self, dof).ok().and_then(|number| basis.number[number]);
            try_push(&mut numbers, number, CONTEXT)?;
        }
        let left_out = basis.left_out(self, &reduced, families, interrupt)?;
        Ok(BladeModes {
            model: reduced,
            numbers,
            first: basis.order - modes,
            left_out,
            basis,
        })
    }
}

/// Damping by numbers, wave and speed.
fn copy_numbers(from: &Structure, to: &mut Structure) {
    to.rayleigh = from.rayleigh;
    to.loss_factor = from.loss_factor;
    to.loss_of_stiffness = from.loss_of_stiffness;
    to.speed = from.speed;
    to.engine_order = from.engine_order;
}

impl Basis {
    fn new(model: &Model, dofs: &[usize], modes: usize, interrupt: &Interrupt<'_>) -> Result<Self> {
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

    /// Number of columns that belong to the rest.
    fn static_columns(&self) -> usize {
        self.columns.len() - self.squares.len()
    }

    /// DᵀAD among the columns and A for the rest.
    fn reduced(&self, a: &KeptMatrix, kind: MatrixKind, interrupt: &Interrupt<'_>) -> Result<Csc> {
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

    /// A coupling to another sector, which no blade has.
    fn renumbered(&self, a: &KeptMatrix, kind: MatrixKind) -> Result<Csc> {
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

    /// Contacts, springs, loads and forces in the numbers of the reduced sector.
    fn move_places(&self, from: &Model, to: &mut Model) -> Result<()> {
        let moved = |what: &str, id: usize, dof: usize| match independent(from, dof).map(|number| self.number[number]) {
            Ok(Some(number)) => Ok(number),
            _ => fail!(
                Argument,
                "{what} {id} is at dof = {dof}, which is in the blade, fixed or on the right face; leave it out of dofs"
            ),
        };
        for (id, contact) in from.contacts().iter().enumerate() {
            let mut contact: Contact = copy(contact)?;
            let sides = contact.dof_a.iter_mut().chain(&mut contact.dof_b).flatten();
            let rotations = contact
                .rigid
                .iter_mut()
                .flat_map(|rigid| &mut rigid.rotations)
                .flatten();
            for dof in sides.chain(&mut contact.dofs).chain(rotations) {
                *dof = moved("contact", id, *dof)?;
            }
            try_push(&mut to.contacts, contact, CONTEXT)?;
        }
        for (id, spring) in from.springs().iter().enumerate() {
            let place = |dof: Option<usize>| dof.map(|dof| moved("spring", id, dof)).transpose();
            let spring = Spring {
                dof_a: place(spring.dof_a)?,
                dof_b: place(spring.dof_b)?,
                ..*spring
            };
            try_push(&mut to.springs, spring, CONTEXT)?;
        }
        for load in from.speed_loads() {
            try_push(&mut to.speed_loads, *load, CONTEXT)?;
        }
        for force in from.excitation().forces() {
            let number = independent(from, force.dof).map_err(|e| e.at(format_args!("force")))?;
            let Some(b) = self.place[number] else {
                let dof = self.number[number].unwrap_or_default();
                to.excitation.restore(self.order, Force { dof, ..*force })?;
                continue;
            };
            for (c, &dof) in self.columns.iter().enumerate() {
                let weight = self.values[c * self.blade + b].re;
                if weight != 0.0 {
                    let part = Force {
                        dof,
                        value: weight * force.value,
                        per_speed2: weight * force.per_speed2,
                        ..*force
                    };
                    to.excitation.restore(self.order, part)?;
                }
            }
        }
        Ok(())
    }

    /// Largest relative error of a frequency by the modes that are left out: with the residual r = (K − ω²M) x of a mode at the blade,
    /// those add −rᴴK_bb⁻¹r / (1 − ω²/Λ_next) to ω², whose half is the relative error of ω.
    fn left_out(&self, given: &Model, reduced: &Model, families: usize, interrupt: &Interrupt<'_>) -> Result<f64> {
        let nb = self.blade;
        let structure = given.structure();
        let (stiffness, k_attached) = of_blade(structure, MatrixKind::Stiffness, &self.place, nb)?;
        let (mass, m_attached) = of_blade(structure, MatrixKind::Mass, &self.place, nb)?;
        let mut factor = Factor::new(&stiffness, 1)?;
        factor.factor(&stiffness, interrupt)?;
        let mut largest = 0.0_f64;
        for diameter in 0..=structure.sectors() / 2 {
            let found = reduced.lowest_modes_with(diameter as i64, ContactState::Stuck, families, interrupt)?;
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
                let error = 0.5 * energy / (1.0 - square / self.next_square) / square;
                if square > 0.0 {
                    largest = largest.max(error);
                }
            }
        }
        Ok(largest)
    }
}

/// Appends real modes of unit mass to the columns, and returns the squares of their frequencies. The phase of a mode is arbitrary, and so is
/// the mixture of modes of one frequency: real and imaginary parts are modes, as far as they are not there already.
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

/// A matrix among the degrees of freedom of a blade, and its entries (place, independent number of another, value).
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
