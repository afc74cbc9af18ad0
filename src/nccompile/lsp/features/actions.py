"""Code actions and formatting: fixes, all fixes, silencing comments, layout, new block numbers."""

from __future__ import annotations

from lsprotocol import types

from nccompile.diagnostics import Diagnostic, Severity
from nccompile.errors import NccompileError
from nccompile.lint.fix import apply_fixes
from nccompile.lint.fmt import format_text, renumbered
from nccompile.lint.layout import laid_out
from nccompile.lsp.analysis import Analysis
from nccompile.lsp.convert import diagnostic, edits_of, edits_to, line_range, range_of
from nccompile.lsp.document import Document
from nccompile.parser import Block

__all__ = ["FIX_ALL", "RENUMBER", "actions", "formatted", "formatted_lines", "resolved"]

FIX_ALL = "source.fixAll.nccompile"
RENUMBER = "source.renumber.nccompile"


def actions(
    document: Document, analysis: Analysis | None, asked: types.Range, only: list[str] | None
) -> list[types.CodeAction]:
    """What can be done in a range; changes of the whole text are made when one is chosen (`resolved`)."""
    found: list[types.CodeAction] = []
    if analysis is not None and analysis.version == document.version and _wants("quickfix", only):
        for finding in analysis.report.ordered():
            if _touches(range_of(document, finding.span), asked):
                found += _quick(document, analysis, finding)
    for kind, title in ((FIX_ALL, "Apply all safe fixes"), (RENUMBER, "Number the blocks anew")):
        if _wants(kind, only):
            found.append(types.CodeAction(title, kind=kind, data={"uri": document.uri}))
    return found


def _wants(kind: str, only: list[str] | None) -> bool:
    return only is None or any(kind == asked or kind.startswith(asked + ".") for asked in only)


def _touches(one: types.Range, other: types.Range) -> bool:
    return one.start.line <= other.end.line and other.start.line <= one.end.line


def _quick(document: Document, analysis: Analysis, finding: Diagnostic) -> list[types.CodeAction]:
    shown = [diagnostic(document, finding, analysis.report.source)]
    made = []
    fix = analysis.report.fixes.get(finding)
    if fix is not None:
        edit = types.WorkspaceEdit(changes={document.uri: edits_of(document, fix)})
        made.append(
            types.CodeAction(fix.title, kind="quickfix", diagnostics=shown, is_preferred=True, edit=edit)
        )
    if finding.severity is not Severity.ERROR and finding.span.line:
        line = finding.span.line - 1
        end = line_range(document, line, line).end
        change = types.TextEdit(types.Range(end, end), f" (nc: ignore[{finding.code}])")
        edit = types.WorkspaceEdit(changes={document.uri: [change]})
        title = f"Silence {finding.code} here"
        made.append(types.CodeAction(title, kind="quickfix", diagnostics=shown, edit=edit))
    return made


def resolved(document: Document, analysis: Analysis, action: types.CodeAction) -> types.CodeAction:
    """An action with its edit; raises NccompileError if it cannot be done."""
    source, settings = analysis.report.source, analysis.settings
    if action.kind == FIX_ALL:
        text = apply_fixes(source, settings.options, settings.config).text
    elif action.kind == RENUMBER:
        text = renumbered(source, settings.config.step).text
    else:
        raise NccompileError(f"there is nothing to do for {action.kind}")
    action.edit = types.WorkspaceEdit(changes={document.uri: edits_to(document, text)})
    return action


def formatted(document: Document) -> list[types.TextEdit]:
    """The whole text laid out, as `nccompile fmt` does."""
    return edits_to(document, format_text(document.source()))


def formatted_lines(document: Document, first: int, last: int) -> list[types.TextEdit]:
    """The blocks of some lines, from 0, laid out."""
    edits = []
    for line in range(max(first, 0), min(last + 1, len(document.nodes))):
        node = document.node(line)
        text = document.text.lines[line]
        if isinstance(node, Block) and laid_out(node) != text:
            edits.append(types.TextEdit(line_range(document, line, line), laid_out(node)))
    return edits
