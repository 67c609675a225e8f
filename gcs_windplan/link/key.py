"""The file with the key that signs MAVLink 2."""

from __future__ import annotations

import hashlib
import re
from pathlib import Path

from gcs_windplan.errors import InputError, Problem

_LENGTH = 32  # [bytes] mavlink.io, Message Signing
_FORMS = "64 hexadecimal digits, one line with a passphrase, or 32 bytes"


def read_key(path: Path) -> bytes:
    """The key of 32 bytes in a file.

    The file holds 64 hexadecimal digits, or one line with a passphrase, of which the SHA-256 is the key, as
    MAVProxy, Mission Planner and QGroundControl have it, or the 32 bytes as they are. Raises InputError.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise InputError(Problem(f"the key file cannot be read ({reason}): check its name", file=path)) from error
    text = _line(data)
    if text is not None:
        digits = re.fullmatch(r"[0-9a-fA-F]{64}", text)
        return bytes.fromhex(text) if digits else hashlib.sha256(text.encode()).digest()
    if len(data) == _LENGTH and data.strip():
        return data
    raise InputError(Problem(f"is no key file: it must hold {_FORMS}", file=path))


def _line(data: bytes) -> str | None:
    """The one line of text that the file is, None where it is something else."""
    try:
        text = data.decode("utf-8").rstrip("\r\n")
    except UnicodeDecodeError:
        return None
    return text if text.strip() and text.isprintable() else None
