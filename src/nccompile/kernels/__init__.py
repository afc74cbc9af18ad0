"""Hot sequential loops on arrays: plain Python by meaning, compiled by numba when the work is large.

A function marked `@kernel` is ordinary Python on numpy arrays and floats.  One switch a process decides
how all of them run:

    python   the function as written; nothing is imported, nothing compiled (small programs start at once)
    numba    compiled on first call, machine code kept in a cache folder for the next process

`expect_work(items)` is called once by whoever knows the size of the job; above `LARGE` items it turns the
switch to numba.  NCCOMPILE_KERNELS=python|numba fixes it for the process.  Both ways give the same bits:
kernels use only IEEE operations and libm, no fast-math, no `**`, no `math.hypot`, no exceptions.
"""

from __future__ import annotations

import functools
import hashlib
import os
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Generic, ParamSpec, TypeVar

__all__ = [
    "LARGE",
    "Kernel",
    "compiled",
    "expect_work",
    "kernel",
    "machine_code",
    "on_first_compilation",
    "use",
]

P = ParamSpec("P")
R = TypeVar("R")

LARGE = 20_000
"""Items of work (segments, cycles) above which compiled kernels pay for importing numba."""

_state: dict[str, Any] = {"compiled": os.environ.get("NCCOMPILE_KERNELS") == "numba", "tell": None}


class Kernel(Generic[P, R]):
    """A function that runs as Python or as machine code, by the switch of this module."""

    def __init__(self, function: Callable[P, R]) -> None:
        self.py_func = function
        self._dispatcher: Any = None
        self._native: Sequence[Any] | None = None
        self._compilations = 0
        functools.update_wrapper(self, function)

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R:
        """Runs the function the way the switch says."""
        if not _state["compiled"]:
            return self.py_func(*args, **kwargs)
        if self._native is None:
            self._native = _native_forms(self._name)
        for form in self._native:
            if not kwargs and form.takes(args):
                ended_well, result = form(args)
                if ended_well:
                    return result  # type: ignore[no-any-return]
                break  # numba's own call raises what was wrong
        result = self.dispatcher(*args, **kwargs)
        if len(self.dispatcher.overloads) > self._compilations:
            self._compilations = len(self.dispatcher.overloads)
            _keep(self._name, self.dispatcher.overloads)
        return result  # type: ignore[no-any-return]

    @property
    def _name(self) -> str:
        return f"{self.py_func.__module__}.{self.py_func.__qualname__}"

    @property
    def dispatcher(self) -> Any:
        """The compiled twin, made on first use."""
        if self._dispatcher is None:
            numba = _numba()
            self._dispatcher = numba.njit(cache=True, nogil=True)(self.py_func)
        return self._dispatcher

    @property
    def _numba_type_(self) -> Any:
        # numba asks globals of a compiled function for their type here: a kernel called by a kernel
        # is its compiled twin.
        return self.dispatcher._numba_type_


def kernel(function: Callable[P, R]) -> Kernel[P, R]:
    """Marks a function as a kernel (see the module's docstring)."""
    return Kernel(function)


def compiled() -> bool:
    """Whether kernels run as machine code in this process."""
    return bool(_state["compiled"])


def use(*, compiled: bool) -> None:
    """Sets the switch; for tests and benchmarks.  NCCOMPILE_KERNELS has no say after this."""
    _state["compiled"] = compiled


def expect_work(items: int) -> None:
    """Announces a job of `items` segments or cycles: a large one turns the compiled kernels on."""
    if items >= LARGE and os.environ.get("NCCOMPILE_KERNELS") != "python":
        _state["compiled"] = True


def on_first_compilation(tell: Callable[[], None]) -> None:
    """Has `tell` called once before kernels are compiled that no earlier process has left in the cache."""
    _state["tell"] = tell


@functools.cache
def machine_code() -> Path:
    """The folder where these kernels are kept compiled; another one as soon as any of them changes.

    numba's cache looks only at the file of the kernel itself, so a changed callee would leave stale machine
    code; a folder named after the content of all kernels cannot be stale.
    """
    sources = b"".join(p.read_bytes() for p in sorted(Path(__file__).parent.glob("*.py")))
    digest = hashlib.sha256(sources + sys.version.encode()).hexdigest()[:16]
    return _cache_base() / "nccompile" / digest


@functools.cache
def _numba() -> Any:
    """Imports numba with a cache folder of our own."""
    folder = machine_code()
    if not folder.exists() and _state["tell"] is not None:
        _state["tell"]()
    os.environ.setdefault("NUMBA_CACHE_DIR", str(folder))
    import numba  # noqa: PLC0415

    return numba


def _native_forms(name: str) -> Sequence[Any]:
    if not machine_code().exists():
        return ()
    from nccompile.kernels import native  # noqa: PLC0415 - llvmlite takes its time, and Python kernels need none

    return native.load(machine_code(), name)


def _keep(name: str, overloads: Mapping[Any, Any]) -> None:
    from nccompile.kernels import native  # noqa: PLC0415

    native.save(machine_code(), name, list(overloads.values()))


def _cache_base() -> Path:
    """The folder for machine code: NCCOMPILE_CACHE, the user's cache, or where that cannot be written, a new one."""
    named = os.environ.get("NCCOMPILE_CACHE") or os.environ.get("XDG_CACHE_HOME")
    base = Path(named) if named else Path.home() / ".cache"
    try:
        (base / "nccompile").mkdir(parents=True, exist_ok=True)
    except OSError:
        return Path(tempfile.mkdtemp(prefix="nccompile-"))
    return base if os.access(base / "nccompile", os.W_OK) else Path(tempfile.mkdtemp(prefix="nccompile-"))
