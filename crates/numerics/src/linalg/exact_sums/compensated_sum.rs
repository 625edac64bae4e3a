//! Sums of products as if computed in twice the working precision and rounded once (Ogita, Rump & Oishi 2005,
//! doi:10.1137/030601818).

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

/// A sum with its rounding errors accumulated separately.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sum {
    pub(super) value: f64,
    pub(super) error: f64,
}

impl Sum {
    /// self ← self + term.
    #[inline(always)]
    pub(super) fn add(&mut self, term: f64) {
        let sum = self.value + term;
        let part = sum - self.value;
        self.error += (self.value - (sum - part)) + (term - part);
        self.value = sum;
    }

    /// self ← self + a b, on any processor.
    #[inline(always)]
    pub(super) fn add_product(&mut self, a: f64, b: f64) {
        let product = a * b;
        self.error += rounding_of(a, b, product);
        self.add(product);
    }

    /// self ← self + a b, on processors with fused operations.
    #[inline(always)]
    pub fn add_fused(&mut self, a: f64, b: f64) {
        let product = a * b;
        let sum = self.value + product;
        let part = sum - self.value;
        self.error += a.mul_add(b, -product) + ((self.value - (sum - part)) + (product - part));
        self.value = sum;
    }

    /// Adds a·b, where a is a sum with its own rounding errors.
    pub(super) fn add_multiple(&mut self, a: Self, b: f64) {
        self.add_product(a.value, b);
        self.error += a.error * b;
    }

    /// The sum, rounded once.
    #[must_use]
    #[inline(always)]
    pub fn total(self) -> f64 {
        self.value + self.error
    }
}

/// Rounding error a·b − product, exactly, by splitting the factors (Dekker 1971, doi:10.1007/BF01397083). A fused
/// multiply-add gives the same number, but is a slow call on processors that are not known to have it.
#[inline(always)]
pub(super) fn rounding_of(a: f64, b: f64, product: f64) -> f64 {
    let halves = |x: f64| {
        let c = 134_217_729.0 * x;
        let high = c - (c - x);
        (high, x - high)
    };
    let ((ah, al), (bh, bl)) = (halves(a), halves(b));
    let error = ((ah * bh - product) + ah * bl + al * bh) + al * bl;
    // Numbers near the end of the range cannot be split.
    if error.is_finite() { error } else { 0.0 }
}
