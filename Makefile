# Every target does its own set-up: a Python 3.11 or newer with venv, and make, are all it needs.
PYTHON ?= $(shell for p in python3 python3.14 python3.13 python3.12 python3.11; do \
	command -v $$p >/dev/null 2>&1 && $$p -c 'import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))' 2>/dev/null \
	&& echo $$p && break; done)
VENV ?= .venv
BIN := $(VENV)/bin
TOOLS ?= .venv-tools
DEMO ?= demo
SEED ?= 1
SBOM ?= dist/skisnow.cdx.json
# three workers, since those that drive a browser or another process wait; six where others keep the processors busy,
# since each process gets an equal share of them
WORKERS = $(shell $(BIN)/python -c 'import os; print(3 if os.getloadavg()[0] < 3 * os.cpu_count() else 6)')
# the same examples every time (test-all seeks others); neighbours stay in one process, which has what they share
QUICK = -n $(WORKERS) --dist worksteal -q --hypothesis-profile=ci

# tests start hundreds of Python processes; where compiled modules are not kept, each compiles the package anew
unexport PYTHONDONTWRITEBYTECODE

.PHONY: help set-up messages demo test test-all test-minimum coverage lint tidy sanitize docs bench lock sbom clean

help:
	@echo "make set-up    what all the others need, in $(VENV)/"
	@echo "make messages  new and changed messages into the files of translations, and these compiled"
	@echo "make demo      a synthetic campaign to snow parameters and a simulated turn, and a slalom to watch, in $(DEMO)/"
	@echo "make test      the tests that take minutes, not hours"
	@echo "make test-all  those and the long ones"
	@echo "make test-minimum  the quick tests with the oldest versions that pyproject.toml allows"
	@echo "make coverage  how much of the package the quick tests run"
	@echo "make lint      ruff, mypy, import-linter"
	@echo "make tidy      clang-tidy over the compiled core"
	@echo "make sanitize  the compiled core under sanitizers: tests of contact, motion and carve"
	@echo "make docs      the documentation, into docs/_build/html"
	@echo "make bench     what is measured, as ratios in one run"
	@echo "make lock      requirements/*.txt after a change of pyproject.toml; UPGRADE=--upgrade takes the newest of all"
	@echo "make sbom      the bill of materials, CycloneDX, into $(SBOM)"

$(BIN)/python:
	@test -n "$(PYTHON)" || { echo "skisnow needs Python 3.11 or newer with its venv module (Debian: apt install python3-venv)"; exit 1; }
	$(PYTHON) -m venv $(VENV)

comma := ,
# What is installed stands in requirements/, file by file with its hashes. Where an index has not all of it,
# LOCKED=no takes the newest that pyproject.toml allows.
LOCKED ?= yes
# the extras that tests need; what only those need who work on it stands in [dependency-groups]
TESTED := web$(comma)pandas$(comma)xarray$(comma)racing
# a change of the compiled core builds it anew; without a C++ compiler it is built with the one of Zig's wheel
CORE := CMakeLists.txt $(wildcard build_backend/*.py src/core/*/*)
COMPILER := $(shell command -v c++ || command -v g++ || command -v clang++)
PIP := -m pip --disable-pip-version-check install --quiet
locked = { $(BIN)/python $(PIP) --no-compile --require-hashes --requirement requirements/$(1).txt \
	|| { echo "not all of requirements/$(1).txt could be installed: 'make LOCKED=no ...' takes what pyproject.toml allows"; exit 1; }; }
# the core is built while the rest is fetched; all processors compile the modules, of which a few are not for this Python
define install
	@if [ "$(LOCKED)" = yes ]; then \
		$(call locked,build) && { [ -n "$(COMPILER)" ] || $(call locked,compiler); } || exit 1; \
		$(BIN)/python $(PIP) --no-deps --no-build-isolation --editable . & core=$$!; \
		( $(call locked,$(1)) ); fetched=$$?; \
		wait $$core && [ $$fetched = 0 ] || exit 1; \
		$(BIN)/python -m compileall -qq -j 0 $(VENV)/lib || true; \
	else $(BIN)/python $(PIP) --upgrade 'pip>=25.1' && $(BIN)/python $(PIP) --editable '.[$(2)]' $(3); fi
