from __future__ import annotations

import pytest

from parser_service.labelling import known_forms


@pytest.fixture(autouse=True)
def forget_indices():
    """Worlds of two tests can have one key, which those of an installation never have."""
    known_forms._oracle.cache_clear()
    known_forms._kept.clear()
