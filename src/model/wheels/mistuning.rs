//! Mistuning of a wheel: patterns of blades, contacts and forces over the sectors.
//!
//! A blade is a set of degrees of freedom b; r are those to which its stiffness couples it. Its motion relative to the one
//! that r carries along is y = x_b + K_bb⁻¹ K_br x_r, and its stiffness is the share ½ yᵀ K_bb y of the strain energy: none in
//! a rigid motion of a free blade, and all of it with r held. Hence a pattern of blade frequencies moves the frequencies of
//! the clamped blade by exactly its factors (component mode mistuning: Lim, Bladh, Castanier & Pierre, AIAA Journal 45, 2007,
//! 2285 to 2298).

use crate::error::{Result, fail, try_copy, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::factors::factor::Factor;
use crate::linalg::sparse_storage::kept_matrix::KeptMatrix;
use crate::linalg::sparse_storage::matrix_view::{MatrixView, Part};
use crate::linalg::sparse_storage::sparse::{Csc, Form, Symmetry};
use crate::model::Model;
use crate::model::matrices::sector_matrices::{Entries, of_both_sectors};
use crate::model::matrices::structure::{MatrixKind, Structure};
use crate::model::wheels::sector_digest::SectorUse;
use crate::model::wheels::wheel::symmetrised;
use num_complex::Complex64;

const CONTEXT: &str = "the mistuning";

/// Numbers of the matrix K_bb⁻¹ K_br that are affordable.
/// Kind: cap.
const LARGEST_ATTACHMENT: usize = 4_000_000;

/// Difference of mirrored entries of a stiffness, relative to the largest, that is rounding.
/// Kind: rounding.
const MIRROR_ROUNDING: f64 = 1e-10;

/// Property of the blades that differs between sectors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BladeProperty {
    /// Stiffness of the blade, times 1 + δ.
    Stiffness,
    /// Frequencies of the blade when clamped at its attachment, times 1 + δ: stiffness times (1 + δ)².
    Frequency,
    /// Mass of the blade's degrees of freedom, without coupling to others, times 1 + δ.
    Mass,
    /// Damping of the motion relative to the attachment times 1 + δ: damping matrix and Rayleigh damping.
    Damping,
}

/// Quantity that differs between sectors, with its pattern δ.
#[derive(Clone, Copy, Debug)]
pub enum Mistuning<'a> {
    /// A property of the blade with these degrees of freedom of a sector.
    Blade(BladeProperty, &'a [usize]),
    /// A matrix of a sector, δ times which is added to the matrix of that kind.
    Matrix(MatrixKind, &'a MatrixView<'a>),
    /// Normal load of a contact of each sector, or of all that have one, times 1 + δ.
    Preload(Option<usize>),
    /// Forces on each sector times 1 + δ.
    Force,
}

