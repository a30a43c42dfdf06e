"""Answers in the page's tasks: a reload keeps them, and the page hands them in like a notebook."""

import re
from pathlib import Path

import damage
import graded
import handins
import nbformat
import pytest
from gradebook import Course
from live import again
from page_tasks import TASKS, handed_in, tasks
from playwright.sync_api import Page
from test_python_in_page import fill, given

SAVE = "Save the notebook to hand in"
CHAPTERS = {
    "ch01": "01_gps_to_metres",
    "ch04": "04_lyapunov",
    "ch05": "05_pose_to_pose",
    "ch09": "09_when_things_go_wrong",
}
BLOCKED = """for (const name of ['getItem', 'setItem', 'removeItem']) {
    const kept = Storage.prototype[name];
    Storage.prototype[name] = function (key, ...rest) {
        if (key.startsWith('wmr-')) throw new DOMException('no', 'SecurityError');
        return kept.call(this, key, ...rest);
    };
}"""
LINE = "\n# ü ↦ \\ \" ' </script>"


def models(chapter: str) -> dict[str, str]:
    """The model's answers to the tasks that a page has, checked there or later."""
    told = [cell.metadata.get("task", {"name": "mine"})["name"] for cell in tasks(chapter[2:])]
    return {it: graded.cells(chapter)[it][0] + LINE for it in told if it != "mine"}


def cell_of(site: Path, page: Page, chapter: str, name: str):
    """The cell of a page that waits for the answer of this name."""
    names = [cell["name"] for cell in given(site / f"notebooks/{CHAPTERS[chapter]}.html")]
    return page.locator(".cell:has(script.python-cell)").nth(names.index(name))


def written(site: Path, page: Page, chapter: str, answers: dict[str, str]) -> None:
    for name, text in answers.items():
        fill(cell_of(site, page, chapter, name), text)


def saved(page: Page) -> tuple[str, nbformat.NotebookNode]:
    """What the button saves, and under which name."""
    with page.expect_download() as download:  # by the key: what still loads above moves the button
        page.get_by_role("button", name=SAVE).press("Enter")
    notebook = nbformat.reads(download.value.path().read_text(encoding="utf-8"), as_version=4)
    nbformat.validate(notebook)
    return download.value.suggested_filename, notebook


def by_id(notebook) -> dict[str, str]:
    return {cell.metadata.nbgrader.grade_id: cell.source for cell in notebook.cells}


def test_answers_outlive_a_reload_and_stand_in_the_notebook_that_is_given_out(site, opened):
    page = opened(f"notebooks/{CHAPTERS['ch04']}.html")
    answers = models("ch04") | {"mine": 'name = "Adá"  # I\nmine = grading.variants.right(name)'}
    del answers["turning"]
    exercise = "exercises.aicardi"  # of the chapter itself: nobody hands it in
    written(site, page, "ch04", answers | {exercise: LINE})
    page.get_by_label("User name").fill("bob")
    page.get_by_role("button", name=SAVE).click()
    assert 'The cell above says name = "Adá"' in page.locator(".python-hand-in").last.inner_text()
    again(page, "wmr-user-name", page.reload)
    asked = cell_of(site, page, "ch04", exercise)
    assert asked.locator(".python-editor").input_value() == LINE
    assert page.get_by_label("User name").input_value() == "bob"
    page.get_by_label("User name").fill("adÁ ")
    file, notebook = saved(page)
    release = by_id(handed_in("04")["notebook"])
    graded_ids = {name: text for name, text in answers.items() if name != "mine"}
    assert by_id(notebook) == release | graded_ids | {"name": 'name = "adÁ"'}
    assert file == f"{CHAPTERS['ch04']}.ipynb"
    given_out = "".join(nbformat.writes(handed_in(it)["notebook"]) for it in TASKS)
    assert not re.search("SOLUTION|MARK SCHEME|HIDDEN", given_out)
    # Another page does not have them, and what is reset is gone.
    page.goto(page.url.replace(CHAPTERS["ch04"], CHAPTERS["ch01"]))
    assert by_id(saved(page)[1]) == by_id(handed_in("01")["notebook"])
    again(page, "wmr-user-name", page.go_back)
    rate = cell_of(site, page, "ch04", "V-rate")
    for cell in rate, asked:
        cell.get_by_role("button", name="Reset").press("Enter")
    assert LINE not in rate.locator(".python-editor").input_value()
    again(page, "wmr-user-name", page.reload)
    assert asked.locator(".python-editor").input_value() != LINE
    assert by_id(saved(page)[1])["V-rate"] == release["V-rate"]


def test_where_a_browser_keeps_nothing_answers_are_handed_in_all_the_same(
    site, browser_page, opened
):
    browser_page.add_init_script(BLOCKED)
    page = opened(f"notebooks/{CHAPTERS['ch05']}.html")
    written(site, page, "ch05", models("ch05"))
    assert by_id(saved(page)[1])["law"] == models("ch05")["law"]
    told = page.locator(".python-hand-in").last.inner_text()
    assert by_id(saved(page)[1])["drive"] == models("ch05")["drive"]
    assert "in JupyterLab: Task 5.4: Arrived, and not parked." in told


@pytest.mark.slow
def test_what_a_page_hands_in_is_the_release_with_the_answers(site, opened, tmp_path):
    """Of a telephone too. So it is graded like any other: nothing in it has to be repaired."""
    with Course(damage.empty_course(tmp_path, *CHAPTERS)) as course:
        for chapter, name in CHAPTERS.items():
            page = opened(f"notebooks/{name}.html")
            page.set_viewport_size({"width": 390, "height": 844})
            written(site, page, chapter, models(chapter))
            if chapter == "ch04":
                page.get_by_label("User name").fill("model")
            _, notebook = saved(page)
            release = course.release(chapter)
            assert by_id(handed_in(chapter[2:])["notebook"]) == by_id(release)
            found, how = handins.repaired(notebook, release)
            assert (how, by_id(found)) == ([], by_id(notebook))
            assert models(chapter).items() <= by_id(notebook).items()
