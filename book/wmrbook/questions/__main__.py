"""The concept questions from the command line: the form, a class's histogram, its gain.

    python -m wmrbook.questions form [FILE]
    python -m wmrbook.questions histogram FILE
    python -m wmrbook.questions gain FILE [--guess 0.2]

FILE of the last two holds the lines that came back, one a line (see wmrbook.lines). `histogram`
prints tables and writes a page of pictures beside it; lines that do not count are listed.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from wmrbook.questions import fingerprint, tested
from wmrbook.questions.classes import Class, read_class
from wmrbook.questions.form import form
from wmrbook.questions.gain import gain
from wmrbook.questions.picture import page


def main(arguments: list[str] | None = None) -> None:
    """Do what the command says."""
    parser = argparse.ArgumentParser(
        "python -m wmrbook.questions",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    commands = parser.add_subparsers(dest="command", required=True)
    one = commands.add_parser("form", help="write the test as one HTML file")
    one.add_argument("file", nargs="?", type=Path, default=Path("questions.html"), metavar="FILE")
    for name, text in (("histogram", "what a class chose"), ("gain", "from pre to post")):
        one = commands.add_parser(name, help=text)
        one.add_argument("file", type=Path, metavar="FILE")
    text = "the probability of a right guess, if it is known and nothing is forgotten"
    one.add_argument("--guess", type=float, metavar="C", help=text)
    given = parser.parse_args(arguments)
    questions = tested()
    if given.command == "form":
        given.file.write_text(form(questions), encoding="utf-8")
        print(given.file)
        return
    try:
        answers = read_class(given.file, questions, fingerprint(questions))
        if given.command == "histogram":
            groups = answers.histograms(questions)
            _tell(answers, "\n\n".join(it.text() for group in groups.values() for it in group))
            beside = given.file.with_name(f"{given.file.name}.html")
            beside.write_text(page(groups), encoding="utf-8")
            print(beside)
        else:
            sheets = (answers.right(test, questions) for test in ("pre", "post"))
            result = gain(*sheets, guess=given.guess)
            rows = [
                f"{at:2d} {it.id:<20} {before:6.0%} {after:6.0%} {share:6.2f}"
                for at, (it, (before, after, share)) in enumerate(
                    zip(questions, result.by_question, strict=True), start=1
                )
            ]
            table = ["   question             before  after   gain", *rows]
            _tell(answers, "\n".join([result.text(), "", *table]))
    except (OSError, ValueError) as error:
        raise SystemExit(f"{given.file}: {error}") from None


def _tell(answers: Class, text: str) -> None:
    print(text or "There is no line that counts.")
    for line, _, reason in answers.refused:
        print(f"line {line} does not count: {reason}")


if __name__ == "__main__":
    main()
