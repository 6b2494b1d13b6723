-- Neovim reads this once: missions get the language server and, where its parser is there, tree-sitter.

if vim.g.loaded_dosm then
  return
end
vim.g.loaded_dosm = true

if vim.fn.has("nvim-0.8") == 1 then
  vim.api.nvim_create_autocmd("FileType", {
    group = vim.api.nvim_create_augroup("dosm", {}),
    pattern = "dosm",
    callback = function(event)
      require("dosm").attach(event.buf)
    end,
  })
else
  vim.cmd([[
    augroup dosm
      autocmd!
      autocmd FileType dosm lua require("dosm").attach(tonumber(vim.fn.expand("<abuf>")))
    augroup END
  ]])
end

vim.cmd([[command! DosmInstallParser lua require("dosm.treesitter").install()]])
