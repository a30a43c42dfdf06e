"""What all figures have in common: colours by role, line styles, axes, robots and a text.

Colours and font are those of `wmrbook.face`, which pages, panels and slides have too.
"""

from __future__ import annotations

import html
import io
import json
import re
from collections.abc import Sequence
from importlib.resources import files
from typing import Any, NamedTuple
from urllib.parse import quote

import matplotlib as mpl
import numpy as np
from matplotlib import font_manager
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from matplotlib.text import Text
from matplotlib.transforms import Affine2D, ScaledTranslation

from wmrbook import face
from wmrbook.face import in_symbols
from wmrlib.kinematics import Pose

COLOURS = {role: light for role, (light, _) in face.COLOURS.items()} | {
    "robot": "#56b4e9",
    "v": face.COLOURS["path"][0],
    "omega": "#cc79a7",
    "y_error": "#e69f00",
}
STYLE: dict[Any, Any] = {
    "font.family": "Source Sans Pro",
    "font.size": 13,
    "mathtext.fontset": "stix",
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": face.COLOURS["line"][0],
    "grid.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": face.COLOURS["soft"][0],
    "axes.titleweight": 600,
    "xtick.color": face.COLOURS["soft"][0],
    "ytick.color": face.COLOURS["soft"][0],
    "text.color": face.COLOURS["ink"][0],
    "axes.labelcolor": face.COLOURS["ink"][0],
    "lines.linewidth": 2.0,
    "legend.frameon": False,
}
# On dark paper: black is ink, white is the paper, and an area with hatches in ink, and the robot on
# its path, is dark.
DARK = dict(face.COLOURS.values()) | {
    "#000000": face.COLOURS["ink"][1],
    "#ffffff": face.COLOURS["paper"][1],
    "#56b4e9": "#0072b2",
    "#f0e442": "#857c00",
    "#bbbbbb": "#5c646d",
    "#bfbfbf": "#4a5159",
    "#f7c9a8": "#7a3f12",
}
for _path in files("font_source_sans_pro").joinpath("files").iterdir():
    if re.fullmatch(r"SourceSansPro-(Regular|It|Semibold|Bold)\.ttf", _path.name):
        font_manager.fontManager.addfont(str(_path))
# inches: a page shows a figure as wide as its column, 690 px, with letters of 12 to 18 px; and on a
# slide of 1280 by 720 px the letters of the tallest and of the widest figure have 24 px
NARROWEST, WIDEST, TALLEST = 7.0, 9.3, 4.0
LINES = ("-", "--", ":", "-.")
CROWD = 300  # shapes in one graph; more are stored as pixels, which take less room
SVG_URL = "data:image/svg+xml,"
FRAMES, PARTS = 120, 10_000  # of a drive that is played; places in so many parts of the picture
_CODES = {"M": Path.MOVETO, "L": Path.LINETO, "Q": Path.CURVE3, "Z": Path.CLOSEPOLY}
_UNUSED = re.compile(r'<!--.*?--> |(?<=<g) id="[^"]*"')
_CROWDED = re.compile(r'<g( clip-path="[^"]*")>((?: <use [^>]*?style="([^"]*)"/>){100,}) </g>')
_HASHED = re.compile(r"(?<=[\"#])[mp][0-9a-f]{10}\b")  # of all digits of what it names
_POINTS = re.compile(r' (?:d|x|y|width|height)="[^"]*"|translate\([^)]*\)')
_NUMBER = re.compile(r"-?\d+\.\d{3,}(?:e-?\d+)?")  # with more decimals than one can see


class Drive(NamedTuple):
    """A run that a page can play in the axes that show it: arrays in s, m and rad, and a colour."""

    axes: Axes
    t: np.ndarray
    x: np.ndarray
    y: np.ndarray
    heading: np.ndarray
    role: str = "path"


