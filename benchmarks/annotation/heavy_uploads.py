"""How long others wait while large uploads are taken in: a text of 19 MB and a pair file of 10⁵ lines.

Starts a site with its worker for short work on a fresh SQLite database, sends both files, and asks for
pages and saves drafts meanwhile. Prints percentiles in milliseconds, and what became of the jobs.

    python -m benchmarks.annotation.heavy_uploads [--port 8765]
"""

from __future__ import annotations

import argparse
import http.cookiejar
import io
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request
import uuid
import zipfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from benchmarks.fresh_site import ROOT, Site

WORLD, NAME, PASSWORD = "household", "admin", "a long enough password"
PAGES = ("/", f"/w/{WORLD}/", f"/w/{WORLD}/templates/", f"/w/{WORLD}/commands/")
TEXT_BYTES, PAIR_LINES = 19_000_000, 100_000
Files = dict[str, tuple[str, bytes]]
PAUSE_SECONDS = 0.1
PATIENCE_SECONDS = 1200


class Visitor:
    """A browser that has logged in."""

    def __init__(self, address: str) -> None:
        self._address = address
        cookies = http.cookiejar.CookieJar()
        self._opener = urllib.request.build_opener(urllib.request.HTTPCookieProcessor(cookies))
        self.post("/login/", {"username": NAME, "password": PASSWORD})

    def get(self, path: str) -> str:
        with self._opener.open(self._address + path, timeout=120) as answer:
            return str(answer.read().decode())

    def post(
        self, path: str, fields: dict[str, str], files: dict[str, tuple[str, bytes]] | None = None
    ) -> str:
        """Send a form with the token of its page; return where the answer led to."""
        token = first(r'name="csrfmiddlewaretoken" value="([^"]+)"', self.get(path))
        boundary = uuid.uuid4().hex
        body = io.BytesIO()
        for name, value in {"csrfmiddlewaretoken": token, **fields}.items():
            body.write(_part(boundary, f'name="{name}"') + value.encode() + b"\r\n")
        for name, (file_name, data) in (files or {}).items():
            body.write(_part(boundary, f'name="{name}"; filename="{file_name}"') + data + b"\r\n")
        body.write(f"--{boundary}--\r\n".encode())
        request = urllib.request.Request(
            self._address + path,
            body.getvalue(),
            {
                "Content-Type": f"multipart/form-data; boundary={boundary}",
                "Referer": self._address + path,
            },
        )
        with self._opener.open(request, timeout=600) as answer:
            answer.read()
            return str(answer.url)


def first(pattern: str, page: str) -> str:
    """Return the group of the first match on a page, which has one."""
    match = re.search(pattern, page)
    assert match is not None, f"{pattern} is not on the page"
    return match[1]


def _part(boundary: str, disposition: str) -> bytes:
    return f"--{boundary}\r\nContent-Disposition: form-data; {disposition}\r\n\r\n".encode()


class Watch(threading.Thread):
    """Opens pages, or saves drafts, over and over and notes how long each takes, in seconds."""

    def __init__(self, address: str, is_writing: bool) -> None:
        super().__init__(daemon=True)
        self._visitor = Visitor(address)
        self._is_writing = is_writing
        self.seconds: list[float] = []
        self.failures = 0
        self._over = threading.Event()

    def run(self) -> None:
        number = 0
        while not self._over.wait(PAUSE_SECONDS):
            began = time.perf_counter()
            try:
                if self._is_writing:
                    path = f"/w/{WORLD}/templates/new/"
                    category = first(r'<option value="(\d+)"', self._visitor.get(path))
                    text = f"a draft {number}"
                    fields = {"task_category": category, "pattern": text, "form": text}
                    self._visitor.post(path, {**fields, "status": "draft"})
                else:
                    self._visitor.get(PAGES[number % len(PAGES)])
            except OSError:
                self.failures += 1
            self.seconds.append(time.perf_counter() - began)
            number += 1

    def stop(self) -> dict[str, float]:
        self._over.set()
        self.join()
        ordered = sorted(self.seconds)
        quantile = statistics.quantiles(ordered, n=100)
        return {
            "requests": len(ordered),
            "failures": self.failures,
            "median ms": round(1000 * quantile[49]),
            "95th percentile ms": round(1000 * quantile[94]),
            "most ms": round(1000 * ordered[-1]),
        }


