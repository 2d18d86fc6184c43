"""The drawings and tables of the documentation, from the project's own numbers: docs/pictures, and tables in pages.

Run it after a change of the engine, of the groups or of an example in docs/design-file.md: python
docs/generate/diagrams.py [tables] [groups] [strokes] [method] [cones] [gradients] [fits] [sweeps].
"""

from __future__ import annotations

import sys

import diagrams_cones
import diagrams_fits
import diagrams_gradients
import diagrams_groups
import diagrams_method
import diagrams_strokes
import diagrams_sweeps
import diagrams_tables

PARTS = {
    "tables": diagrams_tables.write,
    "groups": diagrams_groups.write,
    "strokes": diagrams_strokes.write,
    "method": diagrams_method.write,
    "cones": diagrams_cones.write,
    "gradients": diagrams_gradients.write,
    "fits": diagrams_fits.write,
    "sweeps": diagrams_sweeps.write,
}


def main() -> None:
    """Write the parts that are named, or all."""
    unknown = [name for name in sys.argv[1:] if name not in PARTS]
    if unknown:
        sys.exit(f"unknown part {unknown[0]}: use {' '.join(PARTS)}")
    for name in sys.argv[1:] or PARTS:
        PARTS[name]()


if __name__ == "__main__":
    main()
