"""A figure together with the text that says what it shows."""

from __future__ import annotations

import base64
import html
import io

from matplotlib.figure import Figure
from PIL import Image
from PIL.PngImagePlugin import PngInfo


class Picture:
    """A matplotlib figure and the text that says what it shows, for readers who don't see it and for tests that compare text.

    figure: the Figure, to change or save; alt: the alternative text. Jupyter shows it as a PNG image with that text.
    """

    def __init__(self, figure: Figure, alt: str) -> None:
        self.figure = figure
        self.alt = alt

    def __repr__(self) -> str:
        return f"<Picture: {self.alt}>"

    def png(self, dots_per_inch: float = 108.0) -> bytes:
        """The picture as a PNG file of 256 colours, a third of the size of one with all of them; the text is in it as its Description."""
        buffer, file, text = io.BytesIO(), io.BytesIO(), PngInfo()
        self.figure.savefig(buffer, format="png", dpi=dots_per_inch)
        text.add_itxt("Description", self.alt)
        Image.open(buffer).convert("RGB").quantize(256, dither=Image.Dither.NONE).save(
            file, "PNG", optimize=True, pnginfo=text
        )
        return file.getvalue()

    def _repr_mimebundle_(self, include=None, exclude=None):
        """As HTML first, because JupyterLab gives a bare image/png no alternative text; as PNG for a printed book."""
        png, width = self.png(), round(self.figure.get_figwidth() * 72)
        image = f'<img alt="{html.escape(self.alt)}" width="{width}" src="data:image/png;base64,{base64.b64encode(png).decode()}">'
        return {"text/html": image, "image/png": png, "text/plain": repr(self)}, {
            "image/png": {"alt": self.alt, "width": width}
        }
