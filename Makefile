# make bench   set up what is missing, then measure the default suite
# make test    set up what is missing, then run the tests that take little time; with ALL=1 the slow ones too,
#              with ALL=nightly every one
# make site    make a website in site of the newest run; of another with RUN=FOLDER
# make setup   virtual environment in .venv, packages, GL driver, shader compilers
# make lint    ruff and the type checker; with ALL=nightly it checks for Windows and macOS too

PYTHON ?= python3
BIN = .venv/bin
# Modules are compiled once, not by each of the many processes that tests start, whatever the shell says.
export PYTHONDONTWRITEBYTECODE =

RUN ?= $(lastword $(sort $(wildcard results/*/run.json)))

.PHONY: bench test site setup lint say-bench say-test

bench: say-bench .venv/ready
	$(BIN)/normalbench run

# Twice as many as two cores: a test that waits for a command, a file or a browser leaves its core to another.
test: say-test .venv/tests
	$(BIN)/python -m pytest -n 4 $(if $(ALL),--tier $(if $(filter nightly,$(ALL)),nightly,slow))

site: .venv/ready
	@test -n "$(RUN)" || { echo "there is no run in results; make bench measures one" >&2; exit 1; }
	$(BIN)/normalbench site $(RUN:/run.json=)

setup: .venv/tests

lint: .venv/tests
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	for system in Linux $(if $(filter nightly,$(ALL)),Windows Darwin); do $(BIN)/basedpyright --pythonplatform $$system || exit 1; done

# A stamp is younger than what it was made from, so that a second call installs nothing.
.venv/ready: pyproject.toml .ci/constraints.txt
	@.ci/setup bench $(PYTHON)
	@touch $@

.venv/tests: .venv/ready
	@.ci/setup tests $(PYTHON)
	@touch $@

# Said first, whatever is to be set up.
say-bench:
	@echo "make bench: sets up what is missing, then measures the default suite into results: about five minutes, 100 MB"
say-test:
	@echo "make test: sets up what is missing, then runs the tests: $(if $(ALL),$(if $(filter nightly,$(ALL)),about an hour,about 16 minutes),about 3 minutes) on two cores"
