"""TEXT, ATTRIB and MTEXT as outlines of a font, for engraving.

ezdxf finds the fonts of the system; where there are none, the DejaVu fonts that come with matplotlib serve.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

from nccompile.importers.dxf.entities import NotTaken
from nccompile.importers.dxf.pieces import Row, cubic_row, line_row

__all__ = ["text_rows"]

LINE_FEED = 5.0 / 3.0
"""Distance of MTEXT's base lines in cap heights, at spacing factor 1."""


def text_rows(entity: Any) -> list[Row]:
    """The outlines of a TEXT, ATTRIB or MTEXT; raises NotTaken if nothing of it can be drawn."""
    _fonts()
    try:
        paths = _mtext(entity) if entity.dxftype() == "MTEXT" else _text(entity)
    except (ValueError, TypeError, AssertionError, ZeroDivisionError) as error:
        raise NotTaken(f"text that cannot be drawn: {error}") from error
    rows = [row for path in paths for row in _rows(path)]
    if not rows:
        raise NotTaken("text without visible letters")
    return rows


@cache
def _fonts() -> None:
    """Makes sure that there is one font at least."""
    from ezdxf.fonts import fonts  # noqa: PLC0415

    if not fonts.font_manager.has_font("DejaVuSans.ttf"):
        import matplotlib as mpl  # noqa: PLC0415

        fonts.font_manager.build([str(Path(mpl.get_data_path()) / "fonts" / "ttf")])


def _text(entity: Any) -> list[Any]:
    from ezdxf.addons import text2path  # noqa: PLC0415

    return list(text2path.make_paths_from_entity(entity))


def _mtext(entity: Any) -> list[Any]:
    """Every line of the text under the one before it; inline formats are left out."""
    from ezdxf.addons import text2path  # noqa: PLC0415
    from ezdxf.enums import TextEntityAlignment  # noqa: PLC0415
    from ezdxf.fonts import fonts  # noqa: PLC0415
    from ezdxf.math import Matrix44  # noqa: PLC0415

    height, column = entity.dxf.char_height, (entity.dxf.attachment_point - 1) % 3
    row = (entity.dxf.attachment_point - 1) // 3
    align = [TextEntityAlignment.LEFT, TextEntityAlignment.CENTER, TextEntityAlignment.RIGHT][column]
    lines = entity.plain_text(split=True)
    feed = height * LINE_FEED * entity.dxf.get("line_spacing_factor", 1.0)
    whole = height + feed * (len(lines) - 1)
    top = [0.0, whole / 2, whole][row] - height
    style = entity.doc.styles.get(entity.dxf.style) if entity.doc else None
    face = fonts.get_font_face(style.dxf.font if style else "DejaVuSans.ttf")
    place = entity.ucs().matrix
    paths = []
    for at, line in enumerate(lines):
        if line.strip():
            move = Matrix44.translate(0, top - feed * at, 0) @ place
            made = text2path.make_path_from_str(line, face, size=height, align=align).transform(move)
            paths += list(made.sub_paths())
    return paths


def _rows(path: Any) -> list[Row]:
    """An ezdxf path as lines and cubics."""
    rows: list[Row] = []
    at = complex(path.start.x, path.start.y)
    for command in path.commands():
        end = complex(command.end.x, command.end.y)
        if command.type == 1:
            if end != at:
                rows.append(line_row(at, end))
        elif command.type == 2:
            c = complex(command.ctrl.x, command.ctrl.y)
            rows.append(cubic_row(at, at + (c - at) * (2 / 3), end + (c - end) * (2 / 3), end))
        elif command.type == 3:
            c1, c2 = command.ctrl1, command.ctrl2
            rows.append(cubic_row(at, complex(c1.x, c1.y), complex(c2.x, c2.y), end))
        at = end
    return rows
