"""How long a proposal takes from lines that are made to be alike, against the number of lines.

    .venv/bin/python -m benchmarks.language.hostile_lines

Each line has 28 words. Prints the processor seconds of 25, 50, 100 and 200 lines, which is the limit.
"""

from __future__ import annotations

import random
import time
from collections.abc import Callable

from annotations.language.induction import MOST_LINES, propose

LINES = (25, 50, 100, MOST_LINES)
ALIKE = ["same"] * 25
WORDS = random.Random(1)

KINDS: dict[str, Callable[[int], list[str]]] = {
    "other verbs": lambda n: [f"v{n}", *ALIKE, "the", "[x](c)"],
    "another word in one place": lambda n: ["go", f"w{n}", *ALIKE, "[x](c)"],
    "few words in any order": lambda n: [
        "go",
        *WORDS.choices(["a", "b", "c", "d"], k=26),
        "[x](c)",
    ],
    "the same, of one action": lambda n: ["go", *WORDS.choices("abcdefgh", k=26), "[x](c) = do"],
    "marks and prepositions": lambda n: ["go", *WORDS.choices(["[x](c)", "to", "[y](d)"], k=27)],
    "pairs of words of one action": lambda n: [f"v{n % 15}", *ALIKE, f"o{n // 15}", "[x](c) = do"],
}


def main() -> None:
    print(f"{'lines':28}", *(f"{number:>7}" for number in LINES))
    for name, line_of in KINDS.items():
        seconds = []
        for number in LINES:
            text = "\n".join(" ".join(line_of(n)) for n in range(number))
            begun = time.process_time()
            propose(text)
            seconds.append(time.process_time() - begun)
        print(f"{name:28}", *(f"{each:>7.2f}" for each in seconds))


if __name__ == "__main__":
    main()
