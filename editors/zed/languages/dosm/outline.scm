(doc_comment) @annotation

(mission_declaration "mission" @context name: (identifier) @name) @item
(workspace_declaration "workspace" @name) @item
(param_declaration "param" @context name: (identifier) @name) @item
(let_declaration "let" @context name: (identifier) @name) @item
(region_declaration "region" @context name: (identifier) @name) @item
(obstacle_declaration "obstacle" @context name: (identifier) @name) @item
(jammer_declaration "jammer" @context name: (identifier) @name) @item
(base_declaration "base" @context name: (identifier) @name) @item
(dynamics_declaration "dynamics" @context name: (identifier) @name) @item
(mode_item "mode" @context name: (identifier) @name) @item
(robot_declaration "robot" @context name: (identifier) @name) @item
(team_declaration "team" @context name: (identifier) @name) @item
(connectivity_declaration "connectivity" @name) @item
(goal_declaration "goal" @context name: (identifier) @name) @item
(define_declaration "define" @context name: (identifier) @name) @item