endef

$(VENV)/.skisnow: pyproject.toml requirements/build.txt requirements/run.txt $(CORE) | $(BIN)/python
	$(call install,run,web)
	@touch $@

$(VENV)/.skisnow-dev: pyproject.toml requirements/build.txt requirements/dev.txt $(CORE) | $(BIN)/python
	$(call install,dev,$(TESTED),--group dev)
	@touch $@ $(VENV)/.skisnow

$(TOOLS)/.tools: requirements/tools.txt
	$(PYTHON) -m venv $(TOOLS)
	$(TOOLS)/bin/python $(PIP) --require-hashes --requirement requirements/tools.txt
	@touch $@

# what a slow turn on a gentle slope asks of the snow, the weak snow of site C can hold
TURN := --set slope.angle_deg=5 --set start.speed_m_per_s=4.5 --set sledge.edge_angle_deg=40
demo: $(VENV)/.skisnow
	rm -rf $(DEMO)
	$(BIN)/skisnow reference $(DEMO)/campaign --seed $(SEED)
	$(BIN)/skisnow analyse $(DEMO)/campaign --out $(DEMO)/results
	$(BIN)/skisnow turn $(DEMO)/campaign --site C $(TURN) --out $(DEMO)/turn
	$(BIN)/skisnow simulate slalom-15deg --set solver.method=fast --out $(DEMO)/slalom --replay
	@echo "To enter tests and look at turns in a browser: $(BIN)/skisnow serve"
	@echo
	@echo "Open $(DEMO)/turn/report.html (the turn) and $(DEMO)/results/report.html (the campaign) in a browser,"
	@echo "and this one, a skier through twenty gates, in three dimensions:"
	@echo "$(abspath $(DEMO))/slalom/replay.html"

set-up: $(VENV)/.skisnow-dev

messages: $(VENV)/.skisnow-dev
	$(BIN)/python build_backend/messages.py update

test: $(VENV)/.skisnow-dev
	$(BIN)/python -m pytest $(QUICK)

test-all: $(VENV)/.skisnow-dev
	$(BIN)/python -m pytest -n 2 --dist worksteal -q -m 'slow or not slow'

