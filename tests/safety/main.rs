//! A process is not hurt by the library in it: failing memory, small stacks, unloading, many cycles.

#![cfg(target_os = "linux")]

#[path = "../common/mod.rs"]
mod common;

mod decimal_comma;
mod failing_allocations;
mod lifetime;
mod needs;
mod null_pointers;
mod programs;
mod random_calls;
mod stacks;
mod threads;
