//! Finite-element structures: the sector of the example and the beam on a friction lining.

#[path = "../common/mod.rs"]
mod common;

#[path = "../../examples/friction_patch/beam.rs"]
mod beam;
#[path = "../../examples/friction_patch/brick.rs"]
mod brick;
#[path = "../../examples/fe_sector/cost.rs"]
mod cost;
#[path = "../../examples/support/flags.rs"]
mod flags;
#[path = "../../examples/support/json.rs"]
mod json;
#[path = "../../examples/support/matrix_market.rs"]
mod matrix_market;
#[path = "../../examples/support/memory.rs"]
mod memory;
#[path = "../../examples/support/plate.rs"]
mod plate;
#[path = "../../examples/support/progress.rs"]
mod progress;
#[path = "../../examples/support/response.rs"]
mod response;
#[path = "../../examples/fe_sector/sector.rs"]
mod sector;
#[path = "../../examples/fe_sector/single.rs"]
#[allow(dead_code, reason = "the reader of flags alone is needed here")]
mod single;
#[path = "../../examples/support/table.rs"]
mod table;

mod fe_input;
mod fe_modes;
mod fe_pressed;
mod fe_sector;
mod fe_stops;
mod friction_patch;
mod large_models;
mod large_plate;
mod sector_stability;
