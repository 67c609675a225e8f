"""How kernels are compiled: one decorator each for entries, for pieces of them, and for what is inlined by order.

All release the interpreter's lock, and divide as numpy does: divisors are checked where they may be 0; Numba's own
checks would cost up to half of the speed. Entries are kept on disk. Numba would take such machine code for fresh as
long as the file of the entry itself is unchanged, though it holds the code of all kernels that the entry calls. So here
it is fresh as long as no file of this folder has changed.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final, ParamSpec, TypeVar

import numba

_Arguments = ParamSpec("_Arguments")
_Result = TypeVar("_Result")

_OPTIONS: Final[dict[str, Any]] = {"error_model": "numpy", "nogil": True}
_BARE: Final[dict[str, Any]] = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}


def _digest(folder: Path) -> str | None:
    """What all kernels' source comes to; None where there are no files, as in an archive."""
    files = sorted(folder.glob("*.py"))
    whole = hashlib.sha256()
    for file in files:
        whole.update(file.name.encode() + b"\0" + file.read_bytes() + b"\0")
    return whole.hexdigest() if files else None


_DIGEST: Final = _digest(Path(__file__).parent)  # a millisecond


def compiled(function: Callable[_Arguments, _Result]) -> Callable[_Arguments, _Result]:
    """A kernel that Python calls; its machine code is kept on disk, where Numba keeps any."""
    dispatcher = numba.njit(cache=True, **_OPTIONS)(function)
    if _DIGEST is not None:
        # Numba has no option for the stamp by which it tells stale code; a subclass of its cache would need as much
        # of its insides. A stale entry is overwritten in place, so nothing piles up.
        dispatcher._cache._cache_file._source_stamp = _DIGEST
    return dispatcher  # type: ignore[no-any-return]


def piece(function: Callable[_Arguments, _Result]) -> Callable[_Arguments, _Result]:
    """A function that kernels alone call: the wrappers for others would take a seventh of the time to compile."""
    return numba.njit(**_BARE, **_OPTIONS)(function)  # type: ignore[no-any-return]


def inlined(function: Callable[_Arguments, _Result]) -> Callable[_Arguments, _Result]:
    """A function that kernels call for every edge or sample, inlined by order."""
    return numba.njit(forceinline=True, **_OPTIONS)(function)  # type: ignore[no-any-return]
