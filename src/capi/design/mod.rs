//! Parameters, derivatives, studies over designs and wheels, bands, fits, life.

pub(crate) mod band;
pub(crate) mod band_curves;
pub(crate) mod batch;
pub(crate) mod complex_sensitivities;
pub(crate) mod fit;
pub(crate) mod fit_data;
pub(crate) mod fit_profile;
pub(crate) mod life;
pub(crate) mod parameter_optima;
pub(crate) mod parameter_responses;
pub(crate) mod sensitivities;
pub(crate) mod wheel_identify;
pub(crate) mod wheel_peaks;

pub use band::*;
pub use band_curves::*;
pub use batch::*;
pub use complex_sensitivities::*;
pub use fit::*;
pub use fit_data::*;
pub use fit_profile::*;
pub use life::*;
pub use parameter_optima::*;
pub use parameter_responses::*;
pub use sensitivities::*;
pub use wheel_identify::*;
pub use wheel_peaks::*;
