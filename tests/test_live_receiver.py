"""The live receiver: over a real gpsd that reads a pty, and over servers that talk nonsense."""

import json
import math
import os
import socket
import socketserver
import subprocess
import threading
import time
from functools import reduce
from operator import xor

import pytest
from live_receiver import LiveReceiver

VERSION = b'{"class":"VERSION","release":"3.22"}\n'


def until(true, seconds=20.0):
    end = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < end, "it took too long"
        time.sleep(0.02)


def free_port():
    with socket.socket() as sock:
        sock.bind(("127.0.0.1", 0))
        return sock.getsockname()[1]


def nmea(body):
    return f"${body}*{reduce(xor, body.encode()):02X}\r\n".encode()


SKY = nmea("GPGSA,A,3,08,09,10,15,,,,,,,,,1.7,1.1,1.3") + nmea(
    "GPGSV,1,1,04,08,30,075,25,09,20,262,32,10,16,194,27,15,74,263,46"
)


def epoch(k, lat="5405.6081", quality=1):
    clock = f"1047{k // 10 % 60:02d}.{k % 10}0"
    return nmea(f"GPRMC,{clock},A,{lat},N,01049.4791,E,1.94,90.00,010326,,,A") + nmea(
        f"GPGGA,{clock},{lat},N,01049.4791,E,{quality},08,1.1,40.8,M,43.6,M,,0000"
    )


class Feeder:
    """A pty that speaks NMEA ten times a second while it is on, and a gpsd that reads it."""

    def __init__(self, gpsd):
        self.program = gpsd
        self.main, self.side = os.openpty()
        os.chmod(os.ttyname(self.side), 0o666)
        self.port, self.on, self.over = free_port(), True, False
        self.how = {}
        self.thread = threading.Thread(target=self.feed, daemon=True)
        self.thread.start()
        self.begin()

    def feed(self):
        k = 0
        while not self.over:
            if self.on:
                os.write(self.main, epoch(k, **self.how) + SKY * (k % 10 == 0))
            k += 1
            time.sleep(0.1)

    def begin(self):
        line = [self.program, "-N", "-n", "-b", "-S", str(self.port), os.ttyname(self.side)]
        self.gpsd = subprocess.Popen(line, stderr=subprocess.DEVNULL)

    def end(self):
        self.gpsd.kill()
        self.gpsd.wait()

    def close(self):
        self.over = True
        self.thread.join()
        self.end()
        os.close(self.main)
        os.close(self.side)


@pytest.fixture
def feeder(find_tool):
    feeder = Feeder(find_tool("gpsd"))
    yield feeder
    feeder.close()


@pytest.mark.needs("gpsd")
def test_a_fix_comes_through_gpsd_and_grows_old_when_the_receiver_or_gpsd_falls_silent(feeder):
    with LiveReceiver(port=feeder.port, patience=1.0) as receiver:
        until(lambda: receiver.latest() and not math.isnan(receiver.latest().said.satellites))
        fix = receiver.latest()
        assert fix.place.lat == pytest.approx(54 + 5.6081 / 60, abs=1e-8)
        assert fix.place.lon == pytest.approx(10 + 49.4791 / 60, abs=1e-8)
        assert (fix.said.quality, fix.said.satellites, fix.said.hdop) == (1.0, 4.0, 1.1)
        assert fix.said.speed == pytest.approx(1.94 * 1852 / 3600, abs=0.01)
        assert fix.said.course == pytest.approx(math.pi / 2)
        assert fix.age < 1.0
        until(lambda: receiver.latest().utc != fix.utc)
        feeder.how = {"quality": 4, "lat": "5405.6082"}
        until(lambda: receiver.latest().said.quality == 4.0)
        feeder.on = False  # silent
        until(lambda: receiver.latest().age > 1.5)
        feeder.on = True
        until(lambda: receiver.latest().age < 0.5)
        feeder.end()
        until(lambda: receiver.latest().age > 1.5)
        assert receiver.trouble
        feeder.begin()
        until(lambda: receiver.latest().age < 0.5)
        begin = time.perf_counter()
        for _ in range(1000):
            receiver.latest()
        assert time.perf_counter() - begin < 0.1


def tpv(time_s=1, **fields):
    report = {"class": "TPV", "mode": 3, "lat": 54.0, "lon": 10.0}
    report["time"] = f"2026-03-01T12:00:{time_s:02d}.0Z"
    return json.dumps(report | fields).encode() + b"\n"


@pytest.fixture
def serve():
    """A server that gives each connection the next of these answers, and the last one for ever."""
    over, servers = threading.Event(), []

    def begin(*answers):
        left = list(answers)

        class Handler(socketserver.BaseRequestHandler):
            def handle(self):
                last = len(left) == 1
                self.request.sendall(left[0] if last else left.pop(0))
                if last:
                    over.wait()

        servers.append(socketserver.ThreadingTCPServer(("127.0.0.1", 0), Handler))
        threading.Thread(target=servers[-1].serve_forever).start()
        return servers[-1].server_address[1]

    yield begin
    over.set()
    for server in servers:
        server.shutdown()
        server.server_close()


def test_nonsense_and_lost_connections_are_survived(serve):
    nonsense = [
        b"HTTP/1.1 200 OK\r\n\r\n", VERSION + b"{\n", VERSION + b"\xff\xfe\n", VERSION + b"[1]\n",
        VERSION + b'{"class":"TPV","mode":3,"lat":1', b"",
    ]  # fmt: skip
    port = serve(*nonsense, VERSION + tpv(lat=55.0))
    with LiveReceiver(port=port, patience=0.5) as receiver:
        until(lambda: receiver.latest() is not None)
        assert receiver.latest().place.lat == 55.0


UNUSABLE = [
    {"mode": 1}, {"mode": 0}, {"lat": 91.0}, {"lon": 181.0}, {"lat": None}, {"lat": "54"},
    {"lat": math.nan}, {"status": 5}, {"status": 8}, {"time": ""}, {"lon": True},
]  # fmt: skip


def test_a_report_without_a_measured_fix_or_with_an_old_one_is_not_one(serve):
    bad = b"".join(tpv(k + 2, **fields) for k, fields in enumerate(UNUSABLE))
    again = tpv(1, lat=10.0)  # the same time: a frozen receiver
    port = serve(VERSION + tpv(1) + bad + again + b'{"class":"SKY","uSat":9}\n' + tpv(1))
    with LiveReceiver(port=port) as receiver:
        until(lambda: receiver._sky.satellites == 9.0)
        assert receiver.latest().place.lat == 54.0
        assert receiver.latest().utc == "2026-03-01T12:00:01.0Z"


def test_without_gpsd_nothing_is_known_and_nothing_waits():
    begin = time.perf_counter()
    with LiveReceiver(port=free_port()) as receiver:
        assert receiver.latest() is None
        assert time.perf_counter() - begin < 0.5
        until(lambda: "refused" in receiver.trouble)
