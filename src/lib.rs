//! dosmc: from a `.dosm` mission to a plan that is proved in exact arithmetic.
//!
//! A mission says where robots move, who jams their radio, how they are disturbed and what must
//! happen, in temporal logic. A plan is a lasso of nominal states and inputs with a feedback law
//! around it that holds for *every* disturbance allowed, on an infinite run, with every robot in
//! radio contact all the time. The method is that of *DoS-Resilient Multi-Robot Temporal Logic
//! Motion Planning*: tubes take the disturbance out of the problem, and a Boolean solver and a
//! convex one plan what is left together.
//!
//! # Guided tour
//!
//! ```text
//! text ─ syntax ─► ast::File ─ check ─► typed::Mission ─ lower ─► ir::Problem ─ tube ─► Tubes
//!      ─ abstraction ─► half-spaces ─ encode ─► instance ─ solve ─► Outcome
//!      ─ plan ─► Plan ─ verify ─► Report ─► back
//! ```
//!
//! Data flows one way. Read in this order:
//!
//! 1. [`ir`], the middle of everything: what a mission means once names, units, families and sugar
//!    are gone. All later phases speak of an [`ir::Problem`].
//! 2. [`syntax`] reads text into a tree that says what the text says, nothing resolved.
//! 3. [`check`] finds out what names, units and shapes mean, with as many diagnostics as it can, and
//!    [`lower`] turns the result into the IR.
//! 4. [`tube`] takes the disturbance out: a feedback law and the set that errors stay in.
//! 5. [`abstraction`], [`encode`] and [`solve`] look for the shortest lasso that, with the tube around
//!    it, is a plan: half-spaces, clauses, and the loop between the Boolean and the convex solver.
//! 6. [`plan`] is what comes out, with a witness for everything that it claims.
//! 7. [`verify`] believes none of the above: it checks a plan against a problem in exact arithmetic.
//! 8. [`law`] is what goes on the robot: one source file, its tables, and a proved bound on its rounding.
//! 9. [`back`] draws it.
//!
//! [`driver`] is this chain as code. [`cli`] is the command line around it, and [`lsp`] what editors talk to.
//! Below lie [`exact`] (rational numbers), [`entity`] (typed ids and tables), [`source`] (text and
//! places in it), [`quantity`] (dimensions and units), [`geometry`] (polytopes, zonotopes) and
//! [`json`] (strict reading, readable writing) and [`diag`] (one diagnostic for all phases).
//! [`explain`] holds a page for each diagnostic code.
//!
//! # Invariants
//!
//! - After `check` no name is looked up by string; after `lower` every number is exact and SI.
//! - Places in the source are no part of the IR's value: two texts that mean the same have equal IRs.
//! - If the IR's validation is `Ok`, no later phase panics.
//! - `verify` never sees what `tube`, `abstraction`, `encode` or `solve` computed, only the problem
//!   and the plan. No plan leaves `driver` that it has not accepted.
//! - Numeric failure is never taken for infeasibility: *unknown* is an outcome of its own.
//! - The same input gives the same bytes on every machine and with any number of threads (for runs
//!   that end by themselves, printed times excepted).
//! - No library code prints, reads a file, looks at the clock or at the environment: only [`cli`]
//!   and `main` do.
//! - pest is named only in [`syntax`]; rustsat only in `encode`, `solve` and `back::cnf`; clarabel
//!   and microlp behind one module each; dashu only in [`exact`]; miette only in [`diag`].
//!
//! `tests/tidy.rs` holds the table of who may name whom and fails when it is no longer true.

pub mod abstraction;
pub mod back;
pub mod check;
pub mod cli;
pub mod diag;
pub mod driver;
pub mod encode;
pub mod entity;
pub mod exact;
pub mod explain;
pub mod geometry;
pub mod ir;
pub mod json;
pub mod law;
pub mod lower;
pub mod lsp;
pub mod plan;
pub mod quantity;
pub mod simulate;
pub mod solve;
pub mod source;
pub mod syntax;
pub mod tube;
pub mod verify;
