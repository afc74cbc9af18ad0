# make demo    from nothing but Python 3.11: environment, install, compile, run, plot
# make test    the tests
# make check   format, lint, types, layering and the tests
# make bench   the benchmarks
# make docs     writes the pages of the diagnostic codes anew
# make vscode   tests the VS Code extension and makes its .vsix; needs Node 20 and npm
# make accept  rewrites the golden files and the results of tests/passes/*/*.case; read the difference before committing

PYTHON ?= $(shell command -v python3.11 || command -v python3 || echo python)
VENV ?= .venv
BIN := $(VENV)/bin
PIP := $(BIN)/python -m pip --disable-pip-version-check --quiet
INPUTS := pyproject.toml README.md

.PHONY: demo test check lint bench docs vscode accept clean
.DELETE_ON_ERROR:

demo: $(VENV)/.installed
	@sh samples/demo.sh $(BIN)/nccompile demo-out

test: $(VENV)/.installed-dev
	$(BIN)/python -m pytest

check: lint test

lint: $(VENV)/.installed-dev
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/lint-imports

bench: $(VENV)/.installed-dev
	$(BIN)/python -m benchmarks

docs: $(VENV)/.installed-dev
	$(BIN)/python -m tools.rule_pages
	$(BIN)/python -m tools.textmate

vscode: $(VENV)/.installed-dev
	cd editors/vscode && npm ci && NCCOMPILE=$(abspath $(BIN))/nccompile npm test && npm run package

accept: $(VENV)/.installed-dev
	NCCOMPILE_ACCEPT=1 $(BIN)/python -m pytest tests/golden tests/passes/test_cases.py
	git status --short tests/golden tests/passes

clean:
	rm -rf $(VENV) build demo-out .mypy_cache .ruff_cache .pytest_cache .hypothesis .import_linter_cache

$(VENV)/bin/python:
	$(PYTHON) -m venv $(VENV)

# An editable install: sources may change without installing again, only pyproject.toml asks for it.
$(VENV)/.installed: $(INPUTS) | $(VENV)/bin/python
	$(PIP) install -e .
	@touch $@

$(VENV)/.installed-dev: $(INPUTS) | $(VENV)/bin/python
	$(PIP) install -e '.[dev]'
	@touch $@ $(VENV)/.installed
