"""The open documents and the work in the background.

    edit ──> changed lines are read, known findings move ──> published at once
      └────> after a pause: findings of the whole text   ──> published, `nccompile/checked`
                └────> times of the path                  ──> hints and lenses

The analysis of a version that was edited meanwhile is given up at the next chunk of its toolpath, or among its jumps.
"""

from __future__ import annotations

import asyncio
import gc
import logging
import time
from collections.abc import Callable

from nccompile.errors import Cancelled, NccompileError
from nccompile.lint.config import Config, config_for
from nccompile.lsp.analysis import Analysis, Settings, Times, analyse, timed
from nccompile.lsp.document import Document, Snapshot, forget
from nccompile.lsp.threads import Worker
from nccompile.lsp.warming import Warming
from nccompile.machine.model import default_machine, load
from nccompile.parser.lines import read_by_grammar

__all__ = ["Outdated", "Session", "Work"]

PAUSE, LONGEST_PAUSE = 0.02, 0.2
"""Least and greatest pause in typing before an analysis [s]; between them, half of what the last one took."""

IDLE = 30.0
"""Time without edits after which garbage is looked for [s]: among millions of words that takes a while."""

WORK, REST = 0.002, 0.0001
"""How long a check works before it lets others go first, and for how long [s]."""

_log = logging.getLogger(__name__)


class Outdated(Exception):
    """The document changed while something was computed for it."""


class Wish:
    """Whether a version is still wanted.  Programs keep it, so it knows nothing of what holds them."""

    def __init__(self) -> None:
        self.lives = True
        self._rested = 0.0

    def __call__(self) -> bool:
        """Asked from the thread that does the work, which rests a moment each time it has worked for a while.

        A thread of many short kernel calls gives the interpreter's lock away at each, and takes it back before any
        other thread has woken up: an edit waited for half a second.
        """
        now = time.perf_counter()
        if now - self._rested > WORK:
            time.sleep(REST)
            self._rested = now
        return self.lives


class Threads:
    """Those of one document: its checks run one after the other, but wait for no other document, whose loop may be
    endless."""

    def __init__(self) -> None:
        self.checks = Worker("check")
        self.timings = Worker("timing")
        self.timings.start(read_by_grammar, 1, "N1")  # loads Lark, which the first edit would wait for

    def finish(self) -> None:
        """The document was closed: what runs for it gives up by itself."""
        self.checks.finish()
        self.timings.finish()

    def shut_down(self) -> None:
        """Gives up what has not begun."""
        self.checks.shut_down()
        self.timings.shut_down()


class Work:
    """The analysis of one version of a document, under way or done."""

    def __init__(self, document: Document, threads: Threads, loop: asyncio.AbstractEventLoop) -> None:
        self.document = document
        self.threads = threads
        self.version = document.version
        self.wish = Wish()
        self.checked: asyncio.Future[Analysis] = loop.create_future()
        self.timed: asyncio.Future[Analysis] = loop.create_future()
        self.task: asyncio.Task[None] | None = None

    @property
    def wanted(self) -> bool:
        """Whether the version is still the newest."""
        return self.wish.lives

    def drop(self) -> None:
        """The version is not wanted any more."""
        self.wish.lives = False
        for future in (self.checked, self.timed):
            future.cancel()


def _analysed(snapshot: Snapshot, work: Work, settings: Settings) -> Analysis:
    return analyse(snapshot.source(), work.version, settings, work.wish)


