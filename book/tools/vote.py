"""Let a class vote by telephone on the questions of a deck: python book/tools/vote.py 04

It serves the deck of that chapter, or of the concept questions (`questions`), to the lecturer, who
opens the link that it prints. Each question with options shows a QR code, which students in the
same network open: one vote a device, to be changed until the vote is closed. Ctrl-C ends it.
"""

from __future__ import annotations

import argparse
import asyncio
import hmac
import json
import re
import secrets
import signal
import socket
import tempfile
import time
from collections import OrderedDict
from contextlib import suppress
from ipaddress import ip_address
from pathlib import Path

from build import BOOK
from tornado.httpserver import HTTPServer
from tornado.web import Application, HTTPError, RequestHandler, StaticFileHandler
from vote_deck import Question, make

from wmrbook import face

PHONE = (BOOK / "deck" / "vote.html").read_text(encoding="utf-8").replace("/* face */", face.css())
LIMITS = {  # of one request: bytes, and seconds for its head and for its body
    "max_body_size": 1000,
    "max_header_size": 8000,
    "idle_connection_timeout": 10.0,
    "body_timeout": 5.0,
}
DEVICES = 1000  # that a question counts
BURST, RATE = 300.0, 5.0  # of one address: new devices or votes at once, and again each second


class Poll:
    """The votes on each question, by its slide: one a device."""

    def __init__(self, questions: dict[int, Question]) -> None:
        self.questions = questions
        self.asked: int | None = None  # the slide whose question the telephones show
        self.closed: set[int] = set()
        self.votes: dict[int, dict[str, int]] = {slide: {} for slide in questions}

    def open(self) -> bool:
        return self.asked is not None and self.asked not in self.closed

    def vote(self, device: str, slide: object, option: object) -> None:
        """Count a device's vote; raises ValueError if that is not allowed now."""
        if self.asked is None or slide != self.asked or not self.open():
            raise ValueError(f"slide {slide!r} is not allowed: there is no open vote on it")
        votes, most = self.votes[self.asked], len(self.questions[self.asked].options)
        if type(option) is not int or not 0 <= option < most:
            raise ValueError(f"option {option!r} is not allowed: a number from 0 to {most - 1} is")
        if device not in votes and len(votes) >= DEVICES:
            raise ValueError(f"device is not allowed: {DEVICES} have voted")
        votes[device] = option

    def counts(self, slide: int) -> list[int]:
        """How many have chosen each option."""
        votes = list(self.votes[slide].values())
        return [votes.count(option) for option in range(len(self.questions[slide].options))]

    def act(self, what: str, slide: int) -> None:
        """Ask the question of a slide or leave it, close or open its vote, or begin it anew."""
        if what in ("ask", "leave"):
            self.asked = slide if what == "ask" else None
        elif what == "close":
            self.closed.add(slide)
        elif what in ("open", "reset"):
            self.closed.discard(slide)
        if what == "reset":
            self.votes[slide].clear()


class Allowance:
    """Lets an address do so much at once, and more as time goes by."""

    def __init__(self) -> None:
        self.left: OrderedDict[str, tuple[float, float]] = OrderedDict()

    def take(self, address: str) -> bool:
        """Whether this address may."""
        now = time.monotonic()
        left, last = self.left.pop(address, (BURST, now))
        left = min(left + RATE * (now - last), BURST)
        self.left[address] = max(left - 1.0, 0.0), now
        while len(self.left) > DEVICES:
            self.left.popitem(last=False)
        return left >= 1.0


class Page(RequestHandler):
    """What all answers have in common."""

    def initialize(self, poll: Poll, token: str, allowance: Allowance) -> None:
        self.poll, self.token, self.allowance = poll, token, allowance

    def set_default_headers(self) -> None:
        for name, value in (
            ("Cache-Control", "no-store"),
            ("Referrer-Policy", "no-referrer"),
            ("Server", "vote"),
            ("X-Content-Type-Options", "nosniff"),
            ("X-Frame-Options", "SAMEORIGIN"),
        ):
            self.set_header(name, value)

    def prepare(self) -> None:
        if self.request.method == "POST":
            if self.request.headers.get("Origin") != f"http://{self.request.host}":
                raise HTTPError(403, reason="Another page asks")
            if not self.allowance.take(self.request.remote_ip or ""):
                raise HTTPError(429)

    def write_error(self, status_code: int, **_: object) -> None:
        self.finish({"error": self._reason})

    def keep(self, name: str, value: str) -> None:
        self.set_signed_cookie(name, value, 1, httponly=True, samesite="Strict")

    def lecturers(self) -> None:
        if not hmac.compare_digest(self.get_signed_cookie("lecturer") or b"", self.token.encode()):
            raise HTTPError(403, reason="For the lecturer alone")

    def body(self) -> dict:
        with suppress(ValueError):
            if isinstance(found := json.loads(self.request.body), dict):
                return found
        raise HTTPError(400, reason="An object in JSON is needed")


