"""Decode the bytes of an uploaded file, or say what is wrong with them."""

from __future__ import annotations

from pathlib import Path

from annotations.language.errors import LanguageError, Offsets, Position
from annotations.language.limits import MAX_FILE_NAME, require_name

_UTF16_MARKS = (b"\xff\xfe", b"\xfe\xff")
_BYTE_ORDER_MARK = "\ufeff"
_SAVE_AS = "save it as UTF-8 text"
MAX_FILES = 200
MAX_FILE_BYTES = 20_000_000


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
    return {path.name: _bytes_of(path, folder, most_bytes) for path in paths}


def _bytes_of(path: Path, folder: Path, most_bytes: int) -> bytes:
    place = Position(path.name)
    if not path.resolve().is_relative_to(folder.resolve()):
        raise LanguageError(
            "this link points outside its folder", place, "put the file itself here"
        )
    try:
        if path.stat().st_size > most_bytes:
            raise LanguageError(f"the file is larger than {most_bytes:,} bytes", place)
        return path.read_bytes()
    except OSError as error:
        raise LanguageError(f"the file cannot be read: {error.strerror}", place) from error


def decode(data: bytes, source: str = "") -> str:
    """Decode UTF-8 to text without a leading byte-order mark and with ``\\n`` for every line end.

    Raises:
        LanguageError: the data are UTF-16, binary, not UTF-8 (at the first bad byte), or empty, or
            the name of the file is too long.
    """
    require_name(source, "file name", MAX_FILE_NAME, Position(source[:MAX_FILE_NAME]))
    if data.startswith(_UTF16_MARKS):
        raise LanguageError("the file is UTF-16, not UTF-8", Position(source), _SAVE_AS)
    try:
        text = data.decode("utf-8").removeprefix(_BYTE_ORDER_MARK)
    except UnicodeDecodeError as error:
        before = data[: error.start].decode("utf-8")
        place = Offsets(before, source).position(len(before))
        byte = data[error.start]
        raise LanguageError(f"the byte 0x{byte:02x} is not UTF-8", place, _SAVE_AS) from error
    if "\0" in text:
        place = Offsets(text, source).position(text.index("\0"))
        raise LanguageError("the file is binary or UTF-16, not UTF-8 text", place, _SAVE_AS)
    if not text.strip():
        raise LanguageError("the file is empty", Position(source), "remove it, or fill it")
    return text.replace("\r\n", "\n").replace("\r", "\n")
