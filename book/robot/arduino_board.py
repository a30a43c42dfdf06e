"""The Arduino sketch: its library written and compiled, and an ATmega328P that runs it, simulated.

    python book/robot/arduino_board.py WmrPark.zip

writes the library as the Arduino IDE adds it (Sketch, Include Library, Add .ZIP Library).
Compiling needs avr-gcc and Arduino's core, running cc and libsimavr (Debian: apt install gcc-avr
avr-libc arduino-core-avr gcc libc6-dev libsimavr-dev).
"""

from __future__ import annotations

import ctypes
import subprocess
import sys
import tempfile
import zipfile
from functools import cache
from pathlib import Path
from typing import NamedTuple

from wmrbook import robot_io
from wmrbook.robot_sheet import Robot
from wmrlib import symbolic

FOLDER = Path(__file__).parent / "arduino"
LIBRARY = FOLDER / "WmrPark"
CORE = Path("/usr/share/arduino/hardware/arduino/avr")
SIMAVR = Path("/usr/include/simavr/sim_avr.h")
NUMBERS = "my_robot_arduino.h"
CLOCK, BAUD = 16_000_000, 38_400
# As platform.txt of the core has them; its avr-gcc is newer than Debian's, which lacks DECIMAL_DIG.
_FLAGS = "-mmcu=atmega328p -DF_CPU=16000000L -DARDUINO=10819 -DARDUINO_AVR_UNO -DARDUINO_ARCH_AVR"
_FLAGS += " -Os -flto -fno-fat-lto-objects -ffunction-sections -fdata-sections"
_CPP = "-std=gnu++11 -fpermissive -fno-exceptions -fno-threadsafe-statics"
_CPP += " -DDECIMAL_DIG=__DECIMAL_DIG__"
_PARTS = CORE / "cores/arduino", CORE / "variants/standard"


def library(robot: Robot | None = None) -> dict[str, str]:
    """The library's files by their names in it: those of the repository, and what is printed."""
    texts = {
        path.relative_to(LIBRARY).as_posix(): path.read_text(encoding="utf-8")
        for path in sorted(LIBRARY.rglob("*"))
        if path.is_file()
    }
    for header in (symbolic.C_HEADER, symbolic.C_DRIVE, symbolic.C_FILTER_HEADER):
        texts[f"src/{header.name}"] = header.read_text(encoding="utf-8")
    texts[f"examples/Park/{NUMBERS}"] = robot_io.files(robot or Robot())[NUMBERS]
    return texts


def write_zip(path: Path) -> None:
    """Write the library for the Arduino IDE."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in library().items():
            archive.writestr(f"{LIBRARY.name}/{name}", text)


class Program(NamedTuple):
    """A compiled program, and its bytes of flash and of RAM besides the stack."""

    elf: bytes
    flash: int
    ram: int


def _gcc(folder: Path, *options: str | Path, command: str = "avr-gcc") -> str:
    words = [word for each in options for word in (str(each).split() if isinstance(each, str) else [each])]
    done = subprocess.run([command, *words], cwd=folder, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"{command}: {done.stderr}")
    return done.stdout


@cache
def _core() -> bytes:
    """Arduino's own part, as an archive."""
    includes = [f"-I{part}" for part in _PARTS]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        sources = [path for part in _PARTS for path in sorted(part.rglob("*.c*"))]
        for path in sources:
            language = _CPP if path.suffix == ".cpp" else "-std=gnu11"
            _gcc(folder, "-c -w", _FLAGS, language, *includes, path, f"-o {path.name}.o")
        objects = [f"{path.name}.o" for path in sources]
        _gcc(folder, "rcs core.a", *objects, command="avr-gcc-ar")
        return (folder / "core.a").read_bytes()