lint: $(VENV)/.skisnow-dev
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/lint-imports --no-cache
	$(BIN)/clang-format --dry-run --Werror src/core/*/*

# What clang-tidy says of the core; .clang-tidy tells what it looks for and what fails.
TIDY := build/tidy
tidy: $(VENV)/.skisnow-dev $(TOOLS)/.tools
	PATH="$(abspath $(BIN)):$$PATH" cmake -S . -B $(TIDY) -G Ninja -DPython_EXECUTABLE=$(abspath $(BIN))/python \
		-DCMAKE_BUILD_TYPE=Release -DCMAKE_EXPORT_COMPILE_COMMANDS=ON
	$(TOOLS)/bin/python $(TOOLS)/bin/run-clang-tidy.py -quiet -p $(TIDY) -clang-tidy-binary $(abspath $(TOOLS))/bin/clang-tidy \
		'src/core/(?!contact/kernels).*\.cpp$$'

# The core built with sanitizers, and the tests of its own run under them: SANITIZE=thread finds races.
SANITIZE ?= address,undefined
SANITIZED := build/sanitize-$(SANITIZE)
SANITIZED_TESTS ?= tests/compiled tests/contact tests/dynamics tests/ski/beam tests/carving
RUNTIMES := $(if $(findstring thread,$(SANITIZE)),tsan,asan ubsan) stdc++
PRELOAD = $(foreach each,$(RUNTIMES),$(shell c++ -print-file-name=lib$(each).so))
sanitize: $(VENV)/.skisnow-dev
	PATH="$(abspath $(BIN)):$$PATH" cmake -S . -B $(SANITIZED) -G Ninja -DPython_EXECUTABLE=$(abspath $(BIN))/python \
		-DSKISNOW_SANITIZE=$(SANITIZE) -DCMAKE_BUILD_TYPE=Release
	PATH="$(abspath $(BIN)):$$PATH" cmake --build $(SANITIZED)
	rm -rf $(SANITIZED)/package && mkdir -p $(SANITIZED)/package && cp -r src/skisnow $(SANITIZED)/package
	cp $(SANITIZED)/_core*.so $(SANITIZED)/libskisnow_contact* src/core/bindings/skisnow_contact.h $(SANITIZED)/package/skisnow/compiled
# -S: the checkout's own core is not to be found; a program in C would have to be linked with the runtimes
	LD_PRELOAD="$(PRELOAD)" ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=print_stacktrace=1 \
		PYTHONPATH=$(SANITIZED)/package:$$($(BIN)/python -c 'import sysconfig; print(sysconfig.get_path("purelib"))') \
		$(BIN)/python -S -m pytest -q -p no:cacheprovider -p no:xdist $(SANITIZED_TESTS) \
		--deselect tests/contact/test_c_library.py::test_the_example_gives_the_bits_of_python

# The oldest versions that pyproject.toml allows, in a virtual environment of their own; browsers are the newest's affair.
MINIMUM := .venv-minimum
$(MINIMUM)/.installed: pyproject.toml $(CORE) $(TOOLS)/.tools
	$(TOOLS)/bin/uv --quiet venv --clear --python '$(PYTHON)' $(MINIMUM)
	$(TOOLS)/bin/uv --quiet pip install --python $(MINIMUM) --resolution lowest-direct --group test --editable '.[$(TESTED)]'
	@touch $@

test-minimum: $(MINIMUM)/.installed
	$(MINIMUM)/bin/python -m pytest $(QUICK) -m 'not slow and not browser'

# how much of the package the quick tests run; coverage.py is fetched for it and stays nobody's dependency
coverage: $(VENV)/.skisnow-dev
	$(BIN)/python $(PIP) --target build/coverage 'pytest-cov>=6' --no-deps 'coverage>=7.6'
	PYTHONPATH=build/coverage $(BIN)/python -m pytest $(QUICK) --cov=skisnow --cov-branch --cov-report=term:skip-covered

docs: $(VENV)/.skisnow-dev
	$(BIN)/sphinx-build -q -W --keep-going -b html docs docs/_build/html

bench: $(VENV)/.skisnow-dev
	$(BIN)/python -m benchmarks

# uv asks the public index, or the one in UV_DEFAULT_INDEX; what it writes names none
COMPILE := $(TOOLS)/bin/uv --quiet --no-config pip compile --universal --python-version 3.11 --generate-hashes \
	--no-header --no-annotate $(UPGRADE)
lock: $(TOOLS)/.tools
	$(COMPILE) --group dev $(addprefix --extra ,web pandas xarray racing) pyproject.toml requirements/build.in --output-file requirements/dev.txt
	$(COMPILE) --extra web --constraint requirements/dev.txt pyproject.toml requirements/build.in --output-file requirements/run.txt
	$(COMPILE) requirements/build.in --constraint requirements/dev.txt --output-file requirements/build.txt
	$(COMPILE) requirements/tools.in --output-file requirements/tools.txt
	$(COMPILE) requirements/compiler.in --output-file requirements/compiler.txt

sbom: $(TOOLS)/.tools
	rm -rf $(TOOLS)/run
	$(PYTHON) -m venv --without-pip $(TOOLS)/run
	$(TOOLS)/bin/python -m pip --python $(TOOLS)/run/bin/python install --quiet --disable-pip-version-check \
		--require-hashes --requirement requirements/run.txt
	$(TOOLS)/bin/python requirements/sbom.py $(TOOLS)/run/bin/python $(SBOM)

clean:
	rm -rf $(VENV) $(TOOLS) $(MINIMUM) $(DEMO) build dist docs/_build docs/_generated .pytest_cache .mypy_cache .ruff_cache .hypothesis
