"""Machine code of kernels from the cache folder, run without importing numba.

numba compiles a kernel once a machine.  Importing numba again in every process, only to find that machine code,
costs half a second; llvmlite alone loads it in a few milliseconds:

    first process    numba compiles ──> machine code, symbol, argument types ──> FOLDER/<kernel>.json, .o
    next processes   llvmlite links that code into the process ──> called with numba's calling convention

The convention (numba documents it as `CPUCallConv`): int f(result*, exception**, arguments...), an array as
meminfo, parent, items, item size, data, shape..., strides....  Files name the versions and the processor they are
for; in doubt a kernel has no native form and numba takes the call.
"""

from __future__ import annotations

import ctypes
import hashlib
import importlib.machinery
import importlib.util
import json
import os
import secrets
import sys
from collections.abc import Sequence
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

__all__ = ["Native", "load", "save"]

_OK = (0, -2)  # numba's return codes of a value and of None
_SCALARS: dict[str, Any] = {"i": ctypes.c_int64, "f": ctypes.c_double, "b": ctypes.c_bool}
_SCALAR_NAMES = {"int64": "i", "float64": "f", "bool": "b"}
_HELPERS = (("numba.core.runtime._nrt_python", "NRT_"), ("numba._helperlib", "numba_"))


class Native:
    """One compiled form of a kernel: for arguments of certain types.

    arguments: "i", "f", "b", or "dtype/dimensions/layout/writable" for an array;  result: "", "i", "f", "b" or
    "f" several times for a tuple of floats.
    """

    def __init__(self, arguments: Sequence[str], result: str, symbol: str, code: bytes) -> None:
        self.arguments = tuple(arguments)
        self._result = result
        self._engine = _link(code)
        address = self._engine.get_function_address(symbol)
        types: list[Any] = [ctypes.c_void_p, ctypes.c_void_p]
        for argument in self.arguments:
            types += (
                [_SCALARS[argument]] if argument in _SCALARS else _array_types(int(argument.split("/")[1]))
            )
        self._function = ctypes.CFUNCTYPE(ctypes.c_int32, *types)(address)
        self._arrays = [None if a in _SCALARS else _array_of(a) for a in self.arguments]

    def takes(self, args: Sequence[Any]) -> bool:
        """Whether the arguments have the types this form is for."""
        if len(args) != len(self.arguments):
            return False
        for value, argument, array in zip(args, self.arguments, self._arrays, strict=True):
            if array is None:
                if _scalar(value) != argument:
                    return False
            elif not (
                isinstance(value, np.ndarray)
                and value.dtype == array[0]
                and value.ndim == array[1]
                and value.flags.c_contiguous >= array[2]
                and value.flags.writeable >= array[3]
                and value.flags.aligned
            ):
                return False
        return True

    def __call__(self, args: Sequence[Any]) -> tuple[bool, Any]:
        """Runs the kernel without the interpreter's lock: whether it ended well, and its result."""
        result = (
            _SCALARS[self._result[:1] or "i"] * max(len(self._result), 1)
        )()  # None is stored as 8 zero bytes
        raised = ctypes.c_void_p()
        flat: list[Any] = [ctypes.addressof(result), ctypes.addressof(raised)]
        for value, array in zip(args, self._arrays, strict=True):
            if array is None:
                flat.append(value)
            else:
                flat += [
                    None,
                    None,
                    value.size,
                    value.itemsize,
                    value.ctypes.data,
                    *value.shape,
                    *value.strides,
                ]
        status = self._function(*flat)
        values = tuple(result)[: len(self._result)]
        return status in _OK, values if len(values) > 1 else values[0] if values else None


def _scalar(value: Any) -> str:
    if isinstance(value, (bool, np.bool_)):
        return "b"
    if isinstance(value, float):
        return "f"
    return "i" if isinstance(value, (int, np.int64)) else ""


def _array_types(dimensions: int) -> list[Any]:
    return (
        [ctypes.c_void_p] * 2 + [ctypes.c_int64] * 2 + [ctypes.c_void_p] + [ctypes.c_int64] * (2 * dimensions)
    )


def _array_of(argument: str) -> tuple[np.dtype[Any], int, bool, bool]:
    dtype, dimensions, layout, writable = argument.split("/")
    return np.dtype(dtype), int(dimensions), layout == "C", writable == "1"


