"""The extension, made once."""

from __future__ import annotations

import os

import pytest
from helpers.blender import Extension, make_extension


@pytest.fixture(scope="session")
def extension(tmp_path_factory: pytest.TempPathFactory) -> Extension:
    """The extension's file, made of the checkout; its tests are left out where Blender is not installed."""
    base = tmp_path_factory.getbasetemp()
    shared = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base
    return make_extension(shared, tmp_path_factory.mktemp("blender"))
