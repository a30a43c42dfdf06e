"""The book's face: what each thing's colour is on light and on dark paper, and the fonts.

One table, which figures, panels, pages, slides and the printed book take their looks from. The
colours are those of Okabe and Ito, which colour-blind readers can tell apart, darker where they
colour text; a symbol has one hue wherever it stands. Whatever a colour says, a line style, a marker
or a label says too.
"""

from __future__ import annotations

import re
import textwrap
import unicodedata

COLOURS = {
    # role: on light paper, on dark paper
    "paper": ("#fdfcf8", "#15191e"),
    "ink": ("#1d2429", "#eef1f4"),
    "soft": ("#57606a", "#b1bac4"),
    "line": ("#cdcbc1", "#424a53"),
    "raised": ("#f2f0e8", "#22272e"),
    "focus": ("#0069a6", "#56b4e9"),
    "lawn": ("#e1ead2", "#1c261c"),
    "mown": ("#d5e0c2", "#233024"),
    "path": ("#0072b2", "#56b4e9"),
    "start": ("#00795a", "#2fc796"),
    "goal": ("#b84f00", "#f58d3d"),
    "rho": ("#7a3fb8", "#c3a2f2"),
    "alpha": ("#a8447f", "#e59cc4"),
    "theta": ("#7d7000", "#f0e442"),
    "h": ("#4a7800", "#a5d65c"),
    "V": ("#3a55c9", "#95aaff"),
    "rising": ("#d00000", "#ff7b72"),
    "ghost": ("#7a828b", "#9aa4af"),
}
LETTERS = {"rho": "1D70C", "alpha": "1D6FC", "theta": "1D703", "h": "210E", "V": "1D449"}
"""The symbols among them, as MathJax names what it draws."""

TRACK = 23  # px, between the middles of its wheels
_WHEEL = (
    "M-6 {0} L6 {0} Q8 {0} 8 {1} L8 {2} Q8 {3} 6 {3} "
    "L-6 {3} Q-8 {3} -8 {2} L-8 {1} Q-8 {0} -6 {0} Z"
)
ROBOT = {
    "wheels": " ".join(_WHEEL.format(*(y + by for by in (0, 2, 4, 6))) for y in (-14.5, 8.5)),
    "body": "M-11 -9 Q-13 -9 -13 -7 L-13 7 Q-13 9 -11 9 L4 9 Q9 8 15 0 Q9 -8 4 -9 Z",
    "nose": "M5 -4 L10.5 0 L5 4 Z",
}
"""The robot from above, its nose to the right, as paths of SVG in px: wherever one is drawn."""

FONTS = {
    "serif": '"Source Serif 4", Georgia, "Times New Roman", serif',
    "sans": '"Source Sans 3", "Source Sans Pro", system-ui, "Segoe UI", Roboto, Arial, sans-serif',
    "code": '"JetBrains Mono", ui-monospace, Menlo, Consolas, monospace',
    "maths": '"STIX Two Text", "Source Serif 4", "Cambria Math", Georgia, serif',
}
# The files that pages carry, from npm's @fontsource: family, weights, styles, folder, parts.
FILES = (
    ("Source Serif 4", "200 900", "normal italic", "-variable/source-serif-4", "latin-wght"),
    ("Source Sans 3", "200 900", "normal", "-variable/source-sans-3", "latin-wght"),
    ("Source Sans 3", "200 900", "normal", "-variable/source-sans-3", "greek-wght"),
    ("JetBrains Mono", "100 800", "normal", "-variable/jetbrains-mono", "latin-wght"),
    ("STIX Two Text", "400", "italic", "/stix-two-text", "greek-400"),
)


_DEGREES = re.compile(r"(?<=\d) deg\b|(?<=\[)deg(?=\])")
_GREEK = "alpha|beta|gamma|delta|zeta|theta|kappa|lambda|rho|sigma|tau|phi|omega"
_NAME = re.compile(rf"\b(?:([kvl])_(?:(max|x|y)|({_GREEK}))|({_GREEK}))\b")


def in_symbols(words: str) -> str:
    """Return a text with symbols for their names, and a sign for degrees."""
    return _NAME.sub(_symbol, _DEGREES.sub("°", words))


def _symbol(name: re.Match) -> str:
    stem, index, greek, letter = name.groups()
    if stem:
        return f"${stem}_{{{index}}}$" if index else f"${stem}_{{\\{greek}}}$"
    spelled = "lamda" if letter == "lambda" else letter  # by Unicode
    return unicodedata.lookup(f"GREEK SMALL LETTER {spelled.upper()}")


def css() -> str:
    """The table as variables of CSS, for pages whose theme stands at their root."""
    themes = []
    for k, theme in enumerate(("light", "dark")):
        rows = "".join(f"  --{role}: {codes[k]};\n" for role, codes in COLOURS.items())
        chosen = ":root" if theme == "light" else ':root[data-theme="dark"]'
        themes.append(f"{chosen} {{\n{rows}}}\n")
    fonts = "".join(f"  --{role}: {names};\n" for role, names in FONTS.items())
    # A page's script reads --role of what is touched, see reading.js.
    letters = "".join(
        f"{shapes} {{ fill: var(--{role}); --role: {role}; }}\n"
        f'[data-lit="{role}"] :is({shapes}, .live-symbol[data-role="{role}"]) '
        "{ filter: var(--lit); }\n"
        for role, shapes in ((role, _shapes(role)) for role in LETTERS)
    )
    return "".join([*themes, f":root {{\n{fonts}}}\n", letters])


def _shapes(role: str) -> str:
    """The selector of a symbol in formulas; the h of e_h stands for a heading, not for the gain."""
    letter = f'[data-c="{LETTERS[role]}"]'
    index = ':is([data-mml-node="msub"], [data-mml-node="msubsup"]) > :last-child *'
    return f"{letter}:not({index})" if role == "h" else letter


def javascript() -> str:
    """The table, and the robot, as a module of the panels' kit."""
    rows = "".join(f"  {role}: ['{a}', '{b}'],\n" for role, (a, b) in COLOURS.items())
    fonts = "".join(f"  {role}: '{names}',\n" for role, names in FONTS.items())
    robot = "".join(f"  {part}: {_in_lines(path)},\n" for part, path in ROBOT.items())
    return (
        "// Printed by book/tools/kit.py from wmrbook.face: colours on light and on "
        "dark paper,\n// fonts, and the robot.\n"
        f"export const COLOURS = {{\n{rows}}};\nexport const FONTS = {{\n{fonts}}};\n"
        f"export const TRACK = {TRACK}; // px, between the middles of a robot's wheels\n"
        f"export const ROBOT = {{\n{robot}}};\n"
    )


def _in_lines(path: str) -> str:
    """A path as a text of JavaScript, in lines that are no longer than the others."""
    lines = textwrap.wrap(path, 88)
    return "'" + " '\n    + '".join(lines) + "'"
