"""Processes of their own, and what they use."""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
from collections.abc import Collection, Sequence
from typing import IO


def usage_of(
    command: Sequence[str], *, stdout: int | IO[bytes] = subprocess.DEVNULL, fine: Collection[int] = (0,)
) -> resource.struct_rusage:
    """Run a command to its end: what it used. Exits with what it said where its status is none of those."""
    with tempfile.TemporaryFile() as said:
        process = subprocess.Popen(command, stdout=stdout, stderr=said)  # noqa: S603 our own
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode not in fine:
            said.seek(0)
            sys.exit(f"{' '.join(command)} failed: {said.read().decode()}")
    return usage