/// Mistunes a wheel by a value δ_s for each sector s.
pub(crate) fn mistune(model: &mut Model, sector: &Model, what: &Mistuning<'_>, delta: &[f64]) -> Result<()> {
    let sectors = sector.structure().sectors();
    if delta.len() != sectors {
        return fail!(
            Dimension,
            "{} numbers delta, needs one for each of {sectors} sectors",
            delta.len()
        );
    }
    if let Some(s) = delta.iter().position(|d| !d.is_finite()) {
        return fail!(NotFinite, "delta[{s}] = {}, needs a finite number", delta[s]);
    }
    let contacts = sector.contacts().len();
    let fits = sectors > 1 && model.structure().sectors() == 1 && model.ndof() == sectors * sector.ndof();
    if !fits || model.structure().ndof() != sectors * sector.structure().ndof() {
        return fail!(
            Dimension,
            "the wheel has {} degrees of freedom, which are not {sectors} sectors with {}",
            model.ndof(),
            sector.ndof()
        );
    }
    let has_damping = matches!(
        what,
        Mistuning::Blade(BladeProperty::Damping, _)
            | Mistuning::Matrix(MatrixKind::Damping | MatrixKind::Structural, _)
    );
    model.check_sector(
        sector,
        if has_damping {
            SectorUse::DampingPattern
        } else {
            SectorUse::Pattern
        },
    )?;
    let mut changed = model.try_clone()?;
    match *what {
        Mistuning::Blade(property, dofs) => {
            // A stiffness, mass or damping below zero has no sense.
            if let Some(s) = delta.iter().position(|&d| d < -1.0) {
                return fail!(
                    Argument,
                    "delta[{s}] = {}, needs at least -1: a share, not a per cent",
                    delta[s]
                );
            }
            let (kind, entries) = sector.structure().of_blade(property, dofs)?;
            let share = |d: f64| {
                if property == BladeProperty::Frequency {
                    d * (2.0 + d)
                } else {
                    d
                }
            };
            add_to_sectors(&mut changed, kind, &entries, sector, |s| share(delta[s]))?;
        }
        Mistuning::Matrix(kind, direction) => {
            let entries = sector.structure().of_direction(kind, direction)?;
            add_to_sectors(&mut changed, kind, &entries, sector, |s| delta[s])?;
        }
        Mistuning::Preload(id) => {
            if let Some(id) = id.filter(|&id| id >= contacts) {
                return fail!(Index, "contact id = {id}, but a sector has {contacts} contacts");
            }
            if model.contacts().len() != contacts * sectors {
                return fail!(Dimension, "the wheel has other contacts than {sectors} sectors");
            }
            for c in 0..contacts {
                let without = sector.contacts().get(c).is_some_and(|c| c.without_load().is_some());
                if id.map_or(without, |id| id != c) {
                    continue;
                }
                for (s, d) in delta.iter().enumerate() {
                    let at = s * contacts + c;
                    if let Some((preload, per_speed2, _)) = model.given_load(at) {
                        changed.set_preload_at_speed(at, preload * (1.0 + d), per_speed2 * (1.0 + d))?;
                    }
                }
            }
        }
        Mistuning::Force => {
            let n = sector.ndof();
            changed.excitation.scale_each(|dof| 1.0 + delta[dof / n]);
        }
    }
    *model = changed;
    Ok(())
}

/// Adds a multiple of entries of sector 0, over the independent degrees of freedom of the wheel, for each sector.
fn add_to_sectors(
    model: &mut Model,
    kind: MatrixKind,
    entries: &Entries,
    sector: &Model,
    factor: impl Fn(usize) -> f64,
) -> Result<()> {
    let (n, sectors) = (sector.structure().ndof(), sector.structure().sectors());
    let all = n * sectors;
    let mut factors = try_vec(sectors, 0.0, CONTEXT)?;
    for (s, to) in factors.iter_mut().enumerate() {
        *to = factor(s);
    }
    if entries.is_empty() || factors.iter().all(|f| *f == 0.0) {
        return Ok(());
    }
    let of_sector = Csc::from_triplets(all, all, try_copy(entries, CONTEXT)?)?;
    let added = around(&symmetrised(of_sector, MIRROR_ROUNDING)?, n, &factors)?;
    let blocks = model.changed_structure().blocks_mut(kind)?;
    let added = KeptMatrix::new(added)?;
    let one = Complex64::ONE;
    blocks.own = Some(match &blocks.own {
        Some(own) => KeptMatrix::new(Csc::sum(all, &[(one, own, Form::Plain), (one, &added, Form::Plain)])?)?,
        None => added,
    });
    Ok(())
}

/// Entries of a matrix that the caller gives for a sector.
pub(crate) fn of_direction(structure: &Structure, kind: MatrixKind, direction: &MatrixView<'_>) -> Result<Entries> {
    if matches!(kind, MatrixKind::Gyroscopic | MatrixKind::StiffnessSpeed2) {
        return fail!(
            Unsupported,
            "mistuning of the {} matrix; needs mass, damping, stiffness or structural damping",
            kind.name()
        );
    }
    if kind == MatrixKind::Mass && direction.part == Part::General {
        return fail!(Argument, "a mass is symmetric, but its direction was passed as GENERAL");
    }
    of_both_sectors(
        structure.degrees(),
        &direction.copy_in("direction", structure.degrees().given())?,
    )
}

/// Independent degrees of freedom of the blade of sector 0, and the place of each degree of freedom of the sector among them.
struct Blade {
    numbers: Vec<usize>,
    place: Vec<Option<usize>>,
}

