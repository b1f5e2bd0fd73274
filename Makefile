VENV ?= .venv
PYTHON ?= python3
BIN := $(VENV)/bin

.PHONY: study test test-slow test-ross lint clean pictures trade

study: $(BIN)/.installed
	$(BIN)/leblanc run examples/horizontal_rig.toml

test: $(BIN)/.installed-test
	$(BIN)/python -m pytest -n 2 -m "not slow"

test-slow: $(BIN)/.installed-test
	$(BIN)/python -m pytest -m slow

# ROSS brings some sixty packages of its own: an environment apart.
test-ross:
	$(PYTHON) -m venv .venv-ross
	.venv-ross/bin/python -m pip install --quiet --editable ".[test,ross]"
	.venv-ross/bin/python -m pytest tests/solvers/test_ross_element.py

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
	$(BIN)/python -m pip install --quiet --editable ".[test]"
	touch $@

$(BIN)/.installed-lint: pyproject.toml | $(BIN)/python
	$(BIN)/python -m pip install --quiet --editable ".[test,lint]"
	touch $@

clean:
	rm -rf $(VENV) .venv-ross out .pytest_cache .mypy_cache .ruff_cache .import_linter_cache

# The pictures of the README and the docs, drawn by the examples.
pictures: $(BIN)/.installed
	mkdir -p docs/images
	$(BIN)/leblanc run examples/horizontal_rig.toml --out out/pictures
	cp out/pictures/amplitude.png docs/images/horizontal_rig_amplitude.png
	cp out/pictures/chamber.png docs/images/horizontal_rig_chamber.png
	$(BIN)/leblanc map examples/horizontal_rig.toml --out out/pictures
	cp out/pictures/map.png docs/images/whirl_map.png
	$(BIN)/leblanc runup examples/runup.toml --out out/pictures
	cp out/pictures/runup_speed.png docs/images/runup_example_speed.png
	$(BIN)/python -m validation.tub_figures --out docs/images
	$(BIN)/python -m validation.two_plane_figures --out docs/images
	$(BIN)/leblanc optimise examples/runup.toml --out out/pictures
	cp out/pictures/objective.png docs/images/optimise_objective.png
	$(BIN)/leblanc optimise examples/washing_machine.toml --objective peak --steady --out out/pictures
	cp out/pictures/front.png docs/images/optimise_front.png

# Accuracy against cost of every model on every example: kept in validation/trade, drawn in docs/images.
trade: $(BIN)/.installed
	$(BIN)/python -m validation.trade --out docs/images
