//! Back ends: one file a format, problem and plan in, [`Artifact`]s out.

pub mod cnf;
pub mod controller;
pub mod html;
pub mod ir;
mod names;
pub mod smc;
pub mod smt2;
pub mod svg;

use names::{Names, dyadic};

/// What a mission can be compiled to, without a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Emit {
    /// `NAME.ir.json`
    Ir,
    /// `NAME.smc.json`
    Smc,
    /// `NAME.cnf`
    Cnf,
    /// `NAME.smt2`
    Smt2,
}

impl Emit {
    /// All there are, in the order in which they are written.
    pub const ALL: &[Emit] = &[Emit::Ir, Emit::Smc, Emit::Cnf, Emit::Smt2];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Emit::Ir => "ir",
            Emit::Smc => "smc",
            Emit::Cnf => "cnf",
            Emit::Smt2 => "smt2",
        }
    }
}

/// A file to be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Artifact {
    /// Its name, relative to the output directory.
    pub name: String,
    /// Its text.
    pub contents: String,
}

/// A simulated run, for pictures.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Flight {
    /// By robot, in the problem's order, and sample: its position in metres, one entry a coordinate.
    pub ways: Vec<Vec<Vec<f64>>>,
}

/// A mission's file name with an extension: its name, with `_` for what is no good in file names.
pub fn file_name(mission: &str, extension: &str) -> String {
    let safe = |c: char| if c.is_ascii_alphanumeric() || matches!(c, '_' | '-') { c } else { '_' };
    let stem: String = mission.chars().take(LONGEST_STEM).map(safe).collect();
    // A leading `-` would be read as an option by many commands.
    let stem = if stem.starts_with('-') { format!("_{stem}") } else { stem };
    format!("{}.{extension}", if stem.is_empty() { "mission" } else { &stem })
}

/// The longest part of a mission's name in a file's name; identifiers are shorter.
const LONGEST_STEM: usize = 100;

#[cfg(test)]
mod tests {
    use super::{Emit, file_name};

    #[test]
    fn all_formats_are_listed_in_order() {
        let source = include_str!("mod.rs");
        let body = source.split("pub enum Emit {").nth(1).and_then(|rest| rest.split('}').next()).unwrap();
        let declared: Vec<&str> = body
            .lines()
            .filter_map(|line| line.trim().strip_suffix(','))
            .filter(|l| !l.contains('/'))
            .collect();
        let listed: Vec<String> = Emit::ALL.iter().map(|emit| format!("{emit:?}")).collect();
        assert_eq!(declared, listed, "`Emit::ALL` lacks a format or has it elsewhere");
    }

    #[test]
    fn file_names_are_harmless() {
        assert_eq!(file_name("relay_2", "ir.json"), "relay_2.ir.json");
        for (name, expected) in [
            ("", "mission.x"),
            ("../a b", "___a_b.x"),
            ("-rf", "_-rf.x"),
            ("a.b", "a_b.x"),
            ("Ω\u{1b}", "__.x"),
        ] {
            assert_eq!(file_name(name, "x"), expected);
        }
        assert!(file_name(&"x".repeat(5000), "x").len() < 255);
    }
}
