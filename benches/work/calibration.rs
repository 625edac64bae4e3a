//! Units of the rows.

use crate::cpu_time::{cpu_seconds, lu11_seconds};
use faer::Mat;
use faer::linalg::solvers::PartialPivLu;
use std::hint::black_box;

/// What a row is a multiple of.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// LU of order 11 with one solution, nalgebra.
    Lu11,
    /// LU of this order, faer, one thread.
    Faer(usize),
}

impl Unit {
    /// Its name in the table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lu11 => "LU11",
            Self::Faer(500) => "LU500",
            Self::Faer(_) => "LU1000",
        }
    }

    /// CPU time of one, s: the least of several.
    pub fn seconds(self) -> f64 {
        match self {
            Self::Lu11 => lu11_seconds(),
            Self::Faer(order) => (0..8).map(|_| lu_seconds(order)).fold(f64::INFINITY, f64::min),
        }
    }
}

fn lu_seconds(order: usize) -> f64 {
    let a = Mat::<f64>::from_fn(order, order, |i, j| {
        if i == j { 50.0 } else { (1.0 + (i * 3 + j) as f64).sin() }
    });
    let begin = cpu_seconds();
    black_box(PartialPivLu::new(black_box(a).as_ref()));
    cpu_seconds() - begin
}
