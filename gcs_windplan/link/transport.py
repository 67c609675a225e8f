"""Bytes to and from a vehicle: UDP, TCP and serial lines behind one small protocol.

udpin:HOST:PORT   listen, and answer whoever spoke (the way simulators and most autopilots call in)
udpout:HOST:PORT  speak to an address
tcp:HOST:PORT     connect to a server
tcpin:HOST:PORT   be the server
DEVICE[:BAUD]     a serial line

udpin://HOST:PORT and the like mean the same, in capitals as well.
"""

from __future__ import annotations

import errno
import os
import select
import socket
import time
from collections.abc import Callable
from typing import Any, Protocol, TypeAlias

from gcs_windplan.errors import AddressError, LinkError

Clock: TypeAlias = Callable[[], float]
"""Seconds that only ever grow, such as `time.monotonic`."""

_LONGEST = 65_535  # [bytes] of a UDP datagram
_CALLERS = 16  # addresses that a listening socket answers at most, the latest ones
_SERIAL_RATE = 57_600  # [baud] of telemetry radios; USB lines do not care
_FASTEST = 2**31 - 1  # [baud] that can be told to the system
_CONNECTING = 5.0  # [s]
_UNBROKEN = getattr(socket, "MSG_NOSIGNAL", 0)  # a closed connection is an error, and no signal that ends us
_KINDS = ("udpin", "udpout", "tcp", "tcpin")
_FORMS = "udpin:HOST:PORT, udpout:HOST:PORT, tcp:HOST:PORT, tcpin:HOST:PORT or a serial DEVICE[:BAUD]"


class Transport(Protocol):
    """Carries bytes both ways. `receive` waits up to `timeout` seconds and gives b"" when nothing came."""

    def send(self, data: bytes) -> None:
        """Send one message; a datagram where the link has datagrams."""

    def receive(self, timeout: float) -> bytes:
        """What arrived, at least one byte, or b"" after `timeout` seconds. Raises LinkError on a dead line."""

    def close(self) -> None:
        """Give the line back."""


def open_transport(address: str) -> Transport:
    """The transport for an address; raises AddressError with what to write in its place.

    Raises LinkError where the address is right and the other side does not take the connection.
    """
    kind, colon, place = address.partition(":")
    kind = kind.lower()
    if kind in _KINDS and colon:
        return _open_socket(kind, _host_and_port(address, place.removeprefix("//")), address)
    if kind in (*_KINDS, "udp", "serial", "file", "com") or "://" in address:
        raise AddressError(f"unknown address format {address!r}: write {_FORMS}")
    return _open_serial(address)


def _host_and_port(address: str, place: str) -> tuple[str, int]:
    host, colon, port = place.rpartition(":")
    if not colon or not host:
        raise AddressError(f"the address {address!r} lacks host or port: write for example {_example(address)}")
    if not _is_number(port, 65_535):
        raise AddressError(f"the address {address!r} has the port {port!r}: give a number from 1 to 65535")
    return host.removeprefix("[").removesuffix("]"), int(port)


def _is_number(text: str, most: int) -> bool:
    """Whether a text is a whole number from 1 to `most`."""
    return text.isascii() and text.isdigit() and len(text) < 11 and 0 < int(text) <= most


def _example(address: str) -> str:
    kind = address.partition(":")[0].lower()
    return f"{kind}:{'0.0.0.0' if kind.endswith('in') else '127.0.0.1'}:14550"


def _open_socket(kind: str, place: tuple[str, int], address: str) -> Transport:
    udp = kind.startswith("udp")
    family, kind_of_socket, number, _, name = _resolve(place, socket.SOCK_DGRAM if udp else socket.SOCK_STREAM, address)
    line = socket.socket(family, kind_of_socket, number)
    try:
        if kind == "udpin":
            line.bind(name)
            return _Listening(line)
        if kind == "udpout":
            line.connect(name)
            return _Datagrams(line)
        return _Stream(line, name) if kind == "tcp" else _Server(line, name)
    except OSError as error:
        line.close()
        raise _socket_error(kind, address, error) from error


def _resolve(place: tuple[str, int], kind: socket.SocketKind, address: str) -> tuple[Any, ...]:
    try:
        return socket.getaddrinfo(*place, type=kind)[0]
    except (OSError, UnicodeError) as error:
        raise AddressError(f"the host of {address!r} is not known: check its name") from error


def _socket_error(kind: str, address: str, error: OSError) -> AddressError | LinkError:
    if error.errno == errno.EADDRINUSE:
        return AddressError(f"the port of {address!r} is in use: end the program that has it, or take another port")
    reason = (error.strerror or str(error)).lower()
    if kind == "tcp":
        return LinkError(f"nobody takes the connection at {address!r} ({reason}): is the vehicle there?")
    return AddressError(f"the address {address!r} cannot be used ({reason}): write one that this computer has")


class _Socket:
    """What the transports on a socket share."""

    def __init__(self, line: socket.socket) -> None:
        self._line = line

    def close(self) -> None:
        self._line.close()


class _Datagrams(_Socket):
    """UDP to one address. That nobody listens there yet is no error: a vehicle may still be starting."""

    def send(self, data: bytes) -> None:
        try:
            self._line.send(data)
        except ConnectionError:
            pass
        except OSError as error:
            raise _lost(error) from error

    def receive(self, timeout: float) -> bytes:
        until = time.monotonic() + timeout
        while _readable(self._line, until):
            try:
                data = self._line.recv(_LONGEST)
            except ConnectionError:
                continue
            except OSError as error:
                raise _lost(error) from error
            if data:
                return data
        return b""


