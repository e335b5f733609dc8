//! Runs, what is seen of them and what they cost: one file per property.
mod advise;
mod bad_input;
#[path = "../common/mod.rs"]
mod common;
mod front;
mod loads;
mod observers;
mod relaxation;
mod resume;
mod resume_refused;
mod short_runs_fail;
mod shown_message;
mod threads;
mod trade;