fn blade_of(structure: &Structure, dofs: &[usize]) -> Result<Blade> {
    let mut place = try_vec(structure.ndof(), None, CONTEXT)?;
    let mut numbers = Vec::new();
    for (k, &dof) in dofs.iter().enumerate() {
        if dof >= structure.degrees().given() {
            return fail!(
                Index,
                "dofs[{k}] = {dof}, needs 0 .. {}",
                structure.degrees().given() - 1
            );
        }
        if structure.degrees().image(dof).0 != 0 {
            return fail!(
                Argument,
                "dofs[{k}] = {dof} is on the right face, which the next sector moves; give that of the left face there"
            );
        }
        let Some(number) = structure.degrees().number(dof) else {
            continue;
        };
        if place[number].is_some() {
            return fail!(Argument, "dofs[{k}] = {dof} is there twice");
        }
        place[number] = Some(numbers.len());
        try_push(&mut numbers, number, CONTEXT)?;
    }
    if numbers.is_empty() {
        return fail!(Argument, "a blade has no degree of freedom that moves");
    }
    Ok(Blade { numbers, place })
}

/// The matrix of a property of the blade of sector 0 over the degrees of freedom of the wheel.
pub(crate) fn of_blade(
    structure: &Structure,
    property: BladeProperty,
    dofs: &[usize],
) -> Result<(MatrixKind, Entries)> {
    let n = structure.ndof();
    let Blade { numbers: blade, place } = blade_of(structure, dofs)?;
    let interrupt = Interrupt::none();
    let ring = structure.around_ring()?;
    let within = |a: &Csc| -> Result<Entries> {
        let mut entries = Vec::new();
        for (j, &column) in blade.iter().enumerate() {
            for (i, v) in a.column(column) {
                if let Some(i) = place.get(i).copied().flatten() {
                    try_push(&mut entries, (i, j, v), CONTEXT)?;
                }
            }
        }
        Ok(entries)
    };
    if property == BladeProperty::Mass {
        let mut entries = within(&ring.given_around(MatrixKind::Mass, &interrupt)?)?;
        for (i, j, _) in &mut entries {
            (*i, *j) = (blade[*i], blade[*j]);
        }
        return Ok((MatrixKind::Mass, entries));
    }
    let stiffness = ring.given_around(MatrixKind::Stiffness, &interrupt)?;
    let (_, _, gap) = stiffness.worst_pair(Symmetry::Plain);
    if gap > MIRROR_ROUNDING * stiffness.max_abs() {
        return fail!(
            Unsupported,
            "the stiffness is not symmetric: the share of a blade is unknown; give a direction"
        );
    }
    let nb = blade.len();
    let mut root = Vec::new();
    for &column in &blade {
        for (i, _) in stiffness.column(column) {
            if place.get(i).copied().flatten().is_none() {
                try_push(&mut root, i, CONTEXT)?;
            }
        }
    }
    root.sort_unstable();
    root.dedup();
    let nr = root.len();
    if nb.saturating_mul(nr) > LARGEST_ATTACHMENT {
        return fail!(
            Unsupported,
            "a blade of {nb} degrees of freedom with {nr} where it is attached, needs a product of at most {LARGEST_ATTACHMENT}; give \
             a direction"
        );
    }
    // X = K_bb⁻¹ K_br: y = x_b + X x_r.
    let own = Csc::from_triplets(nb, nb, within(&stiffness)?)?;
    let mut x = try_vec(nb * nr, Complex64::ZERO, CONTEXT)?;
    for (b, &column) in blade.iter().enumerate() {
        for (i, v) in stiffness.column(column) {
            if let Ok(r) = root.binary_search(&i) {
                x[r * nb + b] = v;
            }
        }
    }
    if nr > 0 {
        let mut factor = Factor::new(&own, nr)?;
        factor.factor(&own, &interrupt)?;
        factor.solve(&mut x, false, &interrupt)?;
    }
    let (kind, form) = if property == BladeProperty::Damping {
        let (alpha, beta) = structure.rayleigh;
        let mut terms = Vec::new();
        let given = ring.given_around(MatrixKind::Damping, &interrupt)?;
        let mass = ring.given_around(MatrixKind::Mass, &interrupt)?;
        for (factor, a) in [(1.0, &given), (alpha, &mass), (beta, &stiffness)] {
            try_push(&mut terms, (Complex64::from(factor), a, Form::Plain), CONTEXT)?;
        }
        let damping = Csc::sum(n * structure.sectors(), &terms)?;
        (MatrixKind::Damping, Csc::from_triplets(nb, nb, within(&damping)?)?)
    } else {
        (MatrixKind::Stiffness, own)
    };
    Ok((kind, relative(&form, &x, &blade, &root)?))
}

