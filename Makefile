# Two commands matter: `make demo` and `make check`. CMake with presets does the work.

all: ## builds build/sinew
	@cmake --preset default >build/configure.log 2>&1 || { tail -n 15 build/configure.log; \
	  echo "The build could not be configured. Missing packages: scripts/install-packages.sh"; exit 1; }
	@cmake --build --preset default

demo: ## installs what is missing, builds, fits a real tissue, runs and compares it
	@scripts/install-packages.sh demo
	@$(MAKE) --no-print-directory all
	@scripts/demo.sh build/sinew build/demo

check: ## installs what is missing, then all tests: style, includes, warnings, units, sanitizers
	@scripts/install-packages.sh check
	@scripts/check.sh

verify: all ## long verification runs
	@scripts/verify.sh build/sinew

study: all ## runs the study of docs/theory/study.md, or goes on with it
	@scripts/study.sh build/sinew

figures: all ## figures of the manual, from the command's own output
	@scripts/figures.sh build/sinew

fuzz: ## fuzzes every reader for SECONDS each (100: ten minutes in all)
	@scripts/install-packages.sh fuzz
	@scripts/fuzz.sh $(SECONDS)

manual: all ## rewrites the manual's printed tables
	@scripts/manual.sh build/sinew

install: all ## headers, libraries, command, sinew.pc, CMake package (PREFIX, DESTDIR)
	@cmake --install build $(if $(PREFIX),--prefix $(PREFIX))

clean:
	rm -rf build

help:
	@grep -E '^[a-z]+:.*##' $(MAKEFILE_LIST) | sed 's/:.*## /\t/'

.PHONY: all demo check verify study figures fuzz manual install clean help
$(shell mkdir -p build)
