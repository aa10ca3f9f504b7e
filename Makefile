# `make demo` bakes the procedural character; `make test` checks everything, `make package` packs what
# Unity installs. All set up what they need.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
DEMO := build/demo

.PHONY: demo test test-long check package setup clean

demo: setup
	$(BIN)/mua-bake --preset tiny -o $(DEMO)/avatar.muaavatar
	$(BIN)/mua-inspect --verify $(DEMO)/avatar.muaavatar

test: setup check
	$(BIN)/pytest

test-long: setup
	$(BIN)/pytest -m long

check: setup
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/python tools/gen_layout.py --check
	$(BIN)/python tools/gen_golden.py --check
	$(BIN)/python tools/gen_kernel_table.py --check
	$(BIN)/python tools/gen_meta.py --check
	$(BIN)/python tools/lint_upm.py
	$(BIN)/python tools/pack_upm.py --check

package: setup
	$(BIN)/python tools/pack_upm.py

setup: $(VENV)/.installed

$(VENV)/.installed: python/pyproject.toml tools/setup.sh
	PYTHON=$(PYTHON) sh tools/setup.sh $(VENV)
	touch $@

clean:
	rm -rf build
