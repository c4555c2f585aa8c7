"""One fault each: what is put into the files, and where and how it is reported."""

from __future__ import annotations

from dataclasses import dataclass

GRAMMAR, TEMPLATES = "tiny_category_1_grammar.txt", "tiny_category_1_semantics.txt"
PNG = b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR"
BOMB = (
    '<?xml version="1.0"?><!DOCTYPE z [<!ENTITY a "aaaaaaaaaa">'
    + "".join(
        f'<!ENTITY {n} "{f"&{p};" * 10}">' for p, n in zip("abcdefgh", "bcdefghi", strict=True)
    )
    + "]><categories><category name='&i;'/></categories>"
)
EXTERNAL = (
    '<!DOCTYPE z [<!ENTITY x SYSTEM "file:///etc/passwd">]>'
    "<categories><category name='&x;'/></categories>"
)


@dataclass(frozen=True)
class Fault:
    """``data`` is added to the file ``name``, or replaces it; the report names the place and cause."""

    name: str
    data: str | bytes
    line: int
    cause: str
    replaces: bool = False

    def put_into(self, files: dict[str, bytes]) -> None:
        data = self.data if isinstance(self.data, bytes) else self.data.encode()
        files[self.name] = data if self.replaces else files[self.name] + data


FAULTS = {
    "a cycle": Fault(GRAMMAR, "$Main = $a\n$a = $b\n$b = $a\n", 6, "a cycle: $a → $b → $a"),
    "an unbalanced choice": Fault(GRAMMAR, "$Main = ( a | b\n", 4, "never closed"),
    "an unknown wildcard": Fault(GRAMMAR, "$Main = see {planet}\n", 4, "planet"),
    "an unbound variable": Fault(TEMPLATES, "go to {room} = (go $2)\n", 4, "no λ binds"),
    "a slot that only the form has": Fault(
        TEMPLATES, "go to the {room} = (go {beacon})\n", 4, "which the pattern never produces"
    ),
    "an import that leaves the folder": Fault(
        GRAMMAR, "; import ../../etc/passwd\n", 4, "leads out of the folder"
    ),
    "a pattern 5,000 deep": Fault(GRAMMAR, "$Main = " + "(" * 5_000 + "\n", 4, "deep"),
    "a form 1,000 deep": Fault(TEMPLATES, "go = " + "(a " * 1_000 + ")" * 1_000, 4, "deep"),
    "an entity bomb": Fault("objects.xml", BOMB, 1, "entit", replaces=True),
    "an external entity": Fault("objects.xml", EXTERNAL, 1, "entit", replaces=True),
    "a picture for XML": Fault("objects.xml", PNG, 1, "UTF-8", replaces=True),
    "a picture for a grammar": Fault(GRAMMAR, PNG, 1, "UTF-8", replaces=True),
    "XML for a grammar": Fault(GRAMMAR, "<rooms/>", 1, "not a grammar file", replaces=True),
    "prose for templates": Fault(
        TEMPLATES, "Dear all,\n", 1, "no semantic template", replaces=True
    ),
    "a grammar for XML": Fault("objects.xml", "$Main = hello\n", 1, "XML", replaces=True),
    "rooms for objects": Fault("objects.xml", "<rooms/>", 1, "categories", replaces=True),
    "an empty grammar": Fault(GRAMMAR, "", 1, "empty", replaces=True),
    "an empty XML file": Fault("objects.xml", "", 1, "empty", replaces=True),
    "a UTF-16 file": Fault(GRAMMAR, "$Main = hi\n".encode("utf-16"), 1, "UTF-16", replaces=True),
}
