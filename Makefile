# Thin over the CMake presets. On a fresh Debian or Ubuntu:
#   make demo    installs what is missing, builds, shows gonio at work
#   make check   the same, then all tests, also under the sanitizers, and the style checks
# WERROR=ON treats warnings as errors. INSTALL=no leaves apt alone.

WERROR ?= OFF
INSTALL ?= yes
JOBS ?= $(shell nproc)

# What the tests of a build left, by which their times are shown.
RESULTS = build/release/tests.xml build/sanitize/tests.xml

.PHONY: all demo check test sanitize style times fuzz bench coverage install python clean

all:
	scripts/install-dependencies.sh $(INSTALL) build
	cmake --preset release -DGONIO_WERROR=$(WERROR) -DBUILD_TESTING=OFF >/dev/null
	cmake --build --preset release -j $(JOBS)

demo: all
	build/release/apps/gonio/gonio demo -o gonio-demo

# The style is checked beside the tests, which leave a processor free at times. How many tests passed is said last.
check:
	$(MAKE) -j 2 test style
	$(MAKE) sanitize
	@echo "All checks passed."
	@scripts/test-times.sh $(RESULTS)

test: release-configured
	cmake --build --preset release -j $(JOBS)
	ctest --preset release -j $(JOBS) --output-junit $(CURDIR)/build/release/tests.xml

sanitize: check-tools
	cmake --preset sanitize -DGONIO_WERROR=$(WERROR) -DBUILD_TESTING=ON >/dev/null
	cmake --build --preset sanitize -j $(JOBS)
	ctest --preset sanitize -j $(JOBS) --output-junit $(CURDIR)/build/sanitize/tests.xml

style: release-configured
	scripts/check-style.sh build/release

# The page, as its packages have to be there before its style is checked.
.PHONY: release-configured
release-configured: check-tools
	cmake --preset release -DGONIO_WERROR=$(WERROR) -DBUILD_TESTING=ON >/dev/null
	cmake --build --preset release --target gonio-viewer

# After `make check` on a quiet machine: keeps the times that it showed.
times:
	scripts/test-times.sh $(RESULTS) docs/test-times.md

.PHONY: check-tools
check-tools:
	scripts/install-dependencies.sh $(INSTALL) check

# TIME: seconds for each target; TARGETS: some of them, all by default.
TIME ?= 60
fuzz:
	scripts/install-dependencies.sh $(INSTALL) fuzz
	cmake --preset fuzz >/dev/null
	cmake --build --preset fuzz --target fuzz-targets -j $(JOBS)
	scripts/fuzz.sh build/fuzz $(TIME) $(TARGETS)

# MATERIALS: a folder of at least 81 materials, the built-in ones by default.
MATERIALS ?= atlas:
bench: all
	cmake --build --preset release --target gonio-bench -j $(JOBS)
	cd build && release/bench/gonio-bench $(MATERIALS) $(SECTIONS)

coverage: check-tools
	cmake --preset coverage >/dev/null
	cmake --build --preset coverage -j $(JOBS)
	ctest --preset coverage
	scripts/report-coverage.sh build/coverage

install: all
	cmake --install build/release

# The Python package: a wheel with all that it needs but Python and NumPy.
python: all
	scripts/install-dependencies.sh $(INSTALL) python
	scripts/make-wheel.sh build/release build/wheel

clean:
	rm -rf build python/build
