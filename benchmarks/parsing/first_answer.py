"""How long a newcomer waits from the first page of a new installation: for a robot's first answer, and for a good one.

    .venv/bin/python -m benchmarks.parsing.first_answer [--minutes 15] [--good 70]

Starts ``manage.py quickstart``, which is what ``make run`` does, in an empty folder and on free ports, and asks the
REST address of a robot again and again. An answer is *good* where the run that gives it is right on more than 70 % of
the starter world's validation paraphrases. Seconds are those since the first page was answered. Processor time is that
of all processes of the installation, which says more than wall time on a busy machine. For Linux.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from collections import defaultdict
from pathlib import Path
from typing import Any

from benchmarks.fresh_site import ROOT
from benchmarks.parsing.serving import free_port

WORLD = "household"
ASKED = "could you please fetch me the apple juice from the kitchen table"
MOST_SECONDS_TO_FIRST, MOST_SECONDS_TO_GOOD = 60.0, 180.0
BF16 = ("avx512_bf16", "amx_bf16", "bf16")  # flags of /proc/cpuinfo
TICKS = os.sysconf("SC_CLK_TCK")


class Installation:
    """A new installation in ``folder``, while the block lasts."""

    def __init__(self, folder: str):
        port, parser_port = free_port(), free_port()
        self.environment = {
            **{name: text for name, text in os.environ.items() if name != "DATABASE_URL"},
            "GPSR_VAR_DIR": folder,
            "HOST": "127.0.0.1",
            "PORT": str(port),
            "PARSER_PORT": str(parser_port),
        }
        self.address = f"http://127.0.0.1:{port}"

    def __enter__(self) -> Installation:
        self.process = subprocess.Popen(
            [sys.executable, "manage.py", "quickstart"],
            cwd=ROOT,
            env=self.environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        return self

    def __exit__(self, *error: object) -> None:
        self.process.send_signal(signal.SIGINT)
        self.process.wait(timeout=60)

    def issue_token(self) -> str:
        """Return a new token of the administrator that may read."""
        command = [sys.executable, "manage.py", "issue_token", "admin", "--scope", "read"]
        done = subprocess.run(
            command, cwd=ROOT, env=self.environment, stdout=subprocess.PIPE, text=True, check=True
        )
        return next(line for line in done.stdout.split() if len(line) > 30)

    def get(self, path: str, token: str = "", data: object = None) -> Any:
        """Return the JSON of an answer, or its status where no token is sent; None while there is no answer."""
        body = None if data is None else json.dumps(data).encode()
        request = urllib.request.Request(f"{self.address}{path}", body)
        request.add_header("Content-Type", "application/json")
        if token:
            request.add_header("Authorization", f"Bearer {token}")
        try:
            with urllib.request.urlopen(request, timeout=30) as answer:
                return json.load(answer) if token else answer.status
        except (OSError, ValueError):
            return None

    def processor_seconds(self) -> float:
        """Return the processor time of all processes of the installation, also of those that have ended."""
        children, ticks = defaultdict(list), {}
        for path in Path("/proc").glob("[0-9]*/stat"):
            try:
                fields = path.read_text().rpartition(")")[2].split()
            except OSError:  # it has ended
                continue
            key = int(path.parent.name)
            children[int(fields[1])].append(key)
            ticks[key] = sum(map(int, fields[11:15]))
        waiting, total = [self.process.pid], 0
        while waiting:
            key = waiting.pop()
            total += ticks.get(key, 0)
            waiting += children[key]
        return total / TICKS


def measure(site: Installation, minutes: float, good: float) -> dict[str, float]:
    """Print each new run that answers; return the seconds to the first answer and to the first good one."""
    while site.get("/login/") is None:
        if site.process.poll() is not None:
            sys.exit(
                "The installation ended before it had a page; start manage.py quickstart to see why."
            )
        time.sleep(0.2)
    began, spent = time.monotonic(), site.processor_seconds()
    print(f"first page after {spent:.1f} s of processor time")
    token = site.issue_token()
    reached: dict[str, float] = {}
    last = None
    while time.monotonic() - began < 60 * minutes and "good" not in reached:
        answer = site.get(f"/api/v1/worlds/{WORLD}/parse/", token, {"utterance": ASKED})
        seconds = time.monotonic() - began
        if answer and answer["run"] != last:
            last = answer["run"]
            right = accuracy(site.get(f"/api/v1/worlds/{WORLD}/evaluations/?run={last}", token))
            reached.setdefault("first", seconds)
            if right > good:
                reached["good"] = seconds
            print(
                f"{seconds:5.1f} s ({site.processor_seconds() - spent:.1f} s of processor time): {answer['parser']}, "
                f"right on {right:.1f} % of validation paraphrases",
                flush=True,
            )
        time.sleep(0.5)
    return reached


def accuracy(answer: Any) -> float:
    """Return how often a run is right on validation paraphrases, in percent, from its evaluations."""
    wanted = ("para", "validation")
    scores = (answer or {}).get("results", [])
    return next(
        (100 * s["accuracy"] for s in scores if (s["test_source"], s["part"]) == wanted), 0.0
    )


def processor() -> str:
    """Return the name of the processor, its cores, and whether it computes in bf16."""
    lines = Path("/proc/cpuinfo").read_text().splitlines()
    about = {
        key.strip(): value.strip() for key, _, value in (line.partition(":") for line in lines)
    }
    has_bf16 = set(BF16) & set(about.get("flags", about.get("Features", "")).split())
    name = about.get("model name", "a processor without a name")
    return f"{name}, {os.cpu_count()} cores, {'with' if has_bf16 else 'without'} bf16"


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    arguments.add_argument("--minutes", type=float, default=15.0, help="after which it gives up")
    arguments.add_argument("--good", type=float, default=70.0, help="percent of the paraphrases")
    given = arguments.parse_args()
    print(f"{processor()}; load {os.getloadavg()[0]:.1f}")
    with tempfile.TemporaryDirectory() as folder, Installation(folder) as site:
        reached = measure(site, given.minutes, given.good)
    bounds = {"first": MOST_SECONDS_TO_FIRST, "good": MOST_SECONDS_TO_GOOD}
    for name, bound in bounds.items():
        seconds = reached.get(name)
        verdict = "held" if seconds is not None and seconds <= bound else "MISSED"
        said = "none" if seconds is None else f"{seconds:.1f} s"
        print(f"{name} answer: {said}   (bound {bound:g} s: {verdict})")
    if any(reached.get(name, bound + 1) > bound for name, bound in bounds.items()):
        sys.exit(1)


if __name__ == "__main__":
    main()
