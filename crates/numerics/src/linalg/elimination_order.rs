//! Orders of elimination of sparse symmetric matrices: nested dissection, whose small pieces are ordered by approximate
//! minimum degrees (Amestoy, Davis & Duff 1996, doi:10.1137/S0895479894278952).

use crate::error::{Error, Result, try_vec};
use crate::interrupt::Interrupt;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;
use hbvib_dissection::{Host, OutOfMemory};

const CONTEXT: &str = "nested dissection";

/// The running call as the host of a dissection.
struct Call<'a, 'b>(&'a Interrupt<'b>);

/// Why there is no order. A type of its own: a second way to make an error would leave `?` undecided all over the library.
struct Refused(Error);

impl From<OutOfMemory> for Refused {
    fn from(_: OutOfMemory) -> Self {
        Self(Error::out_of_memory(CONTEXT))
    }
}

impl Host for Call<'_, '_> {
    type Error = Refused;

    fn before(&self, operations: u64) -> core::result::Result<(), Refused> {
        self.0.check_before(operations).map_err(Refused)
    }

    fn positions(&self, starts: &[usize], later: &[usize]) -> core::result::Result<Vec<usize>, Refused> {
        by_degrees(starts, later).map_err(Refused)
    }
}

/// The position of each vertex by approximate minimum degrees.
fn by_degrees(starts: &[usize], later: &[usize]) -> Result<Vec<usize>> {
    let n = starts.len() - 1;
    let no_memory = || Error::out_of_memory(CONTEXT);
    let pattern = SymbolicSparseColMatRef::new_checked(n, n, starts, None, later);
    let mut order = try_vec(n, 0, CONTEXT)?;
    let mut place = try_vec(n, 0, CONTEXT)?;
    let need = amd::order_scratch::<usize>(n, later.len());
    let mut scratch = MemBuffer::try_new(need).map_err(|_| no_memory())?;
    let control = amd::Control::default();
    amd::order(&mut order, &mut place, pattern, control, MemStack::new(&mut scratch)).map_err(|_| no_memory())?;
    Ok(place)
}

/// The order of elimination of a symmetric matrix, from the pattern of its lower triangle: the row at each position.
///
/// # Errors
/// `OutOfMemory`; `StoppedByCaller`.
pub fn nested_dissection(col_ptr: &[usize], rows: &[usize], interrupt: &Interrupt<'_>) -> Result<Vec<usize>> {
    hbvib_dissection::order(col_ptr, rows, &Call(interrupt)).map_err(|refused| refused.0)
}
