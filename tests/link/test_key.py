"""Key files, as other ground stations make keys of passphrases."""

from __future__ import annotations

import hashlib

import pytest

from gcs_windplan.errors import InputError
from gcs_windplan.link.key import read_key


@pytest.mark.parametrize(
    ("content", "key"),
    [
        (b"0A" * 32, b"\x0a" * 32),
        (b"0a" * 32 + b"\r\n", b"\x0a" * 32),
        (b"correct horse\n", hashlib.sha256(b"correct horse").digest()),
        ("Zürich".encode(), hashlib.sha256("Zürich".encode()).digest()),
        (b"x" * 32, hashlib.sha256(b"x" * 32).digest()),
        (bytes(range(32)), bytes(range(32))),
        (b"\xff" * 32, b"\xff" * 32),
    ],
)
def test_keys(tmp_path, content, key):
    path = tmp_path / "key"
    path.write_bytes(content)
    assert read_key(path) == key


@pytest.mark.parametrize(
    "content", [b"", b"\n", b"  \n", b" " * 32, b"\t\n" * 16, b"two\nlines\n", bytes(31), b"\xff" * 33]
)
def test_no_keys(tmp_path, content):
    path = tmp_path / "key"
    path.write_bytes(content)
    with pytest.raises(InputError, match="is no key file: it must hold 64 hexadecimal digits"):
        read_key(path)


def test_a_key_file_that_is_not_there(tmp_path):
    with pytest.raises(InputError, match="cannot be read"):
        read_key(tmp_path / "absent")
