"""A file is there whole or not at all."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path

import pytest

from gcs_windplan.errors import FormatError
from gcs_windplan.formats import write_atomically, write_plan, write_waypoints
from gcs_windplan.mission import MissionItems


def test_text_and_bytes_are_written_as_they_are(tmp_path: Path) -> None:
    write_atomically(tmp_path / "a.txt", "höhe\n")
    write_atomically(str(tmp_path / "b.png"), b"\x89PNG\r\n")
    assert (tmp_path / "a.txt").read_bytes() == "höhe\n".encode()
    assert (tmp_path / "b.png").read_bytes() == b"\x89PNG\r\n"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.txt", "b.png"]


def test_a_new_file_heeds_the_umask_and_an_old_one_keeps_its_mode(tmp_path: Path) -> None:
    plain = tmp_path / "plain"
    plain.write_text("")
    path = tmp_path / "file"
    write_atomically(path, "one")
    assert stat.S_IMODE(path.stat().st_mode) == stat.S_IMODE(plain.stat().st_mode)
    path.chmod(0o640)
    write_atomically(path, "two")
    assert stat.S_IMODE(path.stat().st_mode) == 0o640


def test_a_symbolic_link_stays_one(tmp_path: Path) -> None:
    target, link = tmp_path / "target", tmp_path / "link"
    target.write_text("old")
    link.symlink_to(target)
    write_atomically(link, "new")
    assert link.is_symlink()
    assert target.read_text() == "new"


@pytest.mark.parametrize("failing", ["fsync", "replace", "interrupt"])
def test_a_failure_leaves_the_old_file_and_nothing_else(
    failing: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "mission.plan"
    path.write_text("old")

    def fail(*_: object) -> None:
        if failing == "interrupt":
            raise KeyboardInterrupt
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    if failing == "replace":
        monkeypatch.setattr(Path, "replace", fail)
    else:
        monkeypatch.setattr(os, "fsync", fail)
    with pytest.raises(KeyboardInterrupt if failing == "interrupt" else FormatError) as caught:
        write_atomically(path, "new")
    if failing != "interrupt":
        assert str(caught.value) == f"{path}: cannot be written (no space left on device): free some space"
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_failures_say_what_to_do(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="make the folder first"):
        write_atomically(tmp_path / "missing" / "mission.plan", "")
    with pytest.raises(FormatError, match="add a file name"):
        write_atomically(tmp_path, "")
    with pytest.raises(FormatError, match="choose a shorter name"):
        write_atomically(tmp_path / ("m" * 300), "")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("write", [write_plan, write_waypoints])
def test_a_refused_mission_leaves_no_file(write, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(FormatError):
        write(MissionItems(()), tmp_path / "mission")
    assert list(tmp_path.iterdir()) == []