class Session:
    """What the server knows; `publish` shows the findings of a document, `say` a message."""

    def __init__(
        self,
        publish: Callable[[Document, bool], None],
        say: Callable[[str], None],
        done: Callable[[Document, float], None],
    ) -> None:
        self.documents: dict[str, Document] = {}
        self._publish, self._say, self._done = publish, say, done
        self._works: dict[str, Work] = {}
        self._threads: dict[str, Threads] = {}
        self._warming = Warming()
        self._said: set[str] = set()
        self._idle: asyncio.TimerHandle | None = None
        gc.disable()  # an analysis leaves next to no cycles; see IDLE

    def open(self, document: Document) -> None:
        """A document was opened, or opened again."""
        self.documents[document.uri] = document
        if document.uri not in self._threads:
            self._threads[document.uri] = Threads()
        self._warming.start(len(document.text.lines))
        self.changed(document)

    def close(self, uri: str) -> None:
        """A document was closed; its findings go."""
        work = self._works.pop(uri, None)
        if work is not None:
            work.drop()
        threads = self._threads.pop(uri, None)
        if threads is not None:
            threads.finish()
        document = self.documents.pop(uri, None)
        if document is not None:
            document.shown = []
            self._publish(document, False)

    def changed(self, document: Document) -> None:
        """A document has a new text or new settings: it is checked anew."""
        if self._idle is not None:
            self._idle.cancel()
        before = self._works.get(document.uri)
        if before is not None:
            before.drop()
        loop = asyncio.get_running_loop()
        work = self._works[document.uri] = Work(document, self._threads[document.uri], loop)
        work.task = loop.create_task(self._run(work))

    def settings_changed(self) -> None:
        """Settings or machine files changed: all documents are checked anew."""
        self._said.clear()
        for document in self.documents.values():
            self.changed(document)

    def shut_down(self) -> None:
        """Gives up what is under way."""
        for work in self._works.values():
            work.drop()
        for threads in self._threads.values():
            threads.shut_down()
        self._warming.stop()

    async def analysis(self, uri: str, *, with_times: bool = False) -> tuple[Document, Analysis]:
        """A document and the analysis of its newest version.

        Raises:   KeyError: it is not open;  Outdated: it was edited meanwhile.
        """
        work = self._works[uri]
        future = work.timed if with_times else work.checked
        try:
            analysis = await asyncio.shield(future)
        except asyncio.CancelledError:
            if future.cancelled():
                raise Outdated from None
            raise
        return work.document, analysis

    async def _run(self, work: Work) -> None:
        document = work.document
        pause = min(max(PAUSE, 0.5 * document.seconds), LONGEST_PAUSE)
        try:
            await asyncio.sleep(pause)
            analysis = await self._check(work)
            await asyncio.sleep(pause)  # times are for those who read, not for those who type
            if not work.wanted:
                return
            times: Times | None = await work.threads.timings.run(timed, analysis, work.wish)
            analysis.times = times
            if work.wanted:
                work.timed.set_result(analysis)
                self._idle = asyncio.get_running_loop().call_later(IDLE, gc.collect)
        except Cancelled:
            return
        except Exception:
            _log.exception("the analysis of %s failed", document.uri)
            self._say(f"nccompile: the analysis of {document.name} failed; please report it")
            work.drop()

    async def _check(self, work: Work) -> Analysis:
        """Checks a version and publishes what was found; raises Cancelled if it is not wanted any more."""
        if not work.wanted:
            raise Cancelled
        document, begun = work.document, time.perf_counter()
        snapshot, settings = document.snapshot(), self._settings(document)
        outdated = snapshot.nodes
        try:
            analysis = await work.threads.checks.run(_analysed, snapshot, work, settings)
            if not work.wanted:
                raise Cancelled
            document.analysis = analysis
            outdated, document.nodes = document.nodes, list(snapshot.nodes)
        finally:
            work.threads.checks.start(forget, outdated)
        document.shown = analysis.report.ordered()
        document.seconds = time.perf_counter() - begun
        self._publish(document, True)
        self._done(document, document.seconds)
        work.checked.set_result(analysis)
        return analysis

    def _settings(self, document: Document) -> Settings:
        """The settings that hold for a document; the defaults, with a message, if they cannot be read."""
        try:
            config = Config() if document.path is None else config_for(document.path)
            machine = default_machine() if config.machine is None else load(config.machine)
        except NccompileError as error:
            if str(error) not in self._said:
                self._said.add(str(error))
                self._say(str(error))
            return Settings(Config(), default_machine())
        return Settings(config, machine)
