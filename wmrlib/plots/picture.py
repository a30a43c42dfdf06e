"""A figure together with the text that says what it shows."""

from __future__ import annotations

import base64
import html
import io

from matplotlib.figure import Figure
from PIL import Image
from PIL.PngImagePlugin import PngInfo


class Picture:
    """A figure and its alternative text, which Jupyter shows as a PNG image with that text.

    Parameters
    ----------
    figure : matplotlib's Figure, to change or save
    alt : str, for readers who don't see the figure, and for tests
    """

    def __init__(self, figure: Figure, alt: str) -> None:
        self.figure = figure
        self.alt = alt

    def __repr__(self) -> str:
        return f"<Picture: {self.alt}>"

    def png(self, dots_per_inch: float = 108.0) -> bytes:
        """Return a PNG file of 256 colours, a third of the full size, with the text inside."""
        buffer, file, text = io.BytesIO(), io.BytesIO(), PngInfo()
        self.figure.savefig(buffer, format="png", dpi=dots_per_inch)
        text.add_itxt("Description", self.alt)
        few = Image.open(buffer).convert("RGB").quantize(256, dither=Image.Dither.NONE)
        few.save(file, "PNG", optimize=True, pnginfo=text)
        return file.getvalue()

    def _repr_mimebundle_(self, include=None, exclude=None):
        """As HTML first: JupyterLab gives a bare image/png no text. As PNG for a printed book."""
        png, width = self.png(), round(self.figure.get_figwidth() * 72)
        source = f"data:image/png;base64,{base64.b64encode(png).decode()}"
        image = f'<img alt="{html.escape(self.alt)}" width="{width}" src="{source}">'
        bundle = {"text/html": image, "image/png": png, "text/plain": repr(self)}
        return bundle, {"image/png": {"alt": self.alt, "width": width}}
