"""The Arduino library written and compiled, and a simulated ATmega328P that runs its sketch.

    python book/robot/arduino_board.py WmrPark.zip

writes the library for the Arduino IDE: Sketch, Include Library, Add .ZIP Library. To compile needs
avr-gcc and Arduino's core, to run cc and libsimavr (Debian: apt install gcc-avr avr-libc
arduino-core-avr gcc libc6-dev libsimavr-dev).
"""

from __future__ import annotations

import argparse
import ctypes
import re
import subprocess
import tempfile
import zipfile
from functools import cache
from pathlib import Path
from typing import NamedTuple

from wmrlib import symbolic
from wmrrobot import files, printing
from wmrrobot.sheets import Robot

FOLDER = Path(__file__).parent / "arduino"
LIBRARY = FOLDER / "WmrPark"
CORE = Path("/usr/share/arduino/hardware/arduino/avr")
NUMBERS = "my_robot.h"
CLOCK, BAUD = 16_000_000, 38_400
_RESET, _SOUND = 0, (2, 3)  # of simavr's states: by the watchdog; running, sleeping
# As in the core's platform.txt; Debian's avr-gcc is older than Arduino's and lacks DECIMAL_DIG.
_FLAGS = "-mmcu=atmega328p -DF_CPU=16000000L -DARDUINO=10819 -DARDUINO_AVR_UNO -DARDUINO_ARCH_AVR"
_FLAGS += " -Os -flto -fno-fat-lto-objects -ffunction-sections -fdata-sections"
_CPP = "-std=gnu++11 -fpermissive -fno-exceptions -fno-threadsafe-statics"
_CPP += " -DDECIMAL_DIG=__DECIMAL_DIG__"
_PARTS = CORE / "cores/arduino", CORE / "variants/standard"


