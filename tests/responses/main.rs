//! Responses of a forced response: gauges, harmonics, peaks over the period, and their maxima over the frequency.

#[path = "../common/mod.rs"]
mod common;

mod derivatives;
mod engine_orders;
mod everywhere;
mod kinks;
mod peaks;
mod peaks_of_dampings;
mod readings;
mod refused;
mod tolerance;
