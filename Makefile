# Everything sets itself up: python3, python3-venv and make are all it needs.
#   make demo    export and draw the examples        make test    run the tests, but for the slow ones
#   make studio  draw in the browser: the studio, on a new design, or DESIGN=examples/p4-key.toml
#   make test-slow  run those                        make test-pythons  a part on every other Python that is here
#   make lint    lint and format check               make types   mypy --strict, tests and scripts too
#   make bench   speed and accuracy, beside peers    make fuzz N=10000
#   make format  rewrite the sources' layout         make clean   remove all that was made here
#   make docs    the documentation, in docs/_build   make paper   docs/paper.md: the paper, reproduced and measured
#   make wheels  what a release is made of: the source and a wheel for each platform, in dist
#   make blender the extension for Blender, a file for each platform, in dist
#   make blender-pictures  those of docs/blender.md, rendered
#   make blender-versions  its tests in the oldest and the newest Blender that it is for
#   make gallery the pictures of docs/gallery.md     make diagrams  the drawings of the other pages
#   make screenshots  those of docs/studio.md, by the tests' browser
#   make readers  docs/readers.md: what other programs make of our files, measured
#   make page-tools  what the tests of the studio's page use, by npm: without it they are left out
#   make page-format rewrite the layout of the page's modules, and of the tests' scripts

.DEFAULT_GOAL := help
.PHONY: help demo studio test test-slow test-pythons environment lint format types bench fuzz docs paper gallery diagrams screenshots wheels blender blender-programs blender-pictures blender-versions readers reader-programs page-tools page-format clean
.DELETE_ON_ERROR:

PYTHON ?= python3
VENV ?= .venv
# The packages as an install lays them out: mypy cannot see through an editable one.
TYPES := .types
DEMO ?= demo
N ?= 500
PIP := -m pip install --quiet --disable-pip-version-check

INSTALLED := $(VENV)/.installed
INSTALLED_DEV := $(VENV)/.installed-dev
INSTALLED_DOCS := $(VENV)/.installed-docs
# Compiled into one library at the install: changes of theirs need a new one.
KERNELS := setup.py $(shell find voronoi_tiles vector raster -name "*.c")
EXAMPLES := $(wildcard examples/*.toml)

help:
	@sed -n 's/^#  //p' Makefile

# The core alone, editable: changes of the Python sources need no new installation.
$(INSTALLED): pyproject.toml $(KERNELS)
	$(PYTHON) -m venv $(VENV)
	$(VENV)/bin/python $(PIP) -e .
	touch $@

# The documentation's scripts are tested as well.
$(INSTALLED_DEV): pyproject.toml $(KERNELS)
	$(PYTHON) -m venv $(VENV)
	$(VENV)/bin/python $(PIP) -e '.[test,dev,docs]'
	touch $(INSTALLED) $(INSTALLED_DOCS) $@

$(INSTALLED_DOCS): $(INSTALLED)
	$(VENV)/bin/python $(PIP) -e '.[docs]'
	touch $@

demo: $(INSTALLED)
	$(VENV)/bin/voronoi-tiles export $(EXAMPLES) -o $(DEMO) --format svg
	for design in $(EXAMPLES); do \
	    $(VENV)/bin/voronoi-tiles render $$design -o $(DEMO)/$$(basename $$design .toml).png --size 800 --quiet || exit 1; \
	done
	$(VENV)/bin/voronoi-tiles export examples/art/swallow.toml -o $(DEMO)/sheet.svg --sheet 300x200mm --margin 5mm --fit clip
	$(VENV)/bin/voronoi-tiles export examples/p3-puzzle.toml -o $(DEMO)/sheet.dxf --sheet 300x200mm --margin 5mm --kerf 0.15mm
	$(VENV)/bin/voronoi-tiles coupon -o $(DEMO)/coupon.svg --thickness 3mm
	@echo "The tiles are in $(abspath $(DEMO)): open the .svg files in a browser, Inkscape or your cutter's software."
	@echo "The .png files beside them show how their copies fill the plane; sheet.svg and sheet.dxf are sheets of them."
	@echo
	@echo "A design of your own, in the p4 group, and its tile:"
	@echo "    . $(abspath $(VENV))/bin/activate"
	@echo "    voronoi-tiles new p4 -o bird.toml"
	@echo "    voronoi-tiles export bird.toml -o bird.svg"
	@echo "Change bird.toml while this runs, and look at bird.png:  voronoi-tiles watch bird.toml"
	@echo "In a new shell begin with the first of these lines, or call $(abspath $(VENV))/bin/voronoi-tiles."

studio: $(INSTALLED)
	$(VENV)/bin/voronoi-tiles studio $(DESIGN)

test: $(INSTALLED_DEV)
	$(VENV)/bin/python -m pytest -n auto --dist loadfile $(PYTEST)

test-slow: $(INSTALLED_DEV)
	$(VENV)/bin/python -m pytest -m slow -n auto --dist worksteal $(PYTEST)

# What the page does in a browser is the same whatever Python serves it, Blender has its own; the wheel is one for all, and so are the sources.
# Of the rest each Python takes another part. Asserts are not rewritten to say more: of a failure the test itself is run again.
ANOTHER := $(patsubst %,--ignore-glob=*/test_%,browser* page_* accessibility* wheel* addon* layering*) --thin --assert=plain

