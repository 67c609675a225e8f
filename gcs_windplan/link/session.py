"""A session on a link: runs exchanges over a transport, and keeps the ground station's heartbeat going."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Protocol, Self, TypeAlias

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.errors import InputError, LinkError
from gcs_windplan.link.codec import Codec, Message
from gcs_windplan.link.discovery import Discovery
from gcs_windplan.link.home import AskHome
from gcs_windplan.link.key import read_key
from gcs_windplan.link.outcome import Reason
from gcs_windplan.link.peer import Contact, Ident, Peer
from gcs_windplan.link.transport import Clock, Transport, open_transport
from gcs_windplan.mission import Home
from gcs_windplan.progress import CancelToken

# 255 is what vehicles take for a ground station; the component keeps us apart from one that runs beside us
OWN = Ident(255, mavlink.MAV_COMP_ID_PATHPLANNER)
PATIENCE = 10.0  # [s] to find a vehicle
_BEAT = 1.0  # [s] mavlink.io, Heartbeat Protocol

TransferCallback: TypeAlias = Callable[[int, int], None]
"""Told how many items of how many are through."""


class Machine(Protocol):
    """What a session runs: a state machine without socket and clock."""

    wake: float

    @property
    def done(self) -> bool:
        """Whether it has ended."""

    @property
    def progress(self) -> tuple[int, int]:
        """How many items of how many are through."""

    def begin(self, now: float) -> list[Message]:
        """The first messages to send."""

    def handle(self, message: Message, now: float) -> list[Message]:
        """Take in a message; gives what to send."""

    def tick(self, now: float) -> list[Message]:
        """What to send because time has passed."""

    def cancel(self, reason: Reason = ..., message: str = ...) -> list[Message]:
        """End it; gives what to send."""


class Session:
    """One ground station on one link.

    With `key` it signs, and hears only what is signed with it. `timeout` [s] bounds everything the session does;
    what is under way then is cancelled, and so it is by the token `cancel`. `interrupted` tells that the user did so.
    """

    def __init__(
        self,
        transport: Transport,
        *,
        key: bytes | None = None,
        timeout: float | None = None,
        clock: Clock = time.monotonic,
        own: Ident = OWN,
        cancel: CancelToken | None = None,
    ) -> None:
        self.own = own
        self.codec = Codec(*own, key)
        self.interrupted = False
        self._cancel = cancel
        self._transport = transport
        self._clock = clock
        self._signs = key is not None
        self._timeout = timeout
        self._deadline = math.inf if timeout is None else clock() + timeout
        self._next_beat = -math.inf
        self._contacts: dict[Ident, Contact] = {}

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._transport.close()

    @property
    def clock(self) -> Clock:
        """The session's clock."""
        return self._clock

    def meet(self, system: int | None = None, component: int | None = None) -> Peer:
        """The vehicle on the link, the one wanted if there are several.

        Raises LinkError where none is heard, InputError where several fit or where the keys do not.
        """
        discovery = Discovery(PATIENCE if self._timeout is None else self._timeout, system, component)
        self.run(discovery)
        peer = discovery.peer()
        if discovery.lost:
            raise LinkError(discovery.lost)
        if peer is None:
            raise self._nobody(discovery)
        self.codec.version = peer.version
        self._contacts[peer.ident] = discovery.contact(peer)
        return peer

    def contact(self, peer: Peer) -> Contact:
        """What the session has seen of a vehicle."""
        return self._contacts.setdefault(peer.ident, Contact(peer.ident))

    def ask_home(self, peer: Peer) -> Home | None:
        """The vehicle's home, None where it does not say."""
        question = AskHome(peer)
        self.run(question)
        return question.home

    def hint(self) -> str:
        """What the signatures seen say of a vehicle that does not answer; mostly empty."""
        if self.codec.signatures.unchecked and not self._signs:
            return "its messages are signed, so it may want ours to be: give its key with --sign"
        return ""

    def run(self, machine: Machine, watch: TransferCallback | None = None) -> None:
        """Run a machine until it is done; Ctrl-C, a dead line and the session's end of time cancel it."""
        try:
            self._send(machine.begin(self._clock()))
            while not machine.done:
                self._step(machine)
                if self._cancel is not None and self._cancel.cancelled:
                    self._stop(machine)
                if watch is not None:
                    watch(*machine.progress)
        except KeyboardInterrupt:
            self._stop(machine)
        except LinkError as error:
            machine.cancel("lost", str(error))

    def _stop(self, machine: Machine) -> None:
        """End a machine because the user wants it."""
        self.interrupted = True
        with suppress(LinkError):
            self._send(machine.cancel())

    def _step(self, machine: Machine) -> None:
        self._beat()
        now = self._clock()
        data = self._transport.receive(max(0.0, min(machine.wake, self._next_beat, self._deadline) - now))
        now = self._clock()
        for message in self.codec.decode(data):
            self._send(machine.handle(message, now))
        if now >= machine.wake:
            self._send(machine.tick(now))
        if now >= self._deadline:
            self._send(machine.cancel("time-out", f"timed out after {self._timeout:g} s"))

    def _beat(self) -> None:
        now = self._clock()
        if now >= self._next_beat:
            self._next_beat = now + _BEAT
            kind, no_autopilot = mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID
            self._send([mavlink.MAVLink_heartbeat_message(kind, no_autopilot, 0, 0, mavlink.MAV_STATE_ACTIVE, 3)])

    def _send(self, messages: list[Message]) -> None:
        for message in messages:
            self._transport.send(self.codec.encode(message))

    def _nobody(self, discovery: Discovery) -> Exception:
        seen = self.codec.signatures
        if seen.wrong:
            return InputError("the vehicle signs with another key: give its own with --sign")
        if seen.missing:
            return InputError("the vehicle does not sign: leave --sign out, or set the key up in the vehicle")
        if others := discovery.others():
            return LinkError(f"the vehicle wanted is not there, only {', '.join(others)}: check --sysid and --compid")
        return LinkError("no vehicle was heard: check the address, and that the vehicle is on")


def open_session(
    address: str, *, key_file: Path | None = None, timeout: float | None = None, cancel: CancelToken | None = None
) -> Session:
    """A session at an address; raises InputError for a wrong address or key file."""
    key = None if key_file is None else read_key(key_file)
    return Session(open_transport(address), key=key, timeout=timeout, cancel=cancel)
