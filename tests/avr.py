"""The printed C on a simulated ATmega328P at 16 MHz: what it prints, how large it is, how fast."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path
from typing import NamedTuple

from arduino_board import run, sizes
from compiled import INCLUDES

from wmrrobot import printing

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


class Parked(NamedTuple):
    """What the example's drive came to: flash and RAM in bytes, and the longest period's work."""

    periods: int
    pose: tuple[float, float, float]
    flash: int
    ram: int
    memory: int  # bytes of it are wmr_memory
    milliseconds: float


def printed_by(example: str) -> tuple[str, int, int]:
    """What example.c, as changed, prints on the board; its flash and RAM in bytes."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "example.c").write_text(example, encoding="utf-8")
        (folder / "board.c").write_text(AVR, encoding="utf-8")
        options = ["-mmcu=atmega328p", *STRICT, *INCLUDES, "-Wl,-u,vfprintf"]
        source = ["board.c", "-o", "board.elf", "-lprintf_flt", "-lm"]
        run("avr-gcc", *options, *source, folder=folder)
        flash, ram = sizes("avr-", folder, "board.elf")
        command = ["simavr", "-m", "atmega328p", "-f", str(int(1e6 * CLOCK_MHZ)), "board.elf"]
        output = run(*command, folder=folder)
    return re.sub(r"\x1b\[[\d;]*m|\.\.?$", "", output, flags=re.MULTILINE), flash, ram


def drive_of_the_example() -> Parked:
    """The example's drive, with a timer round what a real robot would compute in a period."""
    text = printing.C_EXAMPLE.read_text(encoding="utf-8")
    place = "#endif\n\n/* What the sensors say."
    assert text.count(place) == 1
    output, flash, ram = printed_by(text.replace(place, TIMED + place))
    number = r"(-?\d+\.\d+)"
    ((periods, *reached),) = re.findall(rf"(\d+) {number} {number} {number}", output)
    (cycles,), (memory,) = re.findall(r"cycles (\d+)", output), re.findall(r"memory (\d+)", output)
    x, y, heading = map(float, reached)
    longest = float(cycles) / CLOCK_MHZ / 1e3
    return Parked(int(periods), (x, y, heading), flash, ram, int(memory), longest)
