# Every target but the charts runs in .venv, made from the locks by the first supported Python that is found (or
# PYTHON=). Hashes are checked: the same packages, and results that agree to rounding error, on every machine.
HOST ?= 127.0.0.1
PORT ?= 8000
PYTHONS := python3.11 python3.12 python3.13 python3.14
# A name on the path may be a shim of a Python that is not selected, or lack the module venv: try it.
PYTHON ?= $(shell for python in $(PYTHONS); do \
	$$python -c 'import ensurepip, venv' 2>/dev/null && echo $$python && break; done)

BIN := .venv/bin
# Sources of the compiled module.
COMPILED := src/mdr_core/history/slip_kernel.py src/mdr_core/history/slip_kernel.pxd
PIP := $(BIN)/python -m pip --disable-pip-version-check --quiet

# More BLAS threads than cores wait for each other and make small products slower, not faster.
export OPENBLAS_NUM_THREADS := 1
# Without bytecode, each of the hundred processes that the tests start would compile every module.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: run test test-portable test-packages test-all random fuzz check bench bench-gate faults pages sweeps charts figures openapi verification docs dist sbom lock clean
.DELETE_ON_ERROR:

# `exec` makes the service itself the child of make, so that a signal to make reaches it.
run: .venv/runtime
	@exec $(BIN)/python -m mdr_command serve --host $(HOST) --port $(PORT)

# Two tiers: every guard of correctness, about three minutes on two cores; and the long tier, with
# processes, the browser, killed sweeps and regenerated references.
test: .venv/development
	$(BIN)/python -m pytest --numprocesses logical --dist worksteal -m "not long"

test-all: test
	$(BIN)/python -m pytest --numprocesses logical --dist worksteal -m "long and not alone"
	$(BIN)/python -m pytest -m alone

# The fast tests of numbers as on a processor without wide vector units, for NumPy, glibc and OpenBLAS alike, with the
# loop of load histories as Python text. Names that do not apply to a processor have no effect.
NUMBERS := tests/core tests/stability $(addprefix tests/contract/test_,example_answers.py gallery.py readme.py \
	subsurface.py)
