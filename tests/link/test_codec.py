"""The codec: both versions, signatures, and good frames among bad bytes."""

from __future__ import annotations

import os
import random
import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.link.codec import Codec, wire_version

KEY = bytes(range(32))


def request(seq: int):
    return mavlink.MAVLink_mission_request_int_message(255, 195, seq, 1)


def seqs(messages) -> list[int]:
    return [message.seq for message in messages]


@pytest.mark.parametrize("version", [1, 2])
def test_there_and_back(version):
    codec = Codec(1, 2)
    codec.version = version
    data = codec.encode(request(7))
    assert data[0] == (0xFE if version == 1 else 0xFD)
    (message,) = Codec(255, 195).decode(data)
    assert (message.seq, message.get_srcSystem(), message.get_srcComponent()) == (7, 1, 2)
    assert wire_version(message) == version
    assert message.mission_type == (0 if version == 1 else 1)  # MAVLink 1 has no place for it


def test_mavlink_1_frames_are_as_long_as_mavlink_1_says():
    from pymavlink.dialects.v10 import ardupilotmega as mavlink1

    codec = Codec(1, 2)
    codec.version = 1
    reader = mavlink1.MAVLink(None)
    for message in (request(7), mavlink.MAVLink_mission_ack_message(1, 1, 15, 2)):
        data = codec.encode(message)
        theirs = reader.decode(bytearray(data))
        assert len(data) == 8 + mavlink1.mavlink_map[data[5]].unpacker.size
        assert theirs.target_system == message.target_system


def test_frames_are_numbered():
    codec, other = Codec(1, 1), Codec(2, 2)
    numbers = [other.decode(codec.encode(request(0)))[0].get_seq() for _ in range(258)]
    assert numbers == [*range(256), 0, 1]


@given(st.lists(st.integers(1, 40), min_size=1, max_size=30), st.integers(0, 2**32))
def test_bytes_may_come_in_any_pieces(sizes, seed):
    rng = random.Random(seed)
    codec, other = Codec(1, 1), Codec(2, 2)
    data = b"".join(codec.encode(request(seq)) for seq in range(5))
    heard = []
    while data:
        size = rng.choice(sizes)
        heard += other.decode(data[:size])
        data = data[size:]
    assert seqs(heard) == [0, 1, 2, 3, 4]


@given(st.binary(max_size=60), st.binary(max_size=60))
def test_good_frames_among_garbage(before, after):
    codec, other = Codec(1, 1), Codec(2, 2)
    heard = other.decode(before + codec.encode(request(1)) + after + codec.encode(request(2)))
    assert seqs(heard) == [1, 2]  # at once, whatever lengths the garbage announces


@given(st.binary(max_size=40), st.integers(1, 3))
def test_a_frame_behind_garbage_is_heard_once(garbage, version):
    codec, other = Codec(1, 1), Codec(2, 2)
    heard = [message for _ in range(3) for message in other.decode(garbage + codec.encode(request(version)))]
    assert seqs(heard) == [version] * 3


@given(st.integers(0, 2**32))
def test_a_spoilt_frame_takes_no_other_with_it(seed):
    rng = random.Random(seed)
    codec, other = Codec(1, 1), Codec(2, 2)
    frames = [bytearray(codec.encode(request(seq))) for seq in range(3)]
    place = rng.randrange(len(frames[1]))
    frames[1][place] ^= rng.randint(1, 255)
    assert seqs(other.decode(b"".join(frames))) == [0, 2]


def test_unknown_messages_are_passed_over():
    codec = Codec(1, 1)
    frame = bytearray(codec.encode(request(1)))
    frame[7:10] = (60_000).to_bytes(3, "little")
    assert seqs(Codec(2, 2).decode(bytes(frame) + codec.encode(request(2)))) == [2]


def test_frames_with_unknown_flags_are_passed_over():
    frame = bytearray(Codec(1, 1).encode(request(1)))
    frame[2] |= 0x02
    checksum = mavlink.x25crc(bytes(frame[1:-2]) + bytes((mavlink.MAVLink_mission_request_int_message.crc_extra,))).crc
    frame[-2:] = checksum.to_bytes(2, "little")
    assert Codec(2, 2).decode(bytes(frame)) == []


def test_what_is_kept_waiting_is_bounded():
    codec = Codec(1, 1)
    for _ in range(1000):
        codec.decode(b"\xfd\xff\x00" * 10)
    assert len(codec._rest) < 400


def test_signed():
    sender, receiver = Codec(1, 1, KEY), Codec(2, 2, KEY)
    data = sender.encode(request(3))
    assert data[2] & 1
    assert seqs(receiver.decode(data)) == [3]
    assert receiver.signatures.good == 1
    assert receiver.decode(data) == []  # said again by somebody else
    assert receiver.signatures.wrong == 1


def test_wrongly_signed_unsigned_and_unchecked():
    receiver = Codec(2, 2, KEY)
    assert receiver.decode(Codec(1, 1, bytes(32)).encode(request(1))) == []
    assert receiver.decode(Codec(1, 1).encode(request(1))) == []
    assert (receiver.signatures.wrong, receiver.signatures.missing) == (1, 1)
    keyless = Codec(2, 2)
    assert seqs(keyless.decode(Codec(1, 1, KEY).encode(request(1)))) == [1]
    assert keyless.signatures.unchecked == 1


def test_the_time_in_signatures_grows_across_sessions():
    receiver = Codec(2, 2, KEY)
    for _ in range(3):
        sender = Codec(1, 1, KEY)
        assert [len(receiver.decode(sender.encode(request(1)))) for _ in range(3)] == [1, 1, 1]


def test_a_key_has_32_bytes():
    with pytest.raises(ValueError, match="32 bytes"):
        Codec(1, 1, b"short")


def test_importing_changes_no_environment():
    code = (
        "import os; before = dict(os.environ); import sys; import gcs_windplan.link.session, gcs_windplan.cli.app;"
        "print(before == dict(os.environ), 'pymavlink.mavutil' in sys.modules)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, env=dict(os.environ), check=True
    )
    assert done.stdout.split() == ["True", "False"]
