--- Colours by tree-sitter, where the grammar's parser is installed.

local M = {}

--- Neovim 0.7 has no names for these captures.
local names = {
  ["comment.documentation"] = "SpecialComment",
  ["keyword.modifier"] = "Keyword",
  ["keyword.operator"] = "Statement",
  ["constructor"] = "Structure",
  ["module"] = "Identifier",
  ["variable"] = "Identifier",
  ["variable.parameter"] = "Identifier",
  ["variable.member"] = "Identifier",
  ["type.definition"] = "Type",
  ["type.builtin"] = "Type",
  ["function.builtin"] = "Function",
  ["function.call"] = "Function",
  ["property"] = "Special",
  ["label"] = "Label",
  ["punctuation.bracket"] = "Delimiter",
  ["punctuation.delimiter"] = "Delimiter",
}

--- Whether the parser can be used.
function M.is_installed()
  return #vim.api.nvim_get_runtime_file("parser/dosm.so", false) > 0
end

--- Colours a buffer by its tree; gives whether that was possible.
function M.start(buffer)
  if not M.is_installed() then
    return false
  end
  if vim.treesitter.start then
    return (pcall(vim.treesitter.start, buffer, "dosm"))
  end
  local highlighter = require("vim.treesitter.highlighter")
  for capture, group in pairs(names) do
    highlighter.hl_map[capture] = rawget(highlighter.hl_map, capture) or group
  end
  return (pcall(function()
    highlighter.new(vim.treesitter.get_parser(buffer, "dosm"))
  end))
end

--- Where the grammar's sources are: beside this plug-in, in the repository.
local function sources()
  local here = debug.getinfo(1, "S").source:sub(2)
  local editors = vim.fn.fnamemodify(vim.loop.fs_realpath(here) or here, ":p:h:h:h:h")
  return editors .. "/tree-sitter/src"
end

--- Compiles the parser into the user's folder. `folder` is another place for the sources.
function M.install(folder)
  folder = folder or sources()
  if vim.fn.filereadable(folder .. "/parser.c") == 0 then
    vim.notify("there is no parser.c in " .. folder, vim.log.levels.ERROR)
    return false
  end
  local into = vim.fn.stdpath("data") .. "/site/parser"
  vim.fn.mkdir(into, "p")
  local compiler = vim.env.CC or "cc"
  local said = vim.fn.system({
    compiler, "-shared", "-fPIC", "-O2", "-std=c11", "-I", folder,
    folder .. "/parser.c", folder .. "/scanner.c", "-o", into .. "/dosm.so",
  })
  if vim.v.shell_error ~= 0 then
    vim.notify("the parser was not compiled: " .. said, vim.log.levels.ERROR)
    return false
  end
  vim.notify("the parser is " .. into .. "/dosm.so: missions that are opened from now on use it")
  return true
end

return M
