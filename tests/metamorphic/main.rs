//! Metamorphic tests: random missions, changed in ways that must not change the verdict, or must not
//! cost a plan.
//!
//! Each law runs over missions of its own, always the same ones. `DOSMC_METAMORPHIC=1000` tries a
//! thousand for each law instead of the few that fit into a test run, `DOSMC_METAMORPHIC_FROM` begins
//! with another seed.

#[path = "../common/mod.rs"]
mod common;

mod chance;
mod draft;
mod formula;
mod generate;
mod laws;
mod luck;
mod motion;
mod verdict;
