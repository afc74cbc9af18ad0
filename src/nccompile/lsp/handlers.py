"""Registers what the server can do."""

from __future__ import annotations

from lsprotocol import types

from nccompile.lsp import convert
from nccompile.lsp.features import actions, completion, hints, hover, navigation, outline, tokens
from nccompile.lsp.server import NcServer

__all__ = ["make_server"]

_WATCHED = ["**/nccompile.toml", "**/pyproject.toml", "**/*.toml"]


def make_server() -> NcServer:
    """A server with all features, not started."""
    server = NcServer()
    _documents(server)
    _reading(server)
    _colouring(server)
    _navigating(server)
    _changing(server)
    _acting(server)
    return server


def _documents(server: NcServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_DID_OPEN)
    def opened(params: types.DidOpenTextDocumentParams) -> None:
        server.opened(params)

    @server.feature(types.TEXT_DOCUMENT_DID_CHANGE)
    def changed(params: types.DidChangeTextDocumentParams) -> None:
        server.changed(params)

    @server.feature(types.TEXT_DOCUMENT_DID_CLOSE)
    def closed(params: types.DidCloseTextDocumentParams) -> None:
        server.colours.forget(params.text_document.uri)
        server.session.close(params.text_document.uri)

    @server.feature(types.WORKSPACE_DID_CHANGE_WATCHED_FILES)
    def files_changed(_: types.DidChangeWatchedFilesParams) -> None:
        server.session.settings_changed()

    @server.feature(types.SHUTDOWN)
    def shut_down(_: None) -> None:
        server.shut_down()

    @server.feature(types.INITIALIZED)
    def initialized(_: types.InitializedParams) -> None:
        """Has an editor that can do so watch the files with settings."""
        workspace = server.client_capabilities.workspace
        watching = None if workspace is None else workspace.did_change_watched_files
        if watching is None or not watching.dynamic_registration:
            return
        options = types.DidChangeWatchedFilesRegistrationOptions(
            [types.FileSystemWatcher(pattern) for pattern in _WATCHED]
        )
        server.client_register_capability(
            types.RegistrationParams(
                [types.Registration("settings", types.WORKSPACE_DID_CHANGE_WATCHED_FILES, options)]
            )
        )


def _reading(server: NcServer) -> None:
    """What is shown beside the text."""

    @server.feature(types.TEXT_DOCUMENT_HOVER)
    async def hovered(params: types.HoverParams) -> types.Hover | None:
        document, analysis = await server.analysis(params.text_document.uri)
        text = hover.hover_text(document, analysis, convert.place(params.position))
        content = types.MarkupContent(types.MarkupKind.Markdown, text or "")
        return None if text is None else types.Hover(content)

    @server.feature(types.TEXT_DOCUMENT_INLAY_HINT)
    async def hinted(params: types.InlayHintParams) -> list[types.InlayHint]:
        uri, asked = params.text_document.uri, params.range
        _, analysis = await server.analysis(uri, with_times=True)
        return await server.beside(
            uri, lambda document: hints.hints(document, analysis, asked.start.line, asked.end.line), now=True
        )

    @server.feature(types.TEXT_DOCUMENT_CODE_LENS)
    async def lenses(params: types.CodeLensParams) -> list[types.CodeLens]:
        uri = params.text_document.uri
        _, analysis = await server.analysis(uri, with_times=True)
        return await server.beside(uri, lambda document: hints.lenses(document, analysis), now=True)


def _colouring(server: NcServer) -> None:
    """Semantic tokens."""
    legend = types.SemanticTokensRegistrationOptions(
        tokens.LEGEND, full=types.SemanticTokensFullDelta(delta=True), range=True
    )

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, legend)
    async def all_tokens(params: types.SemanticTokensParams) -> types.SemanticTokens:
        uri = params.text_document.uri
        return server.colours.full(uri, await server.beside(uri, tokens.tokens, now=True))

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL_DELTA)
    async def changed_tokens(
        params: types.SemanticTokensDeltaParams,
    ) -> types.SemanticTokens | types.SemanticTokensDelta:
        uri = params.text_document.uri
        numbers = await server.beside(uri, tokens.tokens, now=True)
        return server.colours.since(uri, params.previous_result_id, numbers)

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_RANGE)
    def some_tokens(params: types.SemanticTokensRangeParams) -> types.SemanticTokens:
        document, asked = server.document(params.text_document.uri), params.range
        return types.SemanticTokens(tokens.tokens(document, asked.start.line, asked.end.line))


