"""Read the bytes of an uploaded file as text, or say what is wrong with them."""

from __future__ import annotations

import codecs
import os
import re
from collections.abc import Iterator, Sequence
from pathlib import Path

from annotations.language.texts.errors import LanguageError, Offsets, Position, Problem, warning_at
from annotations.language.texts.limits import MAX_FILE_NAME, require_name
from annotations.language.texts.text import changes_by_line, normalise


class EmptyFile(LanguageError):
    """A file without any text."""


UTF8 = "utf-8"
# What a file may be read as, by Python's names, and what each is called for people.
ENCODINGS = {
    UTF8: "UTF-8",
    "windows-1252": "Western European (Windows-1252)",
    "iso-8859-15": "Western European (ISO 8859-15)",
    "mac-roman": "Western European (Mac Roman)",
    "windows-1250": "Central European (Windows-1250)",
    "windows-1251": "Cyrillic (Windows-1251)",
    "shift_jis": "Japanese (Shift JIS)",
    "gb18030": "Chinese (GB 18030)",
    "euc-kr": "Korean (EUC-KR)",
    "utf-16": "UTF-16",
    "utf-16-le": "UTF-16, little-endian",
    "utf-16-be": "UTF-16, big-endian",
}
# What XML may declare: encodings of texts alone.
_DECLARABLE = (
    *ENCODINGS, "ascii", "koi8-r", "koi8-u", "euc-jp", "iso2022_jp", "gb2312", "gbk", "big5", "utf-32",
    "mac-cyrillic",
    *(f"iso-8859-{number}" for number in (*range(1, 12), *range(13, 17))),
    *(f"cp{number}" for number in (*range(1250, 1259), 437, 850, 852, 866, 874)),
)  # fmt: skip
_DECLARATION = re.compile(rb"""<\?xml\s[^<>]*?\bencoding\s*+=\s*+["']([\w.:-]++)["']""")
_LONGEST_DECLARATION = 200
_LONGEST_PREVIEW = 60
_MOST_OFFERS = 4
_UTF16_MARKS = (b"\xff\xfe", b"\xfe\xff")
_BYTE_ORDER_MARK = "\ufeff"
_SAVE_AS = "save it as UTF-8 text"
_PUT_IT_HERE = "put the file itself here, or name the folder that holds both"
MAX_FILES = 200
MAX_FILE_BYTES = 20_000_000
MAX_LINKS = 5  # one behind another
_LONGEST_LINK = 300


def read_folder(
    folder: Path, pattern: str = "*", most_bytes: int = MAX_FILE_BYTES
) -> dict[str, bytes]:
    """Return the files directly in ``folder`` whose names match ``pattern``: name → bytes.

    Raises:
        LanguageError: there is no such folder, a file cannot be read or is larger than
            ``most_bytes``, there are more than ``MAX_FILES``, or a link points outside the folder.
    """
    if not folder.is_dir():
        raise LanguageError("there is no such folder", Position(folder.name))
    paths = sorted(path for path in folder.glob(pattern) if path.is_file())
    if len(paths) > MAX_FILES:
        raise LanguageError(
            f"the folder holds {len(paths)} files; {MAX_FILES} is the limit", Position(folder.name)
        )
    return {path.name: read_file(path, folder, most_bytes) for path in paths}


def walk_folder(folder: Path, problems: list[Problem]) -> Iterator[Path]:
    """Yield the files in and below ``folder``. Hidden ones are skipped, and links to folders followed, each once.

    A link that leads out of the folder joins the ``problems``.

    Raises:
        LanguageError: there is no such folder.
    """
    if not folder.is_dir():
        raise LanguageError("there is no such folder", Position(folder.name))
    for directory, _, names in _walk(folder, problems):
        yield from (Path(directory, name) for name in sorted(names) if not name.startswith("."))