def run(*command: str | Path, folder: Path) -> str:
    """The output of a command; RuntimeError with its words if it fails."""
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300)
    if done.returncode:
        raise RuntimeError(f"{command[0]}: {done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def sizes(prefix: str, folder: Path, name: str) -> tuple[int, int]:
    """Bytes of flash, and of RAM without the stack, of a compiled program."""
    numbers = run(f"{prefix}size", name, folder=folder).splitlines()[1].split()
    text, data, bss = map(int, numbers[:3])
    return text + data, data + bss


def library(robot: Robot | None = None) -> dict[str, str]:
    """The library's files by their names in it: those of the repository, and what is printed."""
    texts = {
        path.relative_to(LIBRARY).as_posix(): path.read_text(encoding="utf-8")
        for path in sorted(LIBRARY.rglob("*"))
        if path.is_file()
    }
    for header in (symbolic.C_HEADER, printing.C_DRIVE, printing.C_FILTER_HEADER):
        texts[f"src/{header.name}"] = header.read_text(encoding="utf-8")
    texts[f"examples/Park/{NUMBERS}"] = files(robot or Robot())[NUMBERS]
    return texts


def write_zip(path: Path) -> None:
    """Write the library for the Arduino IDE."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in library().items():
            archive.writestr(f"{LIBRARY.name}/{name}", text)


class Program(NamedTuple):
    """A compiled program, its bytes of flash, and its bytes of RAM without the stack."""

    elf: bytes
    flash: int
    ram: int


@cache
def _core() -> bytes:
    """Arduino's own part, as an archive."""
    sources = [path for part in _PARTS for path in sorted(part.glob("*.c*"))]
    gcc = ["avr-gcc", "-c", "-w", *_FLAGS.split(), *(f"-I{part}" for part in _PARTS)]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for path in sources:
            language = _CPP if path.suffix == ".cpp" else "-std=gnu11"
            run(*gcc, *language.split(), path, "-o", f"{path.name}.o", folder=folder)
        objects = (f"{path.name}.o" for path in sources)
        run("avr-gcc-ar", "rcs", "core.a", *objects, folder=folder)
        return (folder / "core.a").read_bytes()


@cache
def compiled(robot: Robot, changes: tuple[tuple[str, str], ...] = ()) -> Program:
    """The library's sketch with the robot's numbers.

    Each of the changes is a text that is in the library once, and the one in its place.
    """
    texts = library(robot)
    for old, new in changes:
        places = [name for name, text in texts.items() if old in text]
        if len(places) != 1 or texts[places[0]].count(old) != 1:
            raise ValueError(f"changes has {old!r}: a text that is in the library once is needed")
        texts[places[0]] = texts[places[0]].replace(old, new)
    sketch = texts["examples/Park/Park.ino"]  # the IDE includes Arduino.h and declares functions
    declared = ";\n".join(re.findall(r"^(void \w+\(.*\)) {$", sketch, re.MULTILINE))
    head = f'#include <Arduino.h>\n{declared};\n#line 1 "Park.ino"\n'
    texts["examples/Park/Park.cpp"] = head + sketch
    return build(texts, "examples/Park/Park.cpp")


def build(texts: dict[str, str], main: str) -> Program:
    """Compile one of the files, which may include the others, with Arduino's core, for an Uno."""
    gcc = ["avr-gcc", *f"-c -Wall -Wextra -Werror {_FLAGS} {_CPP}".split()]
    gcc += [f"-I{part}" for part in (*_PARTS, "src")]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for place, text in texts.items():
            (folder / place).parent.mkdir(parents=True, exist_ok=True)
            (folder / place).write_text(text, encoding="utf-8")
        (folder / "core.a").write_bytes(_core())
        run(*gcc, main, "-o", "main.o", folder=folder)
        link = "avr-gcc -Os -flto -fuse-linker-plugin -Wl,--gc-sections -mmcu=atmega328p"
        run(*f"{link} main.o core.a -o main.elf -lm".split(), folder=folder)
        return Program((folder / "main.elf").read_bytes(), *sizes("avr-", folder, "main.elf"))


@cache
def _simulator() -> ctypes.CDLL:
    """sim.c as a library; the folder goes as soon as it is loaded."""
    options = "-std=gnu11 -O2 -Wall -Wextra -Werror -shared -fPIC"
    with tempfile.TemporaryDirectory() as name:
        command = ["cc", *options.split(), FOLDER / "sim.c", "-o", "sim.so", "-lsimavr", "-lm"]
        run(*command, folder=Path(name))
        sim = ctypes.CDLL(str(Path(name, "sim.so")))
    whole, real = ctypes.c_int, ctypes.c_double
    sim.sim_run.argtypes = [ctypes.c_uint32, real, real, whole, whole, whole, whole, whole]
    return sim


class Inputs(NamedTuple):
    """The inputs at the board's pins: the encoders' quarter steps and the field, in counts.

    `field` is None for a compass that does not answer.
    """

    quarters: tuple[float, float] = (0.0, 0.0)
    field: tuple[float, float] | None = None
    pressed: bool = False  # the emergency stop
    volts: float = 3.0  # at the battery's pin


class Board:
    """An ATmega328P that runs a program, one at a time."""

    def __init__(self, program: Program, baud: int = BAUD) -> None:
        self.sim, self.program, self.baud, self.resets = _simulator(), program, baud, 0
        self._open()

    def _open(self) -> None:
        with tempfile.NamedTemporaryFile(suffix=".elf") as file:
            file.write(self.program.elf)
            file.flush()
            if not self.sim.sim_open(file.name.encode(), self.baud):
                raise RuntimeError("simavr can't load the program")

    def send(self, data: bytes) -> None:
        """Let its UART receive bytes, one after the other at the baud."""
        self.sim.sim_send(data, len(data))

    def run(self, seconds: float, inputs: Inputs = Inputs()) -> bytes:  # noqa: B008 (constant)
        """Run, while the encoders turn to their quarter steps; what the program sends meanwhile."""
        answers = inputs.field is not None
        x, y = map(round, inputs.field or (0, 0))
        given = *inputs.quarters, x, y, answers, inputs.pressed, round(1000 * inputs.volts)
        state = self.sim.sim_run(round(CLOCK * seconds), *given)
        if state == _RESET:
            self.resets += 1
            self._open()
            return b""
        if state not in _SOUND:
            raise RuntimeError(f"the program crashed: simavr is in state {state}")
        letters = ctypes.create_string_buffer(4096)
        count = self.sim.sim_said(letters, len(letters))
        return letters.raw[:count]

    def pins(self) -> tuple[float, float, bool]:
        """Duty of the left and the right motor, -1 to 1, and whether they have power."""
        out = (ctypes.c_double * 3)()
        self.sim.sim_pins(out)
        return out[0], out[1], bool(out[2])

    def hang(self) -> None:
        """Catch the program in an endless loop where it is, until it is reset."""
        self.sim.sim_hang()

    def untouched(self) -> int:
        """Bytes of RAM that neither data nor stack ever reached."""
        return self.sim.sim_untouched()


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("path", type=Path, nargs="?", default="WmrPark.zip", help="of the library")
    write_zip(parser.parse_args().path)
