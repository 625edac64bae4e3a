//! Numbers that look random and repeat from run to run, on every machine.

use num_complex::Complex64;
use std::f64::consts::TAU;

/// A generator by a counter and two multiplications (Steele, Lea & Flood, Fast Splittable Pseudorandom
/// Number Generators, 2014, doi:10.1145/2660193.2660195).
pub struct Random(u64);

impl Random {
    /// The generator of one case: cases do not depend on those before them.
    pub fn of(seed: u64, case: u64) -> Self {
        let mut mixed = Self(seed ^ 0x5851_f42d_4c95_7f2d);
        let own = mixed.bits() ^ case.wrapping_mul(0xd134_2543_de82_ef95);
        Self(own)
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number in [0, 1).
    pub fn share(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number in [low, high).
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    /// 10 to a power in [low, high).
    pub fn decade(&mut self, low: f64, high: f64) -> f64 {
        10.0_f64.powf(self.within(low, high))
    }

    /// A whole number below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    /// Whether something happens that has this probability.
    pub fn happens(&mut self, probability: f64) -> bool {
        self.share() < probability
    }

    /// A complex number of modulus 1.
    pub fn phase(&mut self) -> Complex64 {
        Complex64::cis(TAU * self.share())
    }
}

/// A number that the environment may set; `otherwise` where it does not.
pub fn from_environment(name: &str, otherwise: u64) -> u64 {
    match std::env::var(name) {
        Ok(text) => text
            .parse()
            .unwrap_or_else(|_| panic!("{name} = {text}, needs a whole number")),
        Err(_) => otherwise,
    }
}
