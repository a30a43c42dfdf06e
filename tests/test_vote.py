"""The server of a vote: one vote a device, for the lecturer alone to steer, whoever attacks it."""

import asyncio
import re
import socket
import threading
import time
from functools import partial

import pytest
import requests
import slides
import vote
from tornado.httpserver import HTTPServer
from tornado.netutil import bind_sockets
from vote_deck import Question, question_of

HOST, TOKEN = "127.0.0.1", "of the lecturer"
QUESTIONS = {3: Question("Which?", ("this", "that", "none")), 7: Question("When?", ("now", "then"))}
SHORT = {"idle_connection_timeout": 0.5, "body_timeout": 0.5}  # s


@pytest.fixture
def site(tmp_path):
    """The address of a running server."""
    (tmp_path / "secret.txt").write_text("secret")
    folder = tmp_path / "deck"
    folder.mkdir()
    (folder / "04.slides.html").write_text("the slides")
    (sock,) = bind_sockets(0, HOST)
    address, started = f"http://{HOST}:{sock.getsockname()[1]}", threading.Event()
    loop = asyncio.new_event_loop()

    async def run():
        app = vote.application(vote.Poll(QUESTIONS), folder, "04.slides.html", HOST, TOKEN)
        server = HTTPServer(app, **(vote.LIMITS | SHORT))
        server.add_sockets([sock])
        started.set()
        await stopped.wait()
        server.stop()
        await server.close_all_connections()

    stopped = asyncio.Event()
    thread = threading.Thread(target=loop.run_until_complete, args=(run(),))
    thread.start()
    assert started.wait(10)
    yield address
    loop.call_soon_threadsafe(stopped.set)
    thread.join(10)
    loop.close()


def someone(site):
    """A session that asks from the vote's own page."""
    session = requests.Session()
    session.headers["Origin"] = site
    return session


def device(site):
    session = someone(site)
    assert session.get(site).status_code == 200
    return session


def lecturer(site):
    session = someone(site)
    assert session.get(f"{site}/lecturer", params={"token": TOKEN}).text == "the slides"
    return session


def votes(session, site, option, slide=3):
    return session.post(f"{site}/now", json={"slide": slide, "option": option}).status_code


def test_each_device_counts_once_and_may_change_its_mind_until_the_vote_is_closed(site):
    ours, ada, bob = lecturer(site), device(site), device(site)

    def act(what, slide=3):
        told = ours.post(f"{site}/{what}/{slide}").json()
        return told["counts"], told["open"]

    assert ada.get(f"{site}/now").json() == {"slide": None, "known": True}
    assert votes(ada, site, 0) == 409  # nothing is asked
    assert act("ask") == ([0, 0, 0], True)
    assert [votes(ada, site, it) for it in (0, 1, 1, 1)] == [200] * 4
    assert votes(bob, site, 2) == 200
    assert act("counts") == ([0, 1, 1], True)
    now = ada.get(f"{site}/now").json()
    assert now == QUESTIONS[3]._asdict() | {
        "options": ["this", "that", "none"], "slide": 3, "mine": 1, "open": True, "known": True
    }  # fmt: skip
    assert [act(it) for it in ("close", "counts", "ask")] == [([0, 1, 1], False)] * 3
    assert votes(ada, site, 0) == 409
    assert act("open") == ([0, 1, 1], True)
    assert votes(ada, site, 0) == 200
    assert act("ask", 7) == ([0, 0], True)
    assert votes(ada, site, 0) == 409  # of the slide before
    assert votes(ada, site, 1, slide=7) == 200
    assert act("ask") == ([1, 0, 1], True)
    assert act("reset") == ([0, 0, 0], True)
    assert act("leave")[1] is False
    assert act("counts", 7)[0] == [0, 1]


@pytest.mark.parametrize("option", [-1, 3, 1e9, True, "0", None, [0], {"a": 1}, 10**30])
def test_an_option_that_there_is_not_is_refused(site, option):
    ours, ada = lecturer(site), device(site)
    ours.post(f"{site}/ask/3")
    assert votes(ada, site, option) == 409
    assert ours.post(f"{site}/counts/3").json()["counts"] == [0, 0, 0]


@pytest.mark.parametrize("body", ["", "[]", "3", "{", '{"slide": NaN}', "\x00", b"\xff"])
def test_a_body_that_is_no_vote_is_refused(site, body):
    lecturer(site).post(f"{site}/ask/3")
    assert device(site).post(f"{site}/now", data=body).status_code in (400, 409)


@pytest.mark.parametrize(
    "rest", ["Content-Length: 1000000\r\n\r\n{", "Content-Length: -1\r\n\r\n",
             "Transfer-Encoding: chunked\r\n\r\nfffff\r\n{", f"X: {9000 * 'x'}\r\n\r\n"]
)  # fmt: skip
def test_an_oversized_body_and_head_are_refused(site, rest):
    ada = device(site)
    head = f"POST /now HTTP/1.1\r\nHost: {HOST}\r\nOrigin: {site}\r\n"
    assert re.match(rb"HTTP/1.1 4\d\d |\Z", raw(site, head + rest))
    assert ada.get(site).status_code == 200


