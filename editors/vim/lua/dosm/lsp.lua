--- The language server, `dosmc lsp`.

local M = {}

--- The folder that a mission belongs to: where `.git` is, or its own.
local function root(buffer)
  local name = vim.api.nvim_buf_get_name(buffer)
  local folder = name ~= "" and vim.fn.fnamemodify(name, ":p:h") or vim.fn.getcwd()
  local git = vim.fn.finddir(".git", folder:gsub(" ", "\\ ") .. ";")
  return git ~= "" and vim.fn.fnamemodify(git, ":p:h:h") or folder
end

--- The server's client at a buffer.
function M.client(buffer)
  local get = vim.lsp.get_clients or vim.lsp.get_active_clients
  for _, client in pairs(get()) do
    if client.name == "dosmc" and vim.lsp.buf_is_attached(buffer, client.id) then
      return client
    end
  end
end

--- Sends a request, in each version's way.
local function request(client, method, params, handler, buffer)
  if vim.fn.has("nvim-0.11") == 1 then
    return client:request(method, params, handler, buffer)
  end
  return client.request(method, params, handler, buffer)
end

--- Formats a buffer, in each version's way.
local function format(buffer)
  if vim.lsp.buf.format then
    vim.lsp.buf.format({ bufnr = buffer, name = "dosmc" })
  else
    vim.lsp.buf.formatting_sync(nil, 2000)
  end
end

--- Keys in a mission's buffer, where nobody has them yet: those of Neovim 0.11, and `K`, `gd`, `gq`.
local function keys(buffer)
  local function map(mode, key, what, description)
    if vim.fn.mapcheck(key, mode) == "" then
      vim.keymap.set(mode, key, what, { buffer = buffer, desc = "dosm: " .. description })
    end
  end
  map("n", "K", vim.lsp.buf.hover, "what is this")
  map("n", "gd", vim.lsp.buf.definition, "to its declaration")
  map("n", "grn", vim.lsp.buf.rename, "rename")
  map("n", "grr", vim.lsp.buf.references, "where it is used")
  map("n", "gra", vim.lsp.buf.code_action, "mend")
  map("n", "gO", vim.lsp.buf.document_symbol, "outline")
  map("n", "grl", vim.lsp.codelens.run, "run the lens of this line")
  map("n", "[d", vim.diagnostic.goto_prev, "diagnostic before")
  map("n", "]d", vim.diagnostic.goto_next, "diagnostic behind")
  map("i", "<C-s>", vim.lsp.buf.signature_help, "what goes in here")
end

--- Once a mission has its server.
local function attached(client, buffer, options)
  vim.bo[buffer].omnifunc = "v:lua.vim.lsp.omnifunc"
  -- `formatexpr` is the plug-in's own, which needs no server.
  vim.api.nvim_buf_call(buffer, function()
    vim.cmd([[setlocal formatexpr=dosm#formatexpr()]])
    vim.cmd([[command! -buffer -bar DosmFormat lua require("dosm.lsp").format()]])
  end)
  if options.keys then
    keys(buffer)
  end
  if client.server_capabilities.codeLensProvider or client.resolved_capabilities and client.resolved_capabilities.code_lens then
    vim.api.nvim_buf_call(buffer, function()
      vim.cmd([[
        augroup dosm_lenses
          autocmd! * <buffer>
          autocmd BufEnter,InsertLeave,BufWritePost <buffer> silent! lua vim.lsp.codelens.refresh()
        augroup END
      ]])
    end)
    vim.lsp.codelens.refresh()
  end
  if options.hints and vim.lsp.inlay_hint and client.server_capabilities.inlayHintProvider then
    vim.lsp.inlay_hint.enable(true, { bufnr = buffer })
  end
  if options.on_attach then
    options.on_attach(client, buffer)
  end
end

--- Formats the current buffer.
function M.format()
  format(vim.api.nvim_get_current_buf())
end

--- What the server says when a plan was sought.
local function planned(outcome)
  if type(outcome) == "table" and outcome.message then
    vim.notify(outcome.message)
  end
  pcall(vim.lsp.codelens.refresh)
end

--- Plans a mission by its server; gives whether it has one.
function M.solve(buffer)
  local client = M.client(buffer)
  if not client then
    return false
  end
  local params = { command = "dosmc.solve", arguments = { vim.uri_from_bufnr(buffer) } }
  request(client, "workspace/executeCommand", params, function(problem, outcome)
    if problem then
      vim.notify(problem.message or vim.inspect(problem), vim.log.levels.WARN)
    else
      planned(outcome)
    end
  end, buffer)
  vim.notify("dosmc: planning …")
  return true
end

--- Starts the server for a buffer, or lets one that runs have it.
function M.start(buffer, options)
  if vim.bo[buffer].buftype ~= "" then
    return
  end
  if vim.fn.executable(options.program) == 0 then
    vim.notify_once("dosmc is not found, so missions have no language server: put it on the PATH, or set vim.g.dosm_program", vim.log.levels.WARN)
    return
  end
  if vim.lsp.is_enabled and vim.lsp.is_enabled("dosmc") then
    -- Neovim starts it by itself: `vim.lsp.enable("dosmc")`.
    vim.api.nvim_create_autocmd("LspAttach", {
      buffer = buffer,
      callback = function(event)
        local client = vim.lsp.get_client_by_id(event.data.client_id)
        if client and client.name == "dosmc" then
          attached(client, buffer, options)
        end
      end,
    })
    return
  end
  local config = {
    name = "dosmc",
    cmd = vim.list_extend({ options.program, "lsp" }, options.arguments),
    root_dir = root(buffer),
    capabilities = options.capabilities,
    on_attach = function(client, attached_buffer)
      attached(client, attached_buffer, options)
    end,
  }
  if vim.lsp.start then
    vim.lsp.start(config, { bufnr = buffer })
    return
  end
  -- Neovim 0.7: one server for each folder.
  for _, client in pairs(vim.lsp.get_active_clients()) do
    if client.name == "dosmc" and client.config.root_dir == config.root_dir then
      vim.lsp.buf_attach_client(buffer, client.id)
      return
    end
  end
  local id = vim.lsp.start_client(config)
  if id then
    vim.lsp.buf_attach_client(buffer, id)
  end
end

return M
