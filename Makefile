# `make demo` and `make test` need nothing but Python 3.11 or newer.

PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
DIST ?= dist
READY := $(VENV)/.ready

# Bytecode is compiled when it is needed, once for all processes, where the tests keep it; most of what is installed never is needed.
export PYTHONPYCACHEPREFIX ?= $(CURDIR)/build/compiled/python
INSTALL = $(BIN)/python -m pip install --quiet --no-compile

.PHONY: demo test check gen bench docs site wheel clean

demo: $(READY)
	@mkdir -p build
	$(BIN)/amuros build samples/bodas-test-advanced.yaml -o build/app.amxmi
	$(BIN)/amuros info --schema build/app.amxmi
	$(BIN)/amuros check samples/bodas-test-advanced.yaml
	$(BIN)/amuros analyze build/app.amxmi
	$(BIN)/amuros analyze build/app.amxmi --chain factor-to-output
	sed 's/rate: 50 Hz/rate: 100 Hz/' samples/bodas-test-advanced.yaml > build/faster.yaml
	$(BIN)/amuros build build/faster.yaml -o build/faster.amxmi
	$(BIN)/amuros diff build/app.amxmi build/faster.amxmi || true
	$(BIN)/amuros report samples/bodas-test-advanced.yaml -o build/report.html
	$(BIN)/amuros measure samples/bodas-test-measured.log --markers samples/bodas-test-measured.markers.yml --select Executor_Task
	$(BIN)/amuros optimize samples/bodas-test-advanced.yaml --limit 'factor-to-output.max_reduced_reaction_time<11ms' --proposals 1

test: $(READY)
	$(BIN)/python -m pytest -n auto

check: $(READY)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

# Everything that is generated and committed.
gen: $(READY)
	$(BIN)/python tools/generate_metamodel.py
	$(BIN)/python tools/generate_schemas.py
	$(BIN)/python tools/generate_app_schema.py
	$(BIN)/python tools/generate_app_reference.py
	$(BIN)/python tools/generate_rules.py
	$(BIN)/python tools/generate_findings.py
	$(BIN)/python samples/executor.py samples/executor.amxmi
	for sample in samples/*.yaml; do $(BIN)/amuros build $$sample --output json=/dev/null; done
	$(BIN)/python tools/draw_terminal.py docs/images/info.svg info executor.amxmi
	$(BIN)/python tools/draw_terminal.py docs/images/analyze.svg analyze bodas-test-advanced.yaml
	$(BIN)/python tools/draw_terminal.py docs/images/build.svg build bodas-test-advanced.yaml
	$(BIN)/python tools/draw_terminal.py docs/images/check.svg check --profile inchron bodas-test-hardware.yaml
	$(BIN)/python tools/draw_quantities.py docs/images
	$(BIN)/python tools/draw_rooms.py
	$(BIN)/python tools/generate_benchmarks.py
	$(BIN)/python tools/run_notebooks.py
	$(BIN)/amuros sweep samples/bodas-test-advanced.amxmi --sweep Message_Factor.period=5ms,10ms,20ms \
		--sweep Control_Function.offset=0ms..400us/200us --picture factor-to-output.max_reduced_reaction_time=docs/images/sweep-map.svg
	$(BIN)/amuros simulate samples/bodas-test-advanced.yaml --gantt docs/images/simulation-gantt.svg --chain factor-to-output

# Measures, and writes docs/benchmarks.md; takes some minutes.
bench: $(READY)
	$(INSTALL) --editable '.[bench]'
	$(BIN)/python tools/generate_benchmarks.py --measure

# The pages are Markdown; their examples are executed and their output is compared.
docs: $(READY)
	$(BIN)/python -m pytest tests/test_docs.py

# The same pages as a site, in build/site.
site: $(READY)
	$(INSTALL) --editable '.[docs]'
	$(BIN)/python -m mkdocs build --strict

# What is published: the source distribution and the wheel.
wheel: $(READY)
	$(BIN)/python -m hatchling build --directory $(DIST)

# What builds the package is installed first, so that pip makes no environment of its own for that.
$(READY): pyproject.toml
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or newer is needed, set PYTHON=...")'
	$(PYTHON) -m venv $(VENV)
	$(INSTALL) --upgrade pip hatchling editables
	$(INSTALL) --no-build-isolation --editable '.[dev]'
	@touch $@

clean:
	rm -rf $(VENV) build dist .mypy_cache .pytest_cache .ruff_cache .hypothesis
