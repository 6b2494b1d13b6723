; Bound variables and indices keep their colour where they are used.

(quantified_formula) @local.scope
(count) @local.scope
(obstacle_declaration) @local.scope
(region_declaration) @local.scope
(jammer_declaration) @local.scope
(base_declaration) @local.scope
(robot_declaration) @local.scope

(quantified_formula variable: (identifier) @local.definition.variable.parameter)
(count variable: (identifier) @local.definition.variable.parameter)
(index_range name: (identifier) @local.definition.variable.parameter)

(reference name: (identifier) @local.reference)
