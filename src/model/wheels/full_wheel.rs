//! The wheel as one structure in time: the sectors of one repetition of a travelling wave.
//!
//! With g = gcd(EO, N) the sectors s and s + N/g move alike in every harmonic, so that n = N/g sectors closed to a
//! ring represent the whole wave. In time the wave is a shift: sector s + 1 repeats the motion of sector s with a
//! delay of EO/N periods, whatever the harmonics, x_{s+1}(t) = x_s(t − T·EO/N); see Thomas 1979,
//! doi:10.1002/nme.1620140107.

use crate::error::{Result, fail, try_push};
use crate::interrupt::Interrupt;
use crate::linalg::sparse_storage::sparse::{Csc, Form};
use crate::model::matrices::influence::AeroForm;
use crate::model::matrices::speed::Speed;
use crate::model::matrices::structure::{MatrixKind, Structure};
use num_complex::Complex64;

const CONTEXT: &str = "the matrices of the wheel";

/// Entries of a transform over nodal diameters below this share of the largest are rounding.
/// Kind: rounding.
const FULL_WHEEL_ROUNDING: f64 = 1e-14;

/// Operations, about, that an entry takes until it is placed and sorted.
/// Kind: block.
const FULL_WHEEL_OF_ONE_ENTRY: u64 = 20;

/// The number j of sectors, below n = [`Structure::repeating_sectors`], after which the motion is delayed by the n-th
/// part of the period.
pub(crate) fn sectors_per_part(structure: &Structure) -> usize {
    let n = structure.repeating_sectors();
    let divisor = (structure.sectors() / n) as i128;
    let waves = (i128::from(structure.engine_order()).rem_euclid(structure.sectors() as i128) / divisor) as usize;
    (0..n).find(|j| (j * waves) % n == 1 % n).unwrap_or(0)
}

/// M, C or K of [`Structure::repeating_sectors`] sectors closed to a ring, sector after sector.
pub(crate) fn unrolled(structure: &Structure, which: MatrixKind, interrupt: &Interrupt<'_>) -> Result<Csc> {
    let (alpha, beta) = structure.rayleigh;
    let mut parts = Vec::new();
    let mut add = |factor: f64, which: MatrixKind| -> Result<()> {
        if factor == 0.0 {
            return Ok(());
        }
        try_push(&mut parts, (factor, structure.given_around(which, interrupt)?), CONTEXT)
    };
    add(1.0, which)?;
    let speed = match structure.speed {
        Speed::Fixed(speed) => speed,
        Speed::PerOmega(_) => return fail!(Internal, "the speed of rotation depends on the frequency"),
    };
    match which {
        MatrixKind::Damping => {
            add(alpha, MatrixKind::Mass)?;
            add(beta, MatrixKind::Stiffness)?;
            add(speed, MatrixKind::Gyroscopic)?;
        }
        MatrixKind::Stiffness => add(speed * speed, MatrixKind::StiffnessSpeed2)?,
        _ => {}
    }
    if which == MatrixKind::Damping && !structure.modal_damping.is_empty() {
        let modal = structure.blocks_of_waves(Structure::modal_damping_of_diameter, interrupt)?;
        try_push(&mut parts, (1.0, modal), CONTEXT)?;
    }
    let aero = match which {
        MatrixKind::Damping => structure.aero_around(AeroForm::Velocity, interrupt)?,
        MatrixKind::Stiffness => structure.aero_around(AeroForm::Displacement, interrupt)?,
        _ => None,
    };
    if let Some(aero) = aero {
        try_push(&mut parts, (1.0, aero), CONTEXT)?;
    }
    let mut terms = Vec::new();
    for (factor, a) in &parts {
        try_push(&mut terms, ((*factor).into(), a, Form::Plain), CONTEXT)?;
    }
    interrupt.check()?;
    let own = Csc::sum(structure.ndof() * structure.repeating_sectors(), &terms)?;
    interrupt.check()?;
    for j in 0..own.cols {
        if let Some((i, v)) = own.column(j).find(|(_, v)| v.im != 0.0) {
            return fail!(
                Unsupported,
                "{}[{i},{j}] has the imaginary part {}: complex matrices mean nothing in time; use real ones",
                which.name(),
                v.im
            );
        }
    }
    Ok(own)
}

/// One matrix as the caller gave it, without derived parts, for the sectors of the ring.
pub(crate) fn given_around(structure: &Structure, which: MatrixKind, interrupt: &Interrupt<'_>) -> Result<Csc> {
    if structure.blocks[which as usize].diameters.is_empty() {
        sectors_around(structure, which, interrupt)
    } else {
        structure.blocks_of_waves(|structure, d| structure.given_of_diameter(which, d), interrupt)
    }
}

