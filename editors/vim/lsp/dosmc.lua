-- For `vim.lsp.enable("dosmc")` of Neovim 0.11.

return {
  cmd = { vim.g.dosm_program or "dosmc", "lsp" },
  filetypes = { "dosm" },
  root_markers = { ".git" },
}
