//! The flexibility as a sum over modes or poles of waves.

pub(crate) mod eliminated_modes;
pub(crate) mod few_directions;
pub(crate) mod low_rank;
pub mod modal_rows;
pub(crate) mod modal_slopes;
pub mod modal_table;
pub mod mode_flexibility;
pub(crate) mod mode_sums;
pub(crate) mod quadratic_poles;
pub(crate) mod single_contact;
pub(crate) mod soft_modes;
pub(crate) mod soft_store;
pub(crate) mod soft_tables;
pub(crate) mod sum_terms;
pub mod wave_cache;
pub mod wave_modes;
pub(crate) mod wave_poles;