def test_only_who_has_the_token_steers_and_sees_the_slides(site):
    ada = device(site)
    for what in ("ask", "leave", "close", "open", "reset", "counts"):
        assert ada.post(f"{site}/{what}/3").status_code == 403
    assert ada.get(f"{site}/deck/04.slides.html").status_code == 403
    assert ada.get(f"{site}/lecturer?token=of+the+lecture").status_code == 403
    ada.cookies.set("lecturer", TOKEN)  # not signed
    assert ada.post(f"{site}/ask/3").status_code == 403
    ours = lecturer(site)
    assert ours.post(f"{site}/ask/4").status_code == 404  # no question
    for other in ("http://evil.example", "null", None):
        ours.headers["Origin"] = other
        assert ours.post(f"{site}/ask/3").status_code == 403
    for name in ("evil.example", "localhost", f"{HOST}.evil.example"):
        assert ours.get(site, headers={"Host": name}).status_code == 404  # a name that was rebound


def test_a_device_is_not_made_up(site):
    lecturer(site).post(f"{site}/ask/3")
    nobody = someone(site)
    assert votes(nobody, site, 0) == 403
    nobody.cookies.set("device", "0123456789abcdef")
    assert votes(nobody, site, 0) == 403
    codes = {requests.get(site).status_code for _ in range(int(vote.BURST) + 30)}
    assert codes == {200, 429}


@pytest.mark.parametrize(
    "path",
    ["../secret.txt", "..%2fsecret.txt", "%2e%2e/secret.txt", "/etc/passwd", "%2fetc%2fpasswd",
     "..\\secret.txt", "....//secret.txt", "x/../../secret.txt", "04.slides.html%00"],
)  # fmt: skip
def test_nothing_but_the_deck_is_served(site, path):
    cookie = f"lecturer={lecturer(site).cookies['lecturer']}"
    reply = raw(site, f"GET /deck/{path} HTTP/1.0\r\nHost: {HOST}\r\nCookie: {cookie}\r\n\r\n")
    assert re.match(rb"HTTP/1.1 40[034] ", reply), reply
    assert b"secret" not in reply.partition(b"\r\n\r\n")[2]
    assert b"root:" not in reply


def raw(site, text):
    host, port = site.removeprefix("http://").split(":")
    with socket.create_connection((host, int(port)), timeout=10) as connection:
        connection.sendall(text.encode())
        return b"".join(iter(partial(connection.recv, 4096), b""))


def test_slow_clients_block_nobody_and_are_cut_off(site):
    host, port = site.removeprefix("http://").split(":")
    begun = f"POST /now HTTP/1.1\r\nHost: {HOST}\r\nContent-Length: 50\r\n"
    heads = [begun, f"{begun}Origin: {site}\r\n\r\n{{", ""]
    slow = [socket.create_connection((host, int(port)), timeout=10) for _ in range(150)]
    for k, connection in enumerate(slow):
        connection.sendall(heads[k % 3].encode())
    start = time.monotonic()
    assert device(site).get(f"{site}/now", timeout=5).status_code == 200
    assert time.monotonic() - start < 3
    for connection in slow:
        assert b"200 OK" not in b"".join(iter(partial(connection.recv, 4096), b""))
        connection.close()


def test_an_address_may_do_so_much_at_once_and_again_later(monkeypatch):
    now = [100.0]
    monkeypatch.setattr(vote.time, "monotonic", lambda: now[0])
    allowance = vote.Allowance()
    assert [allowance.take("a") for _ in range(int(vote.BURST) + 1)].count(True) == vote.BURST
    assert allowance.take("b")
    now[0] += 1.0
    assert [allowance.take("a") for _ in range(20)].count(True) == vote.RATE
    for k in range(2 * vote.DEVICES):
        allowance.take(str(k))
    assert len(allowance.left) == vote.DEVICES


def test_no_more_devices_than_a_question_counts():
    poll = vote.Poll(QUESTIONS)
    poll.act("ask", 3)
    for k in range(vote.DEVICES):
        poll.vote(str(k), 3, 0)
    poll.vote("0", 3, 1)
    with pytest.raises(ValueError, match=f"device is not allowed: {vote.DEVICES} have voted"):
        poll.vote("one more", 3, 0)
    assert poll.counts(3) == [vote.DEVICES - 1, 1, 0]


def test_slides_that_give_options_are_voted_on():
    _, deck = slides.deck("06")
    asked = [found for slide in deck if (found := question_of(slide))]
    assert len(asked) >= 2
    assert "<i>k<sub>&alpha;</sub></i>" in asked[0].options[1]
    assert all("$" not in text for one in asked for text in (one.ask, *one.options))
    listed = slides.Slide("1. Which?", "This?\n\n<ol type='A'>\n<li>a $k_h$</li>\n</ol>")
    assert question_of(listed) == ("This?", ("a <i>k<sub>h</sub></i>",))
