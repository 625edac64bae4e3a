//! The job file: its tables and their keys.

pub(crate) mod job;
pub(crate) mod job_damper;
pub(crate) mod job_faces;
pub(crate) mod job_files;
pub(crate) mod job_fit;
pub(crate) mod job_life;
pub(crate) mod job_motion;
pub(crate) mod job_passages;
pub(crate) mod job_residual;
pub(crate) mod job_response;
pub(crate) mod job_solutions;
pub(crate) mod job_static;
pub(crate) mod job_studies;
pub(crate) mod job_surfaces;
pub(crate) mod job_words;
pub(crate) mod nearest_name;
