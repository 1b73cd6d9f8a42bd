# make bench   set up what is missing, then measure the default suite
# make test    set up what is missing, then run the tests that take little time; with ALL=1 the slow ones too,
#              with ALL=nightly every one
# make slow    the other tests: whole runs and what seldom breaks; .ci/nightly has those that take longest
# make site    make a website in site of the newest run; of another with RUN=FOLDER
# make setup   virtual environment in .venv, packages, GL driver, shader compilers
# make lint    ruff and the type checker, which checks for Linux, Windows and macOS

PYTHON ?= python3
BIN = .venv/bin
# Modules are compiled once, not by each of the many processes that tests start, whatever the shell says.
export PYTHONDONTWRITEBYTECODE =

RUN ?= $(lastword $(sort $(wildcard results/*/run.json)))

.PHONY: bench test slow site setup lint

bench: .venv/ready
	$(BIN)/normalbench run

# Twice as many as two cores: a test that waits for a command, a file or a browser leaves its core to another.
test: .venv/ready
	$(BIN)/python -m pytest -n 4 $(if $(ALL),-m "$(if $(filter nightly,$(ALL)),nightly or not nightly,not nightly)")

slow: .venv/ready
	$(BIN)/python -m pytest -n 4 -m "slow and not nightly"

site: .venv/ready
	@test -n "$(RUN)" || { echo "there is no run in results; make bench measures one" >&2; exit 1; }
	$(BIN)/normalbench site $(RUN:/run.json=)

setup: .venv/ready

lint: .venv/ready
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	for system in Linux Windows Darwin; do $(BIN)/basedpyright --pythonplatform $$system || exit 1; done

# The stamp is younger than what it was made from, so that a second call installs nothing.
.venv/ready: pyproject.toml .ci/constraints.txt
	.ci/prepare-venv $(PYTHON)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --constraint .ci/constraints.txt --editable ".[dev]"
	# Its compiler alone: the package needs torch, and no extra can say --no-deps.
	-$(BIN)/python -m pip install --quiet --disable-pip-version-check --constraint .ci/constraints.txt --no-deps slangtorch
	# Apart, because it is compiled: where there is no C++ compiler the tests of its files are skipped.
	-$(BIN)/python -m pip install --quiet --disable-pip-version-check --constraint .ci/constraints.txt "meshoptimizer>=0.2.30a0"
	.ci/prepare-gl $(BIN)/python
	.ci/prepare-isa $(BIN)/python
	touch $@
