"""Bytes of an uploaded file → text, or a sentence that says what the file is instead."""

from __future__ import annotations

from pathlib import Path

from annotations.language.errors import LanguageError, Position

_UTF16_MARKS = (b"\xff\xfe", b"\xfe\xff")
_BYTE_ORDER_MARK = "\ufeff"
_SAVE_AS = "save it as UTF-8 text"
MAX_FILES = 200
MAX_FILE_BYTES = 4_000_000


def read_folder(folder: Path, pattern: str = "*") -> dict[str, bytes]:
    """The files of ``folder`` itself whose names match ``pattern``: name → bytes.

    Raises:
        LanguageError: there is no such folder, a file cannot be read or is larger than
            ``MAX_FILE_BYTES``, there are more than ``MAX_FILES``, or a link leads out of the folder.
    """
    if not folder.is_dir():
        raise LanguageError("there is no such folder", Position(folder.name))
    paths = sorted(path for path in folder.glob(pattern) if path.is_file())
    if len(paths) > MAX_FILES:
        raise LanguageError(
            f"the folder holds {len(paths)} files; {MAX_FILES} is the limit", Position(folder.name)
        )
    return {path.name: _bytes_of(path, folder) for path in paths}


def _bytes_of(path: Path, folder: Path) -> bytes:
    place = Position(path.name)
    if not path.resolve().is_relative_to(folder.resolve()):
        raise LanguageError("this link leads out of its folder", place, "put the file itself here")
    try:
        if path.stat().st_size > MAX_FILE_BYTES:
            raise LanguageError(f"the file is larger than {MAX_FILE_BYTES:,} bytes", place)
        return path.read_bytes()
    except OSError as trouble:
        raise LanguageError(f"the file cannot be read: {trouble.strerror}", place) from trouble


def decode(data: bytes, source: str = "") -> str:
    """UTF-8 to text, without a leading byte-order mark and with ``\\n`` for every line end.

    Raises:
        LanguageError: the data are UTF-16, binary, not UTF-8 (at the first bad byte), or empty.
    """
    if data.startswith(_UTF16_MARKS):
        raise LanguageError("the file is UTF-16, not UTF-8", Position(source), _SAVE_AS)
    try:
        text = data.decode("utf-8").removeprefix(_BYTE_ORDER_MARK)
    except UnicodeDecodeError as trouble:
        place = _position(data[: trouble.start].decode("utf-8"), source)
        byte = data[trouble.start]
        raise LanguageError(f"the byte 0x{byte:02x} is not UTF-8", place, _SAVE_AS) from trouble
    if "\0" in text:
        place = _position(text[: text.index("\0")], source)
        raise LanguageError("the file is binary or UTF-16, not UTF-8 text", place, _SAVE_AS)
    if not text.strip():
        raise LanguageError("the file is empty", Position(source), "remove it, or fill it")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _position(before: str, source: str) -> Position:
    """Where the character after ``before`` stands."""
    return Position(source, before.count("\n") + 1, len(before) - (before.rfind("\n") + 1) + 1)
