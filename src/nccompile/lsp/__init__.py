"""The language server: the findings of `nccompile lint` as one types it, and what an editor can show of a program.

    text        lines of an open document, edits, positions in the client's encoding
    document    an open document: its lines with what was read in them, and its newest analysis
    analysis    findings, toolpath and times, made in the background
    features    hover, completion, navigation, symbols, tokens, hints, actions: pure functions of a document
    server      the protocol (pygls, extra `[lsp]`)

Only `server` and the features import pygls and lsprotocol, and only `nccompile lsp` imports them.
"""
