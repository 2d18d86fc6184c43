"""Started by Inkscape, with whatever Python that has; starts the one that has voronoi_tiles, and hands everything on.

`voronoi-tiles inkscape install` copies this file beside its .inx files, once for each entry, with ENTRY, PYTHON
and LIBRARIES filled in. It runs with Pythons from 3.8 on, and needs no other module of ours.
"""

from __future__ import annotations

import os
import sys

ENTRY = ""
"""What is asked for: the name of an entry."""

PYTHON = ""
"""The interpreter in whose environment voronoi_tiles is installed."""

LIBRARIES = {}  # type: dict[str, str]
"""Where that interpreter finds libraries: LD_LIBRARY_PATH and its like as they were when it was known to work."""

SANDBOX = "This Inkscape runs in a sandbox, Flatpak's or Snap's, and can start no program outside. Install another one."

AGAIN = 'Run "voronoi-tiles inkscape install" once more, in the environment where voronoi-tiles is installed now.'

BEGIN = """\
import sys
try:
    from voronoi_tiles.inkscape.extension import run
except ImportError as error:
    sys.exit("voronoi-tiles cannot be started with %s: %s. {}" % (sys.executable, error))
run()
""".format(AGAIN.replace('"', '\\"'))

SEARCHED = ("LD_LIBRARY_PATH", "LD_PRELOAD", "DYLD_LIBRARY_PATH", "DYLD_FALLBACK_LIBRARY_PATH", "DYLD_INSERT_LIBRARIES")


def environment(found: dict[str, str]) -> dict[str, str]:
    """The environment for our interpreter: without what Inkscape sets for its own, PYTHONPATH above all."""
    kept = {name: value for name, value in found.items() if not name.startswith("PYTHON") and name not in SEARCHED}
    return {**kept, **LIBRARIES}


def main() -> None:
    """Become our interpreter; say what to do where it is gone."""
    # Not -I: voronoi_tiles may be installed for this user alone.
    words = [PYTHON, "-E", "-P", "-c", BEGIN, ENTRY, *sys.argv[1:]]
    try:
        if os.name == "nt":  # whose execve comes back at once
            import subprocess

            sys.exit(subprocess.call(words, env=environment(dict(os.environ))))
        os.execve(PYTHON, words, environment(dict(os.environ)))
    except OSError as error:
        boxed = "FLATPAK_ID" in os.environ or "SNAP" in os.environ
        sys.exit(f"{PYTHON} cannot be started: {error.strerror}. {SANDBOX if boxed else AGAIN}")


if __name__ == "__main__":
    main()
