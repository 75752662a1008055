-- What a user does in Neovim, step by step. Writes what came of each step as JSON; neovim_test.py says what should have.
--   nvim --headless -u NONE -i NONE -n -c "luafile neovim_session.lua"
-- Environment: TMCL the program, TMCL_SOURCE the file to edit, TMCL_RESULT the file to write.

local patience = 60000 -- ms; only a hang reaches it
local result = {}

local function eventually(what, condition)
  if not vim.wait(patience, condition, 10) then error("not within " .. patience .. " ms: " .. what) end
end

local function text()
  return table.concat(vim.api.nvim_buf_get_lines(0, 0, -1, false), "\n")
end

local function messages()
  return vim.tbl_map(function(diagnostic)
    return { line = diagnostic.lnum, column = diagnostic.col, message = diagnostic.message, code = diagnostic.code }
  end, vim.diagnostic.get(0))
end

-- Lines count from 1, columns from 0.
local function put_cursor(line, column)
  vim.api.nvim_win_set_cursor(0, { line, column })
end

local function ask(method, parameters)
  parameters = vim.tbl_extend("force", vim.lsp.util.make_position_params(), parameters or {})
  local answers = vim.lsp.buf_request_sync(0, method, parameters, patience)
  local _, answer = next(answers or {})
  if answer == nil then error("no answer to " .. method) end
  if answer.error ~= nil then return { refused = answer.error.message } end
  return answer.result
end

local function session()
  vim.cmd("edit " .. vim.fn.fnameescape(vim.env.TMCL_SOURCE))
  local exit_code
  local client = vim.lsp.start_client({
    name = "tmcl",
    cmd = { vim.env.TMCL, "lsp" },
    root_dir = vim.fn.fnamemodify(vim.env.TMCL_SOURCE, ":h"),
    on_exit = function(code) exit_code = code end,
  })
  vim.lsp.buf_attach_client(0, client)

  eventually("diagnostics of the file", function() return #vim.diagnostic.get(0) > 0 end)
  result.diagnostics = messages()

  -- The user corrects the misspelt instruction; the cursor does not matter.
  vim.api.nvim_buf_set_text(0, 3, 7, 3, 9, { "VP" })
  eventually("no diagnostics", function() return #vim.diagnostic.get(0) == 0 end)
  result.corrected = text()

  put_cursor(4, 1)
  result.hover = ask("textDocument/hover").contents.value

  -- A new line that is being written.
  vim.api.nvim_buf_set_lines(0, 5, 5, false, { "  JC G" })
  put_cursor(6, 6)
  local items = vim.lsp.util.text_document_completion_list_to_complete_items(ask("textDocument/completion"), "G")
  result.completion = vim.tbl_map(function(item) return item.word end, items)
  vim.api.nvim_buf_set_lines(0, 5, 6, false, {})

  -- From the jump to the label, as the key for it does.
  put_cursor(5, 6)
  vim.lsp.buf.definition()
  eventually("the jump", function() return vim.api.nvim_win_get_cursor(0)[1] == 4 end)
  result.jumped_to = vim.api.nvim_win_get_cursor(0)

  put_cursor(5, 6)
  result.refused = ask("textDocument/rename", { newName = "GE" }).refused
  vim.lsp.buf.rename("Again")
  eventually("the new name", function() return text():find("JA Again", 1, true) ~= nil end)
  result.renamed = text()

  vim.lsp.buf.formatting_sync(nil, patience)
  result.formatted = text()

  -- An included file, to which a jump leads.
  put_cursor(3, 10)
  vim.lsp.buf.definition()
  eventually("the included file", function() return vim.fn.expand("%:t") == "speeds.inc" end)
  result.included = text()

  vim.lsp.stop_client(client)
  eventually("the end of the server", function() return exit_code ~= nil end)
  result.exit_code = exit_code
end

local done, failure = pcall(session)
if not done then result.failure = failure end
local file = io.open(vim.env.TMCL_RESULT, "w")
file:write(vim.json.encode(result))
file:close()
vim.cmd("qall!")
