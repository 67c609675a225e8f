"""A stand-in vehicle on a line: bytes in and out, by the clock, until it is told to stop."""

from __future__ import annotations

from collections.abc import Callable

from gcs_windplan.link.codec import Codec
from gcs_windplan.link.transport import Clock, Transport
from gcs_windplan.standin.standin import StandIn

_LONGEST_WAIT = 0.1  # [s]


def serve(
    vehicle: StandIn,
    codec: Codec,
    transport: Transport,
    clock: Clock,
    goes_on: Callable[[], bool] = lambda: True,
) -> None:
    """Keep a vehicle on a line for as long as `goes_on`; raises LinkError when the line is lost."""
    while goes_on():
        now = clock()
        if now >= vehicle.wake:
            for message in vehicle.tick(now):
                transport.send(codec.encode(message))
        data = transport.receive(max(0.0, min(_LONGEST_WAIT, vehicle.wake - clock())))
        for message in codec.decode(data):
            for answer in vehicle.handle(message, clock()):
                transport.send(codec.encode(answer))
