# make run and make test need Python >= 3.11 and make, nothing else. Set-up is a no-op once done.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
RUNS := $(VENV)/.runs
STAMP := $(VENV)/.set-up
PIP := $(BIN)/python -m pip install --quiet --disable-pip-version-check --constraint constraints.txt

.PHONY: setup run reproduce test bounds fuzz attack lint types bench docs scatter-study products-study where-a-sink-wins examples validation clean

setup: $(STAMP)

$(RUNS): pyproject.toml constraints.txt
	@$(PYTHON) -c 'import sys; sys.exit("Python 3.11 or newer is needed, this is " + sys.version.split()[0]) if sys.version_info < (3, 11) else None'
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(PIP) --editable '.[app]'
	touch $@

# what tests, lint and documentation need as well
$(STAMP): $(RUNS)
	$(PIP) --editable '.[dev,docs,app,cluster,pdf,uq]'
	touch $@

run: $(RUNS)
	$(BIN)/frahm run jacket-pipe --out out/jacket-pipe

reproduce: $(RUNS)
	$(BIN)/frahm reproduce --out out/reproduce

test: setup
	$(BIN)/frahm warmup  # once, so that all processes of the tests find the same kernels
	$(BIN)/python -m pytest -n 2 --dist worksteal

bounds:
	$(PYTHON) .ci/bounds

fuzz: setup
	$(BIN)/python -m pytest -n 2 --dist worksteal -m hypothesis --hypothesis-profile search

attack: setup
	$(BIN)/python tests/attack/run.py
	cp out/attack/attack.md docs/attack.inc

lint: setup
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/lint-imports

types: setup
	$(BIN)/mypy

bench: setup
	$(BIN)/python -m pytest benchmarks -q --benchmark-only --benchmark-timer=time.process_time

docs: setup
	$(BIN)/sphinx-build -W --keep-going -q -b html docs docs/_build/html
	@echo "docs/_build/html/index.html"

scatter-study: setup
	$(BIN)/python examples/scatter_study.py $(SCATTER)

products-study: setup
	$(BIN)/python examples/products_study.py docs/examples

where-a-sink-wins: setup
	$(BIN)/python examples/where_a_sink_wins.py

examples: setup
	for name in elastic_fatigue design_a_sink; do \
	  $(BIN)/python examples/$$name.py docs/examples > docs/examples/$$name.txt || exit 1; done

validation: setup
	$(BIN)/python -m pytest -n 2 --dist worksteal tests/literature
	cp out/validation.json docs/validation.json

clean:
	rm -rf $(VENV) .bounds out docs/_build docs/_generated .mypy_cache .pytest_cache .ruff_cache .import_linter_cache
