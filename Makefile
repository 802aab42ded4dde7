# make demo: set up and compare the sample photos with the model; make test: set up and run the tests.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/.ready

.PHONY: demo test lint types format bench bench-fe wheel-check report-check docs clean clean-kernels

demo: $(READY)
	$(BIN)/spavision correlate --crimp 0.2 --output results/demo --force

test: $(READY)
	OMP_NUM_THREADS=1 $(BIN)/python -m pytest -n 2

lint: $(READY)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

# mypy does not know setuptools' package-dir: it is shown the packages under the names they install as.
types: $(READY)
	rm -rf build/types && mkdir -p build/types/spavision
	ln -s $(CURDIR)/spavision/* build/types/spavision/
	for folder in model correlate sample_images; do ln -s $(CURDIR)/$$folder build/types/spavision/$$folder; done
	cd build/types && $(CURDIR)/$(BIN)/mypy --config-file $(CURDIR)/pyproject.toml -p spavision

format: $(READY)
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

wheel-check: $(READY)
	$(BIN)/python .ci/check_wheel.py

report-check: $(READY)
	$(BIN)/python -m pip install --disable-pip-version-check --quiet --constraint constraints.txt --editable ".[fast,test,browser]"
	$(BIN)/python -m pytest tests/correlate/test_report_in_browser.py

# mkdocs reads the packages from where `types` shows them.
docs: types
	$(BIN)/python -m pip install --disable-pip-version-check --quiet --constraint constraints.txt --editable ".[fast,test,docs]"
	$(BIN)/mkdocs build --strict

bench: $(READY)
	$(BIN)/python benchmarks/run_all.py

bench-fe: $(READY)
	$(BIN)/python -m pip install --disable-pip-version-check --quiet --editable ".[fast,bench]"
	$(BIN)/python benchmarks/run_all.py fe_

$(READY): pyproject.toml constraints.txt
	$(PYTHON) -c "import sys; sys.exit(sys.version_info < (3, 11) and 'spavision needs Python 3.11 or newer; try make PYTHON=python3.12')"
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --disable-pip-version-check --quiet --constraint constraints.txt --editable ".[fast,test]"
	touch $(READY)

# numba looks at a compiled function's own file alone: after a change to a kernel that other files call.
clean-kernels:
	find spavision model -name '*.nb[ci]' -delete

clean: clean-kernels
	rm -rf $(VENV) build dist results *.egg-info .pytest_cache .mypy_cache .ruff_cache
