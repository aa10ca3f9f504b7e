# `make demo` bakes the procedural character; `make test` checks everything, `make package` packs what
# Unity installs, `make docs` builds the site, `make mutants` tries the tests. Each sets up what it needs.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
DEMO := build/demo
# Tests run in random order, by so many processes; each takes up to 2 GB.
WORKERS ?= 2
BIOME := tests/web/node_modules/.bin/biome
PYTEST := $(BIN)/pytest --numprocesses $(WORKERS) --dist worksteal

.PHONY: demo test test-long test-web test-files test-wheel gallery mutants docs check package npm wheel setup clean

# A quarter of the preset's frames: a first picture soon.
demo: $(VENV)/.demo
	$(BIN)/mua-bake --preset tiny --frames 60 -o $(DEMO)/avatar.muaavatar
	$(BIN)/mua-inspect --verify $(DEMO)/avatar.muaavatar

test: setup check
	$(PYTEST)

test-long: setup
	$(PYTEST) -m long -o faulthandler_timeout=0

# The browser player in a headless browser with WebGPU on the CPU. Tests skip and name what is missing.
test-web: setup
	sh tools/setup_web.sh
	$(PYTEST) -m web

# 100,000 avatars that nobody wrote, plain and packed ones, through the readers in Python, C# and JavaScript.
test-files: setup
	$(PYTEST) -m long -o faulthandler_timeout=0 -k mutants -rP tests/unity/test_mutants.py

# The wheel in an empty environment, its commands without a compiler; downloads about 1 GB.
test-wheel: setup demo
	$(BIN)/python tools/check_wheel.py

# The characters of tools/gallery.toml, from a folder: GALLERY=folder make gallery; GALLERY_FLAGS=--bake bakes them too.
gallery: setup
	@test -n "$(GALLERY)" || { echo "GALLERY=folder make gallery: the folder with the files of tools/gallery.toml" >&2; exit 1; }
	$(BIN)/python tools/gallery.py $(GALLERY) $(GALLERY_FLAGS)

# Faults in the modules of one room of the package, by mutmut, each against the tests of that room: ROOM=pose make mutants
ROOM ?= pose
mutants: setup
	cd python && PYTEST_ADDOPTS="-n0 -p no:randomly ../../tests/$(ROOM)" ../$(BIN)/mutmut run "mua.$(ROOM).*"

# Guides and the reference of the Python names: build/site/index.html. The variable spares Material's word on its successor.
docs: $(VENV)/.docs
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --strict

$(VENV)/.docs: $(VENV)/.demo
	$(BIN)/python -m pip install -q -e "./python[docs]"
	touch $@

check: setup
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/python tools/gen_layout.py --check
	$(BIN)/python tools/gen_golden.py --check
	$(BIN)/python tools/gen_spirv.py --check
	$(BIN)/python tools/gen_wgsl.py --check
	$(BIN)/python tools/gen_kernel_table.py --check
	$(BIN)/python tools/gen_expression_names.py --check
	$(BIN)/python tools/gen_joint_words.py --check
	$(BIN)/python tools/gen_meta.py --check
	$(BIN)/python tools/lint_upm.py
	$(BIN)/python tools/pack_upm.py --check
	@if command -v node >/dev/null && test -x $(BIOME); then $(BIOME) ci --error-on-warnings; \
	else echo "JavaScript is not checked: it needs Node and npm ci --prefix tests/web"; fi

# With nothing but Python.
package:
	$(PYTHON) tools/pack_upm.py

# The browser player as build/mua-player-*.tgz; needs Node and npm.
npm: setup
	npm ci --no-audit --no-fund --prefix tests/web
	$(BIN)/python tools/pack_npm.py

wheel: setup
	rm -rf python/build  # what an older checkout had would go in too
	$(BIN)/python -m pip wheel -q --no-deps -w build ./python

setup: $(VENV)/.installed

$(VENV)/.demo: python/pyproject.toml tools/setup.sh
	PYTHON=$(PYTHON) sh tools/setup.sh $(VENV) demo
	touch $@

$(VENV)/.installed: python/pyproject.toml python/research/pyproject.toml tools/setup.sh
	PYTHON=$(PYTHON) sh tools/setup.sh $(VENV) test
	touch $(VENV)/.demo $@

clean:
	rm -rf build
