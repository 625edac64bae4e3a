//! Sums of products as if computed in twice the working precision and rounded once (Ogita, Rump & Oishi 2005,
//! doi:10.1137/030601818).

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

/// A sum of products, with its accumulated rounding error.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sum {
    value: f64,
    lost: f64,
}

impl Sum {
    /// self ← self + a b, with its rounding error.
    #[inline(always)]
    pub fn add(&mut self, a: f64, b: f64) {
        let product = a * b;
        let sum = self.value + product;
        let taken = sum - self.value;
        self.lost += a.mul_add(b, -product) + ((self.value - (sum - taken)) + (product - taken));
        self.value = sum;
    }

    /// The sum, rounded once.
    #[must_use]
    #[inline(always)]
    pub fn rounded(self) -> f64 {
        self.value + self.lost
    }
}
