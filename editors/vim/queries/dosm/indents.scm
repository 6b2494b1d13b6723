; Generated from editors/tree-sitter/queries/indents.scm by tests/editors.
; The style of `dosmc fmt`: what is inside braces is moved to the right, rows stand below the first one, and
; what goes on on a further line is moved to the right.

[
  (dynamics_block)
  (mode_block)
  (connectivity_block)
  (inequalities)
  (full_state)
] @indent.begin

"}" @indent.branch
(dynamics_block "}" @indent.end)
(mode_block "}" @indent.end)
(connectivity_block "}" @indent.end)
(inequalities "}" @indent.end)
(full_state "}" @indent.end)

[
  (goal_declaration)
  (define_declaration)
  (region_declaration)
  (obstacle_declaration)
  (jammer_declaration)
  (team_declaration)
  (state_item)
  (input_item)
] @indent.begin

((table) @indent.align
  (#set! indent.open_delimiter "[")
  (#set! indent.close_delimiter "]"))

(block_comment) @indent.ignore
(ERROR) @indent.auto
