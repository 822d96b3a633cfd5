# Every target does its own set-up: a Python 3.11 or newer with venv, and make, are all it needs.
PYTHON ?= $(shell for p in python3 python3.14 python3.13 python3.12 python3.11; do \
	command -v $$p >/dev/null 2>&1 && $$p -c 'import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))' 2>/dev/null \
	&& echo $$p && break; done)
VENV ?= .venv
BIN := $(VENV)/bin
DEMO ?= demo
SEED ?= 1

.PHONY: help demo test test-all lint docs bench clean

help:
	@echo "make demo      a synthetic campaign to snow parameters and a simulated turn, with reports in $(DEMO)/"
	@echo "make test      the tests that take minutes, not hours"
	@echo "make test-all  those and the long ones"
	@echo "make lint      ruff, mypy, import-linter"
	@echo "make docs      the documentation, into docs/_build/html"
	@echo "make bench     what is measured, as ratios in one run"

$(BIN)/python:
	@test -n "$(PYTHON)" || { echo "skisnow needs Python 3.11 or newer with its venv module (Debian: apt install python3-venv)"; exit 1; }
	$(PYTHON) -m venv $(VENV)

# what an installation is made from: a change of the compiled core builds it anew
CORE := CMakeLists.txt $(wildcard build_backend/*.py src/core/*)

$(VENV)/.skisnow: pyproject.toml $(CORE) | $(BIN)/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable .
	@touch $@

$(VENV)/.skisnow-test: pyproject.toml $(CORE) | $(BIN)/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[test]'
	@touch $@ $(VENV)/.skisnow

$(VENV)/.skisnow-dev: pyproject.toml $(CORE) | $(BIN)/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev]'
	@touch $@ $(VENV)/.skisnow $(VENV)/.skisnow-test

demo: $(VENV)/.skisnow
	rm -rf $(DEMO)
	$(BIN)/skisnow reference $(DEMO)/campaign --seed $(SEED)
	$(BIN)/skisnow analyse $(DEMO)/campaign --out $(DEMO)/results
	$(BIN)/python examples/campaign_to_turn.py $(DEMO)/results/results.json $(DEMO)/turn
	@echo "To enter tests and look at turns in a browser: $(BIN)/pip install -e '.[web]', then $(BIN)/skisnow serve"
	@echo
	@echo "Open $(DEMO)/turn/report.html (the turn) and $(DEMO)/results/report.html (the campaign) in a browser."

# the same examples every time; test-all seeks others
test: $(VENV)/.skisnow-test
	$(BIN)/python -m pytest -n 2 -q --hypothesis-profile=ci

test-all: $(VENV)/.skisnow-test
	$(BIN)/python -m pytest -n 2 -q -m 'slow or not slow'

lint: $(VENV)/.skisnow-dev
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/lint-imports --no-cache

docs: $(VENV)/.skisnow-dev
	$(BIN)/sphinx-build -q -W --keep-going -b html docs docs/_build/html

bench: $(VENV)/.skisnow-test
	$(BIN)/python -m benchmarks

clean:
	rm -rf $(VENV) $(DEMO) build dist docs/_build .pytest_cache .mypy_cache .ruff_cache .hypothesis
