//! LU factorisation by panels of columns, between which the caller may interrupt: a large matrix takes seconds.
//!
//! Each panel is factored by the blocked kernel with partial pivoting over all its rows; the columns to its right are
//! then exchanged, solved and updated in chunks (Golub & Van Loan, Matrix Computations, 2013, §3.4).

use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::linalg::factors::lu::{Blocked, LU_SIDE_BY_SIDE, Scalar, interchanges};
use faer::dyn_stack::MemStack;
use faer::linalg::lu::partial_pivoting::factor;
use faer::linalg::{matmul, triangular_solve};
use faer::{Accum, MatMut, MatRef, Par};

/// Columns of a panel.
/// Kind: tuned; measured on: not recorded.
const PANEL: usize = 64;

/// Columns that are updated between two checks.
/// Kind: block.
const CHUNK: usize = 192;

/// Factors the n × n column-major matrix; the permutation is left in `blocked`, as the kernel for a whole matrix
/// leaves it.
pub(super) fn factor<T: Scalar>(a: &mut [T], n: usize, blocked: &mut Blocked, interrupt: &Interrupt<'_>) -> Result<()> {
    for (k, row) in blocked.forward[..n].iter_mut().enumerate() {
        *row = k;
    }
    for first in (0..n).step_by(PANEL) {
        let width = PANEL.min(n - first);
        let rows = n - first;
        interrupt.check_before((rows * width * width) as u64 / LU_SIDE_BY_SIDE)?;
        let (done, right) = a.split_at_mut((first + width) * n);
        let (left, panel) = done.split_at_mut(first * n);
        factor::lu_in_place::<usize, T>(
            MatMut::from_column_major_slice_mut(panel, n, width).submatrix_mut(first, 0, rows, width),
            &mut blocked.panel[..rows],
            &mut blocked.backward[..rows],
            Par::Seq,
            MemStack::new(&mut blocked.scratch),
            faer::Spec::default(),
        );
        interchanges(
            &blocked.panel[..rows],
            &mut blocked.backward[..rows],
            &mut blocked.swaps[..rows],
        );
        let swaps = &blocked.swaps[..width];
        exchange(swaps, &mut blocked.forward[first..n]);
        for column in left.chunks_exact_mut(n) {
            exchange(swaps, &mut column[first..]);
        }
        let panel = MatRef::from_column_major_slice(panel, n, width);
        let upper = panel.submatrix(first, 0, width, width);
        let lower = panel.submatrix(first + width, 0, rows - width, width);
        for chunk in right.chunks_mut(CHUNK * n) {
            interrupt.check_before((2 * rows * width * chunk.len() / n) as u64 / LU_SIDE_BY_SIDE)?;
            for column in chunk.chunks_exact_mut(n) {
                exchange(swaps, &mut column[first..]);
            }
            let columns = chunk.len() / n;
            let chunk = MatMut::from_column_major_slice_mut(chunk, n, columns);
            let (_, below) = chunk.split_at_row_mut(first);
            let (mut known, rest) = below.split_at_row_mut(width);
            triangular_solve::solve_unit_lower_triangular_in_place(upper, known.as_mut(), Par::Seq);
            let minus = <T as nalgebra::ComplexField>::from_real(-1.0);
            matmul::matmul(rest, Accum::Add, lower, known.as_ref(), minus, Par::Seq);
        }
    }
    for (k, &row) in blocked.forward[..n].iter().enumerate() {
        blocked.backward[row] = k;
    }
    Ok(())
}

/// Applies interchanges in their order.
fn exchange<T>(swaps: &[usize], rows: &mut [T]) {
    for (k, &with) in swaps.iter().enumerate() {
        rows.swap(k, with);
    }
}
