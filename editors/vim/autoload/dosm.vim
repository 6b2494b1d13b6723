" What the commands of missions do.

let s:cpo_save = &cpo
set cpo&vim

" The program: g:dosm_program, or `dosmc`.
function! dosm#program() abort
  return get(g:, 'dosm_program', 'dosmc')
endfunction

" Says something is wrong.
function! s:warn(text) abort
  echohl WarningMsg
  echomsg a:text
  echohl None
endfunction

" The buffer as `dosmc fmt` lays it out; an empty list where that can't be.
function! s:formatted() abort
  if !executable(dosm#program())
    call s:warn('dosmc is not found: set g:dosm_program')
    return []
  endif
  " What is wrong elsewhere is said by others; a broken declaration is left as it is.
  let l:errors = tempname()
  let l:command = shellescape(dosm#program()) . ' fmt - 2>' . shellescape(l:errors)
  let l:lines = systemlist(l:command, getline(1, '$'))
  let l:status = v:shell_error
  if l:status != 0
    call s:warn('dosmc fmt: ' . get(filter(readfile(l:errors), 'v:val =~# "\\S"'), 0, 'nothing was laid out'))
    let l:lines = []
  endif
  call delete(l:errors)
  return l:lines
endfunction

" Lays the buffer out; the cursor stays in its line as far as it can, marks and folds stay.
function! dosm#format() abort
  let l:lines = s:formatted()
  let l:old = getline(1, '$')
  if empty(l:lines) || l:lines ==# l:old
    return
  endif
  let l:view = winsaveview()
  " What is the same at the beginning and the end is not touched.
  let l:head = 0
  while l:head < min([len(l:old), len(l:lines)]) && l:old[l:head] ==# l:lines[l:head]
    let l:head += 1
  endwhile
  let l:tail = 0
  while l:tail < min([len(l:old), len(l:lines)]) - l:head && l:old[-1 - l:tail] ==# l:lines[-1 - l:tail]
    let l:tail += 1
  endwhile
  let l:fresh = l:head < len(l:lines) - l:tail ? l:lines[l:head : len(l:lines) - l:tail - 1] : []
  let l:gone = len(l:old) - l:tail - l:head
  let l:kept = min([l:gone, len(l:fresh)])
  if l:kept > 0
    call setline(l:head + 1, l:fresh[: l:kept - 1])
  endif
  if l:gone > l:kept
    silent execute 'keepjumps' (l:head + l:kept + 1) . ',' . (l:head + l:gone) . 'delete _'
  else
    call append(l:head + l:kept, l:fresh[l:kept :])
  endif
  call winrestview(l:view)
endfunction

" For 'formatexpr': comments and typed text as always, all else by `dosmc fmt`.
function! dosm#formatexpr() abort
  if mode() =~# '[iR]'
    return 1
  endif
  let l:lines = getline(v:lnum, v:lnum + v:count - 1)
  if empty(filter(l:lines, 'v:val !~# "^\\s*\\%(//\\|$\\)"'))
    return 1
  endif
  call dosm#format()
  return 0
endfunction

" The command that plans the buffer's mission. What it writes goes where the language server's plans go, unless
" the arguments say where.
function! dosm#solve_command(arguments) abort
  let l:into = a:arguments =~# '\%(^\|\s\)\%(-o\|--output\)'
    \ ? '' : ' --output ' . shellescape(expand('%:p:h') . '/out/' . expand('%:t:r'))
  return shellescape(dosm#program()) . ' solve' . l:into . ' ' . a:arguments . ' ' . shellescape(expand('%:p'))
endfunction

" Plans the mission, with what is given as further arguments: by the language server where one is attached and
" nothing is given, else in a terminal.
function! dosm#solve(arguments) abort
  if has('nvim') && empty(a:arguments) && luaeval('require("dosm").solve()')
    return
  endif
  update
  let l:command = dosm#solve_command(a:arguments)
  if has('nvim')
    execute 'botright 12split | terminal' l:command
    " Its end is what is looked at.
    normal! G
    wincmd p
  elseif has('terminal')
    botright call term_start([&shell, &shellcmdflag, l:command], {'term_rows': 12, 'term_name': 'dosmc solve'})
    wincmd p
  else
    execute '!' . l:command
  endif
endfunction

" The code below the cursor, or of the first diagnostic in its line.
function! s:code_here() abort
  let l:word = matchstr(expand('<cWORD>'), 'dosm::\w\+::\w\+')
  if !empty(l:word)
    return l:word
  endif
  let l:said = system(shellescape(dosm#program()) . ' check --quiet --json - 2>' . s:nowhere(), getline(1, '$'))
  try
    let l:diagnostics = json_decode(l:said).diagnostics
  catch
    return ''
  endtry
  for l:diagnostic in l:diagnostics
    for l:label in l:diagnostic.labels
      if l:label.line <= line('.') && line('.') <= l:label.end_line
        return l:diagnostic.code
      endif
    endfor
  endfor
  return ''
endfunction

function! s:nowhere() abort
  return has('win32') ? 'NUL' : '/dev/null'
endfunction

" Shows the page of a code, or of the diagnostic in the cursor's line.
function! dosm#explain(code) abort
  let l:code = empty(a:code) ? s:code_here() : a:code
  if empty(l:code)
    call s:warn('there is no diagnostic in this line: give a code, as in :DosmExplain dosm::check::unknown_region')
    return
  endif
  let l:page = systemlist(shellescape(dosm#program()) . ' explain --color never ' . shellescape(l:code))
  if v:shell_error
    call s:warn(get(filter(l:page, 'v:val =~# "\\S"'), 0, 'there is no such page'))
    return
  endif
  pclose
  execute 'botright pedit +setlocal\ buftype=nofile\ bufhidden=wipe\ noswapfile' fnameescape(l:code)
  wincmd P
  setlocal modifiable
  call setline(1, l:page)
  setlocal nomodifiable nomodified filetype=markdown
  wincmd p
endfunction

" For completion: codes that begin so.
function! dosm#codes(begin, line, position) abort
  let l:list = systemlist(shellescape(dosm#program()) . ' explain')
  let l:codes = filter(map(l:list, 'matchstr(v:val, "dosm::\\w\\+::\\w\\+")'), '!empty(v:val)')
  return filter(l:codes, 'stridx(v:val, a:begin) >= 0')
endfunction

let &cpo = s:cpo_save
unlet s:cpo_save
