//! URIs and paths.

use std::path::{Path, PathBuf};

use lsp_types::Uri;

/// The path of a `file:` URI.
pub fn path(uri: &Uri) -> Option<PathBuf> {
    let rest = uri.as_str().strip_prefix("file://")?;
    let (_host, path) = rest.split_at(rest.find('/')?);
    let decoded = decode(path)?;
    // `/C:/missions` on Windows.
    let is_drive = decoded.as_bytes().get(2) == Some(&b':') && cfg!(windows);
    Some(PathBuf::from(if is_drive { &decoded[1..] } else { &decoded }))
}

/// What messages call a document by: its path, or else its URI.
pub fn name(uri: &Uri) -> String {
    path(uri).map_or_else(|| uri.as_str().to_string(), |path| path.to_string_lossy().into_owned())
}

/// The `file:` URI of an absolute path.
pub fn uri(path: &Path) -> Option<Uri> {
    let path = path.to_str()?.replace('\\', "/");
    let slash = if path.starts_with('/') { "" } else { "/" };
    let plain = |b: u8| b.is_ascii_alphanumeric() || b"/-._~:".contains(&b);
    let encoded: String = path
        .bytes()
        .map(|b| if plain(b) { char::from(b).to_string() } else { format!("%{b:02X}") })
        .collect();
    format!("file://{slash}{encoded}").parse().ok()
}

/// A text with its `%XX` made bytes again; `None` where they are no text.
fn decode(text: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, tail @ ..] = rest {
        let escaped = (*first == b'%').then(|| tail.get(..2)).flatten();
        let hex = escaped.and_then(|h| u8::from_str_radix(std::str::from_utf8(h).ok()?, 16).ok());
        bytes.push(hex.unwrap_or(*first));
        rest = if hex.is_some() { &tail[2..] } else { tail };
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_and_uris_are_each_other() {
        for text in ["/tmp/m.dosm", "/a b/é→😀.dosm", "/100%/#1?.dosm", "/a%20b.dosm"] {
            let uri = uri(Path::new(text)).expect("it is a path");
            assert_eq!(path(&uri).as_deref(), Some(Path::new(text)), "{}", uri.as_str());
        }
    }

    #[test]
    fn what_has_no_path_is_called_by_its_uri() {
        let uri: Uri = "untitled:Untitled-1".parse().expect("it is a URI");
        assert_eq!(path(&uri), None);
        assert_eq!(name(&uri), "untitled:Untitled-1");
        let odd: Uri = "file:///a%2".parse().or_else(|_| "file:///a%25".parse()).expect("it is a URI");
        assert!(path(&odd).is_some());
    }
}
