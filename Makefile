# Everything happens in .venv, made from the locks; nothing has to be installed by hand
# but Python 3.11. Figures and answers are to be the same everywhere, so the hashes are checked.
HOST ?= 127.0.0.1
PORT ?= 8000
PYTHON ?= python3.11

BIN := .venv/bin
# What is compiled is compiled again when it changes.
COMPILED := src/mdr_core/history/walk.py src/mdr_core/history/walk.pxd src/mdr_core/history/slots.pxd
PIP := $(BIN)/python -m pip --disable-pip-version-check --quiet

# More BLAS threads than cores wait for each other and make small products slower, not faster.
export OPENBLAS_NUM_THREADS := 1

.PHONY: run test random check bench costs rates faults sweeps charts figures openapi image-check lock clean
.DELETE_ON_ERROR:

# `exec` makes the service itself the child of make, so that a signal to make reaches it.
run: .venv/runtime
	@exec $(BIN)/python -m mdr_command serve --host $(HOST) --port $(PORT)

test: .venv/development
	$(BIN)/python -m pytest

check: .venv/development
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/python -m mdr_command openapi | diff openapi.json -

bench: .venv/development
	$(BIN)/python benchmarks/ratios.py

# What nobody thought of: scenes against mpmath, and queries of any sort. A quarter of an hour.
random: .venv/development
	$(BIN)/python -m tests.core.random_scenes
	$(BIN)/python -m tests.faults.random_queries

# Full-size figures of sweeps, for a machine that does nothing else: some minutes.
sweeps: .venv/development
	$(BIN)/python benchmarks/sweep_ratio.py
	$(BIN)/python benchmarks/sweep_memory.py
	$(BIN)/python benchmarks/sweep_scaling.py
	$(BIN)/python docs/figures/sweep_map.py

# The charts of docs/accuracy.md: every one by `make charts`, one alone by `make chart-NAME`.
CHARTS := pressure traction pareto hertz_contact partial_slip history wear_evolution scaling wire stability routes
charts:
	for name in $(CHARTS); do $(MAKE) --no-print-directory chart-$$name || exit 1; done

chart-%: .venv-bench/peers
	PYTHONPATH=.:benchmarks .venv-bench/bin/python benchmarks/charts/$*.py

# Its curves are those of the tests, which have no peers.
chart-stability: .venv/development
	PYTHONPATH=.:benchmarks $(BIN)/python benchmarks/charts/stability.py

# What queries cost: how far the estimates are off, and the rates of this machine in their place.
costs: .venv/development
	$(BIN)/python benchmarks/cost_bank.py

rates: .venv/development
	$(BIN)/python benchmarks/cost_bank.py --write

# What the service stands, over real sockets of this machine: a quarter of an hour.
faults: .venv/development
	$(BIN)/python -m pytest tests/faults tests/service/test_compute.py
	$(BIN)/python -m tests.faults.campaign

figures: .venv/development
	$(BIN)/python docs/figures/make_figures.py

openapi: .venv/development
	$(BIN)/python -m mdr_command openapi > openapi.json

# Needs root: it builds the image on a Debian base of its own making, runs, asks and stops it.
image-check:
	$(PYTHON) image/check.py

# Needs uv on the path; only for those who change a dependency.
LOCK := uv pip compile --quiet --generate-hashes --no-header --no-annotate --no-emit-index-url \
	--python-version 3.11 --universal pyproject.toml
lock:
	$(LOCK) --extra build --output-file requirements.lock
	$(LOCK) --extra build --extra sweep --output-file requirements-sweep.lock
	$(LOCK) --all-extras --output-file requirements-dev.lock
	$(LOCK) --extra build requirements-bench.in --output-file requirements-bench.lock

clean:
	rm -rf .venv .venv-bench build dist src/*.egg-info src/mdr_core/history/*.so .mypy_cache .pytest_cache .ruff_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

.venv/bin/python:
	$(PYTHON) -m venv .venv

# The project goes in without build isolation: its build tool is in the lock like all else.
.venv/runtime: requirements.lock pyproject.toml setup.py $(COMPILED) | .venv/bin/python
	$(PIP) install --require-hashes --requirement requirements.lock
	$(PIP) install --no-deps --no-build-isolation --editable .
	touch $@

.venv/development: requirements-dev.lock .venv/runtime
	$(PIP) install --require-hashes --requirement requirements-dev.lock
	touch $@

# The peers live apart, with the project beside them, so that one process can time both in turn.
# PyAbel and openAbel are compiled here, against the NumPy and Cython of the lock.
PEERS := .venv-bench/bin/python -m pip --disable-pip-version-check --quiet install
.venv-bench/peers: requirements.lock requirements-bench.lock requirements-bench-openabel.lock setup.py $(COMPILED)
	$(PYTHON) -m venv .venv-bench
	$(PEERS) --require-hashes --requirement requirements.lock
	$(PEERS) --require-hashes --no-build-isolation --requirement requirements-bench.lock
	$(PEERS) --require-hashes --no-build-isolation --no-deps --ignore-requires-python \
		--requirement requirements-bench-openabel.lock
	$(PEERS) --no-deps --no-build-isolation --editable .
	touch $@
