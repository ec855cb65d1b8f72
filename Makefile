# make run: the viewer on a Cornell box.  make test: every test.  make quick: those under a minute.
# make check: format, lint, types.  make seeds: the statistical tests under 20 other seeds.
# make accuracy: measures and writes ACCURACY.md.  make peers: compares with Mitsuba, likewise.  make clean.
# make doctor-table: which bugs of the zoo the doctor names, into DOCTOR.md.
# make picture-table: which of them a picture alone tells, into DOCTOR.md.
# make false-alarms: how often it finds something in right traces, into DOCTOR.md.
# make lessons: the lessons as web pages, into .lessons/ (OPTIONS=--no-solutions leaves those out).
# make bench: measures and writes BENCHMARKS.md.  make race: the part of it with Mitsuba.

PYTHON ?= python3
RUN := .venv/bin/python -m
# Workers take whole files, in the order of tests/conftest.py.
FILES := --dist loadfile --no-loadscope-reorder

# Old pip takes the first for the build too, new pip the second.
export PIP_CONSTRAINT := constraints.txt
export PIP_BUILD_CONSTRAINT := constraints.txt
export PIP_DISABLE_PIP_VERSION_CHECK := 1
export PYTHON
# Each test starts programs, and each of them would compile castray again.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: run test quick check format seeds accuracy peers lessons bench race doctor-table picture-table false-alarms clean system

run: .venv/.run
	$(RUN) viewer.cli view cornell_unit

test: .venv/.dev system
	@# Those that hold a clock run by themselves (5: there are none).
	$(RUN) pytest -m timed || [ $$? -eq 5 ]
	@# Three on two cores: tests of the browser and of commands wait a good part of their time.
	$(RUN) pytest -n 3 $(FILES) -m "not timed"

quick: .venv/.dev
	$(RUN) pytest -n 2 $(FILES) -m "not slow and not browser and not timed"

check: .venv/.dev
	$(RUN) ruff format --check .
	$(RUN) ruff check .
	$(RUN) mypy

format: .venv/.dev
	$(RUN) ruff format .
	$(RUN) ruff check --fix .

seeds: .venv/.dev
	.venv/bin/python tests/seeds.py

# Half an hour on two cores; may be stopped and goes on where it was. `make test` does one percent of it.
accuracy: .venv/.dev
	.venv/bin/python tests/accuracy.py

# A quarter of an hour on two cores; may be stopped and goes on where it was.
doctor-table: .venv/.dev
	.venv/bin/python tests/doctor_table.py

# Some minutes; may be stopped and goes on where it was.
picture-table: .venv/.dev
	.venv/bin/python tests/picture_table.py

# How often the doctor finds something in right traces. An hour on two cores; may be stopped and goes on where it was.
false-alarms: .venv/.dev
	.venv/bin/python tests/false_alarms.py

# The same scenes by castray and by Mitsuba 3. Half an hour; may be stopped and goes on where it was.
peers: .venv/.peers
	.venv/bin/python tests/peers.py

# A minute or two. They open without a network, for teachers to host.
lessons: .venv/.run
	$(RUN) viewer.cli lesson --site .lessons $(OPTIONS)

# A quarter of an hour on an idle machine; sections measured at this commit are not measured again.
bench: .venv/.dev
	.venv/bin/python tests/bench.py

# The same long; may be stopped and goes on where it was.
race: .venv/.peers
	.venv/bin/python tests/race.py

clean:
	rm -rf .venv .lessons build dist .pytest_cache .mypy_cache .ruff_cache .hypothesis
	find tracer viewer lessons scenes tests -name __pycache__ -prune -exec rm -rf {} +

# Without these parts the tests that need them skip and say so; under CI nothing may be missing.
system:
	.ci/system chromium g++ fonts || [ "$$CI" != true ]

.venv/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "castray needs Python 3.11 or newer; try make PYTHON=python3.12")'
	@.ci/system venv
	$(PYTHON) -m venv --clear .venv

.venv/.run: pyproject.toml constraints.txt | .venv/bin/python
	@echo "The first time about 200 MB are downloaded into .venv: a minute or two."
	$(RUN) pip install -q -e .
	@touch $@

.venv/.dev: pyproject.toml constraints.txt | .venv/bin/python
	$(RUN) pip install -q -e '.[dev]'
	@touch $@ .venv/.run

.venv/.peers: .venv/.dev
	$(RUN) pip install -q -e '.[dev,peers]'
	@touch $@
