# Two commands do everything on a fresh machine with Python 3.11+, make and git:
#   make run    sets up and runs the main job
#   make test   sets up and passes all tests
# INSTALLER=pip does without uv; PYTHON=python3.12 chooses the interpreter.

PYTHON ?= python3
INSTALLER ?= uv
VENV := .venv
BIN := $(VENV)/bin
unexport PYTHONDONTWRITEBYTECODE  # start-up is speed: keep compiled modules
PLUGINS := ncsim-wifi ncsim-saga ncsim-routing ncsim-viz
STAMP := $(VENV)/.installed
DEV_STAMP := $(VENV)/.installed-dev
SETUP_INPUTS := pyproject.toml constraints.txt ncsim-core/pyproject.toml $(PLUGINS:%=%/pyproject.toml)
EDITABLE := -e ./ncsim-core[testing] $(PLUGINS:%=-e ./%)

.DEFAULT_GOAL := help
.PHONY: help setup run paper test bench bench-peers check format schemas viewer constraints clean

help:  ## Show what make can do
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 14

setup: $(DEV_STAMP)  ## Make .venv with the five packages and all tools (done by the others when needed)

$(VENV)/.created:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "ncsim needs Python 3.11 or newer; set PYTHON=..., e.g. make PYTHON=python3.12 run"; exit 1; }
	$(PYTHON) -m venv $(VENV)
	touch $@

ifeq ($(INSTALLER),uv)
INSTALL := $(BIN)/uv pip install --quiet --python $(BIN)/python -c constraints.txt
else
INSTALL := $(BIN)/python -m pip install --quiet -c constraints.txt
endif

$(STAMP): $(VENV)/.created $(SETUP_INPUTS)
ifeq ($(INSTALLER),uv)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt uv
else
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --upgrade 'pip>=25.1'
endif
	$(INSTALL) $(EDITABLE)
	touch $@

$(DEV_STAMP): $(STAMP)  # what tests and checks need besides
	$(INSTALL) --group dev
	touch $@

run: $(STAMP)  ## Run the example in Solo and Full, then the paper's 108-run study
	@$(BIN)/python examples/paper/main_job.py

paper: $(DEV_STAMP)  ## Reproduce every workflow table and figure of the paper, row by row
	@$(BIN)/python examples/paper/reproduce.py

test: $(DEV_STAMP)  ## Run all tests, on every core
	$(BIN)/python -m pytest -n auto

bench: $(DEV_STAMP)  ## Measure every target (BENCH=--all: also what takes minutes), table in out/bench.md
	@$(BIN)/python benchmarks/bench.py $(BENCH)

bench-peers: $(DEV_STAMP)  ## Set up the published ncsim and SimGrid for bench to compare with
	@sh benchmarks/peers/setup.sh $(PYTHON)

check: $(DEV_STAMP)  ## Formatting, lint, types, import rules
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports

format: $(DEV_STAMP)  ## Format and mend what can be mended
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .

schemas: $(DEV_STAMP)  ## Write schemas/ anew from the five packages
	NCSIM_PLUGINS=ncsim-core,ncsim-wifi,ncsim-saga,ncsim-routing,ncsim-viz $(BIN)/ncsim schema --write schemas

viewer:  ## Build the viewer from its source, after its own tests (needs Node 20 or newer)
	cd ncsim-viz/frontend && npm ci --silent --no-audit --no-fund && npm run --silent generate && npm test --silent && npm run --silent build

constraints:  ## Pin every dependency anew
	$(BIN)/uv export --quiet --all-packages --all-extras --group dev --no-hashes --no-header \
	  --no-annotate --no-emit-workspace --output-file constraints.txt
	rm -f uv.lock

clean:  ## Remove everything that make has made
	rm -rf $(VENV) out dist .mypy_cache .ruff_cache .pytest_cache .hypothesis .import_linter_cache
