//! The table of requests that the server answers: each is asked over the wire by some test.

/// The methods that the server answers, from its table.
fn answered() -> Vec<String> {
    let table = include_str!("../../src/lsp/requests.rs");
    let names = table.split("request::").skip(1).filter_map(|rest| rest.split_once("::METHOD"));
    let mut names: Vec<String> =
        names.map(|(name, _)| name.to_string()).filter(|n| !n.contains('\n')).collect();
    names.sort();
    names.dedup();
    names
}

/// What the protocol calls a request, from `lsp_types`' name of it.
fn method(name: &str) -> String {
    let stem = name.trim_end_matches("Request");
    match stem {
        "GotoDefinition" => "textDocument/definition".into(),
        "GotoTypeDefinition" => "textDocument/typeDefinition".into(),
        "SemanticTokensFull" => "textDocument/semanticTokens/full".into(),
        "SemanticTokensFullDelta" => "textDocument/semanticTokens/full/delta".into(),
        "SemanticTokensRange" => "textDocument/semanticTokens/range".into(),
        "WorkspaceSymbol" => "workspace/symbol".into(),
        _ => {
            let (first, rest) = stem.split_at(1);
            format!("textDocument/{}{rest}", first.to_lowercase())
        }
    }
}

#[test]
fn every_request_of_the_table_is_asked_by_a_test() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/lsp");
    let files = std::fs::read_dir(folder).expect("the tests").map(|entry| entry.expect("an entry").path());
    // This file names methods without asking them.
    let others = files.filter(|path| !path.ends_with("table.rs"));
    let tests: Vec<String> = others.filter_map(|path| std::fs::read_to_string(path).ok()).collect();
    let names = answered();
    assert!(names.len() > 10, "{names:?}");
    let asked = |method: &str| tests.iter().any(|text| text.contains(&format!("\"{method}\"")));
    let missing: Vec<String> = names.iter().map(|name| method(name)).filter(|m| !asked(m)).collect();
    assert!(missing.is_empty(), "nobody asks {missing:?}");
}
