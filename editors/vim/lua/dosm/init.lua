--- Missions in Neovim, 0.7 and later: the language server, its commands, tree-sitter.
---
--- Everything is switched on by itself; `vim.g.dosm` (a table) or `setup` changes it:
---
---   program     the program, "dosmc"
---   lsp         whether the language server is started, true
---   treesitter  whether tree-sitter colours missions where its parser is there, true
---   hints       whether values are shown in the text (Neovim 0.10), true
---   keys        whether keys are set in missions, true
---   arguments   what is given to `dosmc lsp`, as { "--set", "robots=4" }
---   on_attach   called as on_attach(client, buffer) when the server has a mission
---   capabilities  what the client can do, as of completion plug-ins

local M = {}

local defaults = {
  program = nil,
  lsp = true,
  treesitter = true,
  hints = true,
  keys = true,
  arguments = {},
  on_attach = nil,
  capabilities = nil,
}

local chosen = {}

--- Changes options; missions that are open already keep theirs.
function M.setup(options)
  chosen = options or {}
end

--- The options as they are now.
function M.options()
  local options = vim.tbl_deep_extend("force", defaults, vim.g.dosm or {}, chosen)
  options.program = options.program or vim.g.dosm_program or "dosmc"
  return options
end

--- Sets a mission's buffer up.
function M.attach(buffer)
  if buffer == 0 or buffer == nil then
    buffer = vim.api.nvim_get_current_buf()
  end
  local options = M.options()
  if options.treesitter then
    require("dosm.treesitter").start(buffer)
  end
  if options.lsp then
    require("dosm.lsp").start(buffer, options)
  end
end

--- Plans the mission in the current buffer by its server; gives whether there is one.
function M.solve()
  return require("dosm.lsp").solve(vim.api.nvim_get_current_buf())
end

return M
