"""The server: answers an editor, and checks its texts in the background.

https://microsoft.github.io/language-server-protocol/specifications/lsp/3.17/specification/
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from lsprotocol import types
from pygls.lsp.server import LanguageServer
from pygls.uris import to_fs_path

from amalthea_uros._internal.failures import failure
from amalthea_uros._internal.records import dataclass
from amalthea_uros._version import __version__
from amalthea_uros.editor.diagnostics import diagnostics_of
from amalthea_uros.editor.document import TextDocument
from amalthea_uros.editor.hover import MAX_LENGTH, TOO_LARGE, analysis_of, hover_text
from amalthea_uros.editor.keys import completions, key_hover
from amalthea_uros.editor.names import definition_of, names_at, symbols_of
from amalthea_uros.editor.quick_fixes import FIX_ALL, quick_fixes
from amalthea_uros.editor.worker import Worker
from amalthea_uros.services.analyze import AnalysisResult

#: Seconds without a change before a text is checked.
PAUSE = 0.15
#: Seconds that a hover waits for an analysis.
PATIENCE = 10.0
STILL_RUNNING = "The analysis is still running."

T = TypeVar("T")


@dataclass(slots=True)
class OpenText:
    """A text that the editor shows.

    Attributes
    ----------
    check : ends with the diagnostics of this version
    analysis : of this version, once somebody asked for it
    """

    document: TextDocument
    check: asyncio.Task[None] | None = None
    analysis: asyncio.Task[AnalysisResult | None] | None = None

    def cancel(self) -> None:
        """Leave out what is not needed any more."""
        for task in (self.check, self.analysis):
            if task is not None:
                task.cancel()


class AmurosServer(LanguageServer):
    """A language server that keeps what it knows of each open text."""

    def __init__(self) -> None:
        # Whole texts: the lines of the protocol are other ones than those of Python, by which pygls would apply changes.
        super().__init__("amuros", __version__, text_document_sync_kind=types.TextDocumentSyncKind.Full)
        self.texts: dict[str, OpenText] = {}
        self.checks = Worker("check")
        self.analyses = Worker("analysis")

    def opened(self, uri: str, version: int | None, text: str) -> None:
        """Take note of a new version of a text, and check it when nothing changes for a moment."""
        self.closed(uri)
        path = to_fs_path(uri)
        if not uri.startswith("file:") or path is None:
            return
        self.texts[uri] = known = OpenText(TextDocument(uri, Path(path), text, version, self.workspace.position_codec))
        known.check = self._in_background(self._check(known.document))

    def closed(self, uri: str) -> None:
        """Forget a text."""
        former = self.texts.pop(uri, None)
        if former is not None:
            former.cancel()

    def publish(self, uri: str, version: int | None, diagnostics: list[types.Diagnostic]) -> None:
        """Let the editor show diagnostics instead of those before."""
        self.text_document_publish_diagnostics(
            types.PublishDiagnosticsParams(uri=uri, version=version, diagnostics=diagnostics)
        )

    async def analysis(self, known: OpenText) -> AnalysisResult | None:
        """The analysis of a text; it is made once."""
        if known.analysis is None:
            known.analysis = self._in_background(self.analyses.run(partial(analysis_of, known.document)))
        return await asyncio.wait_for(asyncio.shield(known.analysis), PATIENCE)

    async def or_nothing(self, answer: Coroutine[Any, Any, T]) -> T | None:
        """An answer; None, and a message in the log of the editor, if there is an error in this package."""
        try:
            return await answer
        except Exception as error:  # the next request may succeed
            self.log(failure(error))
            return None

    def log(self, message: str) -> None:
        """Write to the log of the editor."""
        self.window_log_message(types.LogMessageParams(type=types.MessageType.Error, message=message))

    async def _check(self, document: TextDocument) -> None:
        await asyncio.sleep(PAUSE)
        self.publish(document.uri, document.version, await self.checks.run(partial(diagnostics_of, document)))

    def _in_background(self, work: Coroutine[Any, Any, T]) -> asyncio.Task[T]:
        task = asyncio.get_running_loop().create_task(work)
        task.add_done_callback(self._ended)
        return task

    def _ended(self, task: asyncio.Task[Any]) -> None:
        if not task.cancelled() and (error := task.exception()) is not None:
            self.log(failure(error) if isinstance(error, Exception) else repr(error))


def create_server() -> AmurosServer:
    """The server with all its features."""
    server = AmurosServer()
    for register in (_texts, _hover, _completion, _actions, _names):
        register(server)
    return server


def _texts(server: AmurosServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_DID_OPEN)
    def opened(params: types.DidOpenTextDocumentParams) -> None:
        item = params.text_document
        server.opened(item.uri, item.version, item.text)

    @server.feature(types.TEXT_DOCUMENT_DID_CHANGE)
    def changed(params: types.DidChangeTextDocumentParams) -> None:
        item = params.text_document
        server.opened(item.uri, item.version, server.workspace.get_text_document(item.uri).source)

    @server.feature(types.TEXT_DOCUMENT_DID_SAVE)
    def saved(_params: types.DidSaveTextDocumentParams) -> None:
        # A platform file, or settings, of which other texts depend.
        for known in list(server.texts.values()):
            server.opened(known.document.uri, known.document.version, known.document.text)

    @server.feature(types.TEXT_DOCUMENT_DID_CLOSE)
    def closed(params: types.DidCloseTextDocumentParams) -> None:
        server.closed(params.text_document.uri)
        server.publish(params.text_document.uri, None, [])


def _hover(server: AmurosServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_HOVER)
    async def hover(params: types.HoverParams) -> types.Hover | None:
        known = server.texts.get(params.text_document.uri)
        return None if known is None else await server.or_nothing(_hover_at(server, known, params.position))


async def _hover_at(server: AmurosServer, known: OpenText, position: types.Position) -> types.Hover | None:
    meaning = await server.checks.run(partial(key_hover, known.document, position))
    if meaning is not None:
        return meaning
    names = list(names_at(known.document, position))
    if not names:
        return None
    if len(known.document.text) > MAX_LENGTH:
        return _shown(TOO_LARGE)
    try:
        result = await server.analysis(known)
    except TimeoutError:
        return _shown(STILL_RUNNING)
    except asyncio.CancelledError:  # the text has changed
        return None
    if result is None:
        return None
    for name in names:
        text = await server.analyses.run(partial(hover_text, result, name.text))
        if text:
            return _shown(text, name.range)
    return None


def _shown(text: str, where: types.Range | None = None) -> types.Hover:
    return types.Hover(contents=types.MarkupContent(types.MarkupKind.Markdown, text), range=where)


def _completion(server: AmurosServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_COMPLETION)
    async def completion(params: types.CompletionParams) -> list[types.CompletionItem] | None:
        return await _of_text(server, params.text_document.uri, lambda document: completions(document, params.position))


def _actions(server: AmurosServer) -> None:
    options = types.CodeActionOptions(code_action_kinds=[types.CodeActionKind.QuickFix, FIX_ALL])

    @server.feature(types.TEXT_DOCUMENT_CODE_ACTION, options)
    async def code_action(params: types.CodeActionParams) -> list[types.CodeAction] | None:
        known = server.texts.get(params.text_document.uri)
        if known is None:
            return None
        only = None if params.context.only is None else [str(kind) for kind in params.context.only]
        return await server.or_nothing(
            server.checks.run(partial(quick_fixes, known.document, params.context.diagnostics, only))
        )


def _names(server: AmurosServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    async def symbols(params: types.DocumentSymbolParams) -> list[types.DocumentSymbol] | None:
        return await _of_text(server, params.text_document.uri, symbols_of)

    @server.feature(types.TEXT_DOCUMENT_DEFINITION)
    async def definition(params: types.DefinitionParams) -> types.Location | None:
        return await _of_text(server, params.text_document.uri, lambda document: definition_of(document, params.position))


async def _of_text(server: AmurosServer, uri: str, ask: Callable[[TextDocument], T]) -> T | None:
    known = server.texts.get(uri)
    return None if known is None else await server.or_nothing(server.checks.run(partial(ask, known.document)))