/// Assembles the blocks of a sector around the ring.
fn sectors_around(structure: &Structure, which: MatrixKind, interrupt: &Interrupt<'_>) -> Result<Csc> {
    let (ndof, sectors) = (structure.ndof(), structure.repeating_sectors());
    let blocks = &structure.blocks[which as usize];
    // Each block with the distance from the sector of its columns to that of its rows.
    let mut parts = Vec::new();
    if let Some(own) = &blocks.own {
        try_push(&mut parts, (0, own.expanded()?), CONTEXT)?;
    }
    if let Some(next) = &blocks.next {
        try_push(&mut parts, (sectors - 1, next.expanded()?), CONTEXT)?;
    }
    match (&blocks.previous, &blocks.next) {
        (Some(previous), _) => try_push(&mut parts, (1, previous.expanded()?), CONTEXT)?,
        (None, Some(next)) => {
            let transposed = Csc::sum(ndof, &[(Complex64::ONE, next, Form::Transposed)])?;
            try_push(&mut parts, (1, transposed), CONTEXT)?;
        }
        (None, None) => {}
    }
    let stored: usize = parts.iter().map(|(_, a)| a.values.len()).sum();
    let order = ndof * sectors;
    Csc::from_columns((order, order), stored.saturating_mul(sectors), |column, entries| {
        let (t, j) = (column / ndof, column % ndof);
        if j == 0 {
            interrupt.check_before(FULL_WHEEL_OF_ONE_ENTRY * stored as u64)?;
        }
        for (place, (distance, a)) in parts.iter().enumerate() {
            let row = (t + distance) % sectors * ndof;
            for (i, v) in a.column(j) {
                try_push(entries, (row + i, place, v), CONTEXT)?;
            }
        }
        Ok(())
    })
}

/// The blocks of a ring from the matrices of its waves.
pub(crate) fn blocks_of_waves(
    structure: &Structure,
    wave: impl Fn(&Structure, usize) -> Result<Csc>,
    interrupt: &Interrupt<'_>,
) -> Result<Csc> {
    let (ndof, sectors) = (structure.ndof(), structure.repeating_sectors());
    let divisor = structure.sectors() / sectors;
    let share = 1.0 / sectors as f64;
    let mut waves = Vec::new();
    for d in 0..sectors {
        interrupt.check()?;
        try_push(&mut waves, wave(structure, d * divisor)?, CONTEXT)?;
    }
    let largest = waves.iter().fold(0.0_f64, |m, a| m.max(a.max_abs()));
    let mut entries = Vec::new();
    for offset in 0..sectors {
        let mut terms = Vec::new();
        for (d, a) in waves.iter().enumerate() {
            interrupt.check_before(FULL_WHEEL_OF_ONE_ENTRY * a.values.len() as u64)?;
            let turn = structure.wave_phase((d * divisor) as i64, -(offset as i64));
            try_push(&mut terms, (share * turn, a, Form::Plain), CONTEXT)?;
        }
        let block = Csc::sum(ndof, &terms)?;
        for j in 0..ndof {
            for (i, mut v) in block.column(j) {
                if v.im.abs() <= FULL_WHEEL_ROUNDING * largest {
                    v.im = 0.0;
                }
                if v.norm() <= FULL_WHEEL_ROUNDING * largest {
                    continue;
                }
                interrupt.check_before(sectors as u64)?;
                for s in 0..sectors {
                    let entry = (s * ndof + i, (s + offset) % sectors * ndof + j, v);
                    try_push(&mut entries, entry, CONTEXT)?;
                }
            }
        }
    }
    Csc::from_triplets(ndof * sectors, ndof * sectors, entries)
}

#[cfg(test)]
mod tests {
    use crate::model::Model;

    #[test]
    fn the_sector_that_follows_after_a_part_of_the_period_is_found() {
        let mut model = Model::cyclic(1, 24).unwrap();
        for (engine_order, sectors, follower) in [
            (0, 1, 0),
            (24, 1, 0),
            (2, 12, 1),
            (-2, 12, 11),
            (5, 24, 5),
            (10, 12, 5),
            (12, 2, 1),
        ] {
            model.set_wave(engine_order);
            let structure = model.structure();
            let found = (structure.repeating_sectors(), structure.sectors_per_part());
            assert_eq!(found, (sectors, follower), "EO {engine_order}");
        }
    }
}
