"""A hash of everything that decides a run's result, so that identical runs are reused."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from hashlib import sha256
from typing import Any

from annotations.language.corpus import KNOWN_SHARE, Criterion
from annotations.language.forms import DEFAULT_CLASSES
from annotations.models import Split, World
from annotations.models.description import TemplateStatus
from annotations.rows.from_rows import classes_of
from parser_service.parsers.registry import entry


def content_key(
    split: Split,
    parser: str,
    config: Mapping[str, Any],
    protocol: str,
    train_sources: str,
    seed: int,
    train_share: float = 1.0,
) -> str:
    """Hash the split, the parser and its version, its configuration and protocol, and the seed (SHA-256).

    The share of the training pairs counts where it is not all of them: runs on all pairs keep the keys
    that they had before there were shares.
    """
    share = {} if train_share == 1 else {"train_share": train_share}
    # By form, some pairs of known forms are held out; runs on other splits keep their keys.
    held_out = {"known": KNOWN_SHARE} if split.criterion == Criterion.LOGICAL_FORM else {}
    return _hash(
        {
            "split": split.content_hash,
            "train_sources": train_sources,
            "parser": parser,
            "version": entry(parser).version,
            "config": dict(config),
            "protocol": protocol,
            "knowledge": knowledge_hash(split.world, protocol),
            "seed": seed,
            **share,
            **held_out,
        }
    )


def knowledge_hash(world: World, protocol: str) -> str:
    """Hash the part of ``world`` that ``protocol`` lets a parser read (SHA-256)."""
    rows: dict[str, Any] = {}
    if protocol in ("domain", "grammar"):
        rows["predicates"] = list(
            world.predicates.order_by("name").values("name", "kind", "signatures", "gloss")
        )
        ontology = getattr(world, "ontology", None)
        fields = ("entity_class", "text", "aliases", "attributes")
        entities = ontology.entities.order_by("position").values(*fields) if ontology else ()
        rows["entities"] = list(entities)
        classes = classes_of(world)
        if (
            classes != DEFAULT_CLASSES
        ):  # worlds as they begin keep the keys of before there were others
            rows["classes"] = [asdict(each) for each in classes]
    if protocol == "grammar":
        grammar = getattr(world, "grammar", None)
        rows["grammar"] = {}
        if grammar:
            categories = grammar.task_categories.order_by("position")
            productions = grammar.productions.order_by("position")
            templates = grammar.templates.filter(status=TemplateStatus.READY).order_by("position")
            rows["grammar"] = {
                "task_categories": list(
                    categories.values("name", "rule_sources", "template_sources")
                ),
                "productions": list(productions.values("source", "nonterminal", "expansion")),
                "templates": list(templates.values("source", "pattern", "form")),
            }
    return _hash(rows)


def _hash(value: Any) -> str:
    """Return the SHA-256 of ``value`` as JSON with sorted keys."""
    text = json.dumps(value, sort_keys=True, ensure_ascii=False)
    return sha256(text.encode()).hexdigest()