class Picture:
    """A figure and its alternative text, which Jupyter shows as an SVG image with that text.

    Parameters
    ----------
    figure : matplotlib's Figure, to change or save
    alt : str, for readers who don't see the figure, and for tests
    drives : Drives that the book's pages play over the picture
    narrowest : inches; a picture beside a question may be narrower than one in a column of text
    """

    def __init__(
        self,
        figure: Figure,
        alt: str,
        drives: Sequence[Drive] = (),
        *,
        narrowest: float = NARROWEST,
    ) -> None:
        self.figure = figure
        self.alt = alt
        self.drives = drives
        width, height = figure.get_size_inches()
        figure.set_size_inches(min(max(width, narrowest), WIDEST), min(height, TALLEST))
        _fill(figure)
        for text in figure.findobj(Text):  # those made after `new_figure` have matplotlib's font
            text.set_fontfamily(STYLE["font.family"])
            text.set_fontsize(max(text.get_fontsize(), STYLE["font.size"]))
            if "$" not in text.get_text():
                text.set_text(in_symbols(text.get_text()))

    def __repr__(self) -> str:
        return f"<Picture: {self.alt}>"

    def svg(self) -> str:
        """Return the figure as SVG: letters as outlines, one text whatever the last bits are."""
        for axes in self.figure.axes:
            for one in axes.patches if len(axes.patches) > CROWD else ():
                one.set_rasterized(True)
        buffer, nothing = io.StringIO(), dict.fromkeys(("Creator", "Date", "Format", "Type"))
        with mpl.rc_context({"svg.hashsalt": "wmrbook", "svg.fonttype": "path"}):
            self.figure.savefig(buffer, format="svg", dpi=144, facecolor="none", metadata=nothing)
        text = " ".join(buffer.getvalue().split())
        text = _CROWDED.sub(_styled_once, _UNUSED.sub("", text[text.index("<svg") :]))
        text, names = _POINTS.sub(lambda path: _NUMBER.sub(_rounded, path[0]), text), {}
        return _HASHED.sub(lambda it: names.setdefault(it[0], f"{it[0][0]}{len(names)}"), text)

    def motion(self) -> dict[str, Any]:
        """Return where the robots are on the picture, in `FRAMES` even steps of time.

        Boxes of the axes and first places are in `PARTS` of its width and height, from the left
        and from the top, and first headings in degrees; what follows are changes, which are short.
        """
        if not self.drives:
            raise ValueError("this picture shows no drive to play: give Picture some drives")
        seconds = max(float(drive.t[-1]) for drive in self.drives)
        times, (width, height) = np.linspace(0.0, seconds, FRAMES), self.figure.bbox.size
        robots = []
        for axes, t, x, y, heading, role in self.drives:
            left, bottom, right, top = axes.get_window_extent().extents
            sides = left / width, 1.0 - top / height, right / width, 1.0 - bottom / height
            place = axes.transData.transform(np.column_stack([x, y]))
            across, down = place[:, 0] / width, 1.0 - place[:, 1] / height
            degrees = np.degrees(np.unwrap(heading))
            robots.append(
                {
                    "box": _whole(PARTS * np.array(sides)),
                    "x": _changes(_whole(PARTS * np.interp(times, t, across))),
                    "y": _changes(_whole(PARTS * np.interp(times, t, down))),
                    "heading": _changes(_whole(np.interp(times, t, degrees))),
                    "role": role,
                }
            )
        return {"seconds": round(seconds, 2), "robots": robots}

    def _repr_mimebundle_(self, include=None, exclude=None):
        """As HTML: JupyterLab gives a bare image no alternative text."""
        width = round(self.figure.get_figwidth() * 96)  # px to an inch
        source = quote(self.svg().replace('"', "'"), safe=" ='/:;,()")
        image = f'<img alt="{html.escape(self.alt)}" width="{width}" src="{SVG_URL}{source}"'
        if self.drives:  # after svg(), which lays the axes out
            motion = json.dumps(self.motion(), separators=(",", ":"))
            image += f' data-motion="{html.escape(motion)}"'
        image += ">"
        return {"text/html": image, "text/plain": repr(self)}


def _fill(figure: Figure) -> None:
    """Widen the limits of axes with equal scales, alone on their row, until they fill the room."""
    maps = [axes for axes in figure.axes if axes.get_aspect() == 1.0]
    maps = [it for it in maps if len(it.get_shared_x_axes().get_siblings(it)) == 1]
    if maps:
        figure.draw_without_rendering()  # lays the axes out
    for axes in maps:
        room = axes.get_position(original=True).size * figure.get_size_inches()
        limits = np.array([axes.get_xlim(), axes.get_ylim()])
        spans = np.ptp(limits, axis=1)
        more = room * max(spans / room) - spans
        limits += 0.5 * more[:, None] * np.array([-1.0, 1.0])
        axes.set(xlim=limits[0], ylim=limits[1])


