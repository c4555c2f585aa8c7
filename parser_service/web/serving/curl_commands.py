"""What a page has asked, as a command line that asks the same over REST."""

from __future__ import annotations

import json
import shlex
from collections.abc import Mapping
from typing import Any

from django.http import HttpRequest
from django.urls import reverse

from annotations.models import World

HEADERS = ("Authorization: Bearer $TOKEN", "Content-Type: application/json")


def curl_command(request: HttpRequest, world: World, route: str, sent: Mapping[str, Any]) -> str:
    """Return what a shell takes to POST ``sent`` to the route ``api:<route>`` of ``world``.

    The token is that of the variable TOKEN of the shell; whoever pastes it sets that first.
    """
    address = request.build_absolute_uri(reverse(f"api:{route}", kwargs={"world": world.name}))
    headers = " ".join(f'-H "{each}"' for each in HEADERS)
    data = shlex.quote(json.dumps(sent, ensure_ascii=False))
    return f"curl {headers} \\\n     -d {data} \\\n     {shlex.quote(address)}"
