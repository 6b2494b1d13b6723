[
  (dynamics_block)
  (mode_block)
  (connectivity_block)
  (inequalities)
  (full_state)
  (goal_declaration)
  (define_declaration)
  (team_declaration)
  (state_item)
  (input_item)
] @indent

"}" @outdent

; Rows stand below the first one.
(table . "[" . (row) @anchor) @align
