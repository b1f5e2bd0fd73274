VENV ?= .venv
PYTHON ?= python3
BIN := $(VENV)/bin

.PHONY: study test net test-slow metamorphic test-ross lint clean figures docs trade notebooks

study: $(BIN)/.installed
	$(BIN)/leblanc run examples/horizontal_rig.toml

test: $(BIN)/.installed-test
	$(BIN)/python -m pytest -n 2 --dist worksteal -m "not slow"

# All commands on all example scenes beside the answers kept in tests/net/kept, some minutes.
net: $(BIN)/.installed-test
	$(BIN)/python -m tests.net check

test-slow: $(BIN)/.installed-test
	$(BIN)/python -m pytest -m slow --timeout 0 -o faulthandler_timeout=0

# A thousand random machines, each asked again in other units, scaled, split, permuted, turned and mirrored: an hour
# or two in one process. COUNT and JOBS change that.
COUNT ?= 1000
JOBS ?= 1
metamorphic: $(BIN)/.installed-test
	$(BIN)/python -m tests.leblanc.metamorphic.random_scenes --count $(COUNT) --jobs $(JOBS) --command run

# ROSS brings some sixty packages of its own: an environment apart.
test-ross:
	$(PYTHON) -m venv .venv-ross
	.venv-ross/bin/python -m pip install --quiet --editable ".[test,ross]"
	.venv-ross/bin/python -m pytest tests/solvers/test_ross.py

lint: $(BIN)/.installed-lint
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports

$(BIN)/python:
	$(PYTHON) -m venv $(VENV)

$(BIN)/.installed: pyproject.toml | $(BIN)/python
	$(BIN)/python -m pip install --quiet --editable .
	touch $@

$(BIN)/.installed-test: pyproject.toml | $(BIN)/python
	$(BIN)/python -m pip install --quiet --editable ".[test,browser,app,cad,gpu]"
	touch $@

$(BIN)/.installed-lint: pyproject.toml | $(BIN)/python
	$(BIN)/python -m pip install --quiet --editable ".[test,lint]"
	touch $@

$(BIN)/.installed-notebooks: pyproject.toml | $(BIN)/python
	$(BIN)/python -m pip install --quiet --editable ".[notebooks]"
	touch $@

$(BIN)/.installed-docs: pyproject.toml | $(BIN)/python
	$(BIN)/python -m pip install --quiet --editable ".[docs]"
	touch $@

# All of these by one look at the packages.
$(BIN)/.installed-all: pyproject.toml | $(BIN)/python
	$(BIN)/python -m pip install --quiet --editable ".[test,browser,app,cad,gpu,lint,notebooks,docs]"
	touch $(BIN)/.installed $(addprefix $(BIN)/.installed,-test -lint -notebooks -docs -all)

# The comparisons with measurements, prints and other codes, executed: a notebook whose claims fail stops the make.
notebooks: $(BIN)/.installed-notebooks
	$(BIN)/leblanc notebooks

clean:
	rm -rf $(VENV) .venv-ross out .pytest_cache .mypy_cache .ruff_cache .import_linter_cache

# Every picture of the README and the pages, drawn again: some minutes. Look at them before they are committed.
figures: $(BIN)/.installed
	$(BIN)/python docs/figures.py

# The documentation site in out/docs: pictures drawn again and compared, the pages' commands run, warnings as errors.

docs: $(BIN)/.installed-docs
	$(BIN)/python docs/build.py --out out/docs

# Accuracy against cost of every model on the examples kept in validation/trade, two of them drawn in docs/images.
trade: $(BIN)/.installed
	$(BIN)/python -m validation.trade --out docs/images
