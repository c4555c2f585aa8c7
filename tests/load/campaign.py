"""Many contributors at once: each opens the link of one campaign, agrees, and does the whole task.

    python -m tests.load.campaign                      # 200 people in two minutes, on SQLite
    python -m tests.load.campaign --database postgres://postgres@127.0.0.1:5432/gpsr_load
    python -m tests.load.campaign --flood 10000        # one address begins anew with every post

Starts ``manage.py serve`` with its defaults on a database of its own (SQLite in a temporary folder unless one is
named, which has to be empty). Everybody does what a browser does: loads the page with its styles and scripts, asks
for advice twice while writing, saves, and follows to the next place, with a pause at each place as the whole has to
fit into ``--seconds``. Says how long each step took, and how busy the machine was and with what. Exits with 1 where
an answer was an error, where what was sent is not what is stored, or where somebody has not finished.

With ``--flood`` somebody without a cookie posts so often instead, four at a time, and says how many tasks began and
how long the refused posts took. Exits with 1 where more began than the limit, or where an answer was another error.
"""

from __future__ import annotations

import argparse
import asyncio
import gzip
import html
import os
import random
import re
import subprocess
import sys
import tempfile
import time
from collections import Counter, defaultdict
from pathlib import Path
from urllib.parse import urlencode, urlsplit

from tests.load.annotators import cpu_seconds
from tests.load.work_queue import ROOT, say, server

REWRITES, FREE_COMMANDS = 12, 2
ADVICE_CALLS = 2  # at each place
MOST_SECONDS = 600
FLOODING = 4  # connections that post at once
MOST_POSTS = 20_000
STEPS = ("open the link", "load a file", "agree", "show a place", "advise", "save", "finish")


class Browser:
    """One contributor's connection and cookies. ``times`` are the seconds of each request by step."""

    def __init__(self, port: int, times: dict[str, list[float]]) -> None:
        self.port, self.times = port, times
        self.cookies: dict[str, str] = {}
        self.reader: asyncio.StreamReader | None = None
        self.writer: asyncio.StreamWriter | None = None

    async def get(self, step: str, path: str) -> str:
        status, _, body = await self.send(step, "GET", path)
        if status != 200:
            raise RuntimeError(f"{path}: {status} {body[:200]}")
        return body

    async def post(self, step: str, path: str, values: dict[str, str]) -> str:
        """Post a form, and return the path that it leads to; the answer itself where it leads nowhere."""
        values = {"csrfmiddlewaretoken": self.cookies.get("csrftoken", ""), **values}
        status, location, body = await self.send(step, "POST", path, urlencode(values))
        if status not in (200, 302):
            raise RuntimeError(f"{path}: {status} {body[:200]}")
        return location or body

    async def send(self, step: str, method: str, path: str, form: str = "") -> tuple[int, str, str]:
        cookies = "; ".join(f"{name}={value}" for name, value in self.cookies.items())
        request = (
            f"{method} {path} HTTP/1.1\r\nHost: 127.0.0.1:{self.port}\r\nAccept-Encoding: gzip\r\n"
            f"Cookie: {cookies}\r\nContent-Type: application/x-www-form-urlencoded\r\n"
            f"Content-Length: {len(form)}\r\n\r\n{form}"
        )
        began = time.perf_counter()
        if self.writer is None or self.writer.is_closing() or self.reader.at_eof():
            self.reader, self.writer = await asyncio.open_connection("127.0.0.1", self.port)
        self.writer.write(request.encode())
        lines = (await self.reader.readuntil(b"\r\n\r\n")).decode("latin-1").splitlines()
        head = [line.partition(": ")[::2] for line in lines[1:] if line]
        fields = {name.lower(): value for name, value in head}
        body = await self.reader.readexactly(int(fields.get("content-length", 0)))
        self.times[step].append(time.perf_counter() - began)
        if fields.get("content-encoding") == "gzip":
            body = gzip.decompress(body)
        for name, value in head:
            if name.lower() == "set-cookie":
                key, _, rest = value.strip().partition("=")
                self.cookies[key] = rest.partition(";")[0]
        if fields.get("connection", "").lower() == "close":
            self.writer.close()
        return int(lines[0].split()[1]), fields.get("location", ""), body.decode(errors="replace")


