//! What follows from one solved point: numbers from the harmonics of its motion.

pub mod energy;
pub mod loops;