def _walk(
    folder: Path, problems: list[Problem]
) -> Iterator[tuple[str, Sequence[str], Sequence[str]]]:
    """Walk as ``os.walk`` does, but skip hidden folders and follow links to folders, each once."""
    real_folder = os.path.realpath(folder)
    seen: set[str] = set()
    for directory, subfolders, names in os.walk(folder, followlinks=True):
        followed: list[str] = []
        seen.add(os.path.realpath(directory))
        for name in sorted(name for name in subfolders if not name.startswith(".")):
            path = Path(directory, name)
            real = os.path.realpath(path)
            if path.is_symlink():
                is_around = Path(real_folder).is_relative_to(real)
                if is_around or real in seen or Path(real).is_relative_to(real_folder):
                    continue  # it is read where it is
                if why := why_outside(path, folder):
                    place = Position(path.relative_to(folder).as_posix())
                    problems.append(warning_at(place, f"{why}; left out", _PUT_IT_HERE))
                    continue
            followed.append(name)
            seen.add(real)
        subfolders[:] = followed
        yield directory, subfolders, names


def file_name(written: bytes) -> str:
    """Return the name of a file as text: UTF-8, or else that of the oldest zip archives (code page 437)."""
    try:
        return written.decode()
    except UnicodeDecodeError:
        return written.decode("cp437")


def link_target(data: bytes, name: str) -> str | None:
    """Return the target of a link that was stored as a text file ``name``; None for any other file.

    Git writes a link as a text of one line, a relative path, where the system knows no links.
    """
    if len(data) > _LONGEST_LINK or b"\n" in data.strip():
        return None
    try:
        target = data.decode().strip()
    except UnicodeDecodeError:
        return None
    is_alike = Path(target).suffix.lower() == Path(name).suffix.lower() != ""
    is_path = "/" in target or " " not in target
    return target if is_alike and is_path and not set(target) & set("<>{}=$*?|\0") else None


def read_file(path: Path, folder: Path, most_bytes: int) -> bytes:
    """Return the content of a file in ``folder``, or of the file that it links to.

    A link may point to a file below the folder, or below the root of the repository that the folder is in.

    Raises:
        LanguageError: it cannot be read, is larger than ``most_bytes``, or links to a file elsewhere.
    """
    place = Position(path.relative_to(folder).as_posix())
    try:
        for _ in range(MAX_LINKS):
            if why := why_outside(path, folder):
                raise LanguageError(why, place, _PUT_IT_HERE)
            if path.stat().st_size > most_bytes:
                raise LanguageError(f"the file is larger than {most_bytes:,} bytes", place)
            data = path.read_bytes()
            target = link_target(data, path.name)
            if target is None:
                return data
            path = Path(os.path.realpath(path)).parent / target
    except OSError as error:
        raise LanguageError(f"the file cannot be read: {error.strerror}", place) from error
    raise LanguageError("this link leads through too many others", place, _PUT_IT_HERE)


def why_outside(path: Path, folder: Path) -> str:
    """Return why a link below ``folder`` is not followed; empty if it is followed or is not a link."""
    inside, real = Path(os.path.realpath(folder)), Path(os.path.realpath(path))
    if real.is_relative_to(inside):
        return ""
    root = next((each for each in (inside, *inside.parents) if (each / ".git").exists()), None)
    if root is None or not real.is_relative_to(root):
        return "this link points outside its folder, and outside the repository that it is in"
    is_hidden = any(part.startswith(".") for part in real.relative_to(root).parts)
    if is_hidden or real.suffix.lower() != path.suffix.lower():
        return "this link points to a file of another kind"
    return ""


def read_text(data: bytes, source: str = "") -> tuple[str, list[Problem]]:
    """Return the text of a file, normalised, and a warning for each line in which that changed something.

    Raises:
        LanguageError: as ``decode`` does.
    """
    written = decode(data, source)
    text = normalise(written)
    require_something(text, source)
    return text, changes_by_line(written, source)


def decode(data: bytes, source: str = "") -> str:
    """Decode UTF-8 to text without a leading byte-order mark and with ``\\n`` for every line end.

    XML is decoded as it declares. All other characters stay as they are: for files that are kept byte for byte.

    Raises:
        LanguageError: the data are UTF-16, binary, not UTF-8 (at the first bad byte, with what other
            encodings would read there) or not what XML declares, or the name of the file is too long.
        EmptyFile: there is no text in it.
    """
    require_name(source, "file name", MAX_FILE_NAME, Position(source[:MAX_FILE_NAME]))
    encoding = _encoding_of_xml(data, source) if source.lower().endswith(".xml") else UTF8
    if encoding == UTF8 and data.startswith(_UTF16_MARKS):
        raise LanguageError("the file is UTF-16, not UTF-8", Position(source), _offer(data, 0))
    text = _decode_as(data, encoding, source).removeprefix(_BYTE_ORDER_MARK)
    if "\0" in text:
        place = Offsets(text, source).position(text.index("\0"))
        sentence = "the file is binary or UTF-16, not UTF-8 text"
        raise LanguageError(sentence, place, _offer(data, data.index(b"\0")))
    require_something(text, source)
    return text.replace("\r\n", "\n").replace("\r", "\n")


