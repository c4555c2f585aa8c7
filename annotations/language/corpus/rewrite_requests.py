"""What a language model is asked when it is to paraphrase a command."""

from __future__ import annotations

from collections.abc import Sequence
from hashlib import sha256

from annotations.language.corpus.rewrite_checks import Named
from annotations.language.texts import Refusal

LONGEST_INSTRUCTIONS = 4_000  # characters
INSTRUCTIONS = """\
People give commands to a robot in a home. Say the command below in {count} other ways,
as different people would say it.
The first may be elaborate, with a reason. Each one after it is plainer. The last is as short as it can be.
Every one has to ask for exactly the same, no more and no less.
Keep these names exactly as they are written: {names}.
Answer with {count} numbered lines and nothing else.

Command: {command}
"""
_PLACES = ("command", "count", "names")
_NEEDED = "command"


def instructions_version(instructions: str) -> str:
    """Return eight hexadecimal digits that tell these instructions from others."""
    return sha256(instructions.encode()).hexdigest()[:8]


def check_instructions(instructions: str) -> None:
    """Refuse instructions that do not say where the command goes.

    Raises:
        Refusal: they are too long, or lack ``{command}``.
    """
    if len(instructions) > LONGEST_INSTRUCTIONS:
        sentence = f"Use at most {LONGEST_INSTRUCTIONS:,} characters for the instructions."
        raise Refusal(sentence, "too_long")
    if f"{{{_NEEDED}}}" not in instructions:
        sentence = "Write {command} where the command goes in the instructions."
        raise Refusal(sentence, "no_command_place")


def rewrite_request(instructions: str, prompt: str, entities: Sequence[Named], count: int) -> str:
    """Return the instructions with the command, its names, and the number of rewrites in their places.

    Other braces stay as they are. A description may be reworded, so that it is no name to keep.
    """
    names = [f"“{each.text}”" for each in entities if not each.is_described]
    values = {"command": prompt, "count": str(count), "names": ", ".join(names) or "(none)"}
    # The command last: what looks like a place in it stays.
    for place in sorted(_PLACES, key=lambda name: name == _NEEDED):
        instructions = instructions.replace(f"{{{place}}}", values[place])
    return instructions
