# Thin over the CMake presets. On a fresh Debian or Ubuntu:
#   make demo    installs what is missing, builds, shows gonio at work
#   make check   the same, then all tests, also under the sanitizers, and the style checks
# WERROR=ON treats warnings as errors. INSTALL=no leaves apt alone.

WERROR ?= OFF
INSTALL ?= yes
JOBS ?= $(shell nproc)

.PHONY: all demo check test sanitize style bench coverage install clean

all:
	scripts/install-dependencies.sh $(INSTALL) build
	cmake --preset release -DGONIO_WERROR=$(WERROR) -DBUILD_TESTING=OFF >/dev/null
	cmake --build --preset release -j $(JOBS)

demo: all
	build/release/apps/gonio/gonio demo -o gonio-demo

check: style test sanitize
	@echo "All checks passed."

test: check-tools
	cmake --preset release -DGONIO_WERROR=$(WERROR) -DBUILD_TESTING=ON >/dev/null
	cmake --build --preset release -j $(JOBS)
	ctest --preset release

sanitize: check-tools
	cmake --preset sanitize -DGONIO_WERROR=$(WERROR) -DBUILD_TESTING=ON >/dev/null
	cmake --build --preset sanitize -j $(JOBS)
	ctest --preset sanitize

style: check-tools
	cmake --preset release -DGONIO_WERROR=$(WERROR) -DBUILD_TESTING=ON >/dev/null
	cmake --build --preset release --target gonio-viewer
	scripts/check-style.sh build/release

.PHONY: check-tools
check-tools:
	scripts/install-dependencies.sh $(INSTALL) check

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

clean:
	rm -rf build
