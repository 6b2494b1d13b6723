//! The settings for Helix and Zed are well-formed, and name what is there.

mod common;

use std::fs;

use toml::Table;

fn table(path: &str) -> Table {
    let text = fs::read_to_string(common::root().join(path)).unwrap_or_else(|e| panic!("{path}: {e}"));
    text.parse().unwrap_or_else(|e| panic!("{path}: {e}"))
}

#[test]
fn helix_is_told_of_the_language_its_server_and_its_grammar() {
    let settings = table("editors/helix/languages.toml");
    let language = &settings["language"][0];
    assert_eq!(language["name"].as_str(), Some("dosm"));
    assert_eq!(language["file-types"][0].as_str(), Some("dosm"));
    assert_eq!(language["formatter"]["args"][0].as_str(), Some("fmt"));
    let server = language["language-servers"][0].as_str().expect("a server");
    assert_eq!(settings["language-server"][server]["command"].as_str(), Some("dosmc"));
    assert_eq!(settings["language-server"][server]["args"][0].as_str(), Some("lsp"));
    let grammar = &settings["grammar"][0];
    assert_eq!(grammar["name"].as_str(), Some("dosm"));
    let path = grammar["source"]["path"].as_str().expect("a path");
    let below = path.split_once("dosmc/").expect("below the repository").1;
    assert!(common::root().join(below).join("src/parser.c").is_file(), "{path}");
}

#[test]
fn zed_is_told_of_the_same() {
    let extension = table("editors/zed/extension.toml");
    for key in ["id", "name", "version", "repository", "description"] {
        assert!(extension[key].as_str().is_some_and(|value| !value.is_empty()), "{key}");
    }
    assert_eq!(extension["schema_version"].as_integer(), Some(1));
    let grammar = extension["grammars"]["dosm"].as_table().expect("the grammar");
    let path = grammar["path"].as_str().expect("a path");
    assert!(common::root().join(path).join("src/parser.c").is_file(), "{path}");
    assert_eq!(extension["language_servers"]["dosmc"]["languages"][0].as_str(), Some("dosm"));

    let language = table("editors/zed/languages/dosm/config.toml");
    assert_eq!(language["name"].as_str(), Some("dosm"));
    assert_eq!(language["grammar"].as_str(), Some("dosm"));
    assert_eq!(language["path_suffixes"][0].as_str(), Some("dosm"));

    let glue = table("editors/zed/Cargo.toml");
    assert_eq!(glue["lib"]["crate-type"][0].as_str(), Some("cdylib"));
    let source = glue["lib"]["path"].as_str().expect("a path");
    let text = fs::read_to_string(common::root().join("editors/zed").join(source)).expect("the glue");
    assert!(text.contains("const SERVER: &str = \"dosmc\""), "the server has its name in extension.toml");
}
