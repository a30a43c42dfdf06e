"""JupyterLab, started as README does: the first chapter, an exercise, the panel with a kernel."""

from __future__ import annotations

import json
import re
import shutil

import nbformat
import pytest
from assignments import notebook, released
from live import PATIENCE, ROOT, assert_slider_matters, chapters, jupyterlab, link, sliders

CHAPTER = f"notebooks/{chapters()[0].name}"
ASSIGNMENT, MISTAKE = "ch01", "in kilometres"
PANEL = "notebooks/panel.ipynb"
CELLS = [
    "from wmrbook.panel import Explorer\nimport wmrlib as wmr\n"
    "explorer = Explorer(view='gains')\nexplorer",
    "print('seen', explorer.gains, len(explorer.trajectory()), explorer.law, explorer.moving)",
    "explorer.gains, explorer.law = wmr.Gains(1.5, 4.0, 2.5), 'aicardi'",
    "import ipywidgets as w\nslider = w.FloatSlider(2.5, max=5, step=0.05)\n"
    "w.jslink((slider, 'value'), (explorer, 'k_rho'))\nslider",
]
ROWS = "notebooks/rows.ipynb"
CONTAINERS = [
    """import ipywidgets as w
from wmrbook import stages
from wmrbook.panel import Explorer, Front, MyRobot

def panels():
    return [Explorer(), stages.first_drive(), MyRobot(), Front()]

def app():
    sides = dict(zip(["header", "left_sidebar", "center", "right_sidebar"], panels()))
    return w.AppLayout(**sides, pane_widths=[1, 1, 1])

columns = w.Layout(grid_template_columns="auto auto")
later = w.Tab([w.Label(), w.HBox(panels())]), w.Accordion([w.GridBox(panels(), layout=columns)])
narrow = Explorer()
narrow.layout.width = "400px"
beside = w.HBox([w.Label("The gains of"), w.Label("the paper"), Explorer()]), w.HBox([narrow])
display(w.HBox(panels()), w.VBox(panels()), app(), *beside, *later)""",
    "later[0].selected_index, later[1].selected_index = 1, 0",
]
# Width, whether all canvases are drawn, and the kind, of the panels in sight.
ROOMS = """() => [...document.querySelectorAll('.wmr')].filter(it => it.checkVisibility())
    .map(it => [it.clientWidth, [...it.querySelectorAll('canvas:not([hidden])')]
        .every(canvas => canvas.width > 200), it.className])"""
# ipywidgets' broken link over what has no kernel, which a stored panel doesn't need.
BROKEN_LINKS = """() => [...document.querySelectorAll('.jupyter-widgets-disconnected:has(.wmr)')]
    .map(it => getComputedStyle(it, '::before').content)"""
CONTEXT = "window.jupyterapp?.shell.currentWidget?.context"
KERNEL = f"{CONTEXT}?.sessionContext?.session?.kernel"
WIDGETS = "window.jupyterapp.shell.currentWidget.content.widgets"
RUN_ALL = "() => window.jupyterapp.commands.execute('notebook:run-all-cells').then(() => true)"
SAVE = "() => window.jupyterapp.commands.execute('docmanager:save').then(() => true)"
CHANGED = "() => window.jupyterapp.shell.currentWidget.context.model.dirty"


@pytest.fixture(scope="module")
def lab(tmp_path_factory):
    """JupyterLab on a copy of the chapters; the reader's files and settings stay as they are."""
    home = tmp_path_factory.mktemp("lab")
    shutil.copytree(ROOT / "notebooks", home / "notebooks", ignore=shutil.ignore_patterns(".*"))
    release_with_a_mistake(home / "notebooks")
    for name, cells in ((PANEL, CELLS), (ROWS, CONTAINERS)):
        panel = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(it) for it in cells])
        panel.metadata["kernelspec"] = {"name": "python3", "display_name": "Python 3"}
        nbformat.write(panel, home / name)
    with jupyterlab(home, "--config=book/lab/jupyter_lab_config.py"):
        yield home


def release_with_a_mistake(folder):
    """Put what students get of an assignment into the folder, with one usual mistake in it."""
    assignment = nbformat.read(notebook(ASSIGNMENT), as_version=4)
    for cell in assignment.cells:
        is_answer = cell.metadata.nbgrader.grade_id == "distance"
        wrong = cell.source.replace("return 6_371_000 * 2", "return 6_371 * 2")
        cell.source = wrong if is_answer else released(cell.source)
    nbformat.write(assignment, folder / f"{ASSIGNMENT}.ipynb")


def open_notebook(page, url: str, name: str) -> None:
    """Open a notebook in an empty workspace and wait for its kernel."""
    page.goto(url.replace("?", "?reset&"), timeout=PATIENCE)
    idle = f"name => {KERNEL}?.status === 'idle' && {CONTEXT}.path === name"
    page.wait_for_function(idle, arg=name, timeout=PATIENCE)


