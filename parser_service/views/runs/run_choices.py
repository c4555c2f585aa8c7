"""What the form for a run opens with: choices in the address survive a change of parser and a reload,
and a run can be asked for again with its own values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from django.http import QueryDict
from django.utils.http import urlencode

from annotations.models import World
from parser_service.models import TrainingRun
from parser_service.parsers.registry import PARSERS, config_fields
from parser_service.views.runs.run_forms import GENERAL, PREFIX

DEFAULT_PARSER = next(iter(PARSERS))


@dataclass(frozen=True, slots=True)
class RunChoices:
    """The parser, and what the fields of its form hold at first; ``note`` is a sentence about what
    could not be kept, or empty."""

    parser: str
    initial: dict[str, Any] = field(default_factory=dict)
    note: str = ""


def choices_in(query: QueryDict, world: World) -> RunChoices:
    """Read the choices from an address: ``like`` names a run to ask for again, everything else is
    called as its field. What no field knows is left out."""
    like = query.get("like", "")
    run = world.runs.filter(pk=like).first() if like.isdecimal() and len(like) < 19 else None
    parser = query.get("parser", run.parser if run else DEFAULT_PARSER)
    if parser not in PARSERS:
        return RunChoices(DEFAULT_PARSER, note=f"There is no parser called {parser!r} any more.")
    initial = values_of(run, parser) if run else {}
    names = [*GENERAL, *(PREFIX + each.name for each in config_fields(parser))]
    initial.update({name: query[name] for name in names if name in query})
    return RunChoices(parser, initial, _note(parser, initial))


def values_of(run: TrainingRun, parser: str) -> dict[str, Any]:
    """Return what the form for ``parser`` takes over from ``run``; hyperparameters from the same parser only."""
    general = {
        "split": run.split_id,
        "train_sources": run.train_sources,
        "protocol": run.protocol,
        "seed": run.seed,
        "share": float(f"{100 * run.train_share:g}"),
    }
    config = run.config if parser == run.parser else {}
    return {**general, **{PREFIX + name: value for name, value in config.items()}}


def query_of(posted: Mapping[str, str], parser: str, shown: str) -> str:
    """Return the address of the form for ``parser`` with the choices that were made while the form for
    ``shown`` was open."""
    kept = {name: posted[name] for name in GENERAL if name in posted}
    if parser == shown:
        defaults = {PREFIX + each.name: str(each.default) for each in config_fields(parser)}
        kept |= {
            name: posted[name]
            for name, default in defaults.items()
            if posted.get(name, default) != default
        }
    return urlencode({"parser": parser, **kept})


def _note(parser: str, initial: Mapping[str, Any]) -> str:
    protocol, entry = initial.get("protocol"), PARSERS[parser]
    if protocol in (None, "", *entry.protocols):
        return ""
    return f"{entry.title} has no {protocol} protocol; {entry.protocols[0]} is chosen instead."
