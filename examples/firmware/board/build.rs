//! Puts the linker script where the linker looks for it.

use std::path::PathBuf;
use std::{env, fs};

fn main() {
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets it"));
    fs::write(out.join("board.x"), include_str!("board.x")).expect("cargo made it");
    println!("cargo:rustc-link-search={}", out.display());
    println!("cargo:rerun-if-changed=board.x");
}
