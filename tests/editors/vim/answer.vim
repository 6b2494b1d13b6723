" What tests ask Vim and Neovim: the question is JSON in $DOSMC_ASK, the answer goes to $DOSMC_ANSWER.

set nocompatible nomore noswapfile viminfo= encoding=utf-8
execute 'set runtimepath^=' . fnameescape($DOSMC_PLUGIN)
filetype plugin indent on
syntax on

" The groups at places of a file, each place as [line, column].
function! Groups(ask) abort
  let l:groups = []
  for [l:line, l:column] in a:ask.places
    call add(l:groups, synIDattr(synID(l:line, l:column, 1), 'name'))
  endfor
  return l:groups
endfunction

" Every stretch of a file that no group colours, blanks aside.
function! Plain(ask) abort
  let l:plain = []
  for l:line in range(1, line('$'))
    let l:text = getline(l:line)
    for l:at in range(len(l:text))
      if l:text[l:at] =~# '[!-~]' && synID(l:line, l:at + 1, 1) == 0
        call add(l:plain, l:line . ':' . (l:at + 1))
      endif
    endfor
  endfor
  return l:plain
endfunction

" The file after `gg=G`.
function! Indented(ask) abort
  silent normal! gg=G
  return getline(1, '$')
endfunction

" What is there after keys are typed at the end of the file.
function! Typed(ask) abort
  call cursor(line('$'), 1)
  execute "silent normal! " . (empty(getline('$')) ? 'A' : 'o') . a:ask.keys
  return getline(1, '$')
endfunction

" Options of a mission.
function! Options(ask) abort
  return {'filetype': &filetype, 'commentstring': &commentstring, 'comments': &comments, 'iskeyword': &iskeyword,
    \ 'shiftwidth': &shiftwidth, 'formatprg': &formatprg, 'makeprg': &makeprg, 'undo': exists('b:undo_ftplugin')}
endfunction

" The lines of each fold that is not inside another one.
function! Folds(ask) abort
  setlocal foldmethod=syntax foldlevel=0
  let [l:folds, l:line] = [[], 1]
  while l:line <= line('$')
    if foldclosed(l:line) > 0
      call add(l:folds, [l:line, foldclosedend(l:line)])
      let l:line = foldclosedend(l:line)
    endif
    let l:line += 1
  endwhile
  return l:folds
endfunction

" The list of errors that 'errorformat' makes of what was said.
function! Errors(ask) abort
  let &g:errorformat = &l:errorformat
  cgetexpr readfile(a:ask.said)
  let l:errors = []
  for l:error in getqflist()
    if l:error.valid
      call add(l:errors, [bufname(l:error.bufnr), l:error.lnum, l:error.col, l:error.type, l:error.text])
    endif
  endfor
  return l:errors
endfunction

" The file after `:DosmFormat`, and where the cursor is that was at its end.
function! Formatted(ask) abort
  let g:dosm_program = a:ask.program
  normal! G
  DosmFormat
  return {'lines': getline(1, '$'), 'line': line('.')}
endfunction

" The file after `gq` on all of it.
function! Reformatted(ask) abort
  let g:dosm_program = a:ask.program
  normal! gggqG
  return getline(1, '$')
endfunction

" What `:DosmExplain` shows in a line, and what `:make` finds.
function! Explained(ask) abort
  let g:dosm_program = a:ask.program
  call cursor(a:ask.line, 1)
  DosmExplain
  wincmd P
  return getline(1, '$')
endfunction

" What the terminal of `:DosmSolve` shows.
function! Solved(ask) abort
  return systemlist(dosm#solve_command(a:ask.arguments))
endfunction

function! Made(ask) abort
  silent make!
  let l:errors = filter(getqflist(), 'v:val.valid')
  return map(l:errors, '[v:val.lnum, v:val.col, v:val.type]')
endfunction

function! Answer() abort
  let l:answers = []
  for l:ask in json_decode(join(readfile($DOSMC_ASK), "\n"))
    if has_key(l:ask, 'program')
      let g:dosm_program = l:ask.program
    endif
    silent execute 'edit!' fnameescape(l:ask.file)
    call add(l:answers, call(l:ask.what, [l:ask]))
    set nomodified
  endfor
  return l:answers
endfunction

try
  let s:answer = {'answers': Answer()}
catch
  let s:answer = {'error': v:exception . ' at ' . v:throwpoint}
endtry
call writefile([json_encode(s:answer)], $DOSMC_ANSWER)
qall!
