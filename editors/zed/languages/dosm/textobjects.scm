(goal_declaration formula: (_) @function.inside) @function.around
(define_declaration formula: (_) @function.inside) @function.around
(dynamics_declaration body: (_) @class.inside) @class.around
[(line_comment) (block_comment) (doc_comment)]+ @comment.around
