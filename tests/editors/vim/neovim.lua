-- What tests ask Neovim about the language server and tree-sitter. The question is JSON in $DOSMC_ASK, the answer
-- goes to $DOSMC_ANSWER.

local ask = vim.fn.json_decode(vim.fn.readfile(vim.env.DOSMC_ASK))
local answer = {}

vim.opt.runtimepath:prepend(vim.env.DOSMC_PLUGIN)
vim.opt.swapfile = false
-- So that the cursor can stand behind a line, as it does while one types.
vim.opt.virtualedit = "onemore"
vim.cmd("filetype plugin indent on")
vim.cmd("syntax on")

local said = {}
vim.notify = function(text)
  table.insert(said, text)
end

--- Waits until something holds.
local function await(what, holds)
  if not vim.wait(60000, holds, 20) then
    error("waited in vain: " .. what .. "; said: " .. vim.inspect(said))
  end
end

local function text()
  return table.concat(vim.api.nvim_buf_get_lines(0, 0, -1, false), "\n") .. "\n"
end

--- Puts the cursor on a token of a line, both from 1; the token may be anywhere in the line.
local function go(line, token)
  local start = vim.fn.getline(line):find(token, 1, true)
  vim.api.nvim_win_set_cursor(0, { line, start - 1 })
end

local function client()
  return require("dosm.lsp").client(0)
end

--- The answer to a request at the cursor.
local function request(method, more)
  local params = vim.lsp.util.make_position_params(0, client().offset_encoding)
  local answers = assert(vim.lsp.buf_request_sync(0, method, vim.tbl_extend("force", params, more or {}), 20000))
  for _, one in pairs(answers) do
    if one.error then
      error(method .. ": " .. one.error.message)
    end
    return one.result
  end
end

local questions = {}

--- Which group of tree-sitter's captures each token has, and whether it colours the text.
function questions.captures()
  assert(require("dosm.treesitter").install(ask.sources), vim.inspect(said))
  vim.opt.runtimepath:append(vim.fn.stdpath("data") .. "/site")
  vim.cmd("edit " .. vim.fn.fnameescape(ask.file))
  local buffer = vim.api.nvim_get_current_buf()
  answer.active = vim.treesitter.highlighter.active[buffer] ~= nil
  local query = (vim.treesitter.query.get or vim.treesitter.get_query)("dosm", "highlights")
  local tree = vim.treesitter.get_parser(buffer, "dosm"):parse()[1]
  answer.broken = tree:root():has_error()
  local there = {}
  for id, node in query:iter_captures(tree:root(), buffer, 0, -1) do
    local row, column = node:range()
    there[(row + 1) .. ":" .. (column + 1)] = query.captures[id]
  end
  answer.captures = {}
  for at, place in ipairs(ask.places) do
    answer.captures[at] = there[place[1] .. ":" .. place[2]] or ""
  end
  -- All captures have a colour.
  answer.colourless = {}
  for _, name in ipairs(query.captures) do
    local map = vim.treesitter.highlighter.hl_map
    if map and not map[name] and not name:match("^_") then
      table.insert(answer.colourless, name)
    end
  end
end

