"""A class on a real JupyterHub, with its simple local spawner: hand out, collect, return."""

import asyncio
import json
import os
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import cage
import nbformat
import pytest
from damage import command, empty_course
from graded import BEGIN, ROOT, cells
from jupyter_client.session import Session
from tornado.httpclient import HTTPRequest
from tornado.websocket import websocket_connect

pytestmark = pytest.mark.slow

CHAPTER = "ch01"
CONFIG = """
exec(compile(open(source := {config!r}).read(), source, "exec"), globals() | {{"__file__": source}})
c.JupyterHub.spawner_class = "simple"
c.SimpleLocalProcessSpawner.home_dir_template = {homes!r} + "/{{username}}"
c.JupyterHub.authenticator_class = "dummy"
c.Authenticator.allowed_users = {{"ada", "bob"}}
c.JupyterHub.bind_url = "http://127.0.0.1:{port}"
c.JupyterHub.hub_port = {hub}
c.ConfigurableHTTPProxy.api_url = "http://127.0.0.1:{proxy}"
c.JupyterHub.db_url = "sqlite://"
c.JupyterHub.services = [{{"name": "class", "api_token": "{token}"}}]
c.JupyterHub.load_roles = [{{"name": "class", "services": ["class"],
                            "scopes": ["admin:users", "admin:servers", "tokens"]}}]
c.Spawner.environment = {{"PYTHONPATH": {path!r}}}
"""
TOKEN = "of-the-class"


def ports(count: int) -> list[int]:
    """Ports that nobody uses."""
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    numbers = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return numbers


def ask(url: str, token: str, method: str = "GET", body: object = None):
    """Return (status, what is answered)."""
    data = None if body is None else json.dumps(body).encode()
    headers = {"Authorization": f"token {token}", "Content-Type": "application/json"}
    request = urllib.request.Request(url, data, headers, method=method)
    try:
        with urllib.request.urlopen(request, timeout=30) as reply:
            text = reply.read()
            return reply.status, json.loads(text) if text else None
    except urllib.error.HTTPError as error:
        return error.code, None
    except OSError:
        return 0, None


def until(holds, seconds: float = 60.0):
    """Wait until something holds, and return it."""
    end = time.monotonic() + seconds
    while not (found := holds()):
        assert time.monotonic() < end
        time.sleep(0.2)
    return found


async def run(server: str, token: str, code: str) -> str:
    """Run code as a student does, and return what it prints."""
    _, kernel = ask(f"{server}api/kernels", token, "POST", {})
    url = f"{server}api/kernels/{kernel['id']}/channels".replace("http", "ws", 1)
    link = await websocket_connect(HTTPRequest(url, headers={"Authorization": f"token {token}"}))
    message = Session(username="").msg("execute_request", {"code": code, "silent": False})
    await link.write_message(json.dumps({**message, "channel": "shell"}, default=str))
    text, state = "", ""
    while state != "idle":
        answer = json.loads(await asyncio.wait_for(link.read_message(), 60))
        if answer["parent_header"].get("msg_id") == message["msg_id"]:
            state = answer["content"].get("execution_state")
            text += answer["content"].get("text", "") + answer["content"].get("evalue", "")
    link.close()
    return text


@pytest.fixture
def hub(tmp_path):
    """A hub with a course and the address and tokens of two students whose servers run."""
    pytest.importorskip("jupyterhub", reason="this test needs the Python package jupyterhub")
    pytest.importorskip("configurable_http_proxy", reason="this test needs configurable-http-proxy")
    course, homes = empty_course(tmp_path, CHAPTER), tmp_path / "homes"
    homes.mkdir()
    command("package.py", course)
    tools = {"PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"}
    path = os.pathsep.join([str(ROOT), str(ROOT / "book")])
    environment = os.environ | tools | {"PYTHONPATH": path}
    port, inner, proxy = ports(3)
    config = tmp_path / "config.py"
    places = {"config": str(course / "jupyterhub_config.py"), "homes": str(homes), "path": path}
    config.write_text(CONFIG.format(port=port, hub=inner, proxy=proxy, token=TOKEN, **places))
    words = [sys.executable, "-m", "jupyterhub", f"--config={config}"]
    with (tmp_path / "log").open("w") as log:
        process = subprocess.Popen(words, cwd=tmp_path, env=environment, stdout=log, stderr=log)
    try:
        url = f"http://127.0.0.1:{port}/hub/api/"
        until(lambda: process.poll() is None and ask(f"{url}users", TOKEN)[0] == 200)
        names = "ada", "bob"
        with ThreadPoolExecutor() as pool:  # side by side: to start takes seconds
            [*pool.map(lambda name: ask(f"{url}users/{name}/server", TOKEN, "POST"), names)]
        servers = {name: f"http://127.0.0.1:{port}/user/{name}/" for name in names}
        tokens = {}
        for name in names:
            tokens[name] = ask(f"{url}users/{name}/tokens", TOKEN, "POST", {})[1]["token"]
            contents = f"{servers[name]}api/contents", tokens[name]
            until(lambda contents=contents: ask(*contents)[0] == 200)
        yield course, homes, servers, tokens
    finally:
        process.terminate()
        process.wait(60)


def test_a_class_works_side_by_side_and_sees_neither_answers_nor_each_other(hub):
    course, homes, servers, tokens = hub
    place = next((course / "release" / CHAPTER).glob("*.ipynb")).name
    place = f"api/contents/assignments/{CHAPTER}/{place}"
    answers = {}
    for name, share in ("ada", 2), ("bob", 1):
        _, file = ask(servers[name] + place, tokens[name])
        notebook = nbformat.from_dict(file["content"])
        model = [k for k, (source, _) in cells(CHAPTER).items() if BEGIN in source][:share]
        for cell in notebook.cells:
            if cell.metadata.nbgrader.grade_id in model:
                cell.source = cells(CHAPTER)[cell.metadata.nbgrader.grade_id][0]
        answers[name] = {cells(CHAPTER)[each][0] for each in model}
        saved = {"type": "notebook", "format": "json", "content": notebook}
        assert ask(servers[name] + place, tokens[name], "PUT", saved)[0] == 200
    assert ask(servers["ada"] + place, tokens["bob"])[0] in (403, 404)
    assert ask(f"{servers['ada']}api/contents/../bob/robot", tokens["ada"])[0] in (403, 404)
    if cage.holds():
        code = f"import os; print(os.listdir({str(homes)!r}), os.path.exists({str(course)!r}))"
        spoken = run(servers["ada"], tokens["ada"], code)
        with ThreadPoolExecutor(1) as aside:  # the browser's tests leave a loop in this thread
            assert aside.submit(asyncio.run, spoken).result() == "['ada'] False\n"
    assert command("exchange.py", course, "collect", homes) == "2 files\n"
    for name, model in answers.items():
        (path,) = (course / "submitted" / name / CHAPTER).glob("*.ipynb")
        written = {cell.source for cell in nbformat.read(path, as_version=4).cells}
        assert model <= written
        (pages := course / "feedback" / name / CHAPTER).mkdir(parents=True)
        (pages / "page.html").write_text(name)
    assert command("exchange.py", course, "return", homes) == "2 files\n"
    url = f"{servers['bob']}api/contents/feedback/{CHAPTER}/page.html"
    assert ask(url, tokens["bob"])[1]["content"] == "bob"