class Phone(Page):
    """The page of the telephones: it makes each a device of its own."""

    def get(self) -> None:
        if not self.get_signed_cookie("device"):
            if not self.allowance.take(self.request.remote_ip or ""):
                raise HTTPError(429)
            self.keep("device", secrets.token_hex(8))
        self.set_header("Content-Security-Policy", "default-src 'self' data: 'unsafe-inline'")
        self.write(PHONE)


class Now(Page):
    """What is asked now, and what this device has said."""

    def get(self) -> None:
        device, poll = (self.get_signed_cookie("device") or b"").decode(), self.poll
        if poll.asked is None:
            self.write({"slide": None, "known": bool(device)})
            return
        told = poll.questions[poll.asked]._asdict() | {"known": bool(device), "open": poll.open()}
        self.write(told | {"slide": poll.asked, "mine": poll.votes[poll.asked].get(device)})

    def post(self) -> None:
        device, body = self.get_signed_cookie("device"), self.body()
        if not device:
            raise HTTPError(403, reason="Open the page first")
        try:
            self.poll.vote(device.decode(), body.get("slide"), body.get("option"))
        except ValueError as error:
            raise HTTPError(409, reason=re.sub(r"[^ -~]", "?", str(error))) from None
        self.get()


class Lecturer(Page):
    """Lets in who has the token, which leaves the address bar at once."""

    def get(self) -> None:
        if not hmac.compare_digest(
            self.get_query_argument("token", "").encode(), self.token.encode()
        ):
            raise HTTPError(403)
        self.keep("lecturer", self.token)
        self.redirect(self.settings["deck"])


class Act(Page):
    """The lecturer's keys, and the counts."""

    def post(self, what: str, slide: str) -> None:
        self.lecturers()
        if int(slide) not in self.poll.questions:
            raise HTTPError(404)
        self.poll.act(what, int(slide))
        self.write({"counts": self.poll.counts(int(slide)), "open": self.poll.open()})


class Deck(Page, StaticFileHandler):
    """The lecturer's slides."""

    def initialize(self, path: str, **common: object) -> None:
        Page.initialize(self, **common)
        StaticFileHandler.initialize(self, path)

    def prepare(self) -> None:
        self.lecturers()


def application(poll: Poll, folder: Path, page: str, host: str, token: str) -> Application:
    """Return the server of a deck in a folder, which answers to the name `host` alone."""
    common = {"poll": poll, "token": token, "allowance": Allowance()}
    settings = {"cookie_secret": secrets.token_hex(32), "log_function": lambda handler: None}
    app = Application(deck=f"/deck/{page}", **settings)
    rows = [
        (r"/", Phone, common),
        (r"/now", Now, common),
        (r"/lecturer", Lecturer, common),
        (r"/(ask|leave|close|open|reset|counts)/(\d{1,3})", Act, common),
        (r"/deck/([\w./-]+)", Deck, common | {"path": str(folder)}),
    ]
    app.add_handlers(re.escape(host) + "$", rows)
    return app


def own_address() -> str:
    """Return this machine's address in its network; nothing is sent to find it."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe, suppress(OSError):
        probe.connect(("192.0.2.1", 9))  # an address of no one's
        return probe.getsockname()[0]
    return "127.0.0.1"


async def serve(which: str, host: str, port: int) -> None:
    """Serve until Ctrl-C."""
    token = secrets.token_urlsafe(16)
    with tempfile.TemporaryDirectory() as folder:
        address = f"http://{host}:{port}/"
        page, questions = make(Path(folder), which, address)
        app = application(Poll(questions), Path(folder), page, host, token)
        HTTPServer(app, **LIMITS).listen(port, host)
        print(f"Your slides: {address}lecturer?token={token}\nThe class: {address}", flush=True)
        await asyncio.Event().wait()


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("deck", help="a chapter, such as 04, or questions")
    parser.add_argument("--address", type=ip_address, default=own_address(), help="to listen on")
    parser.add_argument("--port", type=int, default=8040)
    given = parser.parse_args()
    if given.address.version == 6 or given.address.is_unspecified:
        wanted = "the IPv4 address of this machine"
        parser.error(f"--address = {given.address} is not allowed: {wanted}")
    if given.address.is_loopback:
        print("Only this machine can reach 127.0.0.1: telephones need --address", flush=True)
    signal.signal(signal.SIGINT, signal.default_int_handler)  # also where a shell had it ignored
    with suppress(KeyboardInterrupt):
        asyncio.run(serve(given.deck, str(given.address), given.port))
