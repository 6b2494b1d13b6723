(_ "{" "}" @end) @indent
(_ "[" "]" @end) @indent

[(goal_declaration) (define_declaration) (team_declaration) (state_item) (input_item)] @indent
