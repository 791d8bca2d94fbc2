# Two commands do everything: `make demo` shows the system at work, `make test` proves it.
# Each makes its own virtual environment; all that is needed before is Python 3.11+ with pip.

PYTHON ?= python3
VENV := .venv
TESTED := .make/venv
WORKERS ?= 3
SOURCES := $(shell find capar extractors capar_rules kb ontology -type f -not -name '*.pyc' 2>/dev/null)

.PHONY: demo test check bench docs written develop clean

demo: $(VENV)/ready  ## Observe the shipped capture: six steps of drinking from a mug, and a picture.
	$(VENV)/bin/capar demo

# What is imported is compiled by whoever imports it first, and kept; the rest need not be compiled.
test: export PYTHONDONTWRITEBYTECODE =
# Matrices here are small: threads of linear algebra would only wait for each other.
test: export OPENBLAS_NUM_THREADS = 1
test: $(TESTED)/ready  ## Build the wheel, install it, and test it from another folder.
	mkdir -p .make/elsewhere
	cd .make/elsewhere && ../venv/bin/python -m pytest -c $(CURDIR)/pyproject.toml --rootdir $(CURDIR) \
		-n $(WORKERS) --dist loadfile --no-loadscope-reorder $(CURDIR)/tests $(ARGS)

check: $(VENV)/developing  ## Style, types and the import contract, as the tests check them too.
	$(VENV)/bin/ruff format --check .
	$(VENV)/bin/ruff check .
	$(VENV)/bin/mypy
	$(VENV)/bin/lint-imports

BENCHMARKS := $(filter-out benchmarks/scene.py,$(wildcard benchmarks/*.py))
bench: export PYTHONDONTWRITEBYTECODE =
bench: $(VENV)/developing  ## Ratios side by side, half an hour on two quiet cores; NAME.py --help has larger sizes.
	for each in $(BENCHMARKS); do echo; echo "== $$each"; $(VENV)/bin/python $$each || exit 1; done

docs: written  ## The site in .make/site, with references made from code.
	NO_MKDOCS_2_WARNING=1 $(VENV)/bin/mkdocs build --quiet

written: $(VENV)/developing  ## What is written from code: the reference of capture.toml, terms of facts, inputs of rules.
	$(VENV)/bin/python -m extractors.readers.schema.reference docs/capture-toml.md
	$(VENV)/bin/python -m ontology.fact_kinds
	$(VENV)/bin/python -m capar_rules.inputs

develop: $(VENV)/developing  ## An editable install with everything for development.

$(VENV)/ready: pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(VENV)/bin/python -m pip install --quiet --quiet --disable-pip-version-check -e .
	touch $@

$(VENV)/developing: $(VENV)/ready
	$(VENV)/bin/python -m pip install --quiet --quiet --disable-pip-version-check -e '.[dev]'
	touch $@

$(TESTED)/ready: pyproject.toml README.md $(SOURCES)
	$(PYTHON) -m venv $(TESTED)
	rm -rf .make/dist
	$(TESTED)/bin/python -m pip wheel --disable-pip-version-check --no-deps --wheel-dir .make/dist . \
		>.make/build.log 2>&1 || (cat .make/build.log; exit 1)
	if $(TESTED)/bin/python -m pip show --quiet --quiet capar; then \
		$(TESTED)/bin/python -m pip uninstall --quiet --yes capar; fi
	$(TESTED)/bin/python -m pip install --quiet --quiet --disable-pip-version-check --no-compile \
		"$$(ls .make/dist/capar-*.whl)[dev]"
	touch $@

clean:
	rm -rf .make dist build