UNITS := import numpy; print(*numpy.show_config("dicts").get("SIMD Extensions", {}).get("found", []))
test-portable: .venv/development
	rm -rf build/plain && mkdir -p build && cp -R src build/plain && rm -f build/plain/mdr_core/history/*.so
	PORTABLE_RUN=1 MDR_PLAIN=1 PYTHONPATH=build/plain \
	OPENBLAS_CORETYPE=Nehalem GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA \
	NPY_DISABLE_CPU_FEATURES="$$($(BIN)/python -c '$(UNITS)')" \
	$(BIN)/python -m pytest --numprocesses logical --dist worksteal -m "not long" $(NUMBERS)

# The fast tests with the lowest and with the newest packages of the ranges, on the oldest and the newest Python that uv
# finds or fetches: ten minutes. Warnings of deprecated names are errors.
OLDEST := 3.11
NEWEST := 3.14
test-packages: build/uv/bin/uv
	for python in $(OLDEST) $(NEWEST); do for packages in lowest-direct highest; do \
		folder=build/packages/$$python-$$packages; echo "$$folder" && \
		$< venv --quiet --clear --python $$python $$folder && \
		$< pip install --quiet --python $$folder/bin/python --resolution $$packages --editable '.[dev]' && \
		PATH="$(CURDIR)/$$folder/bin:$$PATH" $$folder/bin/python -m pytest \
			--numprocesses logical --dist worksteal -m "not long" || exit 1; \
	done; done

build/uv/bin/uv:
	$(PYTHON) -m venv build/uv
	build/uv/bin/python -m pip --disable-pip-version-check --quiet install uv

check: .venv/development
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/lint-imports --no-cache
	$(BIN)/hadolint Dockerfile
	$(BIN)/python -m mdr_command openapi | diff openapi.json -

# Ordinary engineering queries, each result checked against physical laws: 100,000 take half an hour on one core.
FUZZ ?= --queries 100000
fuzz: .venv/development
	$(BIN)/python -m tests.fuzz.campaign $(FUZZ)

bench: .venv/development
	$(BIN)/python benchmarks/ratios.py

# Fails where a ratio misses its bound by a factor of three: half a minute.
bench-gate: .venv/development
	$(BIN)/python benchmarks/ratios.py --gate

# Random contacts against mpmath: ten minutes.
random: .venv/development
	$(BIN)/python -m tests.core.random_cases

# Figures of sweeps at full size, on a machine without other load: some minutes.
sweeps: .venv/development
	$(BIN)/python benchmarks/sweep_ratio.py
	$(BIN)/python benchmarks/sweep_memory.py
	$(BIN)/python benchmarks/sweep_scaling.py
	$(BIN)/python docs/figures/sweep_map.py

# The charts of docs/accuracy.md: every one by `make charts`, one alone by `make chart-NAME`.
CHARTS := pressure traction pareto hertz_contact partial_slip history contact_laws wear_evolution scaling wire stability calibration \
	tables layers summary
charts:
	for name in $(CHARTS); do $(MAKE) --no-print-directory chart-$$name || exit 1; done

chart-%: .venv-bench/peers
	PYTHONPATH=.:benchmarks OMP_NUM_THREADS=1 .venv-bench/bin/python benchmarks/charts/$*.py

# Need no reference codes: the references are in the tests and in the files of other charts.
chart-stability chart-calibration chart-tables chart-layers chart-summary: .venv/development
	PYTHONPATH=.:benchmarks $(BIN)/python benchmarks/charts/$(@:chart-%=%).py

# Figures of the service under load and attack, over loopback: half an hour of a quiet machine.
faults: .venv/development
	$(BIN)/python -m pytest tests/faults tests/service/test_workers.py
	$(BIN)/python -m tests.faults.campaign

# Figures of the explorer in Chromium, on a machine without other load: a minute.
pages: .venv/development
	PYTHONPATH=. $(BIN)/python benchmarks/explorer.py

figures: .venv/development
	$(BIN)/python docs/figures/make_figures.py
	$(BIN)/python docs/figures/beneath.py
	$(BIN)/python docs/figures/gallery.py
	PYTHONPATH=. $(BIN)/python docs/figures/explorer_page.py

# Published cases, each sent to the service; fails if one misses its bound.
verification: .venv/development
	$(BIN)/python -m verification docs/verification.md

# The manual, which the service of this .venv then serves at /manual.
docs: .venv/development
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --site-dir .venv/share/mdr/manual

openapi: .venv/development
	$(BIN)/python -m mdr_command openapi > openapi.json
	$(BIN)/python -m tests.contract.page_quantities < openapi.json > src/mdr_service/explorer/quantities.js

# The source distribution, a wheel for this Python, and one of Python text alone for the others, each
# built from the unpacked source distribution: a folder that has been built in may hold old modules.
# Their files have the time of the commit, so that the same commit gives the same bytes.
dist: export SOURCE_DATE_EPOCH ?= $(shell git log -1 --format=%ct)
dist: .venv/development
	$(BIN)/python -m build --no-isolation
	MDR_PLAIN=1 $(BIN)/python -m build --no-isolation

# The packages of the service with their versions and hashes, as CycloneDX.
sbom: build/sbom/bin/cyclonedx-py
	mkdir -p dist
	$< requirements requirements.lock --pyproject pyproject.toml --output-reproducible -o dist/mdr.cdx.json

build/sbom/bin/cyclonedx-py:
	$(PYTHON) -m venv build/sbom
	build/sbom/bin/python -m pip --disable-pip-version-check --quiet install cyclonedx-bom

# Needs uv on the path, and only after a dependency has changed.
LOCK := uv pip compile --quiet --generate-hashes --no-header --no-annotate --no-emit-index-url \
	--python-version 3.11 --universal pyproject.toml
lock:
	$(LOCK) --extra build --extra service --output-file requirements.lock
	$(LOCK) --extra build --extra sweep --output-file requirements-sweep.lock
	$(LOCK) --extra docs --output-file requirements-docs.lock
	$(LOCK) --all-extras --output-file requirements-dev.lock
	$(LOCK) --extra build --extra service requirements-bench.in --output-file requirements-bench.lock

clean:
	rm -rf .venv .venv-bench build dist src/*.egg-info src/mdr_core/history/*.so .mypy_cache .pytest_cache .ruff_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

.venv/bin/python:
	@test -n "$(PYTHON)" || { echo "MDR needs one of $(PYTHONS), with the module venv; none is on the path." >&2; exit 1; }
	$(PYTHON) -m venv .venv

# Without build isolation, because the build tools are locked too.
.venv/runtime: requirements.lock pyproject.toml setup.py $(COMPILED) | .venv/bin/python
	$(PIP) install --require-hashes --requirement requirements.lock
	$(PIP) install --no-deps --no-build-isolation --editable .
	touch $@

.venv/development: requirements-dev.lock .venv/runtime
	$(PIP) install --require-hashes --requirement requirements-dev.lock
	touch $@

# Reference codes have an environment of their own that contains the project as well, so that one
# process times both in turn.
# PyAbel, openAbel and ASPHER are compiled here, against the NumPy and Cython of the lock.
PEERS := .venv-bench/bin/python -m pip --disable-pip-version-check --quiet install
.venv-bench/peers: requirements.lock $(wildcard requirements-bench*.lock) setup.py $(COMPILED)
	$(PYTHON) -m venv .venv-bench
	$(PEERS) --require-hashes --requirement requirements.lock
	$(PEERS) --require-hashes --no-build-isolation --requirement requirements-bench.lock
	$(PEERS) --require-hashes --no-build-isolation --no-deps --ignore-requires-python \
		--requirement requirements-bench-openabel.lock
	$(PEERS) --require-hashes --no-build-isolation --no-deps --requirement requirements-bench-aspher.lock
	$(PEERS) --no-deps --no-build-isolation --editable .
	touch $@
