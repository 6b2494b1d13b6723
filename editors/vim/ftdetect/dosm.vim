autocmd BufRead,BufNewFile *.dosm setfiletype dosm
