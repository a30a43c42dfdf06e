"""The printed drive on a simulated AVR, period by period, for a comparison with other programs.

Its sensors are exact and its wheels ideal: only the arithmetic differs, float there, double here.
"""

from __future__ import annotations

import math
import struct

from arduino_board import Board, build, library
from world import positions as positions

import wmrlib as wmr
from wmrlib import trust

BAUD = 250_000
PROGRAM = """#include <WmrPark.h>
static const wmr_plan plan = {@plan@};
static wmr_memory memory;
static struct { float left, right, x, y, heading; } sent;
void setup() { Serial.begin(@baud@); }
void loop() {
  if (Serial.readBytes((char *)&sent, sizeof sent) != sizeof sent) return;
  wmr_seen seen = wmr_seen();
  seen.seconds = seen.later = @period@, seen.left = sent.left, seen.right = sent.right;
  seen.goal_inside = seen.inside = seen.fresh = 1, seen.quality = 4;
  seen.x = sent.x, seen.y = sent.y, seen.heading = sent.heading;
  const wmr_wheels wheels = wmr_drive(&memory, &seen, &plan);
  Serial.write((const uint8_t *)&wheels.left, 4);
  Serial.write((const uint8_t *)&wheels.right, 4);
  Serial.write((uint8_t)memory.state);
}
"""


class AvrDrive(wmr.Drive):
    """A `Drive` whose steps an ATmega328P computes; `Seen` has a fix each `period`, in s."""

    def __init__(self, *given, period: float, **named) -> None:
        super().__init__(*given, **named)
        if self.law != "corrected":
            raise ValueError(f"law = {self.law!r} is not allowed: 'corrected' is needed")
        parts = self.goal, self.gains, self.wheels, self.end, self.rules
        plan = ", ".join(f"{{{', '.join(map(_number, part))}}}" for part in parts)
        text = PROGRAM.replace("@plan@", plan).replace("@period@", _number(period))
        texts = library() | {"main.cpp": text.replace("@baud@", str(BAUD))}
        self.program = build(texts, "main.cpp")
        self.reset()

    def reset(self) -> None:
        super().reset()
        self._state = trust.WAIT
        if hasattr(self, "program"):
            self.board = Board(self.program, BAUD)
            self.board.run(0.01)

    @property
    def state(self) -> str:
        return trust.STATES[self._state]

    def step(self, seen: wmr.Seen) -> tuple[float, float]:
        self.board.send(struct.pack("<5f", seen.left, seen.right, seen.x, seen.y, seen.heading))
        answer = b""
        for _ in range(100):
            answer += self.board.run(0.0005)
            if len(answer) == 9:
                left, right, self._state = struct.unpack("<2fB", answer)
                return left, right
        raise RuntimeError(f"the board sent {len(answer)} bytes of 9")


def _number(value: float) -> str:
    if math.isinf(value):
        return "INFINITY"
    return f"{value:.0f}" if value == int(value) else f"{value!r}f"
