"""GRBL 1.1 as a simulator: what its parser takes and refuses, and where its motions go, in single precision.

Written after gcode.c, motion_control.c, protocol.c and serial.c of github.com/gnea/grbl. It shares no code with
ours. In laser mode ($32=1) the beam is on in G1, G2 and G3 alone, at the last S, while M3 or M4 holds.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

F = np.float32
REALTIME = set("?!~\x18")
LINE_BUFFER = 80
EPSILON = F(5e-7)
TOLERANCE = F(0.0002)  # $12, a tenth of what it is set to: the simulator's own error is to be small


class GrblError(Exception):
    """What GRBL answers with "error"; the number is in the text."""


@dataclass
class Beam:
    """A stretch that is burnt without a break: its points, and feed and power."""

    points: list[complex]
    feed: float
    power: float


class Grbl:
    """The state of the machine. `moves` counts the motions of each kind, `turns` are the angles of arcs."""

    def __init__(self) -> None:
        self.place = (F(0), F(0))
        self.motion = 0
        self.feed = self.power = 0.0
        self.on = False
        self.beams: list[Beam] = []
        self.moves = {0: 0, 1: 0, 2: 0, 3: 0}
        self.turns: list[float] = []
        self.travel: list[tuple[complex, complex, float]] = []
        self._going = False

    def run(self, data: bytes) -> Grbl:
        """Stream a file, as a sender does, line by line."""
        assert data.endswith(b"\n")
        for raw in data.split(b"\n"):
            assert not any(byte > 0x7F or chr(byte) in REALTIME for byte in raw), f"a realtime command: {raw!r}"
            assert len(raw) < LINE_BUFFER, "longer than the buffer, comments counted"
            line = re.sub(r"\([^)]*\)?|;.*", "", raw.decode("ascii"))
            line = re.sub(r"[\s/]", "", line).upper()
            if line:
                self.block(line)
        return self

    def block(self, line: str) -> None:
        """Execute a block."""
        words = re.findall(r"([A-Z])([-+]?\d*\.?\d*)", line)
        if "".join(letter + value for letter, value in words) != line or not all(value for _, value in words):
            raise GrblError(f"error:1 or 2: {line}")
        axes: dict[str, F] = {}
        explicit = False
        for letter, text in words:
            value = float(text)
            if letter == "G" and value in (0, 1, 2, 3):
                self.motion, explicit = int(value), True
            elif letter == "G" and value in (17, 21, 90, 94):
                pass
            elif letter == "M" and value in (3, 4, 5):
                self.on = value != 5
                self._going = False
            elif letter == "F":
                self.feed = value
            elif letter == "S":
                self.power = value
            elif letter in "XYIJ" and letter not in axes:
                axes[letter] = F(text)
            else:
                raise GrblError(f"error:20 or 25: {line}")
        if axes:
            assert explicit, "other readers want a G word on every line"
            self.go(axes, line)

    def go(self, axes: dict[str, F], line: str) -> None:
        """Move."""
        x, y = self.place
        target = (axes.get("X", x), axes.get("Y", y))
        here, there = complex(float(x), float(y)), complex(float(target[0]), float(target[1]))
        self.moves[self.motion] += 1
        if self.motion == 0:
            self.travel.append((here, there, self.power))
            self._going = False
            self.place = target
            return
        if self.feed == 0:
            raise GrblError(f"error:22: {line}")
        points = [there]
        if self.motion > 1:
            points = self.arc(target, axes.get("I", F(0)), axes.get("J", F(0)), line)
        elif set(axes) & {"I", "J"}:
            raise GrblError(f"error:36: {line}")
        if self.on and self.power > 0:
            last = self.beams[-1] if self._going else None
            if last is None or (last.feed, last.power) != (self.feed, self.power):
                self.beams.append(Beam([here], self.feed, self.power))
            self.beams[-1].points += points
            self._going = True
        self.place = target

    def arc(self, target: tuple[F, F], i: F, j: F, line: str) -> list[complex]:
        """The segments of an arc: gcode.c's checks, then mc_arc."""
        x, y = self.place
        dx, dy = target[0] - x - i, target[1] - y - j
        radius, end_radius = F(np.hypot(i, j)), F(np.hypot(dx, dy))
        off = abs(end_radius - radius)
        if off > 0.005 and (off > 0.5 or off > F(0.001) * radius):
            raise GrblError(f"error:33: {line}")
        cx, cy = x + i, y + j
        rx, ry = -i, -j
        tx, ty = target[0] - cx, target[1] - cy
        angle = F(np.arctan2(rx * ty - ry * tx, rx * tx + ry * ty))
        if self.motion == 2 and angle >= -EPSILON:
            angle = F(angle - 2 * np.pi)
        if self.motion == 3 and angle <= EPSILON:
            angle = F(angle + 2 * np.pi)
        self.turns.append(float(angle))
        count = int(abs(F(0.5) * angle * radius) / np.sqrt(TOLERANCE * (2 * radius - TOLERANCE)))
        steps = np.arange(1, count) * (float(angle) / max(count, 1))
        ray = complex(float(rx), float(ry))
        inner = complex(float(cx), float(cy)) + ray * np.exp(1j * steps)
        return [*inner.tolist(), complex(float(target[0]), float(target[1]))]