@contextmanager
def running(site: Site, port: int) -> Iterator[str]:
    """The address of the site while its web server and its worker run."""
    environment = {**site.environment, "PORT": str(port)}
    commands = (["serve"], ["work", "--queue", "quick"])
    log = open(Path(site.environment["GPSR_VAR_DIR"]) / "log", "wb")  # noqa: SIM115
    children = [
        subprocess.Popen(
            [sys.executable, "manage.py", *command], cwd=ROOT, env=environment, stderr=log
        )
        for command in commands
    ]
    address = f"http://127.0.0.1:{port}"
    try:
        for _ in range(300):
            try:
                urllib.request.urlopen(f"{address}/login/", timeout=2).close()
                break
            except OSError:
                time.sleep(0.2)
        yield address
    finally:
        for child in children:
            child.terminate()
        for child in children:
            child.wait()
        log.close()


def text_file() -> bytes:
    """Productions of one nonterminal, 19 MB of them."""
    lines, size, number = ["$Main = $thing\n"], 0, 0
    while size < TEXT_BYTES:
        lines.append(f"$thing = find the thing number {number} in the room\n")
        size, number = size + len(lines[-1]), number + 1
    return "".join(lines).encode()


def pair_archive() -> bytes:
    lines = (
        f'bring me thing {number} from the <room>\n( bring ( lambda $1 e ( is_a $1 " thing {number % 5000} " ) ) )\n'
        for number in range(PAIR_LINES // 2)
    )
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("gen/train.txt", "".join(lines))
    return packed.getvalue()


def wait_for(visitor: Visitor, url: str) -> tuple[str, float]:
    """How a job ended, and after how many seconds."""
    began = time.monotonic()
    path = "/" + url.split("/", 3)[3] + "state/"
    while time.monotonic() - began < PATIENCE_SECONDS:
        status = first(r"status--(\w+)", visitor.get(path))
        if status not in ("queued", "running"):
            return status, round(time.monotonic() - began, 1)
        time.sleep(1)
    return "still at work", round(time.monotonic() - began, 1)


def upload(visitor: Visitor, path: str, fields: dict[str, str], files: Files) -> dict[str, object]:
    """What came of one upload: seconds until the answer, how the job ended, seconds until then."""
    began = time.monotonic()
    url = visitor.post(path, fields, files)
    answered = round(time.monotonic() - began, 1)
    status, seconds = wait_for(visitor, url) if "/jobs/" in url else ("answered at once", 0.0)
    return {"answered after s": answered, "job": status, "ended after s": seconds}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--port", type=int, default=8765)
    port = parser.parse_args().port
    with tempfile.TemporaryDirectory() as folder:
        site = Site(Path(folder))
        site.environment |= {"DJANGO_SUPERUSER_PASSWORD": PASSWORD}
        site.run("createsuperuser", "--no-input", "--username", NAME, "--email", "a@example.org")
        starter = str(ROOT / "annotations" / "starter" / "household")
        site.run("import_generator", starter, "--world", WORLD)
        site.run("generate_pairs", WORLD)
        site.run("collectstatic", "--no-input", "-v0")
        with running(site, port) as address:
            print(json.dumps(measure(address), indent=2))


def measure(address: str) -> dict[str, object]:
    visitor = Visitor(address)
    for world in ("pairs", "text"):
        visitor.post("/worlds/new/", {"name": world, "description": ""})
    figures: dict[str, object] = {"cores": os.cpu_count()}
    figures["idle"] = observe(address, lambda: time.sleep(10))
    pairs = {"archive": ("pairs.zip", pair_archive())}
    text = {"files": ("text.txt", text_file())}
    results: dict[str, object] = {}

    def send_both() -> None:
        results["pairs"] = upload(visitor, "/w/pairs/import/pairs/", {"name": "big"}, pairs)
        results["text"] = upload(visitor, "/w/text/import/", {}, text)

    figures["meanwhile"] = observe(address, send_both)
    return {**figures, **results}


def observe(address: str, act: Callable[[], object]) -> dict[str, object]:
    watches = {"pages": Watch(address, False), "saves": Watch(address, True)}
    for watch in watches.values():
        watch.start()
    act()
    return {name: watch.stop() for name, watch in watches.items()}


if __name__ == "__main__":
    main()
