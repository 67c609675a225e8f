"""Writing a file so that it is there whole or not at all."""

from __future__ import annotations

import errno
import os
import secrets
from pathlib import Path

from gcs_windplan.errors import FormatError, Problem

_ADVICE = {
    errno.ENOENT: "make the folder first",
    errno.ENOTDIR: "make the folder first",
    errno.EACCES: "choose another folder, or make this one writable",
    errno.EPERM: "choose another folder, or make this one writable",
    errno.EROFS: "choose a folder on a disk that can be written",
    errno.EISDIR: "add a file name",
    errno.ENOSPC: "free some space",
    errno.EDQUOT: "free some space",
    errno.ENAMETOOLONG: "choose a shorter name",
}


def write_atomically(path: str | os.PathLike[str], content: str | bytes) -> None:
    """Write the file by way of a temporary one beside it, so that readers see the old content or the new.

    Text is written as UTF-8 with its line ends as they are. When it fails, an older file stays as it was and
    nothing else is left behind. Raises FormatError.
    """
    target = Path(os.path.realpath(path))  # a symbolic link stays one
    data = content.encode("utf-8") if isinstance(content, str) else content
    try:
        if target.exists() and not target.is_file():
            target.write_bytes(data)  # a pipe or a device cannot be replaced; a folder raises
        else:
            _replace(target, data)
    except OSError as error:
        advice = _ADVICE.get(error.errno or 0, "choose another place")
        reason = (error.strerror or str(error)).lower()
        raise FormatError(Problem(f"cannot be written ({reason}): {advice}", file=Path(path))) from error


def check_writable(file: Path) -> None:
    """Raise `FormatError` for a file that cannot be written where it is to be."""
    problem = ""
    try:
        if not file.parent.is_dir():
            problem = "its folder is not there: make it first"
        elif file.is_dir():
            problem = "is a folder: add a file name"
        elif not os.access(Path(os.path.realpath(file)).parent, os.W_OK | os.X_OK):
            problem = "its folder cannot be written: choose another, or make it writable"
    except OSError as error:
        problem = f"cannot be written ({(error.strerror or str(error)).lower()}): choose another name"
    if problem:
        raise FormatError(Problem(problem, file=file))


def _replace(target: Path, data: bytes) -> None:
    temporary = target.with_name(f".{secrets.token_hex(6)}.tmp")
    try:
        with temporary.open("xb") as stream:
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())
        if target.exists():
            temporary.chmod(target.stat().st_mode & 0o7777)
        temporary.replace(target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