def to_utf8(data: bytes, encoding: str, source: str) -> bytes:
    """Return a file in UTF-8: a file in another encoding is read as ``encoding``.

    Raises:
        LanguageError: the file cannot be read as ``encoding``, or that is not one of ``ENCODINGS``.
    """
    if encoding not in ENCODINGS:
        raise LanguageError(
            f"there is no choice of the encoding “{encoding}”",
            hint=f"known are {', '.join(ENCODINGS)}",
        )
    try:
        decode(data, source)
    except EmptyFile:
        return data
    except LanguageError:
        text = _decode_as(data, encoding, source).removeprefix(_BYTE_ORDER_MARK)
        mark = codecs.BOM_UTF8 if source.lower().endswith(".xml") else b""
        return mark + text.encode()  # what XML declares gives way to the mark
    return data


def _decode_as(data: bytes, encoding: str, source: str) -> str:
    try:
        return data.decode(encoding)
    except UnicodeDecodeError as error:
        before = data[: error.start].decode(encoding, "replace")
        place = Offsets(before, source).position(len(before))
        name = "UTF-8" if encoding == UTF8 else encoding
        hint = _offer(data, error.start) if encoding == UTF8 else _SAVE_AS
        sentence = f"the byte 0x{data[error.start]:02x} is not {name}"
        raise LanguageError(sentence, place, hint) from error


def _encoding_of_xml(data: bytes, source: str) -> str:
    """Return the encoding that a document has by its byte-order mark, by its declaration, or UTF-8.

    Raises:
        LanguageError: it declares one that is unknown.
    """
    if data.startswith(codecs.BOM_UTF8):
        return UTF8
    if data.startswith(_UTF16_MARKS):
        return "utf-16"
    for encoding in ("utf-16-le", "utf-16-be"):
        if data.startswith("<?".encode(encoding)):
            return encoding
    match = _DECLARATION.match(data[:_LONGEST_DECLARATION])
    if match is None:
        return UTF8
    declared = match[1].decode("ascii", "replace")
    try:
        encoding = codecs.lookup(declared).name
    except LookupError:
        encoding = ""
    if encoding not in {codecs.lookup(name).name for name in _DECLARABLE}:
        sentence = f"the document declares the encoding “{declared}”, which is not known here"
        raise LanguageError(sentence, Position(source), _SAVE_AS)
    # A declaration that reads as ASCII is not UTF-16 or UTF-32, whatever it says.
    return UTF8 if encoding.startswith(("utf-16", "utf-32")) else encoding


def _offer(data: bytes, at: int) -> str:
    """Return the hint for a file that is not UTF-8: how other encodings read the line of ``at``.

    Only the first few different readings are listed; more would hide the right one.
    """
    readings: dict[str, str] = {}  # what is read → the first encoding that reads it
    for encoding in ENCODINGS:
        is_utf16 = encoding.startswith("utf-16")
        has_mark = data.startswith(_UTF16_MARKS)
        if is_utf16 != (has_mark or b"\0" in data):
            continue
        if is_utf16 and has_mark != (encoding == "utf-16"):
            continue
        start = 0 if is_utf16 else data.rfind(b"\n", 0, at) + 1
        piece = data[start : start + 4 * _LONGEST_PREVIEW]
        try:
            lines = piece.decode(encoding, "ignore" if is_utf16 else "strict").split("\n")
        except UnicodeDecodeError:
            continue
        written = next((line for line in lines if line.strip()), "")
        line = " ".join(written.split())[:_LONGEST_PREVIEW]
        if line.isprintable():
            readings.setdefault(line, encoding)
    offers = [f"as {encoding} it reads “{line}”" for line, encoding in readings.items()]
    del offers[_MOST_OFFERS:]
    return "; ".join([_SAVE_AS, *offers])


def require_something(text: str, source: str) -> None:
    """Raise EmptyFile if the text of a file holds nothing but blanks."""
    if not text.strip():
        raise EmptyFile("the file is empty", Position(source), "remove it, or fill it")
