//! One harmonic of the condensed model on the basis of its wave.

use crate::condense::HarmonicBlock;
use crate::condense::blocks::contact_classes::ContactClasses;
use crate::condense::blocks::flexibility_way::FlexibilityWay;
use crate::condense::blocks::harmonic_block::{Artificial, BlockLoad, BlockMatrices, BlockMotions};
use crate::error::{Result, try_copy, try_push, try_vec};
use crate::linalg::sparse_storage::sparse::Csc;
use crate::model::Model;
use crate::model::few_motions::reduced_wave::{MotionRow, ReducedView, WaveDamping};
use crate::model::matrices::spring::Row;
use crate::model::matrices::wave::Wave;
use num_complex::Complex64;
use std::sync::Arc;

const CONTEXT: &str = "the reduced structure";

/// The block of harmonic `number` on a basis, see [`crate::condense::blocks::harmonic_block::harmonic_block`], with `order` coordinates.
pub(crate) fn reduced_block(
    model: &Model,
    number: usize,
    (contact_classes, representatives): (&ContactClasses, &[(usize, usize)]),
    kappa: impl Fn(usize) -> Complex64,
    (view, order, loss_factor): (ReducedView, usize, f64),
) -> Result<HarmonicBlock> {
    let structure = model.structure();
    let basis = view.pencil().order();
    let n = order.max(basis);
    let mut full = Csc {
        rows: n,
        cols: n,
        col_ptr: try_vec(n + 1, 0, CONTEXT)?,
        row_idx: try_vec(n * n, 0, CONTEXT)?,
        values: try_vec(n * n, Complex64::ZERO, CONTEXT)?,
    };
    for (at, i) in full.row_idx.iter_mut().enumerate() {
        *i = at % n;
    }
    for (j, start) in full.col_ptr.iter_mut().enumerate() {
        *start = j * n;
    }
    let mut mass = try_vec(n * n, Complex64::ZERO, CONTEXT)?;
    let mut damping = try_vec(n * n, Complex64::ZERO, CONTEXT)?;
    for j in 0..n {
        // Coordinates beyond the basis, so that all harmonics have the same number, have a stiffness of 1 and no mass.
        full.values[j * n + j] = view.pencil().stiffness(j).into();
        if j < basis {
            mass[j * n + j] = view.pencil().values[j].into();
            for i in 0..basis {
                damping[j * n + i] = view.damping(i, j);
            }
        } else if let WaveDamping::Proportional(_, beta) = view.pencil().damping {
            // As proportional as the rest, so that the wave has modes.
            damping[j * n + j] = (beta * view.pencil().stiffness(j)).into();
        }
    }
    let stuck = contact_classes.never_slipping.iter().map(|&i| &model.contacts()[i]);
    let springs = model.spring_rows(Wave::Harmonic(number), stuck)?;
    for (force, motion, k) in &springs {
        add(&mut full, &view.row(force)?, &view.row(motion)?, (*k).into());
    }
    let stiffness = try_copy(&full.values, CONTEXT)?;
    // The loss factor is of the structure itself, and dissipates nothing at rest.
    let structural = if loss_factor == 0.0 || number == 0 {
        None
    } else {
        let mut structural = try_vec(n * n, Complex64::ZERO, CONTEXT)?;
        for j in 0..basis {
            structural[j * n + j] = (loss_factor * view.pencil().stiffness(j)).into();
            full.values[j * n + j] += Complex64::I * structural[j * n + j];
        }
        Some(Arc::new(structural))
    };
    let rows_of = |contacts: &[(usize, usize)]| -> Result<(Vec<Row>, Vec<MotionRow>)> {
        let (mut structural, mut reduced) = (Vec::new(), Vec::new());
        for &(i, k) in contacts {
            let row = structure.contact_row(&model.contacts()[i], k, number);
            try_push(&mut reduced, view.row(&row)?, CONTEXT)?;
            try_push(&mut structural, row, CONTEXT)?;
        }
        Ok((structural, reduced))
    };
    let (structural_rows, rows) = rows_of(representatives)?;
    for (c, row) in rows.iter().enumerate() {
        add(&mut full, row, row, kappa(c));
    }
    Ok(HarmonicBlock {
        number,
        next: structure.phase(number, 1),
        matrices: BlockMatrices {
            reference: Arc::new(full),
            stiffness: Arc::new(stiffness),
            structural,
            damping: Arc::new(damping),
            modal: None,
            mass: Arc::new(mass),
            artificial: Artificial::None,
            tied: None,
        },
        source: None,
        without_source: FlexibilityWay::SingleFrequency,
        load: BlockLoad {
            force: try_vec(n, Complex64::ZERO, "the forces")?,
            unbalance: None,
        },
        motions: BlockMotions {
            rows,
            structural_rows,
            linear_rows: rows_of(&contact_classes.linear)?.1,
            springs,
        },
        view: Some(view),
    })
}

/// A ← A + forceᴴ k motion, for one spring of stiffness k.
fn add(a: &mut Csc, force: &MotionRow, motion: &MotionRow, k: Complex64) {
    let n = a.rows;
    for &(j, y) in motion.terms() {
        for &(i, x) in force.terms() {
            a.values[j * n + i] += x.conj() * k * y;
        }
    }
}
