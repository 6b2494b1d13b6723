" Vim indent file
" Language: dosm robot missions
"
" The style of `dosmc fmt`: items of a block two blanks to the right, rows of a table below the first one,
" what goes on on a further line two blanks to the right of its declaration or item.

if exists('b:did_indent')
  finish
endif
let b:did_indent = 1

setlocal indentexpr=GetDosmIndent()
setlocal indentkeys=0{,0},0],0),!^F,o,O,e
setlocal nolisp nosmartindent autoindent

let b:undo_indent = 'setlocal indentexpr< indentkeys< lisp< smartindent< autoindent<'

" The words that begin declarations are reserved: a line that begins with one begins a declaration.
" words(declarations)
let s:declarations = [
  \ 'dosm', 'mission', 'param', 'let', 'workspace', 'region', 'obstacle', 'opaque', 'jammer', 'base',
  \ 'dynamics', 'robot', 'team', 'separation', 'connectivity', 'horizon', 'minimize', 'goal',
  \ 'define',
  \ ]

" words(dynamics_items, connectivity_items)
let s:items = [
  \ 'step', 'state', 'input', 'position', 'continuous', 'integrator', 'bound', 'disturbance',
  \ 'rejection', 'mode', 'hops', 'range', 'redundancy', 'every',
  \ ]

for s:word in s:declarations + s:items
  execute 'setlocal indentkeys+=0=' . s:word
endfor

if exists('*GetDosmIndent')
  finish
endif

let s:declaration = '^\s*\%(' . join(s:declarations, '\|') . '\)\>'
let s:item = '^\s*\%(\%(' . join(s:items, '\|') . '\)\>\|[ABc]\s*=\)'

" What a line that is being begun goes on from: an operator, a comma, an open bracket, a word that wants more.
let s:unfinished = '\%([-+*/^<>=&|!,:(\[{]\|\.\.\|\<\%(and\|or\|not\|until\|release\|weak\|strong\|always\|eventually\|next'
  \ . '\|in\|at\|forall\|exists\|count\|state\|input\|position\|bound\|disturbance\|X\|F\|G\|U\|R\|W\|M\)\)\s*$'

" Whether a line begins inside a block comment.
function! s:in_comment(lnum) abort
  if !has('syntax_items') || a:lnum < 2
    return 0
  endif
  let l:stack = synstack(a:lnum, 1)
  return !empty(l:stack) && synIDattr(l:stack[0], 'name') ==# 'dosmComment'
    \ && getline(a:lnum) !~# '^\s*/[/*]' && !empty(synstack(a:lnum - 1, max([1, len(getline(a:lnum - 1))])))
endfunction

" The line from which brackets are counted: the nearest declaration above.
function! s:begin(lnum) abort
  let l:at = a:lnum
  while l:at > 1
    if getline(l:at) =~# s:declaration && !s:in_comment(l:at)
      return l:at
    endif
    let l:at -= 1
  endwhile
  return 1
endfunction

" Reads from a declaration's line up to a line. Gives the open brackets, each as ['{', 0], ['[', column] … where
" 'block' is a brace with items in it; whether something was begun that the next line may go on; and the last
" line of code, comments left out.
function! s:read(from, to) abort
  let [l:open, l:begun, l:last, l:depth] = [[], 0, '', 0]
  for l:lnum in range(a:from, a:to)
    let [l:line, l:at, l:code] = [getline(l:lnum), 0, '']
    if l:depth == 0 && l:line =~# '\S' && (s:begins(l:line, l:open))
      let l:begun = 0
    endif
    while l:at < len(l:line)
      let l:two = l:line[l:at : l:at + 1]
      if l:two ==# '/*' || (l:depth > 0 && l:two ==# '*/')
        let l:depth += l:two ==# '/*' ? 1 : -1
        let l:at += 2
        continue
      elseif l:depth > 0
        let l:at += 1
        continue
      elseif l:two ==# '//'
        break
      endif
      let l:sign = l:line[l:at]
      if l:sign =~# '[(\[]'
        call add(l:open, [l:sign, l:at + 1, l:code])
      elseif l:sign ==# '{'
        let l:flows = l:code =~# '\<\%(where\|when\|at\)\s*$'
        call add(l:open, [l:flows ? 'flow' : 'block', 0, ''])
        let l:begun = l:flows
      elseif l:sign =~# '[)\]}]' && !empty(l:open)
        let l:closed = remove(l:open, -1)
        let l:begun = l:closed[0] !=# 'block'
      elseif l:sign ==# ';' && !empty(l:open) && l:open[-1][0] ==# 'block'
        let l:begun = 0
      elseif l:sign =~# '\S'
        let l:begun = 1
      endif
      let l:code .= l:sign
      let l:at += 1
    endwhile
    if l:code =~# '\S'
      let l:last = l:code
    endif
  endfor
  return [l:open, l:begun, l:last]
endfunction

" Whether a line begins a declaration or an item.
function! s:begins(line, open) abort
  return empty(a:open) ? a:line =~# s:declaration : a:open[-1][0] ==# 'block' && a:line =~# s:item
endfunction

function! GetDosmIndent() abort
  let l:lnum = v:lnum
  if s:in_comment(l:lnum)
    return indent(l:lnum)
  endif
  let l:line = getline(l:lnum)
  let l:empty = l:line !~# '\S'
  " A comment stands where the code below it does.
  if l:line =~# '^\s*/[/*]'
    let l:next = l:lnum
    while l:next < line('$') && getline(l:next) =~# '^\s*\%(//\|$\)'
      let l:next += 1
    endwhile
    let l:line = getline(l:next) =~# '^\s*\%(//\|/\*\|}\|$\)' ? '' : getline(l:next)
    let l:empty = l:line ==# ''
  endif
  if l:line =~# s:declaration
    return 0
  endif
  let l:from = s:begin(l:lnum - 1)
  if l:lnum == 1 || l:from > l:lnum - 1
    return 0
  endif
  let [l:open, l:begun, l:last] = s:read(l:from, l:lnum - 1)
  let l:depth = len(filter(copy(l:open), 'v:val[0] ==# "block"'))
  let l:width = shiftwidth()
  if empty(l:open) ? 0 : l:open[-1][0] ==# 'block'
    if l:line =~# '^\s*}'
      return (l:depth - 1) * l:width
    endif
  elseif !empty(l:open) && l:open[-1][0] ==# '[' && l:open[-1][2] =~# '=\s*$'
    " A table: below the first row.
    return l:open[-1][1]
  endif
  let l:inside = !empty(l:open) && l:open[-1][0] !=# 'block'
  if s:begins(l:line, l:open) || !l:begun || (l:empty && !l:inside && l:last !~# s:unfinished)
    return l:depth * l:width
  endif
  return (l:depth + 1) * l:width
endfunction