@cache
def compiled(robot: Robot = Robot(), changes: tuple[tuple[str, str], ...] = ()) -> Program:  # noqa: B008
    """The sketch for an Uno, with the robot's numbers, and texts of it changed for others."""
    texts = library(robot)
    sketch = texts["examples/Park/Park.ino"]
    for old, new in changes:
        if sketch.count(old) != 1:
            raise ValueError(f"changes has {old!r}: a text that is in the sketch once is needed")
        sketch = sketch.replace(old, new)
    # the IDE declares functions, and includes Arduino.h
    head = "#include <Arduino.h>\nvoid report(uint16_t longest);\n#line 1\n"
    return build({**texts, "examples/Park/Park.cpp": head + sketch}, "examples/Park/Park.cpp")


def build(texts: dict[str, str], main: str) -> Program:
    """Compile one file, which may include the others, against Arduino's core."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for place, text in texts.items():
            (folder / place).parent.mkdir(parents=True, exist_ok=True)
            (folder / place).write_text(text, encoding="utf-8")
        (folder / "core.a").write_bytes(_core())
        includes = [f"-I{part}" for part in (*_PARTS, folder / "src")]
        _gcc(folder, "-c -Wall -Wextra -Werror", _FLAGS, _CPP, *includes, main, "-o main.o")
        link = "-Os -flto -fuse-linker-plugin -Wl,--gc-sections -mmcu=atmega328p"
        _gcc(folder, link, "main.o core.a -o main.elf -lm")
        sizes = _gcc(folder, "main.elf", command="avr-size").split("\n")[1].split()[:3]
        text, data, bss = map(int, sizes)
        return Program((folder / "main.elf").read_bytes(), text + data, data + bss)


@cache
def _host() -> ctypes.CDLL:
    """sim.c as a library; the folder goes as soon as it is loaded."""
    with tempfile.TemporaryDirectory() as name:
        options = "-std=gnu11 -O2 -Wall -Wextra -Werror -shared -fPIC"
        _gcc(Path(name), options, FOLDER / "sim.c", "-o sim.so -lsimavr -lm", command="cc")
        host = ctypes.CDLL(str(Path(name, "sim.so")))
    host.sim_run.argtypes = [ctypes.c_uint32, ctypes.c_double, ctypes.c_double]
    host.sim_run.argtypes += [ctypes.c_int16, ctypes.c_int16, ctypes.c_int, ctypes.c_int, ctypes.c_int]
    return host


class Board:
    """An ATmega328P that runs a program; one at a time."""

    def __init__(self, program: Program, baud: int = BAUD) -> None:
        self.host, self.text = _host(), ""
        with tempfile.NamedTemporaryFile(suffix=".elf") as file:
            file.write(program.elf)
            file.flush()
            if not self.host.sim_open(file.name.encode(), baud):
                raise RuntimeError("simavr can't load the program")

    def send(self, data: bytes) -> None:
        """Bytes that its UART receives, one after the other at the baud."""
        self.host.sim_send(data, len(data))

    def run(self, seconds, quarters=(0.0, 0.0), field=(0, 0), answers=True, pressed=False, volts=12.0):
        """Run while the encoders turn to so many quarter steps; what the program sends meanwhile."""
        cycles, millivolts = round(CLOCK * seconds), round(250 * volts)
        state = self.host.sim_run(cycles, *quarters, *field, answers, pressed, millivolts)
        if state not in (2, 3):
            raise RuntimeError(f"the program crashed: simavr's state is {state}")
        letters = ctypes.create_string_buffer(4096)
        count = self.host.sim_said(letters, 4096)
        return letters.raw[:count]

    def pins(self) -> tuple[float, float, bool]:
        """Duty of the left and the right motor, -1 to 1, and whether they have power."""
        out = (ctypes.c_double * 3)()
        self.host.sim_pins(out)
        return out[0], out[1], bool(out[2])

    def hang(self, on: bool) -> None:
        """Catch the program in an endless loop, or let the next one go on."""
        self.host.sim_hang(on)

    def untouched(self) -> int:
        """Bytes of RAM that neither data nor stack ever reached."""
        return self.host.sim_untouched()


if __name__ == "__main__":
    write_zip(Path(sys.argv[1] if len(sys.argv) > 1 else "WmrPark.zip"))
