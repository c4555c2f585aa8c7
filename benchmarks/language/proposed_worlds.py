"""What a world that was proposed from 20 commands answers to 40 other wordings, before and after a parser is trained.

    .venv/bin/python -m benchmarks.language.proposed_worlds [--parser linear] [--config KEY=VALUE …]

Stores each domain beside this module, corrected as a person would (``induction``), in a fresh installation, and asks
``parse`` all wordings, which joins several commands. Then freezes a split, trains the parser,
promotes its run, and asks again. Prints how many wordings are answered with their form, how many with
another one, and how many of these a robot would act on.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import tomllib
from collections import Counter
from pathlib import Path
from typing import Any

from annotations.language.forms import canonical_text, read_form
from benchmarks.fresh_site import ROOT, Site
from benchmarks.language.induction import DOMAINS, corrected

STORE = """
import sys
from annotations.labelling.storing_examples import store_examples
from annotations.models import User, World
name, lines = {name!r}, {lines!r}
admin = User.objects.filter(is_superuser=True).first() or User.objects.create_superuser("admin")
store_examples(World.objects.create(name=name), lines, admin)
"""
PROMOTE = """
from annotations.models import User
from parser_service.models import TrainingRun
from parser_service.runs.promoting import promote
promote(TrainingRun.objects.get(world__name={name!r}), User.objects.get(username="admin"), "asked")
"""


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    options.add_argument("--parser", default="linear")
    options.add_argument("--config", nargs="*", default=[])
    given = options.parse_args()
    print("domain       answered by       right  another form  of these acted on")
    with tempfile.TemporaryDirectory() as folder:
        site = Site(Path(folder))
        for path in sorted(DOMAINS.glob("*.toml")):
            domain = tomllib.loads(path.read_text(encoding="utf-8"))
            lines, _ = corrected(domain)
            run(site, "shell", "-c", STORE.format(name=path.stem, lines=lines))
            show(path.stem, "the oracle", answers(site, Path(folder), path.stem, domain))
            run(site, "generate_pairs", path.stem)
            run(site, "freeze_split", path.stem, "--name", "all", "--criterion", "command")
            config = ["--config", *given.config] if given.config else []
            where = ("--world", path.stem, "--split", "all", "--sources", "gen")
            run(site, "train", given.parser, *where, *config)
            run(site, "shell", "-c", PROMOTE.format(name=path.stem))
            show(path.stem, f"and {given.parser}", answers(site, Path(folder), path.stem, domain))


def run(site: Site, *arguments: str) -> None:
    """Run a command. Exits where it fails."""
    if (made := site.run(*arguments)).status:
        sys.exit(made.errors)


def answers(site: Site, folder: Path, world: str, domain: dict[str, Any]) -> Counter[str]:
    """Return how many wordings are right, another form, and wrongly acted on."""
    asked = folder / "asked.txt"
    asked.write_text("\n".join(each["said"] for each in domain["held_out"]), encoding="utf-8")
    command = [
        sys.executable,
        "manage.py",
        "parse",
        "--file",
        str(asked),
        "--world",
        world,
        "--json",
    ]
    said = subprocess.run(
        command, cwd=ROOT, env=site.environment, check=True, capture_output=True, text=True
    )
    counts: Counter[str] = Counter()
    for wording, line in zip(domain["held_out"], said.stdout.splitlines(), strict=True):
        answer = json.loads(line)
        form = form_of(answer)
        means = canonical_text(read_form(wording["means"])) if wording["means"] else ""
        counts["right"] += form == means
        counts["other"] += bool(form) and form != means
        counts["acted on"] += bool(form) and form != means and answer.get("decision") == "act"
    return counts


def form_of(answer: dict[str, Any]) -> str:
    """Return the canonical form of an answer, several commands as a sequence; empty where nothing was understood."""
    forms = [
        each["grounded"]
        for part in answer["several"] or [answer]
        for each in part["candidates"][:1]
    ]
    if not forms or len(forms) < len(answer["several"]):
        return ""
    return canonical_text(
        read_form(forms[0] if len(forms) == 1 else f"(sequence {' '.join(forms)})")
    )


def show(world: str, by: str, counts: Counter[str]) -> None:
    print(f"{world:12} {by:15} {counts['right']:>7} {counts['other']:>13} {counts['acted on']:>18}")


if __name__ == "__main__":
    main()