def _link(code: bytes) -> Any:
    """An execution engine with the machine code in it; it must live as long as its functions."""
    binding = _binding()
    module = binding.parse_assembly("")
    engine = binding.create_mcjit_compiler(
        module, binding.Target.from_default_triple().create_target_machine(jit=True)
    )
    engine.add_object_file(binding.ObjectFileRef.from_data(code))
    engine.finalize_object()
    return engine


@cache
def _binding() -> Any:
    """llvmlite with the helpers that numba's code refers to, taken from numba's extension modules."""
    from llvmlite import binding  # noqa: PLC0415

    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    numba = importlib.util.find_spec("numba")
    folders = list(numba.submodule_search_locations or []) if numba else []
    for name, prefix in _HELPERS:
        below = name.split(".")[1:]
        finder = importlib.machinery.FileFinder(
            str(Path(folders[0], *below[:-1])),
            (importlib.machinery.ExtensionFileLoader, importlib.machinery.EXTENSION_SUFFIXES),
        )
        spec = finder.find_spec(name)
        if spec is None or spec.loader is None:
            raise ImportError(name)
        helpers = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(helpers)
        for helper, address in helpers.c_helpers.items():
            binding.add_symbol(
                helper if helper.startswith("_") and prefix == "NRT_" else prefix + helper, address
            )
    return binding


@cache
def _platform() -> list[str]:
    """What machine code depends on besides its source."""
    from llvmlite import binding  # noqa: PLC0415

    return [
        version("numba"), version("llvmlite"), version("numpy"), binding.get_host_cpu_name(),
        binding.get_host_cpu_features().flatten(), os.environ.get("NUMBA_BOUNDSCHECK", ""),
    ]  # fmt: skip


def save(folder: Path, name: str, overloads: Sequence[Any]) -> None:
    """Keeps the machine code of a kernel's compiled forms that can be called so; failures are harmless."""
    for compiled in overloads:
        arguments = [_argument_name(t) for t in compiled.signature.args]
        result = _result_name(str(compiled.signature.return_type))
        if None in arguments or result is None:
            continue
        try:
            code = compiled.library._get_compiled_object()
        except RuntimeError:  # numba loaded it from its own cache and did not keep the bytes
            continue
        form = {
            "platform": _platform(),
            "sha256": hashlib.sha256(code).hexdigest(),
            "arguments": arguments,
            "result": result,
            "symbol": compiled.fndesc.llvm_func_name,
        }
        content = json.dumps(form).encode() + b"\n" + code
        digest = hashlib.sha256(repr(arguments).encode()).hexdigest()[:12]
        part = folder / f".{name}.{secrets.token_hex(4)}"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            part.write_bytes(content)
            part.replace(folder / f"{name}-{digest}.native")
        except OSError:
            part.unlink(missing_ok=True)


def load(folder: Path, name: str) -> list[Native]:
    """The compiled forms of a kernel that `save` kept on this machine; none if there is any doubt."""
    forms: list[Native] = []
    if not sys.platform.startswith("linux"):  # elsewhere object files and their loading are not tested
        return forms
    for file in sorted(folder.glob(f"{name}-*.native")):
        try:
            head, _, code = file.read_bytes().partition(b"\n")
            form = json.loads(head)
            if form["platform"] == _platform() and form["sha256"] == hashlib.sha256(code).hexdigest():
                forms.append(Native(form["arguments"], form["result"], form["symbol"], code))
        except (OSError, ImportError, ValueError, KeyError, TypeError, AttributeError, RuntimeError):
            return []
    return forms


def _argument_name(kind: Any) -> str | None:
    name = str(kind)
    if name in _SCALAR_NAMES:
        return _SCALAR_NAMES[name]
    if hasattr(kind, "dtype") and hasattr(kind, "layout") and kind.layout in {"C", "A"} and kind.aligned:
        return f"{kind.dtype}/{kind.ndim}/{kind.layout}/{int(kind.mutable)}"
    return None


def _result_name(name: str) -> str | None:
    if name == "none":
        return ""
    if name.startswith("UniTuple(float64 x "):
        return "f" * int(name.removeprefix("UniTuple(float64 x ").rstrip(")"))
    return _SCALAR_NAMES.get(name)
