"""`gcs-windplan vehicle`: a stand-in vehicle to push missions to, and to watch flying."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from gcs_windplan.mission.firmware import autopilots

if TYPE_CHECKING:
    from gcs_windplan.link.transport import Transport
    from gcs_windplan.standin.vehicle import StandInOptions

HELP = (
    "Play a vehicle: a stand-in, not a simulator. It keeps ArduCopter's or PX4's mission rules, answers what ground"
    " stations ask, and moves along the uploaded mission in the wind, without dynamics and with a plain linear"
    " battery. Ctrl-C ends it."
)
EPILOG = (
    "Exit codes: 0 ended by Ctrl-C; 2 an option, file or address cannot be used; 4 the connection was lost. Try:"
    " gcs-windplan vehicle --fly, and in another terminal gcs-windplan push FILE --to udpout:127.0.0.1:14550."
)


def vehicle(
    listen: Annotated[
        str,
        typer.Option(
            "--listen",
            "--connect",
            metavar="ADDRESS",
            help="Where it is: udpin:HOST:PORT and tcpin:HOST:PORT wait for ground stations; udpout:HOST:PORT calls one"
            " that listens, as simulators do; tcp:HOST:PORT; a serial DEVICE[:BAUD].",
        ),
    ] = "udpin:127.0.0.1:14550",
    autopilot: Annotated[
        str | None,
        typer.Option(
            metavar="NAME", help=f"{' or '.join(autopilots())}: whose rules it keeps; default the mission file's."
        ),
    ] = None,
    mission: Annotated[
        Path | None,
        typer.Option(metavar="MISSION.yaml", help="Fly in its wind, over its terrain, at its vehicle's airspeed."),
    ] = None,
    wind: Annotated[
        str | None,
        typer.Option(metavar="WIND", help="In place of the mission's: '5 m/s from 270', short 5@270; or a forecast."),
    ] = None,
    airspeed: Annotated[
        str | None,
        typer.Option(
            metavar="SPEED", help="The most that it flies through the air; default: what its default lean gives."
        ),
    ] = None,
    home: Annotated[
        str | None,
        typer.Option(
            metavar="LAT,LON,ALT",
            help="Where it stands [deg, m above sea level]; default the mission file's start, or where the first"
            " mission that is uploaded begins.",
        ),
    ] = None,
    speedup: Annotated[
        float, typer.Option(metavar="N", min=0.01, max=1000.0, help="Seconds of flight in one of the clock.")
    ] = 1.0,
    fly: Annotated[
        bool, typer.Option("--fly", help="Arm and fly as soon as a mission was uploaded, without being told to.")
    ] = False,
    capacity: Annotated[
        int | None,
        typer.Option(metavar="N", min=0, max=65535, help="Room for N items; default 718 (ArduPilot), 2000 (PX4)."),
    ] = None,
    sysid: Annotated[int, typer.Option(metavar="N", min=1, max=255, help="Its MAVLink system.")] = 1,
    sign: Annotated[
        Path | None,
        typer.Option(metavar="KEYFILE", help="Sign what it says, and hear only what is signed with the same key."),
    ] = None,
    mavlink1: Annotated[
        bool, typer.Option("--mavlink1", help="Speak MAVLink 1, which has no fences and rally points.")
    ] = False,
) -> None:
    """Serve until interrupted."""
    from gcs_windplan.cli.choices import option_name
    from gcs_windplan.jobs.standins import standin_options
    from gcs_windplan.link.key import read_key
    from gcs_windplan.link.transport import open_transport
    from gcs_windplan.standin.rules import ServerOptions

    server = ServerOptions(system=sysid, capacity=capacity, mavlink1=mavlink1)
    options = standin_options(
        mission,
        server,
        autopilot=autopilot,
        wind=wind,
        airspeed=airspeed,
        home=home,
        speedup=speedup,
        fly=fly,
        on_note=lambda text: typer.echo(f"note: {text}"),
        named=option_name,
    )
    key = read_key(sign) if sign is not None else None
    transport = open_transport(listen)
    try:
        _serve(options, transport, listen, key)
    except KeyboardInterrupt:
        typer.echo("ended")
    finally:
        transport.close()


def _serve(options: StandInOptions, transport: Transport, listen: str, key: bytes | None) -> None:
    """Play the vehicle on a line; a TCP server waits for the next caller when one has gone."""
    import time

    from gcs_windplan.errors import LinkError
    from gcs_windplan.link.codec import Codec
    from gcs_windplan.standin.service import serve
    from gcs_windplan.standin.standin import StandIn

    began = time.monotonic()

    def say(words: str) -> None:
        typer.echo(f"{time.monotonic() - began:8.2f} s  {words}")

    codec = Codec(options.server.system, options.server.component, key)
    codec.version = 1 if options.server.mavlink1 else 2
    vehicle = StandIn(options, time.monotonic(), say)
    rules, system = options.firmware.name, options.server.system
    say(f"a stand-in, no real vehicle and no simulator: system {system}, {rules}'s mission rules, {listen}")
    home, wind = options.world.home, options.world.wind
    say(f"it stands at {home.point}, {home.altitude:.1f} m; wind: {wind.name}; speed-up {options.speedup:g}")
    while True:
        try:
            serve(vehicle, codec, transport, time.monotonic)
        except LinkError as error:
            if not listen.lower().startswith("tcpin:"):
                raise
            say(f"{error}; it waits for the next one")
