"""The example's drive on two processors that this machine imitates: how large, how fast, how right?

    python book/robot/boards.py

needs avr-gcc and simavr (an ATmega328P at 16 MHz), arm-linux-gnueabihf-gcc and qemu-arm (Debian:
apt install gcc-avr avr-libc simavr qemu-user gcc-arm-linux-gnueabihf libc6-dev-armhf-cross).
"""

from __future__ import annotations

import re
import subprocess
import tempfile
from pathlib import Path
from typing import NamedTuple

from wmrlib import symbolic

FOLDER = symbolic.C_DRIVE.parent
STRICT = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-Os", "-ffp-contract=off", "-DWMR_REAL=float"]
CLOCK_MHZ = 16.0
# The example's own arithmetic, a UART for printf, and a timer that counts every 8th cycle.
AVR = """#include <avr/io.h>
#include <avr/interrupt.h>
#include <avr/sleep.h>
#include <stdio.h>
#define main example
#include "example.c"
#undef main
static int send(char letter, FILE *to) {
  (void)to;
  while (!(UCSR0A & (1 << UDRE0))) {}
  UDR0 = (uint8_t)letter;
  return 0;
}
static FILE uart = FDEV_SETUP_STREAM(send, NULL, _FDEV_SETUP_WRITE);
int main(void) {
  stdout = &uart, UCSR0B = 1 << TXEN0, TCCR1A = 0, TCCR1B = 1 << CS11;
  example();
  printf("cycles %lu\\nmemory %u\\n", 8UL * most, (unsigned)sizeof(wmr_memory));
  cli();
  sleep_enable();
  sleep_cpu();
  return 0;
}
"""
TIMED = """static uint16_t most = 0;
static void counted_by_timer(int32_t *left, int32_t *right) {
  TCNT1 = 0;
  read_encoders(left, right);
}
static void rolled_by_timer(wmr_wheels wheels, WMR_REAL seconds) {
  const uint16_t now = TCNT1;
  if (now > most) most = now;
  set_wheels(wheels, seconds);
}
#define read_encoders counted_by_timer
#define set_wheels rolled_by_timer
"""


class Board(NamedTuple):
    """What the drive came to on a board: flash and RAM in bytes, and the longest period's work."""

    periods: int
    pose: tuple[float, float, float]
    flash: int
    ram: int
    memory: int  # bytes of it are wmr_memory
    work: float  # cycles, or on ARM instructions, in a period


def run(*command: str | Path, folder: Path) -> str:
    """What a command prints; RuntimeError with its words if it fails."""
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300)
    if done.returncode:
        raise RuntimeError(f"{command[0]}: {done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def sizes(prefix: str, folder: Path, name: str) -> tuple[int, int]:
    """Bytes of flash, and of RAM without the stack, of a compiled program."""
    numbers = run(f"{prefix}size", name, folder=folder).splitlines()[1].split()
    text, data, bss = map(int, numbers[:3])
    return text + data, data + bss


def _reached(text: str) -> tuple[int, tuple[float, float, float]]:
    number = r"(-?\d+\.\d+)"
    (found,) = re.findall(rf"(\d+) {number} {number} {number}", text)
    x, y, heading = map(float, found[1:])
    return int(found[0]), (x, y, heading)


def timed() -> str:
    """The example with a timer round what a real robot would compute in a period."""
    text = (FOLDER / "example.c").read_text(encoding="utf-8")
    place = "#endif\n\n/* What the sensors say."
    assert text.count(place) == 1
    return text.replace(place, TIMED + place)


def on_avr(example: str) -> tuple[str, int, int]:
    """What example.c, as changed, prints on an ATmega328P by simavr; its flash and RAM in bytes."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "example.c").write_text(example, encoding="utf-8")
        (folder / "board.c").write_text(AVR, encoding="utf-8")
        options = ["-mmcu=atmega328p", *STRICT, f"-I{FOLDER}", "-Wl,-u,vfprintf"]
        source = ["board.c", "-o", "board.elf", "-lprintf_flt", "-lm"]
        run("avr-gcc", *options, *source, folder=folder)
        flash, ram = sizes("avr-", folder, "board.elf")
        command = ["simavr", "-m", "atmega328p", "-f", str(int(1e6 * CLOCK_MHZ)), "board.elf"]
        said = run(*command, folder=folder)
    return re.sub(r"\x1b\[[\d;]*m|\.\.?$", "", said, flags=re.MULTILINE), flash, ram


def avr() -> Board:
    """On an ATmega328P, by simavr."""
    plain, flash, ram = on_avr(timed())
    (cycles,), (memory,) = re.findall(r"cycles (\d+)", plain), re.findall(r"memory (\d+)", plain)
    return Board(*_reached(plain), flash, ram, int(memory), float(cycles))


def arm() -> Board:
    """As 32-bit ARM code, by qemu; its size is that for a Cortex-M4 with a float unit."""
    with tempfile.TemporaryDirectory() as name:
        folder, periods = Path(name), (20, 40)
        options = [*STRICT, f"-I{FOLDER}", f"{FOLDER}/example.c"]
        gcc = "arm-linux-gnueabihf-gcc"
        run(gcc, *options, "-static", "-o", "example", "-lm", folder=folder)
        periods_driven, pose = _reached(run("qemu-arm", "example", folder=folder))
        cortex = ["-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16"]
        run(gcc, *options, *cortex, "-c", "-o", "example.o", folder=folder)
        flash, ram = sizes("arm-linux-gnueabihf-", folder, "example.o")
        text, counts = (FOLDER / "example.c").read_text(encoding="utf-8"), []
        assert text.count("count < 4000") == 1
        for count in periods:
            source = folder / "some.c"
            source.write_text(text.replace("count < 4000", f"count < {count}"), encoding="utf-8")
            options[-1] = "some.c"
            run(gcc, *options, "-static", "-o", "some", "-lm", folder=folder)
            one_by_one = ["qemu-arm", "-singlestep", "-d", "exec,nochain", "-D", "log", "some"]
            run(*one_by_one, folder=folder)
            with (folder / "log").open(encoding="utf-8", errors="replace") as log:
                counts.append(sum(line.startswith("Trace") for line in log))
    work = (counts[1] - counts[0]) / (periods[1] - periods[0])
    return Board(periods_driven, pose, flash, ram, ram, work)


def main() -> None:
    """Print the table."""
    for name, board, unit in (("ATmega328P", avr(), "cycles"), ("ARM", arm(), "instructions")):
        place = ", ".join(f"{value:.4f}" for value in board.pose)
        print(f"{name:10}  {board.periods} periods, to {place}")
        print(f"{'':10}  {board.flash} bytes of flash, {board.ram} of RAM;", end=" ")
        print(f"a period takes {board.work:.0f} {unit}", end="")
        print(f", {board.work / CLOCK_MHZ / 1e3:.1f} ms" if unit == "cycles" else "")


if __name__ == "__main__":
    main()
