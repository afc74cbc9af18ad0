-- Run in Neovim behind the set-up lines of docs/editors.md, on editors/bracket.nc:
-- what a user does by keys, done by the functions behind them.  Writes "ok" or "no", a name and what was seen.

local results = assert(io.open(os.getenv("RESULTS"), "w"))

local function check(name, is_right, seen)
  results:write(is_right and "ok " or "no ", name, ": ", vim.inspect(seen):gsub("%s+", " "), "\n")
end

-- Waits until what `ask` gives is as wanted, and writes it down.
local function expect(name, ask, wanted)
  vim.wait(20000, function() return wanted(ask()) end, 50)
  local seen = ask()
  check(name, wanted(seen), seen)
end

local function line(number)
  return function() return vim.api.nvim_buf_get_lines(0, number - 1, number, false)[1] end
end

local function equals(text)
  return function(seen) return seen == text end
end

local function contains(...)
  local parts = { ... }
  return function(seen)
    for _, part in ipairs(parts) do
      if not (seen and seen:find(part, 1, true)) then return false end
    end
    return true
  end
end

local function codes()
  local found = vim.tbl_map(function(d) return d.code end, vim.diagnostic.get(0))
  table.sort(found)
  return table.concat(found, " ")
end

local function floating()
  for _, window in ipairs(vim.api.nvim_list_wins()) do
    if vim.api.nvim_win_get_config(window).relative ~= "" then
      return table.concat(vim.api.nvim_buf_get_lines(vim.api.nvim_win_get_buf(window), 0, -1, false), "\n")
    end
  end
end

local function answer(method, more)
  local document = { textDocument = vim.lsp.util.make_text_document_params() }
  for _, reply in pairs(vim.lsp.buf_request_sync(0, method, vim.tbl_extend("force", document, more), 20000)) do
    return reply.result
  end
end

local function all()
  expect("type of the file", function() return vim.bo.filetype end, equals("din66025"))
  expect("diagnostics", codes, equals("NC054 NC201"))
  vim.api.nvim_win_set_cursor(0, { 12, 5 })
  vim.lsp.buf.hover()
  expect("hover", floating, contains("G1", "Behind this block", "G91"))
  vim.api.nvim_win_set_cursor(0, { 6, 4 })
  vim.lsp.buf.code_action({
    apply = true,
    filter = function(action) return action.title == "Write the letters in upper case" end,
  })
  expect("code action", line(6), equals("N40 G1 X40 Y20"))
  expect("diagnostics after the fix", codes, equals("NC201"))
  vim.api.nvim_win_set_cursor(0, { 15, 10 })
  vim.lsp.buf.definition()
  expect("definition", function() return vim.api.nvim_win_get_cursor(0)[1] end, equals(12))
  vim.lsp.buf.rename("95")
  expect("rename", line(15), equals("N120 G20 L95 K$pass$"))
  vim.api.nvim_buf_set_lines(0, 17, 18, false, { "n150  g90X1,5" })
  expect("error while typing", codes, contains("NC001"))
  vim.api.nvim_buf_set_lines(0, 17, 18, false, { "n150  g90X1" })
  expect("error is gone", codes, function(seen) return not seen:find("NC001") end)
  vim.lsp.buf.format({ timeout_ms = 20000 })
  expect("format", line(18), equals("N150 G90 X1"))
  if vim.lsp.inlay_hint then
    local function hints()
      return vim.inspect(vim.tbl_map(function(h) return h.inlay_hint.label end, vim.lsp.inlay_hint.get({ bufnr = 0 })))
    end
    expect("inlay hints", hints, contains("R10  0.785 s", "→ X0 Y20"))
  end
  if vim.lsp.semantic_tokens then
    local function token()
      local found = vim.lsp.semantic_tokens.get_at_pos(0, 2, 4) or {}
      return found[1] and found[1].type
    end
    expect("semantic tokens", token, equals("keyword"))
  end
  local symbols = answer("textDocument/documentSymbol", {})
  check("outline", #symbols == 2 and symbols[2].name == "finish", symbols[2].name)
  local offered = answer("textDocument/completion", { position = { line = 17, character = 7 } })
  check("completion", offered.items[1].label == "G0", offered.items[1].label)
  local lenses = answer("textDocument/codeLens", {})
  check("code lenses", #lenses == 3, lenses[1].command.title)
end

local is_done, problem = pcall(all)
if not is_done then check("no error", false, problem) end
results:close()
vim.cmd("qall!")
