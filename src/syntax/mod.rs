//! From text to syntax tree. The only module that names `pest`.

pub mod ast;
