//! Studies of a job beside its response: bands, speeds, wheels, life, fits.

pub(crate) mod band_curve;
pub(crate) mod campbell;
pub(crate) mod decay;
pub(crate) mod fit_files;
pub(crate) mod fit_run;
pub(crate) mod fit_table;
pub(crate) mod incomplete_bands;
pub(crate) mod kicks;
pub(crate) mod life;
pub(crate) mod map;
pub(crate) mod mode_band;
pub(crate) mod passages;
pub(crate) mod residual_state;
pub(crate) mod solutions;
pub(crate) mod study;
pub(crate) mod tornado;
pub(crate) mod varied;
pub(crate) mod verification;
pub(crate) mod wheel_patterns;
pub(crate) mod wheel_response;