/// Σ_s f_s A_s with the matrix A of sector 0, over the degrees of freedom of the wheel, moved to sector s; n degrees of freedom a
/// sector. Sums go by s in each entry, so that the matrix is exactly symmetric where A is.
fn around(of_sector: &Csc, n: usize, factors: &[f64]) -> Result<Csc> {
    let all = of_sector.cols;
    let count = of_sector.values.len() * factors.iter().filter(|f| **f != 0.0).count();
    Csc::from_columns((all, all), count, |column, entries| {
        for (s, &factor) in factors.iter().enumerate().filter(|(_, f)| **f != 0.0) {
            for (i, v) in of_sector.column((column + all - s * n) % all) {
                try_push(entries, ((i + s * n) % all, s, factor * v), CONTEXT)?;
            }
        }
        Ok(())
    })
}

/// Entries of Tᵀ A T, where y = T x = x_b + X x_r.
fn relative(form: &Csc, x: &[Complex64], blade: &[usize], root: &[usize]) -> Result<Entries> {
    let nb = blade.len();
    let mut entries = Vec::new();
    for (j, &column) in blade.iter().enumerate() {
        for (i, v) in form.column(j) {
            try_push(&mut entries, (blade[i], column, v), CONTEXT)?;
        }
    }
    for (r, &at) in root.iter().enumerate() {
        let column = form.times(&x[r * nb..(r + 1) * nb], CONTEXT)?;
        for (&row, &v) in blade.iter().zip(&column) {
            if v != Complex64::ZERO {
                try_push(&mut entries, (row, at, v), CONTEXT)?;
                try_push(&mut entries, (at, row, v), CONTEXT)?;
            }
        }
        for (q, &row) in root.iter().enumerate().take(r + 1) {
            let v: Complex64 = x[q * nb..(q + 1) * nb].iter().zip(&column).map(|(a, b)| a * b).sum();
            try_push(&mut entries, (row, at, v), CONTEXT)?;
            if q != r {
                try_push(&mut entries, (at, row, v), CONTEXT)?;
            }
        }
    }
    Ok(entries)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_of_a_sector_stands_in_all_with_their_factors_and_stays_symmetric() {
        let (n, sectors) = (3, 4);
        let all = n * sectors;
        // Entries of sector 0 with both of its neighbours, so that matrices of neighbours overlap.
        let place = |k: usize| (k + all - n) % all;
        let mut entries = Vec::new();
        for i in 0..3 * n {
            for j in 0..=i {
                let v = Complex64::from((0.7 * (i * 9 + j) as f64).sin());
                entries.push((place(i), place(j), v));
                if i != j {
                    entries.push((place(j), place(i), v));
                }
            }
        }
        let factors = [0.3, 0.0, -0.7, 1.1];
        let of_sector = Csc::from_triplets(all, all, entries.clone()).unwrap();
        let found = around(&of_sector, n, &factors).unwrap();
        let mut exact = vec![Complex64::ZERO; all * all];
        for (s, f) in factors.iter().enumerate() {
            for &(i, j, v) in &entries {
                exact[(j + s * n) % all * all + (i + s * n) % all] += *f * v;
            }
        }
        for i in 0..all {
            for j in 0..all {
                assert!((found.get(i, j) - exact[j * all + i]).norm() < 1e-15, "{i}, {j}");
                assert_eq!(found.get(i, j).re.to_bits(), found.get(j, i).re.to_bits());
            }
        }
        // Entries that no sector has are not stored.
        let stored = exact.iter().filter(|v| **v != Complex64::ZERO).count();
        assert_eq!(found.values.len(), stored);
    }
}
