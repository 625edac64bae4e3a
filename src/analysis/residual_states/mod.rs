//! States of contacts that stick through the period: free sliders, and the band of results over their places.

pub mod band;
pub(crate) mod band_corners;
pub mod band_curve;
pub(crate) mod band_ends;
pub(crate) mod band_growth;
pub(crate) mod band_line;
pub(crate) mod band_refinement;
pub mod band_result;
pub(crate) mod band_search;
pub(crate) mod band_starts;
pub(crate) mod free_points;
pub mod freedom;
pub(crate) mod freedom_columns;
pub(crate) mod freedom_warning;
pub(crate) mod held_sliders;
pub mod mode_band;
pub(crate) mod slip_margins;
pub(crate) mod stuck_contacts;
