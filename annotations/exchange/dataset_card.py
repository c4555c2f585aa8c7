"""The card of a data set of Hugging Face: what a split is, and where its parts lie."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

COLUMNS = {
    "position": "the place of the pair in the split",
    "part": "train, validation or test",
    "source": "generated, paraphrased, model or said: who said it",
    "utterance": "the command, with a token such as `<room>` for each entity",
    "source_command": "the generated command that a paraphrase rewrites",
    "task_category": "the category of the task",
    "logical_form": "what it means, in λ-calculus",
    "grounded_form": "the same with the entities of the prompt, where there was one",
}


def write_card(manifest: Mapping[str, Any], parts: Mapping[str, str]) -> str:
    """Return the ``README.md`` of a data set with the files ``parts``, part → path, of an exported split.

    ``manifest`` is that of ``split_manifest``.
    """
    files = "".join(f"  - split: {part}\n    path: {path}\n" for part, path in parts.items())
    rows = "".join(
        f"| {source} | " + " | ".join(f"{counts[part]:,}" for part in parts) + " |\n"
        for source, counts in manifest["counts"].items()
        if any(counts.values())
    )
    columns = "".join(f"| `{name}` | {what} |\n" for name, what in COLUMNS.items())
    sample = manifest["sample"]
    of_sample = f", of a sample of {sample['commands']:,} commands" if sample else ""
    return f"""---
pretty_name: {manifest["world"]}, {manifest["split"]}
language:
- en
tags:
- semantic-parsing
- robotics
configs:
- config_name: default
  data_files:
{files}---

# {manifest["world"]}, {manifest["split"]}

Commands for a service robot and their logical forms{of_sample}. No two parts share a
{manifest["criterion"].replace("_", " ")}.

| who said it | {" | ".join(parts)} |
|{" --- |" * (len(parts) + 1)}
{rows}
| column | what it holds |
| --- | --- |
{columns}
Frozen by GPSR Workbench {manifest["code_version"]} at {manifest["created_at"]}, seed {manifest["seed"]}. The SHA-256 of
all examples of the split is `{manifest["content_hash"]}`.

Add a licence before you publish it.
"""
