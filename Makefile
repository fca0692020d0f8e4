# make run    walk an avatar through a scene in the browser      make test   lint, types, all tests
# make env    .venv with the `elbowroom` command                 make docs   pages and API reference, in site/
# make clean  forget .venv, the built client and site/             make fuzz   damaged files for every reader
# make pictures  those of README and docs again                 make strangers  other programs read what we export
SHELL := /bin/sh
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/kernels $(VENV)/page
# Most of what comes along is never imported; bytecode of the rest is made, and kept, when it first is.
PIP_INSTALL := $(BIN)/python -m pip install --no-compile
PYTHON ?= $(shell for p in python3.14 python3.13 python3.12 python3.11 python3; do \
	"$$p" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && command -v "$$p" && break; done)
WEB_SOURCES := $(shell find web -name node_modules -prune -o -type f -print 2>/dev/null)
export PIP_DISABLE_PIP_VERSION_CHECK := 1
# Bytecode that is not kept makes every start two to four times slower.
unexport PYTHONDONTWRITEBYTECODE

.DEFAULT_GOAL := help
.PHONY: help env run test test-long lint types unit web-test browser browser-tools docs fuzz pictures strangers clean format

help:
	@sed -n '1,4s/^# //p' Makefile

run: env
	@$(BIN)/elbowroom play $(ARGS)

# Kernels keep processors busy, the page mostly waits for a registry: so the two are made side by side.
env: $(VENV)/library
	@$(MAKE) --no-print-directory --jobs 2 $(READY)

$(VENV)/made:
	@test -n "$(PYTHON)" || { echo "Elbowroom needs Python 3.11 or newer: sudo apt install python3 python3-venv"; exit 1; }
	@echo "==> Making $(VENV) with $(PYTHON)"
	@"$(PYTHON)" -m venv $(VENV) || { rm -rf $(VENV); echo "Python has no venv module: sudo apt install python3-venv"; exit 1; }
	@$(PIP_INSTALL) --quiet --upgrade pip
	@touch $@

$(VENV)/library: $(VENV)/made pyproject.toml hatch_build.py
	@echo "==> Installing Elbowroom"
	@ELBOWROOM_SKIP_CLIENT=1 $(PIP_INSTALL) --editable .
	@$(BIN)/python -m compileall -q src
	@touch $@

$(VENV)/page: $(VENV)/library $(WEB_SOURCES)
	@echo "==> Building its page"
	@$(BIN)/python -m pip wheel --quiet --no-deps --wheel-dir $(VENV)/wheel .
	@rm -r $(VENV)/wheel
	@touch $@

$(VENV)/kernels: $(VENV)/library
	@echo "==> Compiling its kernels (some three minutes the first time)"
	@$(BIN)/elbowroom compile
	@touch $@

$(VENV)/developer: $(VENV)/library
	@echo "==> Installing the tools for tests"
	@$(PIP_INSTALL) --quiet --group dev
	@touch $@

# What keeps processors busy, or waits for a registry, goes side by side. Tests fill both processors by themselves: with
# those in a browser beside them all take half as long again.
test: $(VENV)/library
	@$(MAKE) --no-print-directory --jobs 3 --output-sync=target $(READY) lint web-test browser-tools
	@$(MAKE) --no-print-directory unit
	@$(MAKE) --no-print-directory --jobs 2 browser types
	@echo "==> All tests passed"

lint: $(VENV)/developer
	@echo "==> Lint"
	@$(BIN)/ruff check .
	@$(BIN)/ruff format --check .

types: $(VENV)/developer
	@echo "==> Types"
	@$(BIN)/mypy

unit: $(READY) $(VENV)/developer
	@echo "==> Tests"
	@$(BIN)/python -m pytest --ignore tests/browser -m "not long" -n 3 --dist loadfile $(ARGS)

test-long: $(READY) $(VENV)/developer
	@echo "==> Long walks"
	@$(BIN)/python -m pytest -m long -n 2 --dist loadfile $(ARGS)

fuzz: $(READY) $(VENV)/developer
	@echo "==> Damaged files for every reader, each reader in a bounded process of its own"
	@$(BIN)/python tools/fuzz_readers.py $(ARGS)

web-test: $(VENV)/developer
	@echo "==> Tests of the page's modules"
	@$(BIN)/python hatch_build.py ci --no-audit --no-fund --loglevel=error
	@$(BIN)/python hatch_build.py test

browser-tools: $(VENV)/developer
	@sh tools/install_browser.sh
	@sh tools/install_judges.sh $(BIN)/python

browser: browser-tools $(READY)
	@echo "==> Tests in a real browser"
	@$(BIN)/python -m pytest tests/browser -m "not long" -n 2 --dist worksteal $(ARGS)

docs: $(VENV)/developer
	@echo "==> Pages in site/index.html"
	@$(BIN)/python -m mkdocs build --strict --quiet

pictures: $(READY) $(VENV)/developer
	@echo "==> Pictures of README and docs (some minutes)"
	@sh tools/install_browser.sh
	@$(BIN)/python tools/make_pictures.py
	@$(BIN)/python tools/make_planner_pictures.py
	@$(BIN)/python tools/make_ground_pictures.py
	@$(BIN)/elbowroom bench plan --plots docs/images
	@$(BIN)/elbowroom tour d --targets 8 --seed 2 --no-judge --quiet --plan docs/images/tour.png
	@if test -n "$(AVATARS)"; then $(BIN)/elbowroom inspect --quiet --pose-sheet docs/images/pose-sheet.png $(AVATARS); \
	else echo "pose-sheet.png stays as it is: name its avatars, make pictures AVATARS='a.vrm b.glb'"; fi
	@if test -n "$(HOUSE)"; then $(BIN)/elbowroom inspect --quiet --drop 'IfcDoor_*' --plan docs/images/floors.png $(HOUSE); \
	else echo "floors.png stays as it is: name its house, make pictures HOUSE=AC14-FZK-Haus.glb"; fi
	@if test -n "$(WALKS)"; then $(BIN)/python tools/make_walks_pictures.py $(WALKS); \
	else echo "walks.png stays as it is: name a dataset, make pictures WALKS=walks"; fi

strangers: browser-tools $(READY)
	@echo "==> Other programs read what we export (some minutes, and 1 GB the first time)"
	@$(BIN)/python hatch_build.py ci --no-audit --no-fund --loglevel=error
	@$(BIN)/python tools/strangers $(ARGS)

format: $(VENV)/developer
	@$(BIN)/ruff check --fix .
	@$(BIN)/ruff format .

clean:
	rm -rf $(VENV) src/elbowroom/client web/node_modules dist site
