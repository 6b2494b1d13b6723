//! The grammar of dosm robot missions for [tree-sitter](https://tree-sitter.github.io).
//!
//! ```
//! let mut parser = tree_sitter::Parser::new();
//! parser.set_language(&tree_sitter_dosm::LANGUAGE.into()).unwrap();
//! let tree = parser.parse("dosm 1 mission relay", None).unwrap();
//! assert!(!tree.root_node().has_error());
//! ```

use tree_sitter_language::LanguageFn;

unsafe extern "C" {
    fn tree_sitter_dosm() -> *const ();
}

/// The language, for `Parser::set_language`.
// The function is the generated one, of this type.
pub const LANGUAGE: LanguageFn = unsafe { LanguageFn::from_raw(tree_sitter_dosm) };

/// The kinds of nodes, as JSON.
pub const NODE_TYPES: &str = include_str!("../../src/node-types.json");

/// The query for highlighting.
pub const HIGHLIGHTS_QUERY: &str = include_str!("../../queries/highlights.scm");

/// The query for names and where they are seen.
pub const LOCALS_QUERY: &str = include_str!("../../queries/locals.scm");

/// The query for declarations, as code browsers show them.
pub const TAGS_QUERY: &str = include_str!("../../queries/tags.scm");
