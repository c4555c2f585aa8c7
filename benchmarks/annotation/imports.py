"""What importing, generating and refusing cost: processor time of whole commands, database included.

    GPSR_SHARED_DATA=… .venv/bin/python -m benchmarks.annotation.imports

Each command runs as a process of its own on a fresh SQLite database. The bound beside a figure is the
one the project promises.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

from benchmarks.fresh_site import DATA, Site

# What is refused, as files of one folder.
FAULTS: dict[str, dict[str, bytes]] = {
    "a cycle": {"a.txt": b"$Main = $a\n$a = go $Main\n"},
    "a 5,000-deep parenthesis": {"a.txt": b"$Main = " + b"(" * 5000 + b"a" + b")" * 5000},
    "an entity bomb": {
        "objects.xml": b'<?xml version="1.0"?><!DOCTYPE x [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;&a;">]>'
        b"<categories>&b;</categories>"
    },
    "a file outside the folder": {"a.txt": b"; import ../../etc/passwd\n$Main = go\n"},
    "a UTF-16 file": {"a.txt": "$Main = go\n".encode("utf-16")},
}


def report(name: str, seconds: float, bound: float | None = None) -> None:
    verdict = (
        ""
        if bound is None
        else f"   (bound {bound:g} s: {'held' if seconds < bound else 'MISSED'})"
    )
    print(f"{seconds:8.2f} s  {name}{verdict}")


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        site = Site(Path(folder) / "var")
        imported = site.run(
            "import_generator", str(DATA / "generator-2018"), "--world", "g", "--json"
        )
        generated = site.run("generate_pairs", "g", "--json")
        report("import_generator 2018, processor", imported.processor)
        report("generate_pairs 2018, processor", generated.processor)
        report("both", imported.processor + generated.processor, 5.0)
        pairs = site.run("import_pairs", str(DATA / "walker2019"), "--world", "g", "--name", "w")
        report("import_pairs walker2019, processor", pairs.processor)
        for name, files in FAULTS.items():
            bad = Path(folder) / name.replace(" ", "-")
            bad.mkdir()
            for file, data in files.items():
                (bad / file).write_bytes(data)
            refused = site.run("import_generator", str(bad), "--world", "bad", "--json")
            report(f"refuse {name}, wall, exit status {refused.status}", refused.wall, 2.0)


if __name__ == "__main__":
    main()
