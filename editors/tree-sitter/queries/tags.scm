; The declarations of a mission, for lists of symbols.

(mission_declaration name: (identifier) @name) @definition.module
(param_declaration name: (identifier) @name) @definition.constant
(let_declaration name: (identifier) @name) @definition.constant
(region_declaration name: (identifier) @name) @definition.variable
(obstacle_declaration name: (identifier) @name) @definition.variable
(jammer_declaration name: (identifier) @name) @definition.variable
(base_declaration name: (identifier) @name) @definition.variable
(robot_declaration name: (identifier) @name) @definition.variable
(team_declaration name: (identifier) @name) @definition.variable
(dynamics_declaration name: (identifier) @name) @definition.class
(goal_declaration name: (identifier) @name) @definition.function
(define_declaration name: (identifier) @name) @definition.function

(reference name: (identifier) @name) @reference.variable
(defined name: (identifier) @name) @reference.call
(robot_declaration dynamics: (identifier) @name) @reference.class
