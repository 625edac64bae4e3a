//! Responses in time, and points of a branch that are checked in time.

#[path = "../common/mod.rs"]
mod common;

mod missions;
mod run_up;
mod slow_flow;
mod time_response;
mod time_response_balance;
mod time_response_friction;
mod time_response_input;
mod time_response_laws;
mod verify;
mod verify_input;