def _navigating(server: NcServer) -> None:
    """Ways through the text."""

    @server.feature(types.TEXT_DOCUMENT_DEFINITION)
    async def definition(params: types.DefinitionParams) -> list[types.Location]:
        at = convert.place(params.position)
        return await server.beside(
            params.text_document.uri, lambda document: navigation.definitions(document, at), now=True
        )

    @server.feature(types.TEXT_DOCUMENT_REFERENCES)
    async def references(params: types.ReferenceParams) -> list[types.Location]:
        at, declared = convert.place(params.position), params.context.include_declaration
        return await server.beside(
            params.text_document.uri, lambda document: navigation.references(document, at, declared), now=True
        )

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    async def symbols(params: types.DocumentSymbolParams) -> list[types.DocumentSymbol]:
        return await server.beside(params.text_document.uri, outline.symbols)

    @server.feature(types.TEXT_DOCUMENT_FOLDING_RANGE)
    async def foldings(params: types.FoldingRangeParams) -> list[types.FoldingRange]:
        return await server.beside(params.text_document.uri, outline.foldings)


def _changing(server: NcServer) -> None:
    """Changes of the text."""

    @server.feature(
        types.TEXT_DOCUMENT_COMPLETION, types.CompletionOptions(trigger_characters=completion.TRIGGERS)
    )
    def completed(params: types.CompletionParams) -> types.CompletionList:
        document = server.document(params.text_document.uri)
        return completion.completions(document, convert.place(params.position))

    @server.feature(types.TEXT_DOCUMENT_PREPARE_RENAME)
    def prepared(params: types.PrepareRenameParams) -> types.Range | None:
        document = server.document(params.text_document.uri)
        return navigation.prepared(document, convert.place(params.position))

    @server.feature(types.TEXT_DOCUMENT_RENAME, types.RenameOptions(prepare_provider=True))
    async def renamed(params: types.RenameParams) -> types.WorkspaceEdit:
        uri, at, name = params.text_document.uri, convert.place(params.position), params.new_name
        try:
            edits = await server.beside(
                uri, lambda document: navigation.renamed(document, at, name), now=True
            )
        except navigation.CannotRename as error:
            raise server.refused(error) from None
        return types.WorkspaceEdit(changes={uri: edits})

    @server.feature(types.TEXT_DOCUMENT_FORMATTING)
    async def formatted(params: types.DocumentFormattingParams) -> list[types.TextEdit]:
        return await server.beside(params.text_document.uri, actions.formatted, now=True)

    @server.feature(types.TEXT_DOCUMENT_RANGE_FORMATTING)
    def formatted_lines(params: types.DocumentRangeFormattingParams) -> list[types.TextEdit]:
        document, asked = server.document(params.text_document.uri), params.range
        last = asked.end.line - (asked.end.character == 0 and asked.end.line > asked.start.line)
        return actions.formatted_lines(document, asked.start.line, last)


def _acting(server: NcServer) -> None:
    """Code actions."""
    kinds = ["quickfix", actions.FIX_ALL, actions.RENUMBER]

    @server.feature(
        types.TEXT_DOCUMENT_CODE_ACTION,
        types.CodeActionOptions(code_action_kinds=kinds, resolve_provider=True),
    )
    async def acted(params: types.CodeActionParams) -> list[types.CodeAction]:
        document, analysis = await server.analysis(params.text_document.uri)
        only = (
            None
            if params.context.only is None
            else [str(getattr(k, "value", k)) for k in params.context.only]
        )
        return actions.actions(document, analysis, params.range, only)

    @server.feature(types.CODE_ACTION_RESOLVE)
    async def resolved(action: types.CodeAction) -> types.CodeAction:
        return await server.resolve(action)
