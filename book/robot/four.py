"""One robot, four programs: the drive of example.c by Python, JavaScript, C on AVR, and ROS 2.

    python book/robot/four.py [--build FOLDER] [--json FILE]

needs node, avr-gcc and simavr (see boards.py), and for ROS 2 what `pip install '.[robot]'` brings;
a program whose tools are missing is left out, and said to be. Poses are compared period by period
from the first in which a program moves, since JavaScript has no fixes to wait for.
"""

from __future__ import annotations

import argparse
import itertools
import json
import math
import re
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path

import boards
import numpy as np
from world import positions

import wmrlib as wmr

PERIOD, LONGEST = 0.05, 200.0  # s
GAINS = wmr.Gains(0.2, 2.0, 2.0, 4.0)
WHEELS = wmr.Wheels(0.5, max_speed=2.0, min_speed=0.1)
RULES = wmr.Rules(arrival_radius=0.05)
START = wmr.Pose(0.0, 0.0, math.radians(72.0))
ENDS = wmr.GeoPoint(lat=33.273572, lon=44.373160), wmr.GeoPoint(lat=33.274087, lon=44.373264)
GOAL = wmr.Pose(*map(float, wmr.local_position(*ENDS)), -math.pi / 3)
KIT = Path(__file__).parent.parent / "wmrbook" / "panel" / "kit" / "simulate.js"
JAVASCRIPT = """import {{ simulate }} from {kit};
const run = simulate({options});
console.log(JSON.stringify(Array.from(run.x, (x, k) => [x, run.y[k], run.heading[k]])));
"""
DIFFERS = {
    "Python": "64 bits; it waits for three fixes",
    "JavaScript": "64 bits, and the kit's loop in place of the table: it waits for no fix",
    "C on AVR": "32 bits, which tell 58 m to within 4 µm, in some 700 additions",
    "ROS 2": "64 bits, but places travel as degrees, and wheels' speeds as a twist",
}


def python() -> list:
    """By `wmr.Drive`, with exact sensors."""
    return positions(wmr.Drive(GOAL, GAINS, WHEELS, rules=RULES), START, PERIOD, LONGEST)


def javascript() -> list:
    """By the kit that the pages run, in node."""
    wheels = {name: getattr(WHEELS, name) for name in ("track_width", "max_speed", "min_speed")}
    options = {"law": "corrected", "method": "arc", "dt": PERIOD, "duration": LONGEST}
    options |= {"arrivalRadius": RULES.arrival_radius, "start": START, "goal": GOAL}
    options |= {"gains": GAINS._asdict(), "wheels": wheels, "lastTurn": wmr.LastTurn()._asdict()}
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder, "run.mjs")
        kit, given = json.dumps(KIT.as_uri()), json.dumps(options)
        program.write_text(JAVASCRIPT.format(kit=kit, options=given), encoding="utf-8")
        done = subprocess.run(["node", program], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def c_on_avr() -> list:
    """By example.c on a simulated ATmega328P, which prints each pose."""
    text, place = boards.timed(), "    if (memory.reason != reason)"
    assert text.count(place) == 1
    line = '    printf("at %.6f %.6f ", (double)robot.x, (double)robot.y);\n'
    line += '    printf("%.6f\\n", (double)robot.heading);\n'
    said, *_ = boards.on_avr(text.replace(place, line + place))
    number = r"(-?\d+\.\d+)"
    found = re.findall(rf"at {number} {number} {number}", said)
    start = [round(it, 6) for it in START]  # as it prints the others: it has not moved
    return [start, *(list(map(float, pose)) for pose in found)]


def ros_2(build: Path, domain: int) -> list:
    """By the node in book/robot/ros2, with a lawn that keeps step."""
    sys.path.insert(0, str(Path(__file__).parent / "ros2"))
    import interfaces
    import three

    with three.Three(interfaces.build(build), domain) as processes:
        return three.exact(processes, START, GOAL, GAINS, WHEELS, RULES, LONGEST)


def driven(poses: list) -> np.ndarray:
    """East, north and heading in m and rad, from the last pose before it first moved."""
    at = np.array(poses)
    moved = np.flatnonzero(np.any(at != at[0], axis=1))
    return at[moved[0] - 1 :]


def apart(a: np.ndarray, b: np.ndarray) -> tuple[float, float]:
    """The largest distance and turn in a period, m and rad; who has parked stays."""
    count = max(len(a), len(b))
    a, b = (np.vstack([it, np.repeat(it[-1:], count - len(it), axis=0)]) for it in (a, b))
    x, y, turn = (a - b).T
    return float(np.max(np.hypot(x, y))), float(np.max(np.abs(wmr.wrap_angle(turn))))


def compared(build: Path, domain: int = 39) -> dict:
    """Each program's periods and end, why it differs, and how far pairs are apart, in m and rad.

    Over ROS 2 two that compare at once need a domain each, or they hear each other.
    """
    programs = {"Python": python, "JavaScript": javascript, "C on AVR": c_on_avr}
    if find_spec("rclpy"):
        programs["ROS 2"] = lambda: ros_2(build, domain)
    ran, left_out = {}, {} if "ROS 2" in programs else {"ROS 2": "no rclpy"}
    for name, program in programs.items():
        try:
            ran[name] = driven(program())
        except FileNotFoundError as lacking:
            left_out[name] = f"no {lacking.filename}"
    rows = {
        name: {"periods": len(at) - 1, "end": at[-1].round(6).tolist(), "differs": DIFFERS[name]}
        for name, at in ran.items()
    }
    pairs = [[a, b, *apart(ran[a], ran[b])] for a, b in itertools.combinations(ran, 2)]
    return {"programs": rows, "apart": pairs, "left_out": left_out}


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=Path, default=Path(tempfile.gettempdir(), "wmr_interfaces"))
    parser.add_argument("--json", type=Path)
    given = parser.parse_args()
    found = compared(given.build)
    for name, row in found["programs"].items():
        x, y, heading = row["end"]
        end = f"{x:.4f}, {y:.4f}, {math.degrees(heading):.3f} deg"
        print(f"{name:10} {row['periods']:5} periods to {end}; {row['differs']}")
    for a, b, far, turned in found["apart"]:
        print(f"{a:10} {b:10} {1000.0 * far:.3g} mm {math.degrees(turned):.3g} deg")
    for name, why in found["left_out"].items():
        print(f"{name:10} left out: {why}")
    if given.json:
        given.json.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
