# `make demo` and `make test` need nothing but Python 3.11 or newer.

PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
READY := $(VENV)/.ready

.PHONY: demo test check gen bench docs clean

demo: $(READY)
	$(BIN)/amuros info --schema samples/executor.amxmi
	$(BIN)/amuros fmt --check samples/executor.amxmi
	@mkdir -p build
	sed 's/value="20" unit="ms"/value="10" unit="ms"/' samples/executor.amxmi > build/faster.amxmi
	$(BIN)/amuros diff samples/executor.amxmi build/faster.amxmi || true

test: $(READY)
	$(BIN)/python -m pytest

check: $(READY)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

# Everything that is generated and committed.
gen: $(READY)
	$(BIN)/python tools/generate_metamodel.py
	$(BIN)/python tools/generate_schemas.py
	$(BIN)/python samples/executor.py samples/executor.amxmi
	$(BIN)/python tools/draw_terminal.py docs/images/info.svg info executor.amxmi

bench: $(READY)
	$(BIN)/python -m pip install --quiet --editable '.[bench]'
	$(BIN)/python benchmarks/load_save.py

# The pages are Markdown; their examples are executed and their output is compared.
docs: $(READY)
	$(BIN)/python -m pytest tests/test_docs.py

$(READY): pyproject.toml
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or newer is needed, set PYTHON=...")'
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade pip
	$(BIN)/python -m pip install --quiet --editable '.[dev]'
	@touch $@

clean:
	rm -rf $(VENV) build dist .mypy_cache .pytest_cache .ruff_cache .hypothesis
