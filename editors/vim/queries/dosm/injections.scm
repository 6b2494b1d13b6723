; Generated from editors/tree-sitter/queries/injections.scm by tests/editors.
; Documentation is Markdown, tags in comments are those of others.

((doc_comment) @injection.content
  (#offset! @injection.content 0 3 0 0)
  (#set! injection.language "markdown_inline"))

((line_comment) @injection.content
  (#set! injection.language "comment"))
((block_comment) @injection.content
  (#set! injection.language "comment"))
