; `maf` and `mif`: a goal or define, and its formula; `mat`: a motion model; `maa`: a member of a list; `mac`: a comment.

(goal_declaration formula: (_) @function.inside) @function.around
(define_declaration formula: (_) @function.inside) @function.around

(dynamics_declaration body: (_) @class.inside) @class.around

(row (_) @parameter.inside)
(arguments (_) @parameter.inside)
(set (_) @parameter.inside)
(signal) @parameter.inside
(entry) @parameter.inside

[(line_comment) (block_comment) (doc_comment)] @comment.inside
[(line_comment) (block_comment) (doc_comment)]+ @comment.around

(table (row) @entry.inside)
