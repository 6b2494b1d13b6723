//! The language server over its standard input and output, spoken to by a scripted client.

#![allow(clippy::disallowed_methods, reason = "reads what the server wrote")]

mod client;
mod hostile;
mod life;
mod names;
mod outline;
mod plan;
mod reading;
mod table;
mod texts;