async def contribute(
    browser: Browser, path: str, number: int, pause: float, sent: set[str]
) -> None:
    """Do the whole task, with about ``pause`` seconds at each place. What was saved is put into ``sent``."""
    page = await browser.get("open the link", path)
    for file in set(re.findall(r'(?:src|href)="(/static/[^"]+)"', page)):
        await browser.get("load a file", file)
    await asyncio.sleep(pause)
    place = await browser.post("agree", path, {"agrees": "on"})
    while not place.endswith("/done/"):
        page = await browser.get("show a place", place)
        hidden = dict(re.findall(r'<input type="hidden" name="(\w+)" value="([^"]*)"', page))
        prompt = re.search(r"<blockquote[^>]*>(.*?)</blockquote>", page, re.DOTALL)
        shown = html.unescape(prompt[1]) if prompt else "water the plants in the garden"
        text = (
            f"would you kindly {shown} for person {number} at {urlsplit(place).path.split('/')[3]}"
        )
        for part in range(1, ADVICE_CALLS + 1):
            await asyncio.sleep(pause / (ADVICE_CALLS + 1) * random.uniform(0.5, 1.5))
            typed = text[: len(text) * part // ADVICE_CALLS]
            await browser.post("advise", f"{place}check/", {"text": typed})
        await asyncio.sleep(pause / (ADVICE_CALLS + 1) * random.uniform(0.5, 1.5))
        values = {"shown": hidden["shown"], "pasted": "", "advised": "on", "text": text}
        place = await browser.post("save", place, values)
        sent.add(text)
    await browser.get("show a place", place)
    await asyncio.sleep(pause / 2)
    await browser.get("finish", await browser.post("finish", place, {"helped": "no"}))
    browser.writer.close()


async def everybody(
    port: int, path: str, people: int, seconds: float
) -> tuple[dict[str, list[float]], set[str], Counter[str]]:
    """Let ``people`` contribute within ``seconds``; they come evenly over the first sixth of it.

    Returns the times of each step, the texts that were saved, and the errors with how often each came.
    """
    times: dict[str, list[float]] = defaultdict(list)
    sent: set[str] = set()
    errors: Counter[str] = Counter()
    pause = seconds * 0.75 / (REWRITES + FREE_COMMANDS + 1.5)

    async def one(number: int) -> None:
        await asyncio.sleep(seconds / 6 * number / people)
        try:
            await contribute(Browser(port, times), path, number, pause, sent)
        except (RuntimeError, OSError, EOFError, KeyError) as error:
            errors[f"{type(error).__name__}: {error}"[:300]] += 1

    await asyncio.gather(*map(one, range(people)))
    return times, sent, errors


async def flood(port: int, path: str, posts: int) -> tuple[dict[str, list[float]], Counter[int]]:
    """Agree ``posts`` times, each time as somebody new. Returns the times by status, and how often each came."""
    times: dict[str, list[float]] = defaultdict(list)
    statuses: Counter[int] = Counter()

    async def some(count: int) -> None:
        browser = Browser(port, {"": []})
        await browser.get("", path)
        token = {"csrftoken": browser.cookies["csrftoken"]}
        form = urlencode({"csrfmiddlewaretoken": token["csrftoken"], "agrees": "on"})
        for _ in range(count):
            browser.cookies = dict(token)
            began = time.perf_counter()
            status, _, _ = await browser.send("", "POST", path, form)
            times[f"answered {status}"].append(time.perf_counter() - began)
            statuses[status] += 1
        browser.writer.close()

    await asyncio.gather(*(some(posts // FLOODING) for _ in range(FLOODING)))
    return times, statuses


def busy_seconds() -> float:
    """Return the processor time of everything on this machine since it started."""
    user, nice, system, _, _, *interrupts = map(int, Path("/proc/stat").read_text().split()[1:8])
    return (user + nice + system + sum(interrupts)) / os.sysconf("SC_CLK_TCK")


def launch() -> str:
    """Fill a world, launch a campaign in it, and return the path of its link."""
    import django

    django.setup()
    from annotations.models import User, World
    from tests.launched_campaigns import fill_household, launch_in

    world, admin = World.objects.create(name="load"), User.objects.create_user("nora")
    campaign = launch_in(
        fill_household(world),
        admin,
        {"prompts_per_form": 3},
        task_size=REWRITES,
        free_commands=FREE_COMMANDS,
    )
    print(f"{campaign.prompts.count()} prompts")
    return f"/p/{campaign.key}/"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--people", type=int, default=200)
    parser.add_argument("--seconds", type=float, default=120.0)
    parser.add_argument(
        "--flood", type=int, default=0, help="posts of one address, instead of people"
    )
    parser.add_argument("--database", default="", help="a URL; its database has to be empty")
    arguments = parser.parse_args()
    if arguments.seconds > MOST_SECONDS or arguments.flood > MOST_POSTS:
        parser.error(f"at most {MOST_SECONDS} seconds, and {MOST_POSTS} posts")
    with tempfile.TemporaryDirectory(prefix="gpsr-load-") as folder:
        os.environ.update(GPSR_VAR_DIR=folder, DJANGO_SETTINGS_MODULE="gpsr_site.settings")
        os.environ.pop("DATABASE_URL", None)
        if arguments.database:
            os.environ["DATABASE_URL"] = arguments.database
        for command in (["migrate", "-v0"], ["collectstatic", "--no-input", "-v0"]):
            subprocess.run([sys.executable, "manage.py", *command], cwd=ROOT, check=True)
        path = launch()
        with server() as (process, port):
            before = (cpu_seconds(process.pid), busy_seconds(), time.process_time())
            began = time.perf_counter()
            if arguments.flood:
                times, statuses = asyncio.run(flood(port, path, arguments.flood))
            else:
                times, sent, errors = asyncio.run(
                    everybody(port, path, arguments.people, arguments.seconds)
                )
            passed = time.perf_counter() - began
            after = (cpu_seconds(process.pid), busy_seconds(), time.process_time())
        from django.db import connection

        from annotations.campaigns.limits import BEGUN_TASKS
        from annotations.models import Contributor, Submission

        stored = set(Submission.objects.answered().values_list("text", flat=True))
        begun = Contributor.objects.count()
        finished = Contributor.objects.filter(finished_at__isnull=False).count()
        connection.close()
    for step in (*STEPS, *sorted(times.keys() - set(STEPS))):
        if times[step]:
            say(step, times[step])
    served, busy, asked = (end - start for start, end in zip(before, after, strict=True))
    requests = sum(map(len, times.values()))
    print(
        f"{requests} requests in {passed:.0f} s; of {os.cpu_count()} processors the server used "
        f"{served / passed:.2f}, this script {asked / passed:.2f}, everything else "
        f"{max(0, busy - served - asked) / passed:.2f}"
    )
    if arguments.flood:
        print(f"{begun} tasks began; answers by status: {dict(statuses)}")
        sys.exit(begun > BEGUN_TASKS.limit or bool(set(statuses) - {302, 429}))
    print(f"{finished} of {arguments.people} people have finished")
    print(f"{len(sent)} answers were saved, {len(sent - stored)} of them are lost")
    for error, count in errors.most_common():
        print(f"{count} times: {error}")
    whole = arguments.people * (REWRITES + FREE_COMMANDS)
    sys.exit(bool(errors) or stored != sent or len(sent) != whole or finished != arguments.people)


if __name__ == "__main__":
    main()
