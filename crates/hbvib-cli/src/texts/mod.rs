//! Texts of the command: arguments, help, a first job, progress.

pub(crate) mod arguments;
pub(crate) mod convert;
pub(crate) mod counted;
pub(crate) mod demo;
pub(crate) mod end;
pub(crate) mod events;
pub(crate) mod init;
pub(crate) mod init_job;
pub(crate) mod manual;
pub(crate) mod outcome;
pub(crate) mod progress;
