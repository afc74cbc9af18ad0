"""Opening DXF files: any version, text or binary, damaged ones by ezdxf's recover mode, large ones as a stream.

ezdxf keeps a whole drawing in memory, about forty bytes for each byte of the file.  From `LARGE` on, the head of
a text file (header, tables, blocks) is loaded as a drawing of its own and the entities are read one at a time,
so the memory needed is that of the blocks and of the pieces.
"""

from __future__ import annotations

import io
import logging
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TextIO

from nccompile.diagnostics import Diagnostic, Diagnostics, Severity
from nccompile.source import NOWHERE

__all__ = ["LARGE", "Document", "open_document"]

LARGE = 24_000_000
"""Size [bytes] of a text file from which its entities are streamed."""

HEAD = 65536
"""Bytes at the start of a file in which a drawing names its first section."""

BINARY = b"AutoCAD Binary DXF\r\n\x1a\x00"


@dataclass(frozen=True)
class Document:
    """An open drawing: tables and blocks in `doc`, the model space by `entities`, units as $INSUNITS."""

    doc: Any
    entities: Callable[[], Iterator[Any]]
    version: str
    units: int


def open_document(path: Path, found: Diagnostics) -> Document | None:
    """Opens a drawing; None after a finding that says why it cannot be read."""
    from ezdxf.lldxf.const import DXFError  # noqa: PLC0415

    try:
        size = path.stat().st_size
        with path.open("rb") as file:
            head = file.read(HEAD)
    except OSError as error:
        return _refuse(found, path, f"the file cannot be read: {error.strerror or error}")
    if why := _no_drawing(head):
        return _refuse(found, path, *why)
    logging.getLogger("ezdxf").addHandler(logging.NullHandler())
    try:
        large = size >= LARGE and not head.startswith(BINARY)
        return _stream(path, found) if large else _load(path, found)
    except (
        DXFError,
        OSError,
        ValueError,
        KeyError,
        IndexError,
        AttributeError,
        TypeError,
        EOFError,
    ) as error:
        # Damaged files make ezdxf's loaders fail in any of these ways, recover mode included.
        hint = "open it in a CAD program and save it again as DXF"
        return _refuse(found, path, f"this is no DXF drawing that can be read: {_one_line(error)}", hint)


def _no_drawing(head: bytes) -> tuple[str, ...]:
    """Message and hint if a file that begins like this is no DXF drawing."""
    if not head:
        return ("the file is empty",)
    if head[:4] == b"AC10":
        return ("this is a DWG drawing, not a DXF drawing", "save it as DXF in the CAD program")
    if b"SECTION" not in head and not head.startswith(BINARY):
        return ("this is not a DXF drawing",)
    return ()


def _refuse(found: Diagnostics, path: Path, message: str, hint: str = "") -> Document | None:
    """Reports why there is no drawing."""
    found.add(Diagnostic("NC601", Severity.ERROR, message, NOWHERE, str(path), hint))
    return None


def _one_line(error: BaseException) -> str:
    text = " ".join(str(error).split())
    return text[:160] or type(error).__name__


def _load(path: Path, found: Diagnostics) -> Document:
    from ezdxf.filemanagement import readfile  # noqa: PLC0415

    try:
        doc: Any = readfile(str(path))
    except Exception as error:
        doc, auditor = _recover(path)
        _report_repairs(found, path, error, [entry.message for entry in (*auditor.fixes, *auditor.errors)])
    return Document(doc, lambda: iter(doc.modelspace()), doc.acad_release, _units(doc))


def _recover(path: Path) -> tuple[Any, Any]:
    """The drawing and its auditor by recover mode; where lines are missing or added by the mode that finds the
    next sound tag.
    """
    from ezdxf import recover  # noqa: PLC0415
    from ezdxf.lldxf.const import DXFError  # noqa: PLC0415

    whole = _completed(path)
    try:
        return recover.readfile(str(path)) if whole is None else recover.read(io.BytesIO(whole))
    except (DXFError, ValueError):
        return recover.explore(str(path))


def _completed(path: Path) -> bytes | None:
    """The bytes of a text file that was cut off, with its last section closed; None if it has its end.

    Recover mode leaves out a section that has no end, which in a cut-off file is that of the entities.
    """
    data = path.read_bytes()
    if data.startswith(BINARY) or data.rstrip().endswith(b"EOF"):
        return None
    lines = data.splitlines()
    begin = max((at for at in range(0, len(lines), 2) if lines[at].strip() == b"0"), default=0)
    return b"\n".join([*lines[:begin], b"0", b"ENDSEC", b"0", b"EOF", b""])


def _report_repairs(found: Diagnostics, path: Path, error: BaseException, repairs: list[str]) -> None:
    message = f"the drawing is damaged and was recovered: {_one_line(error)}"
    hint = "compare the preview with the drawing; what could not be read is missing"
    found.add(Diagnostic("NC602", Severity.WARNING, message, NOWHERE, str(path), hint))
    for repair in repairs:
        found.add(Diagnostic("NC602", Severity.WARNING, f"repaired: {repair}", NOWHERE, str(path)))


def _units(doc: Any) -> int:
    return int(doc.header.get("$INSUNITS", 0) or 0)


def _stream(path: Path, found: Diagnostics) -> Document:
    """A drawing whose entities are read from the file while they are asked for."""
    from ezdxf import recover  # noqa: PLC0415
    from ezdxf.lldxf.validator import dxf_info  # noqa: PLC0415

    with path.open("rt", encoding="ascii", errors="ignore") as file:
        info = dxf_info(file)
    with path.open("rt", encoding=info.encoding, errors="surrogateescape") as file:
        head = _head(file)
    closing = "  0\nSECTION\n  2\nENTITIES\n  0\nENDSEC\n  0\nEOF\n"
    doc, _ = recover.read(io.BytesIO((head + closing).encode(info.encoding, "surrogateescape")))

    def entities() -> Iterator[Any]:
        with path.open("rt", encoding=info.encoding, errors="surrogateescape") as file:
            _head(file)
            try:
                yield from _model_space(file, doc)
            except Exception as error:
                _report_repairs(found, path, error, ["everything from there on is missing"])

    return Document(doc, entities, doc.acad_release, _units(doc))


def _head(file: TextIO) -> str:
    """The text before the ENTITIES section; the file then stands behind the section's name."""
    lines: list[str] = []
    while True:
        code, value = file.readline(), file.readline()
        if not value:
            raise ValueError("no ENTITIES section")
        lines += [code, value]
        if value.strip() == "ENTITIES" and code.strip() == "2" and lines[-3].strip() == "SECTION":
            return "".join(lines[:-4])


def _model_space(file: TextIO, doc: Any) -> Iterator[Any]:
    """The entities from the file's place to the end of the section, vertices linked to their polylines."""
    from ezdxf.entities import factory  # noqa: PLC0415
    from ezdxf.entities.subentity import entity_linker  # noqa: PLC0415
    from ezdxf.lldxf.extendedtags import ExtendedTags  # noqa: PLC0415
    from ezdxf.lldxf.tagger import ascii_tags_loader, tag_compiler  # noqa: PLC0415

    linked = entity_linker()
    waiting: Any = None
    tags: list[Any] = []
    for tag in tag_compiler(ascii_tags_loader(file)):
        if tag.code == 0 and tags:
            entity = factory.load(ExtendedTags(tags), doc)
            if not linked(entity):
                if waiting is not None:
                    yield waiting
                waiting = entity
            tags = []
        if tag.code == 0 and tag.value in {"ENDSEC", "EOF"}:
            break
        tags.append(tag)
    if waiting is not None:
        yield waiting
