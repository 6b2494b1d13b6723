" Vim filetype plugin
" Language: dosm robot missions

if exists('b:did_ftplugin')
  finish
endif
let b:did_ftplugin = 1

let s:cpo_save = &cpo
set cpo&vim

setlocal comments=s1:/*,mb:*,ex:*/,:////,:///,://!,://
setlocal commentstring=//\ %s
setlocal formatoptions-=t formatoptions+=croql
silent! setlocal formatoptions+=j
setlocal iskeyword=@,48-57,_
setlocal suffixesadd=.dosm
setlocal matchpairs=(:),{:},[:]
" Two blanks, as `dosmc fmt` writes them.
setlocal expandtab shiftwidth=2 softtabstop=2
" `gq` lays the mission out as `dosmc fmt` does, but breaks the lines of comments as always.
setlocal formatexpr=dosm#formatexpr()
let &l:formatprg = dosm#program() . ' fmt -'

let b:match_words = '/\*:\*/,\<weak\>:\<until\>,\<strong\>:\<release\>'
let b:match_ignorecase = 0

compiler dosmc

command! -buffer -bar DosmFormat call dosm#format()
command! -buffer -nargs=* -complete=file DosmSolve call dosm#solve(<q-args>)
command! -buffer -bar -nargs=? -complete=customlist,dosm#codes DosmExplain call dosm#explain(<q-args>)

if get(g:, 'dosm_fmt_on_save', 0)
  augroup dosm_fmt_on_save
    autocmd! * <buffer>
    autocmd BufWritePre <buffer> call dosm#format()
  augroup END
endif

if get(g:, 'dosm_folding', 0)
  setlocal foldmethod=syntax
endif

let b:undo_ftplugin = 'setlocal comments< commentstring< formatoptions< iskeyword< suffixesadd< matchpairs<'
  \ . ' expandtab< shiftwidth< softtabstop< formatexpr< formatprg< makeprg< errorformat< foldmethod<'
  \ . '| unlet! b:match_words b:match_ignorecase'
  \ . '| delcommand DosmFormat | delcommand DosmSolve | delcommand DosmExplain'
  \ . '| silent! autocmd! dosm_fmt_on_save * <buffer>'

let &cpo = s:cpo_save
unlet s:cpo_save
