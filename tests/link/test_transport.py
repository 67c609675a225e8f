"""Sockets and serial lines, on loopback."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import threading
import time

import pytest

from gcs_windplan.errors import AddressError, LinkError
from gcs_windplan.link.transport import Transport, open_transport
from tests.mavsdk_peers import free_port


def heard(transport: Transport, size: int) -> bytes:
    data = b""
    until = time.monotonic() + 5
    while len(data) < size and time.monotonic() < until:
        data += transport.receive(0.2)
    return data


@pytest.fixture
def opened():
    """Opens transports and closes them in the end."""
    transports: list[Transport] = []

    def open_one(address: str) -> Transport:
        transports.append(open_transport(address))
        return transports[-1]

    yield open_one
    for transport in transports:
        transport.close()


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost", "[::1]"])
def test_udp_both_ways(opened, host):
    if host == "[::1]" and not socket.has_ipv6:
        pytest.skip("no IPv6 here")
    port = free_port()
    try:
        listening = opened(f"udpin:{host}:{port}")
    except AddressError:
        pytest.skip("no IPv6 here")
    calling = opened(f"udpout:{host}:{port}")
    listening.send(b"nobody has spoken yet")
    calling.send(b"here I am")
    assert heard(listening, 9) == b"here I am"
    listening.send(b"welcome")
    assert heard(calling, 7) == b"welcome"


def test_udpin_answers_everybody_who_spoke(opened):
    port = free_port()
    listening = opened(f"udpin:127.0.0.1:{port}")
    callers = [opened(f"udpout:127.0.0.1:{port}") for _ in range(3)]
    for caller in callers:
        caller.send(b"x")
    assert heard(listening, 3) == b"xxx"
    listening.send(b"to all")
    assert [heard(caller, 6) for caller in callers] == [b"to all"] * 3


def test_udpin_forgets_the_oldest_callers(opened):
    port = free_port()
    listening = opened(f"udpin:127.0.0.1:{port}")
    callers = [opened(f"udpout:127.0.0.1:{port}") for _ in range(17)]
    for caller in (*callers[:16], callers[0], callers[16]):
        caller.send(b"x")
        assert heard(listening, 1) == b"x"
    listening.send(b"hi")
    assert callers[1].receive(0.05) == b""
    assert [heard(caller, 2) for caller in (callers[0], callers[16])] == [b"hi"] * 2


def test_udpout_bears_that_nobody_listens(opened):
    calling = opened(f"udpout:127.0.0.1:{free_port()}")
    for _ in range(3):
        calling.send(b"hello?")
        assert calling.receive(0.02) == b""


def test_waiting_ends(opened):
    listening = opened(f"udpin:127.0.0.1:{free_port()}")
    took = []
    for _ in range(5):  # a busy machine may stop us in one of them
        start = time.monotonic()
        assert listening.receive(0.1) == b""
        took.append(time.monotonic() - start)
    assert 0.09 < min(took) < 2
    assert listening.receive(0.0) == b""


def test_tcp_both_ways(opened):
    port = free_port()
    server = opened(f"tcpin:127.0.0.1:{port}")
    assert server.receive(0.0) == b""
    server.send(b"nobody is there yet")
    client = opened(f"tcp:127.0.0.1:{port}")
    client.send(b"here I am")
    assert heard(server, 9) == b"here I am"
    server.send(b"welcome")
    assert heard(client, 7) == b"welcome"
    server.close()
    with pytest.raises(LinkError, match="closed by the other side"):
        client.receive(1.0)


def test_tcp_with_nobody_there():
    with pytest.raises(LinkError, match="nobody takes the connection"):
        open_transport(f"tcp:127.0.0.1:{free_port()}")


@pytest.mark.parametrize(("one", "other"), [("udpin://", "udpout://"), ("UDPIN:", "UdpOut:"), ("TCPIN://", "tcp://")])
def test_other_ways_to_write_an_address(opened, one, other):
    port = free_port()
    server = opened(f"{one}127.0.0.1:{port}")
    client = opened(f"{other}127.0.0.1:{port}")
    client.send(b"here I am")
    assert heard(server, 9) == b"here I am"


@pytest.mark.skipif(not hasattr(socket, "MSG_NOSIGNAL"), reason="signals")
def test_a_closed_connection_is_an_error_even_where_sigpipe_ends_programs():
    """The command line lets SIGPIPE end it, for `| head`."""
    code = """
