"""What a student sends back: one line of text, with a checksum, through any channel.

    wmr-KIND id=ID name=NAME value=VALUE check=CHECK

KIND is one word of small letters: "gate", a prediction with a name; "test", a sheet of answers to
the concept questions. ID says which gate or which test: small letters, digits and
hyphens. NAME, a name or a pseudonym, and VALUE, a choice or a number, are written as in an address
(%20 for a space), so that a line has no other blanks and survives mails and chats. The challenge's
lines have fields of their own between KIND and NAME.

CHECK is the first ten hexadecimal digits of the SHA-256 of what stands before " check=". It finds a
character that was lost or mistyped. It is no signature: whoever can run this module can make a line
in any name. `line.js` beside it makes the same lines in a page.

A live figure copies `predict ID VALUE`, with the number of an option, from 0, or an angle in
degrees. It has neither name nor checksum, so each counts. A sketched path is not counted.

A class's file holds a line each. Empty lines and those that begin with # are let alone, and what
stands around a line, such as a chat's date and sender, does not matter.
"""

from __future__ import annotations

import hashlib
import os
import re
import unicodedata
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple
from urllib.parse import quote, unquote

from wmrlib.checks import instance

LONGEST_NAME = LONGEST_VALUE = 60
JOINERS = "\u200c\u200d"
"""Characters of format that names need, in Persian and in Indian scripts."""
SCRIPT = Path(__file__).with_name("line.js")
UTF_16 = b"\xff\xfe", b"\xfe\xff"  # some editors, and PowerShell's >, begin a file so
_FILLERS = "\u034f\u115f\u1160\u17b4\u17b5\u2800\u3164\uffa0"  # unseen letters and marks
_UNSEEN = dict.fromkeys(map(ord, JOINERS))
_ID = re.compile(r"[a-z0-9][a-z0-9-]{0,59}")
_LINE = re.compile(
    r"\bwmr-(?P<kind>[a-z]{1,20}) id=(?P<id>[a-z0-9][a-z0-9-]{0,59}) name=(?P<name>[\w.~%-]{1,800})"
    r" value=(?P<value>[\w.~%-]{1,800}) check=(?P<check>[0-9a-f]{10})(?![0-9a-f])",
    re.ASCII,
)
_BARE = re.compile(r"\bpredict (?P<id>[a-z]\w{0,59}) (?P<value>-?\d{1,6})$", re.ASCII)
_WANTED = "wmr-... id=... name=... value=... check=... is needed"


class Line(NamedTuple):
    """What a line says: its kind, which one, who ("" if nobody), and the value, each a text."""

    kind: str
    id: str
    name: str
    value: str


class Refused(NamedTuple):
    """A line that does not count: its number in the file, from 1, its text, and why."""

    line: int
    text: str
    reason: str


def written(line: Line) -> str:
    """Return the text of a line; raises ValueError for a field that can't stand in one."""
    kind, which, name, value = instance("line", line, Line)
    if not re.fullmatch("[a-z]{1,20}", instance("kind", kind, str)):
        raise ValueError(f"kind = {kind!r} is not allowed: 1 to 20 small letters are needed")
    if not _ID.fullmatch(instance("id", which, str)):
        wanted = "1 to 60 small letters, digits and hyphens are needed, the first no hyphen"
        raise ValueError(f"id = {which!r} is not allowed: {wanted}")
    name, value = quote(clean_name(name), safe=""), quote(_clean_value(value), safe="")
    return checked(f"wmr-{kind} id={which} name={name} value={value}")


def read(text: str) -> Line:
    """Return what the line in a text says, or raise ValueError with the reason."""
    match = _LINE.search(instance("text", text, str))
    if bare := None if match else _BARE.search(text.strip()):
        return Line("predict", bare["id"], "", bare["value"])
    if not match:
        raise ValueError(f"there is no line: {_WANTED}")
    if checked(match[0].rpartition(" check=")[0]) != match[0]:
        raise ValueError("the checksum does not fit: a character was changed, lost or added")
    name, value = (unquote(match[field], errors="strict") for field in ("name", "value"))
    return Line(match["kind"], match["id"], clean_name(name), _clean_value(value))


def read_all(
    path: str | os.PathLike, check: Callable[[Line], object] | None = None
) -> tuple[list[Line], list[Refused]]:
    """Return a file's lines, of each name the last for each kind and id, and the refused ones.

    Names that differ only in upper and lower case, or in joiners, which are not seen, are one.
    check: raises ValueError for a line that is to be refused. Raises OSError if the file can't be
    read.
    """
    last, refused = {}, []
    for number, text in numbered(Path(path).read_bytes()):
        try:
            line = read(text)
            if check:
                check(line)
        except ValueError as error:  # of bytes that are no UTF-8, too
            refused.append(Refused(number, text, str(error)))
        else:
            last[line.kind, line.id, same_name(line.name) or number] = line
    return list(last.values()), refused


def checked(text: str) -> str:
    """Return a line's text with its checksum."""
    digest = hashlib.sha256(text.encode("ascii", "backslashreplace")).hexdigest()
    return f"{text} check={digest[:10]}"


def numbered(content: bytes) -> Iterator[tuple[int, str]]:
    """Yield the lines of a class's file with their numbers, without empty ones and remarks."""
    encoding = "utf-16" if content.startswith(UTF_16) else "utf-8"
    for number, line in enumerate(content.decode(encoding, "backslashreplace").split("\n"), 1):
        stripped = line.strip().strip("\ufeff")  # the mark of UTF-8, where files were joined
        if stripped and not stripped.startswith("#"):
            yield number, stripped


def clean_name(name: str) -> str:
    """Return the same name for the same person: composed characters, single blanks."""
    clean = " ".join(unicodedata.normalize("NFC", instance("name", name, str)).split())
    named = len(clean) <= LONGEST_NAME and any(map(str.isalnum, clean))
    if not named or not all(map(_readable, clean)):
        wanted = f"1 to {LONGEST_NAME} readable characters, one a letter or digit, are needed"
        raise ValueError(f"name = {name!r} is not allowed: {wanted}")
    return clean


def same_name(name: str) -> str:
    """Return what two spellings of a name have in common."""
    return name.casefold().translate(_UNSEEN)


def _clean_value(value: str) -> str:
    clean = " ".join(instance("value", value, str).split())
    if not 1 <= len(clean) <= LONGEST_VALUE or not all(map(_readable, clean)):
        wanted = f"1 to {LONGEST_VALUE} readable characters are needed"
        raise ValueError(f"value = {value!r} is not allowed: {wanted}")
    return clean


def _readable(character: str) -> bool:
    """Whether it is seen, and leaves the direction of the writing alone."""
    control = unicodedata.category(character)[0] == "C"
    return character in JOINERS or not (control or character in _FILLERS)
