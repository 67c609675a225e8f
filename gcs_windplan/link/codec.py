"""MAVLink bytes to messages and back, through a codec that belongs to one link and touches nothing else.

pymavlink's own parser trusts the length byte of whatever looks like a header, so a corrupted one swallows the
good messages behind it. Here frames are found by their checksum, and pymavlink decodes what is whole.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

from pymavlink.dialects.v20 import ardupilotmega as mavlink

Message: TypeAlias = Any
"""A message object of pymavlink's dialect, which has no types."""

Version: TypeAlias = Literal[1, 2]

_MARKERS = {mavlink.PROTOCOL_MARKER_V1: 1, mavlink.PROTOCOL_MARKER_V2: 2}
_HEADERS = {1: mavlink.HEADER_LEN_V1, 2: mavlink.HEADER_LEN_V2}
_CHECKSUM = 2
_SIGNATURE = mavlink.MAVLINK_SIGNATURE_BLOCK_LEN
_SIGNED = mavlink.MAVLINK_IFLAG_SIGNED
_SIGNING_EPOCH = 1_420_070_400  # [s] 2015-01-01 UTC (mavlink.io, Message Signing)
_SIGNING_STEP = 100_000  # ticks of 10 µs in a second (mavlink.io, Message Signing)


@dataclass(slots=True)
class Signatures:
    """What was seen of signing among the messages that arrived whole.

    `good`, `wrong` and `missing` count with a key: signed with it, signed with another (or replayed), not
    signed. `unchecked` counts signed messages where this side has no key.
    """

    good: int = 0
    wrong: int = 0
    missing: int = 0
    unchecked: int = 0


class Codec:
    """Encodes and decodes the messages of one end of a link.

    `system` and `component` are the sender's own. With `key`, 32 bytes, everything sent is signed and only what
    is signed with the same key is decoded. `version` is what `encode` speaks; `decode` reads both versions.
    """

    def __init__(self, system: int, component: int, key: bytes | None = None) -> None:
        self.system = system
        self.component = component
        self.version: Version = 2
        self.signatures = Signatures()
        self._mav = mavlink.MAVLink(None, srcSystem=system, srcComponent=component)
        self._rest = b""
        if key is not None:
            if len(key) != 32:
                raise ValueError(f"a signing key has 32 bytes, not {len(key)}")
            self._mav.signing.secret_key = key
            self._mav.signing.sign_outgoing = True
            self._set_signing_time()

    def encode(self, message: Message) -> bytes:
        """The message as one frame, signed where there is a key (MAVLink 1 knows no signatures)."""
        if self._mav.signing.sign_outgoing:
            self._set_signing_time()
        frame: bytes = message.pack(self._mav, force_mavlink1=self.version == 1)
        if self.version == 1:
            frame = _without_extensions(frame)
        self._mav.seq = (self._mav.seq + 1) % 256
        return frame

    def decode(self, data: bytes) -> list[Message]:
        """The messages that are whole after these bytes; garbage, broken and unknown ones are ignored."""
        messages = []
        for frame in self._frames(self._rest + data):
            message = self._message(frame)
            if message is not None:
                messages.append(message)
        return messages

    def _set_signing_time(self) -> None:
        now = int((time.time() - _SIGNING_EPOCH) * _SIGNING_STEP)
        self._mav.signing.timestamp = max(self._mav.signing.timestamp, now)

    def _frames(self, data: bytes) -> Iterator[bytes]:
        """The frames with a right checksum. Keeps what may be the start of one whose end is yet to come.

        A frame that seems to go on past the end may be a good one cut in two, or a broken length byte: good
        frames behind it are taken at once, and then it was broken.
        """
        position, waiting = 0, None
        while position < len(data):
            if data[position] not in _MARKERS:
                position += 1
                continue
            length = _frame_length(data, position)
            if length is None or position + length > len(data):
                waiting = position if waiting is None else waiting
                position += 1
            elif _is_whole(data, position, length):
                yield data[position : position + length]
                position += length
                waiting = None
            else:
                position += 1
        self._rest = b"" if waiting is None else data[waiting:]

    def _message(self, frame: bytes) -> Message | None:
        signed = frame[0] == mavlink.PROTOCOL_MARKER_V2 and bool(frame[2] & _SIGNED)
        with_key = self._mav.signing.secret_key is not None
        try:
            message = self._mav.decode(bytearray(frame))
        except mavlink.MAVError:
            if with_key and signed:
                self.signatures.wrong += 1
            elif with_key:
                self.signatures.missing += 1
            return None
        if signed and with_key:
            self.signatures.good += 1
        elif signed:
            self.signatures.unchecked += 1
        return message


def wire_version(message: Message) -> Version:
    """The MAVLink version in which a decoded message came."""
    return 1 if message.get_msgbuf()[0] == mavlink.PROTOCOL_MARKER_V1 else 2


def _without_extensions(frame: bytes) -> bytes:
    """A MAVLink 1 frame without the fields that MAVLink 2 added, which pymavlink leaves in it.

    Receivers that know MAVLink 1 only drop a message of another length.
    """
    from pymavlink.dialects.v10 import ardupilotmega as mavlink1

    kind = mavlink1.mavlink_map[frame[5]]
    header = mavlink.HEADER_LEN_V1
    size = kind.unpacker.size
    body = bytes((size,)) + frame[2 : header + size]
    checksum = mavlink.x25crc(body + bytes((kind.crc_extra,))).crc
    return frame[:1] + body + int(checksum).to_bytes(_CHECKSUM, "little")


def _frame_length(data: bytes, start: int) -> int | None:
    """The length that the header at `start` announces, None where the header itself is cut off."""
    version = _MARKERS[data[start]]
    if start + 3 > len(data):
        return None
    length: int = _HEADERS[version] + data[start + 1] + _CHECKSUM
    return length + _SIGNATURE if version == 2 and data[start + 2] & _SIGNED else length


def _is_whole(data: bytes, start: int, length: int) -> bool:
    """Whether a known message with a right checksum lies there."""
    version = _MARKERS[data[start]]
    if version == 2 and data[start + 2] & ~_SIGNED:
        return False  # flags that must be understood, and are not (mavlink.io, Incompatibility Flags)
    kind = data[start + 5] if version == 1 else int.from_bytes(data[start + 7 : start + 10], "little")
    known = mavlink.mavlink_map.get(kind)
    if known is None:
        return False
    end = start + _HEADERS[version] + data[start + 1]
    checksum = mavlink.x25crc(data[start + 1 : end] + bytes((known.crc_extra,))).crc
    return bool(checksum == int.from_bytes(data[end : end + _CHECKSUM], "little"))