import signal, socket
from gcs_windplan.errors import LinkError
from gcs_windplan.link.transport import open_transport
signal.signal(signal.SIGPIPE, signal.SIG_DFL)
server = socket.create_server(("127.0.0.1", 0))
line = open_transport(f"tcp:127.0.0.1:{server.getsockname()[1]}")
server.accept()[0].close()
try:
    for _ in range(100):
        line.send(b"x" * 1000)
except LinkError as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=30, check=False)
    assert done.returncode == 0
    assert done.stdout.startswith("the connection is lost")


@pytest.mark.parametrize("kind", ["udpin", "tcpin"])
def test_port_in_use(opened, kind):
    port = free_port()
    opened(f"{kind}:127.0.0.1:{port}")
    with pytest.raises(AddressError, match="is in use"):
        open_transport(f"{kind}:127.0.0.1:{port}")


@pytest.mark.parametrize(
    ("address", "words"),
    [
        ("udp:127.0.0.1:14550", "unknown address format"),
        ("udp://:14550", "unknown address format"),
        ("UDP:127.0.0.1:14550", "unknown address format"),
        ("udpin", "unknown address format 'udpin': write udpin:HOST:PORT, udpout"),
        ("TCP", "unknown address format"),
        ("tcp:localhost:١٢٣", "from 1 to 65535"),
        ("tcp:localhost:²", "from 1 to 65535"),
        ("udpin://", "for example udpin:0.0.0.0:14550"),
        ("/dev/null", r"'/dev/null' cannot be opened \(it is no serial line\): write udpin"),
        ("/dev/null:0", "the baud rate '0': give a number such as 57600"),
        ("/dev/null:-9600", "the baud rate"),
        ("/dev/null:99999999999999", "the baud rate"),
        ("/dev/no-such-line:0", "the baud rate"),
        ("serial:///dev/ttyACM0", "unknown address format"),
        ("udpin:", "for example udpin:0.0.0.0:14550"),
        ("udpout:14550", "for example udpout:127.0.0.1:14550"),
        ("tcp:localhost:0", "from 1 to 65535"),
        ("tcp:localhost:-1", "from 1 to 65535"),
        ("udpout:no.such.host.invalid:14550", "is not known"),
        ("udpin:203.0.113.7:14550", "one that this computer has"),
        ("/dev/no-such-line", "there is no such device"),
    ],
)
def test_wrong_addresses(address, words):
    with pytest.raises(AddressError, match=words):
        open_transport(address)


@pytest.mark.skipif(sys.platform == "win32", reason="pseudo-terminals")
@pytest.mark.parametrize("rate", ["", ":115200"])
def test_serial_both_ways(opened, rate):
    outside, inside = os.openpty()
    try:
        line = opened(os.ttyname(inside) + rate)
        os.write(outside, b"from the vehicle")
        assert heard(line, 16) == b"from the vehicle"
        line.send(b"to the vehicle")
        assert os.read(outside, 100) == b"to the vehicle"
        assert line.receive(0.01) == b""
    finally:
        os.close(inside)
        os.close(outside)


@pytest.mark.skipif(sys.platform == "win32", reason="pseudo-terminals")
def test_a_serial_line_that_is_pulled_out(opened):
    outside, inside = os.openpty()
    line = opened(os.ttyname(inside))
    os.close(inside)
    threading.Timer(0.1, os.close, (outside,)).start()
    with pytest.raises(LinkError, match="the connection is lost"):
        heard(line, 1)


def test_a_file_is_no_serial_line(tmp_path):
    path = tmp_path / "file"
    path.write_text("")
    with pytest.raises(AddressError, match="cannot be opened"):
        open_transport(str(path))
