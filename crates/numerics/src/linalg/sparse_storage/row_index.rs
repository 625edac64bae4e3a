//! Numbers of rows in 32 bits: half the memory of indices wherever a sparse matrix is kept. All conversions are here.

use crate::error::{Result, fail, try_room};

/// Index of a row in 32 bits.
pub type Row = u32;

/// Refuses an order whose row indices do not fit into 32 bits.
///
/// # Errors
/// `Dimension`.
pub fn check_order(order: usize) -> Result<()> {
    let most = Row::MAX as usize;
    if order > most {
        return fail!(Dimension, "a sparse matrix has {order} rows, needs 0 .. {most}");
    }
    Ok(())
}

/// Index of a row in 32 bits, for an order that [`check_order`] accepts.
#[inline]
#[must_use]
pub fn narrow(row: usize) -> Row {
    row as Row
}

/// Index of a row as `usize`.
#[inline]
#[must_use]
pub fn wide(row: Row) -> usize {
    row as usize
}

/// Indices of rows below `order` in 32 bits; `context` names the purpose of the memory in an error.
///
/// # Errors
/// `Dimension` for a larger order, `OutOfMemory`.
pub fn narrowed(rows: &[usize], order: usize, context: &str) -> Result<Vec<Row>> {
    check_order(order)?;
    let mut narrow_rows = try_room(rows.len(), context)?;
    narrow_rows.extend(rows.iter().map(|&row| narrow(row)));
    Ok(narrow_rows)
}

/// Indices of rows as `usize`, as factorisations take them.
///
/// # Errors
/// `OutOfMemory`.
pub fn widened(rows: &[Row], context: &str) -> Result<Vec<usize>> {
    let mut wide_rows = try_room(rows.len(), context)?;
    wide_rows.extend(rows.iter().map(|&row| wide(row)));
    Ok(wide_rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Status;

    #[test]
    fn numbers_of_32_bits_come_back_and_larger_orders_are_refused() {
        let rows = [0, 7, (1 << 32) - 2];
        let narrow = narrowed(&rows, (1 << 32) - 1, "a test").unwrap();
        assert_eq!(widened(&narrow, "a test").unwrap(), rows);
        let refused = narrowed(&rows, 1 << 32, "a test").unwrap_err();
        assert_eq!(refused.status, Status::Dimension);
        assert!(refused.to_string().contains("4294967296 rows"), "{refused}");
    }
}
