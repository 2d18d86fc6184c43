"""The other CPythons of this machine that the product is for: a line each, "3.12 /path/to/python3.12".

"Other" is: not of the minor version that runs this script. Looked for on PATH and among the versions of pyenv; of one
minor version the newest is taken. One that cannot make virtual environments is named on standard error.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

OLDEST, NEWEST = 11, 30  # minor versions of Python 3
ASKED = """
import sys
print(sys.implementation.name, *sys.version_info[:4])
try:
    import ensurepip, venv
except ImportError:
    print("no venv")
"""


def candidates() -> list[str]:
    """The paths of programs that may be such Pythons."""
    found = [shutil.which(f"python3.{minor}") for minor in range(OLDEST, NEWEST)] + [shutil.which("python3")]
    pyenv = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv"))
    return [name for name in found if name] + sorted(map(str, pyenv.glob("versions/*/bin/python3")))


def main() -> None:
    """Print them, the oldest first."""
    newest: dict[int, tuple[int, str]] = {}
    for name in candidates():
        asked = subprocess.run([name, "-c", ASKED], capture_output=True, text=True, check=False)
        if asked.returncode:  # a shim of pyenv for a version that is not chosen, for one
            continue
        implementation, major, minor, micro, level, *missing = asked.stdout.split()
        if (implementation, major, level) != ("cpython", "3", "final") or int(minor) < OLDEST:
            continue
        if missing:
            print(f"{name} has no venv: the tests are not run on it.", file=sys.stderr)
        elif int(minor) != sys.version_info.minor:
            newest[int(minor)] = max((int(micro), name), newest.get(int(minor), (-1, "")))
    for number, (_, name) in sorted(newest.items()):
        print(f"3.{number} {name}")


if __name__ == "__main__":
    main()
