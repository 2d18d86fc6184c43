"""Lengths of a job where the caller does not say, and the least that can be asked; millimetres."""

from __future__ import annotations

from typing import Final

ACCURACY_MM: Final = 0.005
"""How far approximated curves may be from the exact ones, where the caller does not say; a twentieth of a kerf."""

ACCURACY_MIN: Final = 1e-5
"""Finest accuracy; millimetres. A hundredth of a micrometre; files hold nanometres."""

APART_MM: Final = 1.0
"""How far contours with a kerf are kept apart where the caller does not say; millimetres: no sliver is left to burn."""

STROKE_MIN: Final = 0.001
"""Thinnest lines; millimetres. Thinner ones are lost in programs that keep few digits."""

FRAME_MM: Final = 2.0
"""Least width of a frame where the caller does not say; millimetres. A narrower one breaks, or is cut twice."""

LABEL_MIN: Final = 0.5
"""Smallest height of a label; millimetres. What is smaller nobody reads."""
