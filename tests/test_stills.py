"""Where nothing runs, a picture and a sentence stand in place of each panel."""

import base64
import html
import json
import re

import pages
import pytest
import stills as tool

from wmrbook import live
from wmrbook.panel import Explorer, stills

IMAGE = re.compile(
    r'^<div class="wmr-still"><img alt="([^"]+)" .*src="data:image/webp;base64,(.*?)"'
)


@pytest.mark.parametrize("path", tool.chapters(), ids=lambda path: path.stem)
def test_each_panel_of_a_chapter_has_the_picture_of_now(path):
    """Else run book/tools/stills.py."""
    text = path.read_text(encoding="utf-8")
    notebook = json.loads(text)
    for output, model in tool.panels(notebook):
        still = "".join(output["data"]["text/html"])
        assert still == stills.still(model["program"], model["state"], model["setup"]), model
        alt, picture = IMAGE.match(still).groups()
        words = "".join(output["data"]["text/plain"])
        assert len(alt.split()) > 3
        assert words.endswith(stills.RUN_IT)
        assert len(words) > len(stills.RUN_IT) + 20
        assert not re.search(r"[{}<>]", html.unescape(alt) + words)  # no template
        assert len(base64.b64decode(picture)) <= tool.LARGEST
    assert tool.with_stills(notebook) == json.loads(text)


def test_all_pictures_of_the_chapters_together_take_less_than_two_megabytes():
    texts = (path.read_text(encoding="utf-8") for path in tool.chapters())
    found = [it for text in texts for it in re.findall(r"<div class=.{2}wmr-still.*", text)]
    assert len(found) > 50  # each twice: for a page, and for the panel's own program
    assert sum(map(len, found)) < 2e6


def test_what_a_panel_shows_decides_about_its_picture_but_the_last_digits_do_not():
    panel = Explorer()

    def digest(**changed):
        return stills.digest(panel.program, panel.state | changed, panel.setup)

    assert digest(k_rho=2.0 + 1e-12) == digest(k_rho=2.0) == digest()
    assert len({digest(), digest(k_rho=2.01), digest(law="aicardi"), digest(moving=True)}) == 4
    assert stills.digest("front", panel.state, panel.setup) != digest()


def test_a_panel_that_has_no_picture_says_where_its_knobs_stand():
    panel = live.stopping()
    panel["stop"] = 0.06
    data, _ = panel._repr_mimebundle_()
    assert "0.06 m" in data["text/plain"]
    assert stills.RUN_IT in data["text/html"]
    assert not re.search("[{}]", data["text/html"])


def test_a_page_keeps_the_picture_as_a_file_and_not_twice(tmp_path):
    panel, kind = live.stopping(), "application/vnd.jupyter.widget"
    still = stills.still(panel.program, panel.state, panel.setup)
    state = json.dumps({"state": {"it": {"state": {"still": still}}}}).replace("</", "<\\/")
    page = f'<script type="{kind}-view+json">\n{{"model_id": "it"}}\n</script><p>text</p>'
    page += f'<script type="{kind}-state+json">{state}</script>'
    text = pages.with_stills(page, tmp_path, "../")
    alt, picture = IMAGE.match(still).groups()
    (file,) = tmp_path.rglob("*.webp")
    assert file.read_bytes() == base64.b64decode(picture)
    address = f"../{file.relative_to(tmp_path).as_posix()}"
    assert f'</script><noscript><img alt="{alt}" src="{address}"></noscript><p>' in text
    assert "base64" not in text
    assert json.loads(re.findall(r'state\+json">(.*)</script>', text)[0])["state"]["it"]