def solutions_in_sight(page) -> list:
    folded = "it.model.getMetadata('tags')?.includes('hide-cell')"
    folded += " && !it.model.sharedModel.source.startsWith('# Check')"  # which is no solution
    return page.evaluate(
        f"() => {WIDGETS}.filter(it => it.isVisible && {folded}).map(it => it.model.id)"
    )


def test_the_first_screen_has_a_robot_that_drives_before_anything_is_run(lab, browser_page):
    page = browser_page
    page.set_viewport_size({"width": 1366, "height": 768})
    open_notebook(page, link(lab), CHAPTER)
    panel = page.locator(".wmr.stage").first
    panel.locator(".wmr-slider").last.wait_for(timeout=PATIENCE)
    box, room = panel.bounding_box(), page.locator(".jp-Notebook").first.bounding_box()
    assert box["y"] >= room["y"]
    assert box["y"] + box["height"] <= room["y"] + room["height"]
    canvas = panel.locator("canvas").first.element_handle()
    before = canvas.evaluate("it => it.toDataURL()")
    moved = "([it, before]) => it.toDataURL() !== before"
    page.wait_for_function(moved, arg=[canvas, before], timeout=PATIENCE)
    assert set(page.evaluate(BROKEN_LINKS)) == {"none"}
    settings = json.loads(page.locator("#jupyter-config-data").text_content())
    assert settings["buildCheck"] is False  # where there is no Node.js it would warn
    assert panel.locator("[data-kind=verdict]:visible").count() == 0  # no answer before it is asked


def test_the_first_chapter_lives_before_it_is_run_and_after_it_is_saved(lab, browser_page):
    page = browser_page
    open_notebook(page, link(lab), CHAPTER)
    assert not page.get_by_text("Formgrader").count()
    values = sliders(page)
    page.wait_for_function(f"() => !({CHANGED})()", timeout=PATIENCE)  # once the last is drawn
    assert_slider_matters(page, values[0])
    assert solutions_in_sight(page) == []
    count = page.evaluate(f"() => {WIDGETS}.length")
    page.locator(".live-answers .live-chip").first.click()
    for place in ("[aria-label^=controls] .wmr-slider", ".wmr:not(.live) button"):
        page.locator(place).locator("visible=true").first.press("b")  # in a cell it adds one
    assert page.evaluate(f"() => {WIDGETS}.length") == count

    assert page.evaluate(RUN_ALL)
    page.wait_for_function(f"() => {KERNEL}.status === 'idle'", timeout=PATIENCE)
    assert page.evaluate(CHANGED)
    trouble = '[data-mime-type$="jupyter.stderr"], [data-mime-type$="jupyter.error"]'
    assert page.locator(trouble).count() == 0
    assert_slider_matters(page, sliders(page)[0])
    assert solutions_in_sight(page) == []

    page.evaluate(SAVE)
    # what the kernel still says to a page that is left is logged as an error
    page.wait_for_function(f"() => {KERNEL}.status === 'idle'", timeout=PATIENCE)
    open_notebook(page, link(lab), CHAPTER)
    assert_slider_matters(page, sliders(page)[0])
    assert solutions_in_sight(page) == []
    *_, last = (lab / "log.txt").read_text().splitlines()
    assert last.strip() == link(lab)  # in the terminal no warning pushes it away


@pytest.mark.slow
def test_without_the_books_settings_a_picture_waits_and_the_panel_comes_from_the_kernel(
    tmp_path, browser_page
):
    page = browser_page
    (tmp_path / "notebooks").mkdir()
    shutil.copy(ROOT / CHAPTER, tmp_path / CHAPTER)
    with jupyterlab(tmp_path, "--IdentityProvider.token=bare") as url:
        open_notebook(page, f"{url}lab/tree/{CHAPTER}?token=bare", CHAPTER)
        # what it does not trust it shows as a picture
        page.locator(".wmr-still img").first.wait_for(timeout=PATIENCE)
        assert page.locator(".wmr").count() == 0
        stills = page.locator(".wmr-still").all()
        assert all(re.search(r"\w[.?!] Run this cell to move it", words(it)) for it in stills)
        assert all(it.locator("img").get_attribute("alt") for it in stills)
        page.evaluate(RUN_ALL)
        assert_slider_matters(page, sliders(page)[0])
        page.goto("about:blank")  # before its server ends


def test_a_graded_exercise_shows_its_hint_and_nothing_leaves(lab, browser_page):
    page = browser_page
    name = f"notebooks/{ASSIGNMENT}.ipynb"
    open_notebook(page, link(lab).replace(CHAPTER, name), name)
    page.evaluate(RUN_ALL)  # up to the cell that fails
    hint = page.locator(".jp-OutputArea-output", has_text="Hint: ").first
    hint.wait_for(timeout=PATIENCE)
    assert MISTAKE in hint.inner_text()
    assert "book/wmrbook/grading" not in hint.inner_text()


def words(place) -> str:
    return " ".join(place.inner_text().split())