--- A whole session with the language server.
function questions.session()
  vim.cmd("edit " .. vim.fn.fnameescape(ask.file))
  await("the server", function()
    return client() ~= nil
  end)
  await("diagnostics", function()
    return #vim.diagnostic.get(0) > 0
  end)
  answer.diagnostics = vim.tbl_map(function(one)
    return { one.lnum, one.col, one.end_lnum, one.end_col, one.severity, one.message, one.source, one.code }
  end, vim.diagnostic.get(0))

  do
    go(ask.wrong.line, ask.wrong.token)
    local at = vim.lsp.util.make_range_params(0, client().offset_encoding)
    local row = ask.wrong.line - 1
    at.context = { diagnostics = vim.lsp.diagnostic.get_line_diagnostics(0, row) }
    local answers = vim.lsp.buf_request_sync(0, "textDocument/codeAction", at, 20000)
    local _, first = next(answers)
    answer.actions = vim.tbl_map(function(action)
      return action.title
    end, first.result or {})
    for _, action in ipairs(first.result or {}) do
      if action.edit and action.title:find(ask.wrong.meant, 1, true) then
        vim.lsp.util.apply_workspace_edit(action.edit, client().offset_encoding)
        break
      end
    end
  end
  answer.mended = text()
  await("no diagnostics", function()
    return #vim.diagnostic.get(0) == 0
  end)

  go(ask.model.line, ask.model.token)
  local hover = request("textDocument/hover")
  answer.hover = hover and hover.contents.value

  go(ask.used.line, ask.used.token)
  vim.lsp.buf.definition()
  await("the definition", function()
    return vim.api.nvim_win_get_cursor(0)[1] ~= ask.used.line
  end)
  answer.definition = vim.api.nvim_win_get_cursor(0)

  go(ask.used.line, ask.used.token)
  answer.references = #request("textDocument/references", { context = { includeDeclaration = true } })
  vim.lsp.buf.rename("harbour")
  await("the new name", function()
    return text():find("harbour") ~= nil
  end)
  answer.renamed = text()

  do
    local line = vim.fn.getline(ask.used.line)
    vim.api.nvim_buf_set_lines(0, ask.used.line - 1, ask.used.line, false, { line:gsub("in harbour.*", "in ") .. "" })
    vim.api.nvim_win_set_cursor(0, { ask.used.line, #vim.fn.getline(ask.used.line) })
    local offered = request("textDocument/completion")
    answer.offered = vim.tbl_map(function(item)
      return item.label
    end, offered.items or offered)
    vim.api.nvim_buf_set_lines(0, ask.used.line - 1, ask.used.line, false, { line })
  end

  do
    local symbols = request("textDocument/documentSymbol")
    answer.symbols = vim.tbl_map(function(symbol)
      return symbol.name
    end, symbols)
  end

  -- What only newer versions show.
  if vim.lsp.inlay_hint then
    await("hints", function()
      return #vim.lsp.inlay_hint.get({ bufnr = 0 }) > 0
    end)
    answer.hints = vim.tbl_map(function(hint)
      local label = hint.inlay_hint.label
      return type(label) == "table" and label[1].value or label
    end, vim.lsp.inlay_hint.get({ bufnr = 0 }))
  end
  if vim.lsp.semantic_tokens and vim.lsp.semantic_tokens.get_at_pos then
    local column = vim.fn.getline(ask.model.line):find(ask.model.token, 1, true) - 1
    local function tokens()
      return vim.lsp.semantic_tokens.get_at_pos(0, ask.model.line - 1, column) or {}
    end
    await("tokens", function()
      return #tokens() > 0
    end)
    answer.tokens = vim.tbl_map(function(token)
      return token.type
    end, tokens())
  end

  vim.cmd("DosmFormat")
  answer.formatted = text()

  vim.cmd("DosmSolve")
  await("a plan", function()
    return #said > 1
  end)
  answer.said = said

  -- The program has to end when it is told so.
  local id = client().id
  vim.lsp.stop_client(id)
  await("the end", function()
    return vim.lsp.client_is_stopped(id)
  end)
end

--- How many servers a mission has that Neovim starts by itself, as its versions from 0.11 on can.
function questions.enabled()
  if not (vim.lsp.is_enabled and vim.lsp.enable) then
    answer.servers = 1
    answer.command = true
    return
  end
  vim.lsp.enable("dosmc")
  vim.cmd("edit " .. vim.fn.fnameescape(ask.file))
  await("diagnostics", function()
    return #vim.diagnostic.get(0) > 0
  end)
  answer.servers = #vim.lsp.get_clients({ bufnr = 0 })
  answer.command = vim.fn.exists(":DosmFormat") == 2 and vim.fn.maparg("grl", "n") ~= ""
  vim.lsp.stop_client(vim.lsp.get_clients())
end

--- Without the program something is said, once, and all else works.
function questions.missing()
  vim.cmd("edit " .. vim.fn.fnameescape(ask.file))
  vim.cmd("edit " .. vim.fn.fnameescape(ask.file))
  answer.said = said
  answer.filetype = vim.bo.filetype
end

local fine, problem = xpcall(function()
  vim.cmd("runtime! plugin/dosm.lua")
  questions[ask.what]()
end, debug.traceback)
if not fine then
  answer.error = problem
end
vim.fn.writefile({ vim.fn.json_encode(answer) }, vim.env.DOSMC_ANSWER)
vim.cmd("qall!")
