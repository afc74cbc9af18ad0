"""The protocol: requests of the editor to the functions of `features` (LSP 3.17 over pygls)."""

from __future__ import annotations

import sys
from collections.abc import Callable, Generator
from typing import Any, TypeVar

from lsprotocol import types
from pygls.exceptions import JsonRpcContentModified, JsonRpcException, JsonRpcInvalidParams
from pygls.lsp.server import LanguageServer
from pygls.protocol import LanguageServerProtocol
from pygls.protocol.language_server import lsp_method

from nccompile.errors import NccompileError
from nccompile.lsp import convert
from nccompile.lsp.analysis import Analysis
from nccompile.lsp.colours import Colours
from nccompile.lsp.document import Document
from nccompile.lsp.features.actions import resolved
from nccompile.lsp.session import Outdated, Session
from nccompile.lsp.threads import Worker
from nccompile.version import VERSION

__all__ = ["CHECKED", "NcServer", "ServerProtocol"]

CHECKED = "nccompile/checked"
"""Notification: the findings of a version are complete; `uri`, `version`, `seconds`."""

_SWITCH_INTERVAL = 0.0005
"""Time after which the analysis makes way for requests [s]."""

Answer = TypeVar("Answer")
Handled = Generator[Any, Any, None]


class ServerProtocol(LanguageServerProtocol):
    """Leaves open documents to the session: pygls would copy the whole text at every edit.  Answers requests that
    are not as the protocol says, which pygls only logs: an editor would wait for ever."""

    def structure_message(self, data: dict[str, Any]) -> Any:
        """A message as an object."""
        try:
            return super().structure_message(data)
        except JsonRpcException as error:
            if "id" in data and "method" in data:
                self._send_response(data["id"], error=error.to_response_error())
            raise

    @lsp_method(types.TEXT_DOCUMENT_DID_OPEN)
    def lsp_text_document__did_open(self, params: types.DidOpenTextDocumentParams) -> Handled:
        """A document was opened."""
        yield self.fm.features[types.TEXT_DOCUMENT_DID_OPEN], (params,), None

    @lsp_method(types.TEXT_DOCUMENT_DID_CHANGE)
    def lsp_text_document__did_change(self, params: types.DidChangeTextDocumentParams) -> Handled:
        """A document was edited."""
        yield self.fm.features[types.TEXT_DOCUMENT_DID_CHANGE], (params,), None

    @lsp_method(types.TEXT_DOCUMENT_DID_CLOSE)
    def lsp_text_document__did_close(self, params: types.DidCloseTextDocumentParams) -> Handled:
        """A document was closed."""
        yield self.fm.features[types.TEXT_DOCUMENT_DID_CLOSE], (params,), None


class NcServer(LanguageServer):
    """The server with its open documents."""

    def __init__(self) -> None:
        super().__init__("nccompile", VERSION, protocol_cls=ServerProtocol)
        self.session = Session(self._publish, self._say, self._checked)
        self.colours = Colours()
        self._reader = Worker("reader")
        sys.setswitchinterval(_SWITCH_INTERVAL)

    @property
    def encoding(self) -> str:
        """What characters of positions count."""
        chosen = self.server_capabilities.position_encoding or types.PositionEncodingKind.Utf16
        return str(getattr(chosen, "value", chosen))

    def document(self, uri: str) -> Document:
        """An open document."""
        document = self.session.documents.get(uri)
        if document is None:
            raise JsonRpcInvalidParams(f"{uri} is not open")
        return document

    async def beside(self, uri: str, compute: Callable[[Document], Answer], *, now: bool = False) -> Answer:
        """What is computed of a document as it is; in a thread, so that edits need not wait for it.

        now: whether the answer counts only if the document was not edited meanwhile.
        """
        document = self.document(uri)
        copy = document.copy()
        answer = await self._reader.run(compute, copy)
        if now and (self.document(uri) is not document or document.version != copy.version):
            raise JsonRpcContentModified("the document was edited meanwhile")
        return answer

    async def analysis(self, uri: str, *, with_times: bool = False) -> tuple[Document, Analysis]:
        """A document with the analysis of its newest version."""
        try:
            return await self.session.analysis(uri, with_times=with_times)
        except KeyError:
            raise JsonRpcInvalidParams(f"{uri} is not open") from None
        except Outdated:
            raise JsonRpcContentModified("the document was edited meanwhile") from None

    def shut_down(self) -> None:
        """Gives up what is under way."""
        self.session.shut_down()
        self._reader.shut_down()

    def refused(self, error: Exception) -> JsonRpcException:
        """An answer that says why something cannot be done."""
        return JsonRpcException(str(error), -32803)  # RequestFailed

    def _publish(self, document: Document, is_complete: bool) -> None:
        source = document.analysis.report.source if is_complete and document.analysis is not None else None
        shown = [convert.diagnostic(document, found, source) for found in document.shown]
        self.text_document_publish_diagnostics(
            types.PublishDiagnosticsParams(document.uri, shown, document.version)
        )

    def _say(self, text: str) -> None:
        self.window_show_message(types.ShowMessageParams(types.MessageType.Error, text))

    def _checked(self, document: Document, seconds: float) -> None:
        self.protocol.notify(
            CHECKED, {"uri": document.uri, "version": document.version, "seconds": round(seconds, 4)}
        )

    def opened(self, params: types.DidOpenTextDocumentParams) -> None:
        """A document was opened."""
        item = params.text_document
        self.session.open(Document(item.uri, item.version, item.text, self.encoding))

    def changed(self, params: types.DidChangeTextDocumentParams) -> None:
        """A document was edited: its findings are moved and shown, and it is checked again."""
        document = self.document(params.text_document.uri)
        for change in params.content_changes:
            if isinstance(change, types.TextDocumentContentChangePartial):
                document.edit(convert.place(change.range.start), convert.place(change.range.end), change.text)
            else:
                document.replace(change.text)
        document.version = params.text_document.version
        self._publish(document, False)
        self.session.changed(document)

    async def resolve(self, action: types.CodeAction) -> types.CodeAction:
        """The edit of a chosen action."""
        uri = action.data.get("uri", "") if isinstance(action.data, dict) else ""
        document, analysis = await self.analysis(uri)
        try:
            done = await self._reader.run(resolved, document, analysis, action)
        except NccompileError as error:
            raise self.refused(error) from None
        if document.version != analysis.version:
            raise JsonRpcContentModified("the document was edited meanwhile")
        return done
