//! Soft modes of the harmonics of a wave, which all condensed models of an analysis share.

use crate::condense::by_modes::soft_modes::SoftModes;
use num_complex::Complex64;
use std::fmt;
use std::sync::atomic::AtomicUsize;
use std::sync::{Arc, Mutex, OnceLock};

/// Soft modes of the harmonics of a wave.
#[derive(Default)]
pub(crate) struct SoftStore(pub Mutex<Vec<Arc<SoftTables>>>);

impl fmt::Debug for SoftStore {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("SoftStore")
    }
}

/// Soft modes of a harmonic over a range, from a number of tables on.
pub(crate) struct SoftTables {
    pub plan: Plan,
    /// Rows and excitations by which a harmonic with the same numbers is recognised.
    pub left: Arc<Vec<Complex64>>,
    pub excitations: Vec<Complex64>,
    /// Tables that are still made by sums over all modes.
    pub left_out: AtomicUsize,
    /// Made when these are; `None` where they do not agree with sums.
    pub made: OnceLock<Option<SoftModes>>,
}

/// Soft modes of a range of ν, and the tables within it after which their elimination has paid.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Plan {
    /// Number of the harmonic.
    pub number: f64,
    pub range: (f64, f64),
    /// Index of the first soft mode.
    pub first: usize,
    pub tables: usize,
}

impl Plan {
    /// Whether ν lies in the range.
    pub fn covers(&self, nu: f64) -> bool {
        (self.range.0..=self.range.1).contains(&nu)
    }
}
