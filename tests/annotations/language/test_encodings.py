"""Files that are not UTF-8: XML is read as it declares, everything else where somebody says what it is."""

from __future__ import annotations

import pytest

from annotations.language.texts.decoding import ENCODINGS, decode, to_utf8
from annotations.language.texts.errors import LanguageError, Position
from annotations.language.world import read_ontology

NAMES = "<names>\n<name>Gabriëlle</name>\n</names>"


def declared(encoding: str) -> str:
    return f'<?xml version="1.0" encoding="{encoding}" standalone="yes"?>\n{NAMES}'


@pytest.mark.parametrize(
    ("encoding", "codec"),
    [
        *(
            (name, name)
            for name in ("ISO-8859-1", "iso-8859-15", "windows-1252", "UTF-16", "utf-8", "UTF8")
        ),
        *(
            ("UTF-16", "utf-16-le"),
            ("UTF-16", "utf-16-be"),
            ("utf-16", "utf-8"),
            ("latin1", "latin-1"),
        ),
        *(("iso-8859-1", "utf-8-sig"), ("IBM850", "cp850"), ("macintosh", "mac-roman")),
    ],
)
def test_xml_is_read_as_it_declares(encoding: str, codec: str) -> None:
    ontology, problems = read_ontology({"Names.XML": declared(encoding).encode(codec)})
    assert problems == ()
    assert ontology.texts_of("name") == ("Gabriëlle",)
    assert ontology.entities[0].position == Position("Names.XML", 3, 1)


@pytest.mark.parametrize(
    "encoding", ["x-nothing", "rot13", "base64", "hex", "utf-7", "unicode_escape", "zlib"]
)
def test_an_encoding_that_no_text_has_is_refused_by_its_name(encoding: str) -> None:
    _, (problem,) = read_ontology({"names.xml": declared(encoding).encode("latin-1")})
    assert problem.is_error and encoding in problem.message


def test_a_byte_that_is_not_what_xml_declares_has_its_place() -> None:
    data = declared("windows-1252").encode("cp1252").replace(b"\xeb", b"\x81")
    _, (problem,) = read_ontology({"names.xml": data})
    assert problem.position == Position("names.xml", 3, 12)


@pytest.mark.parametrize(
    "encoding", ["windows-1252", "utf-16", "utf-16-le", "utf-16-be", "mac-roman"]
)
def test_the_advice_shows_what_an_encoding_reads_which_then_reads_it(encoding: str) -> None:
    text = "$Main = a\n$b = “café” für Zoë\n"
    data = text.encode(encoding)
    with pytest.raises(LanguageError) as refused:
        decode(data, "a.txt")
    line = "$Main = a" if "16" in encoding else "$b = “café” für Zoë"
    assert f"as {encoding} it reads “{line}”" in refused.value.hint
    assert decode(to_utf8(data, encoding, "a.txt"), "a.txt") == text


def test_what_is_utf8_stays_whatever_was_chosen() -> None:
    for encoding in ENCODINGS:
        for data in (
            "é\r\n".encode(),
            b"\xef\xbb\xbfa",
            b"",
            b" \n",
            declared("latin1").encode("latin-1"),
        ):
            assert to_utf8(data, encoding, "names.xml") is data


def test_what_cannot_be_read_so_has_its_place() -> None:
    with pytest.raises(LanguageError) as refused:
        to_utf8(b"a\n\xe9\x81", "windows-1252", "a.txt")
    assert refused.value.position == Position("a.txt", 2, 2)
    with pytest.raises(LanguageError):
        to_utf8(b"\xe9", "punycode", "a.txt")