class _Listening(_Socket):
    """UDP from anybody; what is sent goes to everyone who spoke, as on a bus."""

    def __init__(self, line: socket.socket) -> None:
        super().__init__(line)
        self._callers: dict[Any, None] = {}

    def send(self, data: bytes) -> None:
        for caller in list(self._callers):
            try:
                self._line.sendto(data, caller)
            except OSError:
                del self._callers[caller]  # gone; it is taken up again when it speaks

    def receive(self, timeout: float) -> bytes:
        until = time.monotonic() + timeout
        while _readable(self._line, until):
            try:
                data, caller = self._line.recvfrom(_LONGEST)
            except ConnectionError:
                continue  # Windows reports here that an earlier caller has gone
            if data:
                self._remember(caller)
                return data
        return b""

    def _remember(self, caller: Any) -> None:
        self._callers.pop(caller, None)
        self._callers[caller] = None
        while len(self._callers) > _CALLERS:
            del self._callers[next(iter(self._callers))]


class _Stream(_Socket):
    """TCP to a server."""

    def __init__(self, line: socket.socket, name: Any) -> None:
        super().__init__(line)
        line.settimeout(_CONNECTING)
        line.connect(name)
        _prepare(line)

    def send(self, data: bytes) -> None:
        _send_all(self._line, data)

    def receive(self, timeout: float) -> bytes:
        return _from_stream(self._line, timeout)


class _Server(_Socket):
    """TCP as the server of one caller after the other. When one is lost, the next may be received after that."""

    def __init__(self, line: socket.socket, name: Any) -> None:
        super().__init__(line)
        line.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        line.bind(name)
        line.listen(1)
        self._caller: socket.socket | None = None

    def send(self, data: bytes) -> None:
        if self._caller is not None:
            try:
                _send_all(self._caller, data)
            except LinkError:
                self._let_go(self._caller)
                raise

    def receive(self, timeout: float) -> bytes:
        if self._caller is not None:
            try:
                return _from_stream(self._caller, timeout)
            except LinkError:
                self._let_go(self._caller)
                raise
        if _readable(self._line, time.monotonic() + timeout):
            self._caller, _ = self._line.accept()
            _prepare(self._caller)
        return b""

    def close(self) -> None:
        if self._caller is not None:
            self._caller.close()
        super().close()

    def _let_go(self, caller: socket.socket) -> None:
        caller.close()
        self._caller = None


def _prepare(line: socket.socket) -> None:
    line.settimeout(_CONNECTING)
    line.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)


def _send_all(line: socket.socket, data: bytes) -> None:
    try:
        line.sendall(data, _UNBROKEN)
    except OSError as error:
        raise _lost(error) from error


def _from_stream(line: socket.socket, timeout: float) -> bytes:
    if not _readable(line, time.monotonic() + timeout):
        return b""
    try:
        data = line.recv(_LONGEST)
    except OSError as error:
        raise _lost(error) from error
    if not data:
        raise LinkError("the connection was closed by the other side")
    return data


def _readable(line: socket.socket, until: float) -> bool:
    """Whether something is to be read before the time `until`."""
    return bool(select.select([line], [], [], max(0.0, until - time.monotonic()))[0])


def _lost(error: OSError) -> LinkError:
    return LinkError(f"the connection is lost ({(error.strerror or str(error)).lower()})")


def _open_serial(address: str) -> Transport:
    device, rate = _device_and_rate(address)
    try:
        import serial
    except ImportError as error:
        raise AddressError("serial lines need the package pyserial: install it") from error
    try:
        return _Serial(serial.Serial(device, rate, timeout=0, write_timeout=_CONNECTING))
    except (OSError, ValueError) as error:
        code = getattr(error, "errno", None)
        reason = errno.errorcode.get(code, "") if code else ""
        told = {"ENOENT": "there is no such device", "EACCES": "permission denied", "EBUSY": "it is in use"}
        message = told.get(reason, "it is no serial line" if _is_no_line(error) else str(error))
        raise AddressError(f"the serial device {device!r} cannot be opened ({message}): write {_FORMS}") from error


def _device_and_rate(address: str) -> tuple[str, int]:
    device, colon, rate = address.rpartition(":")
    if not colon or os.path.exists(address) or not (rate.isdecimal() or os.path.exists(device)):
        return address, _SERIAL_RATE
    if not _is_number(rate, _FASTEST):
        raise AddressError(f"the address {address!r} has the baud rate {rate!r}: give a number such as {_SERIAL_RATE}")
    return device, int(rate)


def _is_no_line(error: Exception) -> bool:
    """Whether the device took none of a serial line's settings, as files and /dev/null do."""
    return isinstance(error.__context__, Exception) and error.__context__.args[:1] == (errno.ENOTTY,)


class _Serial:
    """A serial line."""

    def __init__(self, line: Any) -> None:
        self._line = line

    def send(self, data: bytes) -> None:
        try:
            self._line.write(data)
        except OSError as error:
            raise _lost(error) from error

    def receive(self, timeout: float) -> bytes:
        try:
            self._line.timeout = timeout
            first: bytes = self._line.read(1)
            rest: bytes = self._line.read(self._line.in_waiting) if first else b""
        except OSError as error:
            raise _lost(error) from error
        return first + rest

    def close(self) -> None:
        self._line.close()
