"""A drive by three processes that know each other by ROS 2 alone: node, lawn and goals.

python book/robot/ros2/three.py    # each fault of drive_faults.py that ROS can show
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
sys.path[:0] = [str(path) for path in (HERE, HERE / "wmr_park", HERE.parent)]

import drive_faults  # noqa: E402
import interfaces  # noqa: E402
import numpy as np  # noqa: E402
from compiled import CDrive  # noqa: E402
from drive_faults import CASES, Case  # noqa: E402
from wmr_park import adapter  # noqa: E402
from world import CASE, WHEELS  # noqa: E402

import wmrlib as wmr  # noqa: E402
from wmrlib import paper  # noqa: E402

# No message shows that the program hangs: the motors' driver must stop when `cmd_vel` falls silent.
SHOWN = [case for case in CASES if not case.wrong.get("hangs")]
# The time of a fix and its age are one stamp in ROS: a stamp that lags behind is old before long.
OTHERWISE = dict.fromkeys(("message frozen", "time goes back"), "wait: fix too old")
_RECORDED = """import json, os
import wmrlib as wmr
from wmr_park import node
class Recorded(wmr.Drive):
    def __init__(self, *given):
        super().__init__(*given)
        self.file = open(os.environ["WMR_RECORD"], "w", buffering=1)
    def step(self, seen):
        speeds = super().step(seen)
        print(json.dumps([seen, speeds, self.state, self.reason]), file=self.file)
        return speeds
node.ParkNode.drive_kind = Recorded
node.main()
"""


def parameters(case: Case) -> dict[str, Any]:
    """The node's parameters for a case of drive_faults.py."""
    told = adapter.DEFAULTS | {
        "start": [paper.GPS_POINT_1.lat, paper.GPS_POINT_1.lon],
        "fence": list(map(float, case.fence)),
    }
    told |= {f"gains.{name}": value for name, value in drive_faults.GAINS._asdict().items()}
    rules = wmr.Rules(**case.rules)._asdict()
    told |= {adapter.OWN.get(name, name): value for name, value in rules.items()}
    return told | WHEELS._asdict() | {"filter": False}


class Three:
    """The three processes, from `with` to its end."""

    def __init__(self, prefix: Path, domain: int = 0, *arguments: str) -> None:
        # The lawn keeps step, however slow the machine is: the watchdog is for real time, and no
        # message may be lost.
        self.arguments = list(arguments or ("-p", "watchdog:=60.0"))
        for topic in ("imu", "fix", "battery", "odom"):
            quality = f"qos_overrides./{topic}.subscription.reliability:=reliable"
            self.arguments += ["-p", quality]
        self.folder = tempfile.TemporaryDirectory()
        self.record = Path(self.folder.name, "record")
        self.environment = interfaces.environment(prefix, domain)
        self.environment["WMR_RECORD"] = str(self.record)

    def __enter__(self) -> Three:
        self.node = self.begin("-c", _RECORDED, "--ros-args", *self.arguments)
        self.lawn, self.goals = (
            self.begin(str(HERE / f"{name}_node.py")) for name in ("lawn", "goals")
        )
        return self

    def begin(self, *command: str) -> subprocess.Popen:
        """A process of this Python, with lines in and out."""
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
        return subprocess.Popen([sys.executable, *command], env=self.environment, **pipes)

    def __exit__(self, *how: object) -> None:
        for process in (self.goals, self.lawn, self.node):
            if process is self.node:
                process.terminate()
            process.communicate()
        self.folder.cleanup()

    def ask(self, process: subprocess.Popen, wish: Any) -> Any:
        """A line to a process, and its answer."""
        self.tell(process, wish)
        return self.answer(process)

    def tell(self, process: subprocess.Popen, wish: Any) -> None:
        process.stdin.write(json.dumps(wish) + "\n")
        process.stdin.flush()

    def answer(self, process: subprocess.Popen) -> Any:
        line = process.stdout.readline()
        if not line:
            raise RuntimeError(f"{process.args[1][:80]} has ended")
        return json.loads(line)

    def run(self, told: dict[str, Any], goal: wmr.Pose | None, wish: dict) -> dict:
        """A drive: what the lawn saw of it, and what the action answered."""
        if refused := self.ask(self.goals, ["set", told]):
            raise ValueError(refused)
        if not self.ask(self.goals, ["park", goal and list(map(float, goal))]):
            raise ValueError("the goal was refused")
        ended = self.ask(self.lawn, wish)
        if ended["state"] not in ("parked", "stopped"):
            self.ask(self.goals, ["cancel"])
        return ended | {"answer": self.ask(self.goals, ["result"])}

    def steps(self) -> list:
        """Each period of the last drive: what was seen, the wheels' speeds, state and reason."""
        return [json.loads(line) for line in self.record.read_text(encoding="utf-8").splitlines()]


def by_c(told: dict[str, Any], goal: wmr.Pose, steps: list) -> list[int]:
    """The periods in which the C header does not do what the node did."""
    drive, differ = adapter.drive_of(adapter.DEFAULTS | told, goal, CDrive), []
    for k, (seen, speeds, *decided) in enumerate(steps):
        off = max(map(abs, np.subtract(drive.step(wmr.Seen(*seen)), speeds)))
        if off > 1e-9 or [drive.state, drive.reason] != decided:
            differ.append(k)
    return differ


def exact(
    three: Three,
    start: wmr.Pose,
    goal: wmr.Pose,
    gains: wmr.Gains,
    wheels: wmr.Wheels,
    rules: wmr.Rules,
    longest: float = 200.0,
) -> list[list[float]]:
    """Drive with exact sensors over ROS; the poses at the start and after each period.

    Parameters
    ----------
    start, goal : Pose, m east and north of the paper's first point
    gains, wheels, rules : as for `wmr.Drive`; the last turn is the usual one
    longest : float, s
    """
    told = parameters(CASES[0]._replace(rules=rules._asdict(), fence=adapter.DEFAULTS["fence"]))
    told |= wheels._asdict() | {f"gains.{name}": k for name, k in gains._asdict().items()}
    wish = {"start": list(start), "width": wheels.track_width, "longest": longest}
    return three.run(told, goal, wish)["poses"]


def main() -> None:
    """Print what each drive came to."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--domain", type=int, default=0)
    parser.add_argument("--build", type=Path, default=Path(tempfile.gettempdir(), "wmr_interfaces"))
    given = parser.parse_args()
    with Three(interfaces.build(given.build), given.domain) as three:
        for case in SHOWN:
            told = parameters(case)
            ran = three.run(told, CASE.goal, {"case": case.name})
            steps = three.steps()
            end, differ = ": ".join(filter(None, steps[-1][2:])), by_c(told, CASE.goal, steps)
            print(f"{case.name:33} {end:41} {ran['blind']:6.2f} m; C differs in {len(differ)}")


if __name__ == "__main__":
    main()