def run(page, cell: int) -> None:
    page.evaluate(
        """cell => {
            window.jupyterapp.shell.currentWidget.content.activeCellIndex = cell;
            return window.jupyterapp.commands.execute('notebook:run-cell').then(() => true);
        }""",
        cell,
    )


def assert_python_sees(page, *words: str) -> None:
    """Python says so at once or soon: a busy kernel hears of the end of a drag when it can."""
    for _ in range(20):
        run(page, 1)
        output = page.locator(".jp-OutputArea-output:has-text('seen ')").inner_text(
            timeout=PATIENCE
        )
        if all(word in output for word in words):
            return
        page.wait_for_timeout(250)
    raise AssertionError(f"{words} were not seen, but {output}")


def assert_all_in_view(page) -> None:
    """In a window of 1440 by 900 the panel needs no scrolling, once its cell is at the top."""
    page.set_viewport_size({"width": 1440, "height": 900})
    root = page.locator(".wmr")
    root.scroll_into_view_if_needed()
    page.wait_for_timeout(300)
    box = root.bounding_box()
    room = page.locator(".jp-WindowedPanel-outer, .jp-Notebook").first.bounding_box()
    assert box["height"] <= room["height"]
    assert box["width"] <= room["width"]
    scrolls = "it => it.scrollHeight > it.clientHeight + 1 || it.scrollWidth > it.clientWidth + 1"
    assert not page.locator(".jp-OutputArea-output:has(.wmr)").evaluate(scrolls)


def test_python_follows_the_panel_which_follows_python(lab, browser_page):
    page = browser_page
    open_notebook(page, link(lab).replace(CHAPTER, PANEL), PANEL)
    run(page, 0)
    status = page.locator(".wmr-status:not(:empty)")
    status.wait_for(timeout=PATIENCE)
    assert_python_sees(page, "k_rho=2.0, k_alpha=1.0, h=0.3")

    assert page.locator(".wmr-slider:not([aria-label]), .wmr select:not([aria-label])").count() == 0
    assert_all_in_view(page)

    def assert_said_anew(act) -> None:
        before = status.inner_text()
        act()
        changed = "before => document.querySelector('.wmr-status').textContent !== before"
        page.wait_for_function(changed, arg=before, timeout=PATIENCE)

    page.locator("[data-control=k_alpha] .wmr-slider").focus()
    assert_said_anew(lambda: [page.keyboard.press("ArrowRight") for _ in range(3)])
    assert_python_sees(page, "k_rho=2.0, k_alpha=1.15, h=0.3")

    chart = page.locator(".wmr-map[data-finished=true]")
    assert_said_anew(lambda: chart.click(position={"x": 250, "y": 100}, timeout=PATIENCE))
    clicked = float(page.locator("[data-control=k_alpha] .wmr-typed").input_value())
    assert clicked != 1.15
    assert_python_sees(page, f"k_alpha={clicked},")

    typed = page.locator("[data-control=h] .wmr-typed")
    run(page, 2)
    page.wait_for_function(
        "() => document.querySelector('[data-control=h] .wmr-typed').value === '2.5'",
        timeout=PATIENCE,
    )
    assert_python_sees(page, "k_rho=1.5, k_alpha=4.0, h=2.5", "aicardi")

    typed.click()
    page.keyboard.press("ControlOrMeta+a")
    page.keyboard.type("3.21")
    page.keyboard.press("Enter")
    assert_python_sees(page, "h=3.21")

    page.get_by_text("More", exact=True).click()
    page.locator("[data-do=reset]").click()
    assert_python_sees(page, "k_rho=2.0, k_alpha=1.0, h=0.3")

    run(page, 3)
    own = page.locator(".widget-slider [role=slider]")
    assert_python_sees(page, "k_rho=2.5, k_alpha=1.0, h=0.3")
    own.press("ArrowRight")
    assert_python_sees(page, "k_rho=2.55, k_alpha=1.0, h=0.3")
    page.locator("[data-control=k_rho] .wmr-slider").press("End")
    assert_python_sees(page, "k_rho=5.0, k_alpha=1.0, h=0.3")
    assert float(own.get_attribute("aria-valuenow")) == 5.0
    page.locator("[data-control=h] .wmr-slider").press("ArrowRight")
    assert_python_sees(page, "k_rho=5.0, k_alpha=1.0, h=0.35")


def test_panels_have_room_and_draw_in_every_container_of_ipywidgets(lab, browser_page):
    page = browser_page
    open_notebook(page, link(lab).replace(CHAPTER, ROWS), ROWS)
    for cell, count in enumerate((14, 22)):  # the last eight once their tab and fold are opened
        run(page, cell)
        drawn = f"count => ({ROOMS})().filter(([, drawn]) => drawn).length === count"
        page.wait_for_function(drawn, arg=count)
        rooms = page.evaluate(ROOMS)
        assert len(rooms) == count
        assert min(rooms)[0] >= 300, rooms
    assert 400 in [width for width, *_ in rooms]  # as its reader chose