# Each in an environment of its own. The kernels are those of the first one: they use nothing of Python's.
test-pythons: $(INSTALLED_DEV)
	+set -e; found=$$($(PYTHON) .ci/pythons.py); echo "$${found:-No other CPython from 3.11 on is here.}"; \
	echo "$$found" | while read -r version python; do \
	    test -z "$$python" || $(MAKE) test VENV=$(VENV)-$$version PYTHON=$$python PYTEST="$(ANOTHER)" < /dev/null || exit 1; \
	done

environment: $(INSTALLED_DEV)

lint: $(INSTALLED_DEV)
	$(VENV)/bin/ruff check .
	$(VENV)/bin/ruff format --check .

format: $(INSTALLED_DEV)
	$(VENV)/bin/ruff check --fix .
	$(VENV)/bin/ruff format .

# All in one run: what is read twice is checked once. From where the folder voronoi_tiles/ of the checkout, which lacks
# two packages, cannot stand in the way of the whole one.
types: $(INSTALLED_DEV)
	rm -rf $(TYPES)/voronoi_tiles && mkdir -p $(TYPES)/voronoi_tiles
	ln -s $(addprefix ../../,$(wildcard voronoi_tiles/*) vector raster) $(TYPES)/voronoi_tiles
	cd $(TYPES) && $(abspath $(VENV))/bin/mypy --config-file ../pyproject.toml --cache-dir cache \
	    voronoi_tiles $(addprefix ../,tests bench blender docs setup.py .ci/pythons.py)

# targets.py exits with 3 where not all that was asked is reached, which its tables say; anything else is a failure.
bench: $(INSTALLED_DEV)
	$(VENV)/bin/python bench/targets.py --numpy --write || test $$? -eq 3
	$(VENV)/bin/python bench/engine.py --write
	$(VENV)/bin/python bench/accuracy.py --write
	$(VENV)/bin/python bench/raster.py --write
	$(VENV)/bin/python bench/sheets.py --write
	$(VENV)/bin/python bench/against.py --write
	$(VENV)/bin/python bench/preflight.py --write
	$(VENV)/bin/python bench/cubics.py --write

fuzz: $(INSTALLED_DEV)
	cd tests && $(abspath $(VENV))/bin/python -m helpers.fuzz $(N)
	cd tests && $(abspath $(VENV))/bin/python -m helpers.fuzz_sheets $(N)

docs: $(INSTALLED_DOCS)
	$(VENV)/bin/python -m sphinx --fail-on-warning --keep-going --quiet -b html docs docs/_build
	@echo "The documentation is in $(abspath docs/_build/index.html)."

# The pages and pictures that the project makes of itself; they are committed.
paper: $(INSTALLED_DOCS)
	$(VENV)/bin/python docs/generate/paper.py

# Other programs, measured: all that PyPI and npm have of them, 2 GB, and the distribution's as far as they are installed.
readers: $(INSTALLED_DEV) reader-programs $(patsubst %,tests/readers/.venv-%/.installed,cadquery build123d blender)
	$(VENV)/bin/python docs/generate/readers.py

# The small ones, which the tests run.
reader-programs: tests/readers/.venv-python/.installed tests/readers/node_modules/.package-lock.json

tests/readers/.venv-%/.installed: tests/readers/%.txt
	$(PYTHON) -m venv $(@D)
	$(@D)/bin/python $(PIP) -r $<
	touch $@

# The studio's pages, photographed by the tests' browser.
screenshots: $(INSTALLED_DEV)
	$(VENV)/bin/python docs/generate/screenshots.py

# The dialogs and drawings of Inkscape itself, on a screen that nobody sees.
inkscape-pictures: $(INSTALLED_DOCS)
	$(VENV)/bin/python docs/generate/inkscape_pictures.py

gallery: $(INSTALLED_DOCS)
	$(VENV)/bin/python docs/generate/gallery.py

diagrams: $(INSTALLED_DOCS)
	$(VENV)/bin/python docs/generate/diagrams.py
	$(VENV)/bin/python docs/generate/solids.py

# Each wheel is built from the source distribution, so that this holds all; compiled here for platforms that are elsewhere.
wheels: $(INSTALLED_DEV)
	rm -rf dist
	$(VENV)/bin/python -c 'from setuptools.build_meta import build_sdist; build_sdist("dist")' > /dev/null
	for target in $$($(VENV)/bin/python -c 'import setup; print(*setup.TARGETS)'); do \
	    VORONOI_TILES_REQUIRE_KERNELS=1 VORONOI_TILES_TARGET=$$target \
	        $(VENV)/bin/python -m pip wheel --quiet --no-deps --wheel-dir dist dist/*.tar.gz || exit 1; \
	done
	@ls -l dist

# With our wheels, and pip's of the libraries that it needs.
blender: wheels
	$(VENV)/bin/python blender/build.py

# Blender as a Python module, 0.8 GB, which takes one version of Python alone.
blender-programs: tests/readers/.venv-blender/.installed

tests/readers/.venv-blender/.installed: PYTHON := $(or $(shell command -v python3.11),$(PYTHON))

blender-pictures: $(INSTALLED_DEV) blender-programs
	$(VENV)/bin/python docs/generate/blender_pictures.py

# The tests of the extension in other versions: for each its number, and the Python that it takes.
BLENDERS ?= 4.2.23-python3.11 4.5.15-python3.11 5.3.0-python3.13

blender-versions: $(INSTALLED_DEV)
	set -e; for one in $(BLENDERS); do \
	    there=tests/readers/.venv-blender-$${one%-*}; \
	    test -e $$there/.installed || { $${one#*-} -m venv $$there; $$there/bin/python $(PIP) bpy==$${one%-*}; touch $$there/.installed; }; \
	    VORONOI_TILES_REQUIRE_BLENDER=1 VORONOI_TILES_BLENDER=$$there/bin/python \
	        $(VENV)/bin/python -m pytest tests/blender/test_addon.py -m slow $(PYTEST) || exit 1; \
	done

# Of exactly the versions that package-lock.json names; nothing of it runs in the page.
page-tools: tests/studio/node_modules/.package-lock.json

%/node_modules/.package-lock.json: %/package-lock.json
	cd $* && npm ci --silent
	touch $@

page-format: page-tools
	node tests/studio/node_modules/prettier/bin/prettier.cjs --config tests/studio/package.json --log-level warn --write \
	    "voronoi_tiles/studio/page/**/*.js" "tests/studio/page/*.js" "tests/readers/programs/*.mjs"

clean:
	rm -rf $(VENV) $(VENV)-3.* $(TYPES) tests/studio/node_modules tests/readers/node_modules tests/readers/.venv-* $(DEMO) docs/_build build dist *.egg-info .pytest_cache .mypy_cache .ruff_cache .hypothesis
	rm -f voronoi_tiles/base/kernels.compiled.*
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
