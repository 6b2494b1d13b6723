; Generated from editors/tree-sitter/queries/folds.scm by tests/editors.
; What can be folded away.

[
  (dynamics_block)
  (mode_block)
  (connectivity_block)
  (inequalities)
  (full_state)
  (table)
  (union)
  (block_comment)
  (goal_declaration)
  (define_declaration)
] @fold
