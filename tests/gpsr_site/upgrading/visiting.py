"""Visit an installation as its administrator: every page that another page leads to, and the API with a token.

Run in a process that has the settings of the installation; prints what did not answer, as JSON.
"""

from __future__ import annotations

import json
import os
import re
from collections import deque
from html import unescape
from urllib.parse import urljoin, urlsplit

import django

TOKEN = "wyQ7hoaSIN47370HwnZHjNDyyxItWh_LNAnSiKSYhEs"  # of the dump, which holds its digest
MOST = 400  # pages; of a path, one with a query
LEADS = re.compile(r'(?:href|hx-get)="([^"]+)"')


def visit() -> dict[str, object]:
    """Return ``visited``, how many pages answered, and ``faults``, the status by path of the others."""
    from django.test import Client

    from annotations.models import User

    client = Client(raise_request_exception=False, SERVER_NAME="localhost")
    client.force_login(User.objects.get(username="root"))
    waiting, seen = deque(["/", "/w/home/"]), {"/", "/w/home/"}
    faults, visited = {}, 0
    while waiting and visited < MOST:
        path = waiting.popleft()
        answer = client.get(path)
        visited += 1
        if answer.status_code not in (200, 204, 302):
            faults[path] = answer.status_code
        answer.close()
        if answer.streaming or "html" not in answer.get("Content-Type", ""):
            continue
        for link in LEADS.findall(answer.content.decode()):
            found = urlsplit(urljoin(path, unescape(link)))
            if found.netloc or found.path.startswith(("/static/", "/documents/", "/admin/")):
                continue
            if found.path not in seen:
                seen.add(found.path)
                waiting.append(found._replace(fragment="").geturl())
    for name in ("utterances", "labels", "templates", "runs", "campaigns", "paraphrases"):
        path = f"/api/v1/worlds/home/{name}/"
        answer = Client(SERVER_NAME="localhost").get(
            path, headers={"authorization": f"Bearer {TOKEN}"}
        )
        if answer.status_code != 200 or not answer.json()["results"]:
            faults[path] = answer.status_code
    return {"visited": visited, "faults": faults}


if __name__ == "__main__":
    os.environ.setdefault("DJANGO_SETTINGS_MODULE", "gpsr_site.settings")
    django.setup()
    print(json.dumps(visit()))
