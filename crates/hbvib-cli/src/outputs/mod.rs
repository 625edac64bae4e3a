//! Files and figures of results.

pub(crate) mod canvas;
pub(crate) mod contact_figures;
pub(crate) mod contact_tables;
pub(crate) mod curve;
pub(crate) mod figure;
pub(crate) mod files;
pub(crate) mod frd;
pub(crate) mod html_report;
pub(crate) mod line_chart;
pub(crate) mod modal_coordinates;
pub(crate) mod modes_table;
pub(crate) mod motion_files;
pub(crate) mod netcdf;
pub(crate) mod netcdf_response;
pub(crate) mod node_motion;
pub(crate) mod npz;
pub(crate) mod output;
pub(crate) mod plot;
pub(crate) mod points;
pub(crate) mod restart;
pub(crate) mod stored_response;
pub(crate) mod uff;
pub(crate) mod vtu;
pub(crate) mod vtu_series;
