//! The parts that laws are made of: the traits of a [`law`], its [`constants`] by name, and the forms in which it gives its force,
//! over a period and in time.

pub mod constants;
pub mod contact_state;
pub mod coupled_search;
pub mod force_derivative;
pub mod law;
pub mod linearisation;
pub mod march;
pub mod onset;
pub mod piece;
pub mod plane_path;
pub mod radau;
pub mod samples;
pub mod time_piece;
