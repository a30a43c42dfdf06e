"""What the tests of live pages share: pictures as values, sliders moved by keyboard, servers."""

from __future__ import annotations

import contextlib
import os
import re
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from pathlib import Path

from wmrbook.figures.style import in_symbols

ROOT = Path(__file__).resolve().parents[2]
PATIENCE = 120_000  # ms for what takes seconds on a quiet machine
# All that is drawn: canvases, and images for a panel that is made of those.
PICTURE = """() => [
    ...[...document.querySelectorAll('canvas')].filter(it => it.width && it.height)
        .map(it => it.toDataURL()),
    ...[...document.querySelectorAll('img')].map(it => it.src),
].join()"""


def as_shown(text: str) -> str:
    """A text of a prediction as the page has it, with symbols for their names."""

    def bare(formula: re.Match) -> str:
        return re.sub(r"[_{}]", "", in_symbols(formula[1].replace("\\", "")))

    return re.sub(r"\$(\w_[^$]*)\$", bare, in_symbols(text))


def run(folder: Path, *arguments: str) -> None:
    """Run Python in a folder; where it fails, the test does."""
    paths = os.pathsep.join([str(ROOT), str(ROOT / "book"), str(ROOT / "book" / "robot")])
    options = {"cwd": folder, "env": os.environ | {"PYTHONPATH": paths}, "text": True}
    options |= {"encoding": "utf-8"}
    done = subprocess.run([sys.executable, *arguments], capture_output=True, **options)
    assert done.returncode == 0, done.stdout + done.stderr


def letters(text: str) -> str:
    """Without spaces, which a PDF does not have everywhere, and marks."""
    return re.sub(r"[\W_]+", "", text)


def chapters() -> list[Path]:
    """The book's notebooks, in order."""
    return sorted((ROOT / "notebooks").glob("[0-9][0-9]_*.ipynb"))


def pages(site: Path) -> list[Path]:
    """The pages of the site, without the theme's own files."""
    return sorted(path for path in site.rglob("*.html") if "_static" not in path.parts)


def confine(page, folder: Path) -> None:
    """Let a request of the page that leaves the folder be a trouble."""
    ours = (f"{folder.as_uri()}/", "data:", "blob:", "about:")

    def asked(request):
        if not request.url.startswith(ours):
            page.troubles.append(f"left {folder.name}: {request.url}")

    page.on("request", asked)


def open_deck(page, url: str) -> None:
    """Open a deck, and wait until it is drawn."""
    page.goto(url, wait_until="load", timeout=PATIENCE)
    page.wait_for_function("document.documentElement.dataset.deck === 'ready'", timeout=PATIENCE)


def sliders(page) -> list:
    """The panels' sliders to be seen, once there is one."""
    page.locator(".wmr-slider:visible").first.wait_for(timeout=PATIENCE)
    return page.locator(".wmr-slider:visible").all()


def settled_picture(page) -> str:
    """The picture, once two frames in a row show the same."""
    page.wait_for_function(
        f"""() => new Promise(done => {{
            const before = ({PICTURE})();
            const settled = () => done(before !== '' && before === ({PICTURE})());
            requestAnimationFrame(() => requestAnimationFrame(settled));
        }})""",
        timeout=PATIENCE,
        polling=100,
    )
    return page.evaluate(PICTURE)


def assert_slider_matters(page, slider) -> None:
    """One step of the slider by keyboard changes the value it announces and the picture."""
    from playwright.sync_api import TimeoutError as TooLate

    slider.scroll_into_view_if_needed(timeout=PATIENCE)
    before, value = settled_picture(page), slider.get_attribute("aria-valuetext")
    changed = f"before => ({PICTURE})() !== before"
    for _ in range(10):  # a page that is still being put together takes the focus away
        at_the_end = slider.evaluate("it => it.value === it.max")
        slider.press("ArrowLeft" if at_the_end else "ArrowRight")
        with contextlib.suppress(TooLate):
            page.wait_for_function(changed, arg=before, timeout=5000, polling=100)
            if slider.get_attribute("aria-valuetext") != value:  # and not a film on its way
                break
    assert slider.get_attribute("aria-valuetext") != value


def free_port() -> int:
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


@contextlib.contextmanager
def serve(command: list, url: str, log: Path, **environment: str):
    """Runs a server until the block ends, and enters the block with it once `url` answers."""
    paths = os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH")]))
    with log.open("w") as output:
        server = subprocess.Popen(
            command,
            stdout=output,
            stderr=subprocess.STDOUT,
            stdin=subprocess.DEVNULL,
            cwd=ROOT,
            env=os.environ | environment | {"PYTHONPATH": paths},
        )
        try:
            _wait_until_up(server, url, log)
            yield server
        finally:
            server.terminate()
            try:
                server.wait(20)
            except subprocess.TimeoutExpired:
                server.kill()
                server.wait()


@contextlib.contextmanager
def jupyterlab(home: Path, *options: str):
    """Runs JupyterLab on a folder; the reader's settings stay as they are. Enters with its URL."""
    port = free_port()
    command = [sys.executable, "-m", "jupyterlab", "--no-browser", "--allow-root"]
    command += [f"--ServerApp.root_dir={home}", f"--ServerApp.port={port}"]
    command += ["--ServerApp.port_retries=0", "--LabApp.expose_app_in_browser=True", *options]
    folders = {
        "JUPYTERLAB_SETTINGS_DIR": str(home / "settings"),
        "JUPYTERLAB_WORKSPACES_DIR": str(home / "workspaces"),
        "JUPYTER_CONFIG_DIR": str(home / "config"),
        "JUPYTER_DATA_DIR": str(home / "data"),  # where the trust in a notebook is kept
        "JUPYTER_CONFIG_PATH": "",  # a reader's kernels do not talk through files
    }
    settings = home / "settings/@jupyterlab/notebook-extension/tracker.jupyterlab-settings"
    settings.parent.mkdir(parents=True)
    settings.write_text('{"windowingMode": "none"}')  # a cell out of sight would not be drawn
    url = f"http://127.0.0.1:{port}/"
    with serve(command, f"{url}api", home / "log.txt", **folders):
        yield url


def link(home: Path) -> str:
    """The link that the terminal of a JupyterLab shows."""
    return re.search(r"http://127\S+", (home / "log.txt").read_text()).group()


def _wait_until_up(server: subprocess.Popen, url: str, log: Path) -> None:
    end = time.monotonic() + PATIENCE / 1000
    while True:
        try:
            with urllib.request.urlopen(url, timeout=5):
                return
        except (urllib.error.URLError, OSError):
            if server.poll() is not None or time.monotonic() > end:
                raise AssertionError(f"no server at {url}:\n{log.read_text()}") from None
            time.sleep(0.1)