def _whole(values: np.ndarray) -> list[int]:
    return np.rint(values).astype(int).tolist()


def _changes(values: list[int]) -> list[int]:
    return [values[0], *np.diff(values).tolist()]


def darkened(svg: str) -> str:
    """Return an SVG text of a Picture in the colours of dark paper."""
    text = re.sub(r"#[0-9a-f]{6}", lambda colour: DARK.get(colour[0], colour[0]), svg)
    return text.replace("<svg", f"<svg fill='{DARK['#000000']}'", 1)  # black is not written


def _styled_once(group: re.Match) -> str:
    """A crowd of marks with the style of the last, if all have it, written once."""
    clip, marks, style = group.groups()
    bare = marks.replace(f' style="{style}"', "")
    return group[0] if "style=" in bare else f'<g{clip} style="{style}">{bare} </g>'


def _rounded(number: re.Match) -> str:
    return f"{float(number[0]):.2f}".rstrip("0").rstrip(".")


def new_figure(width: float, height: float, rows: int = 1, mosaic=None) -> tuple:
    """A figure (inches) outside pyplot, which would show it twice, and its rows or mosaic."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(width, height), layout="constrained")
        if mosaic:
            return figure, figure.subplot_mosaic(mosaic, width_ratios=[1.0, 1.1])
        return figure, figure.subplots(rows, sharex=True)


def icon(part: str) -> Path:
    """A part of `face.ROBOT` as a path of matplotlib, in px; it is the same above and below."""
    numbers, codes = [], []
    for command, given in re.findall(r"([MLQZ])([^MLQZ]*)", face.ROBOT[part]):
        pairs = np.reshape([float(it) for it in given.split()], (-1, 2))
        numbers += [*pairs] or [numbers[-1]]
        codes += [_CODES[command]] * max(len(pairs), 1)
    return Path(numbers, codes)


def placed(axes: Axes, pose: Pose, path: Path, size: float, **looks) -> PathPatch:
    """Draw a path in px, turned and moved to a pose; as large on every scale of the axes."""
    turned = Affine2D().scale(size / 96.0).rotate(pose.heading)
    middle = ScaledTranslation(pose.x, pose.y, axes.transData)
    patch = PathPatch(path.transformed(turned), **looks)
    patch.set_transform(axes.figure.dpi_scale_trans + middle)
    return axes.add_patch(patch)


def robot(axes: Axes, pose: Pose, role: str = "path", size: float = 1.0, zorder: float = 4) -> None:
    """Draw the robot from above, 28 px long times `size`, as panels and slides do."""
    fill, paper = COLOURS.get(role, role), COLOURS["paper"]
    placed(axes, pose, icon("wheels"), size, fc=COLOURS["ink"], lw=0, zorder=zorder)
    looks = {"fc": fill, "ec": paper, "lw": 1.2 * size, "gid": "robot", "zorder": zorder}
    placed(axes, pose, icon("body"), size, **looks)
    placed(axes, pose, icon("nose"), size, fc=paper, lw=0, zorder=zorder)


def pose_arrow(
    axes: Axes, pose: Pose, role: str = "goal", size: float = 1.0, zorder: float = 5
) -> None:
    """Draw a start or a goal: a ring with an arrow, 52 px long times `size`."""
    looks = {"ec": COLOURS[role], "lw": 2.2 * min(size, 1.0), "zorder": zorder}
    shaft, head = Path([(0.0, 0.0), (46.0, 0.0)]), Path([(40, -6), (52, 0), (40, 6), (40, -6)])
    placed(axes, pose, shaft, size, fill=False, gid="pose", **looks)
    placed(axes, pose, head, size, fc=COLOURS[role], **looks)
    placed(axes, pose, Path.circle(radius=7.0), size, fc=COLOURS["paper"], **looks)


def equal_scales(axes: Axes, x: np.ndarray, y: np.ndarray, room: float = 0.08) -> None:
    """Show the points in a square of equal scales, with `room` of its width on each side."""
    half = 0.5 * max(np.ptp(x), np.ptp(y), 1.0) * (1.0 + 2.0 * room)
    middle_x, middle_y = 0.5 * (x.min() + x.max()), 0.5 * (y.min() + y.max())
    xlim, ylim = (middle_x - half, middle_x + half), (middle_y - half, middle_y + half)
    axes.set(xlim=xlim, ylim=ylim, aspect="equal")
