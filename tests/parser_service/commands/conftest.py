from __future__ import annotations

from pathlib import Path

import pytest

from tests.parser_service.made_up import make_folder


@pytest.fixture
def folder(tmp_path) -> Path:
    return make_folder(tmp_path / "pairs")
