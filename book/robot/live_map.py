"""A page with the live position on a local map: where the receiver is, of what quality, how old.

    python book/robot/live_map.py --goal LAT LON HEADING [--fence METRES] [--port 2947]

It opens http://127.0.0.1:PORT/ , for this machine alone, with the goal in the middle. HEADING is in
degrees from east, counter-clockwise.
"""

from __future__ import annotations

import argparse
import json
import math
import webbrowser
from collections import deque
from contextlib import suppress
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

from live_receiver import LiveReceiver

import wmrlib as wmr
from wmrlib.checks import scalar

PAGE = Path(__file__).with_suffix(".html")


class LiveMap:
    """What the page shows; `address` is where it is served until `close`.

    Parameters
    ----------
    receiver : LiveReceiver
    goal : GeoPoint of numbers
    heading : float, rad from east
    fence : float, m round the goal
    """

    def __init__(self, receiver: Any, goal: wmr.GeoPoint, heading: float, fence: float) -> None:
        self._receiver, self._goal = receiver, goal
        self._still = {
            "heading": scalar("heading", heading),
            "fence": scalar("fence", fence, above=0.0),
            "goal": [float(goal.lat), float(goal.lon)],
        }
        self._trail: deque[tuple[float, float]] = deque(maxlen=600)
        show = self.shown

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                own = f"127.0.0.1:{self.server.server_address[1]}"
                if self.headers.get("Host") != own:  # another site's name that leads here
                    return self.send_error(403)
                if self.path == "/fix":
                    return self._send(json.dumps(show()).encode(), "application/json")
                if self.path == "/":
                    return self._send(PAGE.read_bytes(), "text/html; charset=utf-8")
                return self.send_error(404)

            def _send(self, body: bytes, kind: str) -> None:
                self.send_response(200)
                self.send_header("Content-Type", kind)
                self.send_header("Content-Length", str(len(body)))
                self.send_header("Cache-Control", "no-store")
                self.end_headers()
                self.wfile.write(body)

            def log_message(self, *_: Any) -> None:
                pass

        self._server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self._server.daemon_threads = True
        self.address = f"http://127.0.0.1:{self._server.server_address[1]}/"

    def shown(self) -> dict[str, Any]:
        """The place in m from the goal, the trail, and what is said of the fix, as JSON can say."""
        fix = self._receiver.latest()
        if fix is None:
            return self._still | {"place": None, "trail": [], "says": self._receiver.trouble}
        place = tuple(map(float, wmr.local_position(self._goal, fix.place)))
        if not self._trail or math.dist(place, self._trail[-1]) > 0.01:
            self._trail.append(place)
        said = {name: value for name, value in fix.said._asdict().items() if math.isfinite(value)}
        named = {"age": fix.age, "away": math.hypot(*place), "says": self._receiver.trouble}
        return self._still | {"place": place, "trail": [*self._trail], "said": said} | named

    def serve(self) -> None:
        """Answer the page until `close` is called, in another thread."""
        self._server.serve_forever(poll_interval=0.1)

    def close(self) -> None:
        self._server.shutdown()
        self._server.server_close()


def main() -> None:
    """Serve the page until Ctrl-C."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    words = ("LAT", "LON", "HEADING")
    parser.add_argument("--goal", type=float, nargs=3, metavar=words, required=True)
    parser.add_argument("--fence", type=float, default=20.0, metavar="METRES")
    parser.add_argument("--host", default="127.0.0.1", help="of gpsd")
    parser.add_argument("--port", type=int, default=2947, help="of gpsd")
    given = parser.parse_args()
    lat, lon, heading = given.goal
    goal = wmr.GeoPoint(lat=lat, lon=lon)
    with LiveReceiver(given.host, given.port) as receiver, suppress(KeyboardInterrupt):
        shown = LiveMap(receiver, goal, math.radians(heading), given.fence)
        print(shown.address, flush=True)
        webbrowser.open(shown.address)
        shown.serve()


if __name__ == "__main__":
    main()
