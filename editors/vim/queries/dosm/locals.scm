; Generated from editors/tree-sitter/queries/locals.scm by tests/editors.
; Where names are declared and seen. The order of declarations means nothing, so all of a mission is one scope;
; indices and bound variables have scopes of their own.

(source_file) @local.scope
(quantified_formula) @local.scope
(count) @local.scope
(region_declaration indices: (_)) @local.scope
(obstacle_declaration indices: (_)) @local.scope
(jammer_declaration indices: (_)) @local.scope
(base_declaration indices: (_)) @local.scope
(robot_declaration indices: (_)) @local.scope
(dynamics_declaration) @local.scope

(param_declaration name: (identifier) @local.definition.constant)
(let_declaration name: (identifier) @local.definition.constant)
(region_declaration name: (identifier) @local.definition.var)
(obstacle_declaration name: (identifier) @local.definition.var)
(jammer_declaration name: (identifier) @local.definition.var)
(base_declaration name: (identifier) @local.definition.var)
(robot_declaration name: (identifier) @local.definition.var)
(team_declaration name: (identifier) @local.definition.var)
(dynamics_declaration name: (identifier) @local.definition.type)
(goal_declaration name: (identifier) @local.definition.function)
(define_declaration name: (identifier) @local.definition.function)

(index_range name: (identifier) @local.definition.parameter)
(quantified_formula variable: (identifier) @local.definition.parameter)
(count variable: (identifier) @local.definition.parameter)
(signal name: (identifier) @local.definition.field)

(reference name: (identifier) @local.reference)
(defined name: (identifier) @local.reference)
(robot_declaration dynamics: (identifier) @local.reference)
(names (identifier) @local.reference)
(entry name: (identifier) @local.reference)
