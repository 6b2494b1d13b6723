; Generated from editors/tree-sitter/queries/highlights.scm by tests/editors.
; What a mission's words are. No two patterns match the same node, so their order means nothing.

; ---- Comments -------------------------------------------------------------------------------------

[(line_comment) (block_comment)] @comment
(doc_comment) @comment.documentation

; ---- Words ----------------------------------------------------------------------------------------

; words(declarations -opaque)
["dosm" "mission" "param" "let" "workspace" "region" "obstacle" "jammer" "base" "dynamics" "robot"
  "team" "separation" "connectivity" "horizon" "minimize" "goal" "define"] @keyword

"opaque" @keyword.modifier

; words(dynamics_items -continuous, dynamics_parts, connectivity_items, shape_parts, connectivity_off)
["step" "state" "input" "position" "integrator" "bound" "disturbance" "rejection" "mode" "when"
  "hops" "range" "redundancy" "every" "radius" "norm" "none"] @keyword

(continuous_item) @keyword

; words(shapes -where)
["box" "ball" "disc" "polygon" "hull"] @constructor

; As a word of its own it may be a state's name, too.
(half_spaces "where" @constructor)
(bound_item "where" @constructor)

; words(prepositions)
["in" "at"] @keyword.operator

; words(logic)
["and" "or" "not"] @keyword.operator

; words(temporal, temporal_letters)
["always" "eventually" "next" "until" "release" "weak" "strong" "X" "F" "G" "U" "R" "W" "M"] @keyword.operator

; words(quantifiers -count)
["forall" "exists"] @keyword.operator

"count" @function.builtin

; words(sets)
["all"] @constant.builtin

(truth) @boolean

; ---- Names ----------------------------------------------------------------------------------------

(mission_declaration name: (identifier) @module)
(param_declaration name: (identifier) @constant)
(let_declaration name: (identifier) @constant)
(region_declaration name: (identifier) @variable)
(obstacle_declaration name: (identifier) @variable)
(jammer_declaration name: (identifier) @variable)
(base_declaration name: (identifier) @variable)
(robot_declaration name: (identifier) @variable)
(team_declaration name: (identifier) @variable)
(dynamics_declaration name: (identifier) @type.definition)
(robot_declaration dynamics: (identifier) @type)
(goal_declaration name: (identifier) @function)
(define_declaration name: (identifier) @function)
(defined name: (identifier) @function.call)
(minimize_declaration objective: (identifier) @constant.builtin)

(index_range name: (identifier) @variable.parameter)
(quantified_formula variable: (identifier) @variable.parameter)
(count variable: (identifier) @variable.parameter)

(signal name: (identifier) @variable.member)
(names (identifier) @variable.member)
(entry name: (identifier) @variable.member)
(mode_item name: (identifier) @label)
(matrix_item name: _ @property)

((reference name: (identifier) @constant.builtin)
  (#eq? @constant.builtin "pi"))

; A robot, an area, a constant, a coordinate.
((reference name: (identifier) @variable)
  (#not-eq? @variable "pi"))

; There are no others.
(call function: (identifier) @function.builtin)

; ---- Numbers and signs ----------------------------------------------------------------------------

(number) @number
(unit) @type.builtin

; words(logic_signs, comparisons, arithmetic, uncertainty, dots)
["<->" "->" "||" "&&" "!" "!=" "<=" ">=" "<" ">" "=" "+" "-" "*" "/" "^" "+/-" "±" ".."] @operator
"[]" @operator
"<>" @operator

["(" ")" "[" "]" "{" "}"] @punctuation.bracket
["," ";" ":"] @punctuation.delimiter
