" Vim compiler file
" Compiler: dosmc check

if exists('current_compiler')
  finish
endif
let current_compiler = 'dosmc'

let s:cpo_save = &cpo
set cpo&vim

let &l:makeprg = dosm#program() . ' check --color never %:S'

" The message, perhaps in several lines; the first place that it is about; as a line of its own, what helps.
let &l:errorformat = join([
  \ '%E  × %m',
  \ '%W  ⚠ %m',
  \ '%C  │ %m',
  \ '%Z%*[ ]╭─[%f:%l:%c]',
  \ '%+G  help: %.%#',
  \ '%-G%.%#',
  \ ], ',')

let &cpo = s:cpo_save
unlet s:cpo_save
