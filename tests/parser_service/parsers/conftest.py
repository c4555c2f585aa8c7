from __future__ import annotations

import pytest

from parser_service.parsers.server_address import ModelServer
from tests.parser_service.llm_server import KEY, QUICK, installed, tiny_server


@pytest.fixture
def tiny():
    """A server of the protocol."""
    with tiny_server() as server:
        yield server


@pytest.fixture
def place(tiny, tmp_path):
    """It is the server of this installation, which keeps answers."""
    place = ModelServer(tiny.url, KEY, patience=QUICK, answers=tmp_path / "llm")
    with installed(place):
        yield place
