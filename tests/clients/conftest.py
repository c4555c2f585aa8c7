from __future__ import annotations

import sys
from pathlib import Path

CLIENT = Path(__file__).resolve().parents[2] / "clients" / "python"
sys.path[:0] = [str(CLIENT), str(CLIENT / "examples")]

from tests.parser_service.serving.dialogues.conftest import parse_server, shelf  # noqa: E402, F401
