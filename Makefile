# make run   installs what is missing, starts web server and worker, prints the URL
# make test  installs what the tests need, then runs all of them
# make docs  builds docs/ as a site in site/
# make wheel builds what pip installs anywhere, in wheels/

# The first that is new enough and makes virtual environments. A distribution's is compiled with the
# optimisations that pyenv leaves out: the tests take a tenth less time.
PYTHON ?= $(shell for each in /usr/bin/python3 python3.11 python3.12 python3.13 python3; do \
	$$each -c 'import ensurepip, sys; sys.exit(not (3, 11) <= sys.version_info < (3, 14))' 2>/dev/null \
	&& command -v $$each && break; done)
VENV := .venv
BIN := $(VENV)/bin
# Three at a time keep two cores busy while the tests of whole processes wait; a fourth only gets in their
# way. A file's tests share what they set up.
PYTEST_ARGS ?= --numprocesses 3 --dist loadfile
SOURCES := $(wildcard static/src/*.js static/css/*.css) static/build.mjs

# Some shells forbid it; the many processes of the tests would each compile every module anew.
export PYTHONDONTWRITEBYTECODE :=

.PHONY: run test install lint docs wheel
.DEFAULT_GOAL := run

run: install
	@exec $(BIN)/python manage.py quickstart

install: $(VENV)/.installed static/dist/.built

# First with SQLite and the filesystem broker; then, where they are given, what touches the database or
# a broker once more with PostgreSQL and RabbitMQ or Redis.
test: install $(VENV)/.tested lint
	env -u TEST_DATABASE_URL -u TEST_BROKER_URL $(BIN)/python -m pytest $(PYTEST_ARGS)
ifneq ($(TEST_DATABASE_URL)$(TEST_BROKER_URL),)
	$(BIN)/python -m pytest -m "services and not browser" $(PYTEST_ARGS)
else
	@echo "Skipped: PostgreSQL (TEST_DATABASE_URL is not set) and a message broker (TEST_BROKER_URL is not set)."
endif

lint: $(VENV)/.tested
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

# Strict: a link or a heading that is not there, or a page outside the navigation, fails. So does a page that
# would load something from elsewhere.
docs: $(VENV)/.documented
	$(BIN)/mkdocs build --strict --quiet --clean
	@! grep -rEn '<(script|link|img|iframe)[^>]*(src|href)="?(https?:)?//|(@import |url\()["'\'']?(https?:)?//' site --include='*.html' --include='*.css'

wheel: install
	@rm -rf build clients/python/build
	$(BIN)/python -m pip wheel --quiet --disable-pip-version-check --no-deps --wheel-dir wheels . clients/python

$(BIN)/python:
	@test -n "$(PYTHON)" || { echo "There is no Python 3.11 to 3.13 with venv here: install one, or name it: make PYTHON=…"; exit 1; }
	$(PYTHON) -m venv $(VENV)

$(VENV)/.installed: pyproject.toml | $(BIN)/python
	@echo "Installing the workbench into $(VENV): some 1.7 GB with torch, at first for minutes."
	$(BIN)/python -m pip install --disable-pip-version-check --editable .
	@touch $@

$(VENV)/.tested: pyproject.toml | $(VENV)/.installed
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable ".[test]"
	@touch $@

$(VENV)/.documented: pyproject.toml | $(VENV)/.installed
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable ".[docs]"
	@touch $@

static/dist/.built: package.json package-lock.json $(SOURCES) | $(VENV)/.installed
	$(BIN)/python static/build.py
	@touch $@
