"""Attack wmrlib at a size given, and print a table of what went wrong.

    python tests/stress.py [ATTACK ...] [--runs 100000] [--files 10000] [--examples 1000]
                           [--mutants 100] [--jobs 2] [--seed 1]

runs        random runs in every method, held against each other and against the Lyapunov proof
files       damaged NMEA, GPX and CSV files: a ValueError, or all that is undamaged
hosts       no home, nothing writable, full disks, damaged caches: it runs and gives the same
properties  the hypothesis tests with more examples, other ones with another seed
mutants     tests/mutants.py

Without a name, all of them. The exit status is 1 if anything went wrong.
"""

from __future__ import annotations

import argparse
import math
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from functools import reduce
from operator import xor
from pathlib import Path
from typing import NamedTuple

import numpy as np
from oracle import integrated

import wmrlib as wmr

TESTS = Path(__file__).resolve().parent
LAWS = ("corrected", "printed", "aicardi")
RUNS, FILES = 20_000, 250  # in one chunk
REFEREED = 5  # runs of a chunk for which the slow oracle is asked anyhow
ALIKE = {False: 2e-6, True: 2e-4}  # without and with wheel limits, as `sweep` promises, and double
NUDGE, CHAOTIC = (
    1e-12,
    1e-8,
)  # m and rad; who ends so far from a start so near magnifies any rounding
LOST = 1e4  # m or rad: steps too long for the law have gone astray
ROUGHLY = 0.01  # so far apart are fine Runge-Kutta steps, which know nothing of corners
SLOW = 5.0  # s, for a file of a few kilobytes


class Row(NamedTuple):
    """So many were tried, and so many were wrong; `seen` shows the first of these."""

    attack: str
    held: str
    tried: int
    wrong: int
    seen: tuple[str, ...] = ()


# Runs --------------------------------------------------------------------------------------------


class Runs(NamedTuple):
    """Many runs and the options that they have in common."""

    starts: wmr.Pose
    goals: wmr.Pose
    gains: wmr.Gains
    options: dict

    def sweep(self, **more) -> wmr.Arrival:
        return wmr.sweep(*self[:3], progress=False, **self.options | more)

    def of(self, few: np.ndarray) -> Runs:
        return Runs(*(type(each)(*(v[few] for v in each)) for each in self[:3]), self.options)

    def one(self, i: int) -> list:
        return [type(each)(*(float(values[i]) for values in each)) for each in self[:3]]

    def shown(self, i: int) -> str:
        given = [f"{name}={value!r}" for name, value in self.options.items()]
        return f"wmr.sweep({', '.join([*map(repr, self.one(i)), *given])})"

    def row(self, held: str, wrong: np.ndarray, tried: int = RUNS) -> Row:
        found = np.flatnonzero(wrong)
        return Row("runs", held, tried, found.size, tuple(map(self.shown, found[:3])))


def some_runs(rng: np.random.Generator) -> tuple[Runs, float]:
    """Runs of one law, and the largest of their rates (1/s), to which their time is fitted."""
    rate = 10 ** rng.uniform(-0.5, 2.0)
    lam, frequency, k_alpha = rate * 10 ** rng.uniform(-2.0, 0.0, (3, RUNS))
    v_max, far = 10 ** rng.uniform(-1.0, 1.0, RUNS), 10 ** rng.uniform(-2.0, 2.0, RUNS)
    x, y = rng.uniform(-100.0, 100.0, (2, RUNS))
    bearing, heading, goal_heading = rng.uniform(-math.pi, math.pi, (3, RUNS))
    gains = wmr.Gains(lam / v_max, k_alpha, (frequency / lam) ** 2, v_max)
    if (law := str(rng.choice(LAWS))) == "aicardi":
        gains = gains._replace(k_rho=lam)
    elif law == "printed":  # which settles, whatever theta is, if it turns fast enough
        h = np.minimum(gains.h, 0.3)
        gains = gains._replace(k_alpha=np.maximum(k_alpha, 1.5 * lam * (1.0 + math.pi * h)), h=h)
    wheels = wmr.WheelLimits(rng.uniform(0.1, 1.0), 10 ** rng.uniform(-0.5, 1.0))
    options = {
        "law": law,
        "duration": 200.0 / rate,
        "dt": 2.0 / rate,
        "arrival_radius": 10 ** rng.uniform(-2.0, 0.0),
        "wheels": wheels if rng.random() < 0.5 else None,
    }
    starts = wmr.Pose(x - far * np.cos(bearing), y - far * np.sin(bearing), heading)
    return Runs(starts, wmr.Pose(x, y, goal_heading), gains, options), rate


def apart(some: wmr.Arrival, others: wmr.Arrival) -> np.ndarray:
    """How far apart two accounts of the same runs are (of what is over 1, the share)."""
    off = np.subtract(some.heading_error, others.heading_error)
    parts = [np.where(np.isfinite(off), wmr.wrap_angle(np.nan_to_num(off)), np.inf)]
    for name in ("time", "path_length", "distance"):
        one, other = (np.asarray(getattr(each, name)) for each in (some, others))
        both = np.isfinite(one) & np.isfinite(other)
        one, other = np.where(both, one, 0.0), np.where(both, other, 0.0)
        parts.append((one - other) / np.maximum(1.0, np.abs(other)))
    return np.max(np.abs(parts), axis=0)


def attack_runs(seed: int) -> list[Row]:
    rng = np.random.default_rng(seed)
    runs, rate = some_runs(rng)
    ends, gains, radius = runs.sweep(), runs.gains, runs.options["arrival_radius"]
    begin = wmr.polar_error(runs.starts, runs.goals)
    to_go, slack = np.maximum(begin.rho - radius, 0.0), 1.0 - 1e-6
    numbers = np.all(np.isfinite([ends.heading_error, ends.peak_omega, ends.path_length]), axis=0)
    there = np.abs(ends.distance - np.minimum(begin.rho, radius)) < 1e-6
    late = ends.time > runs.options["duration"]
    fast = np.isfinite(ends.time) & (ends.time * gains.v_max < slack * to_go)
    rows = [
        runs.row(
            "an arrival is on the radius and in time, all else is outside",
            ~numbers
            | np.where(
                ends.arrived, ~there | late, (ends.distance < radius) | np.isfinite(ends.time)
            ),
        ),
        runs.row(
            "no way is shorter than the straight line",
            ends.path_length < slack * (begin.rho - ends.distance),
        ),
    ]
    if runs.options["law"] != "aicardi":
        rows.append(runs.row("nobody drives faster than v_max", fast))
    if runs.options["law"] == "corrected":
        left = begin.alpha**2 + gains.h * begin.theta**2  # the part of V that falls by itself
        bound = np.sqrt(left * (1.0 + 1.0 / gains.h))
        rows.append(
            runs.row(
                "no heading error is more than V allows",
                slack * np.abs(ends.heading_error) > bound + 1e-6,
            )
        )
    return [*rows, row_of_methods(runs, ends, rate, rng), *rows_of_samples(runs, rate, rng)]


def row_of_methods(runs: Runs, ends: wmr.Arrival, rate: float, rng) -> Row:
    """Continuous against fine Runge-Kutta steps; where they differ, and now and then, an oracle.

    What a nudge of 1e-10 changes is what no method can know: a hundred times that is let pass.
    """
    nudged = runs._replace(starts=runs.starts._replace(heading=runs.starts.heading + 1e-10))
    unknown = 100.0 * apart(nudged.sweep(), ends)
    few = rng.choice(RUNS, 1000, replace=False)
    some, mine = runs.of(few), wmr.Arrival(*(values[few] for values in ends))
    asked = few[~(apart(mine, in_small_steps(some, mine, rate)) < ROUGHLY + unknown[few])]
    wrong = np.zeros(RUNS, dtype=bool)
    for i in {*asked.tolist(), *rng.choice(RUNS, REFEREED).tolist()}:
        truth = wmr.Arrival(*integrated(*runs.one(i), **runs.options))
        mine = wmr.Arrival(*(values[i] for values in ends))
        allowed = ALIKE[runs.options["wheels"] is not None] + unknown[i]
        close = apart(mine, truth) < allowed
        close &= abs(mine.peak_omega - truth.peak_omega) < allowed * max(1.0, truth.peak_omega)
        late = runs.options["duration"] - min(mine.time, truth.time) < allowed * truth.time
        wrong[i] = not (close and (mine.arrived == truth.arrived or late))
    return runs.row("continuous, Runge-Kutta and the oracle agree", wrong)


def in_small_steps(runs: Runs, ends: wmr.Arrival, rate: float) -> wmr.Arrival:
    """The runs for as long as they are said to take, by Runge-Kutta steps of order 4.

    Who comes within the radius before, or is lost by these steps, is off by infinity.
    """
    law, wheels, radius = (runs.options[name] for name in ("law", "wheels", "arrival_radius"))

    def rates(rho, alpha, theta, _):
        v, omega = wmr.control_law(rho, alpha, theta, runs.gains, law=law)
        v, omega = wmr.limit_wheels(v, omega, wheels) if wheels else (v, omega)
        return np.array([*wmr.polar_rate(rho, alpha, v, omega), np.abs(v)])

    whole = np.minimum(ends.time, runs.options["duration"])
    steps = math.ceil(10.0 * rate * runs.options["duration"])
    dt, begin = whole / steps, wmr.polar_error(runs.starts, runs.goals)
    state = np.array([*begin, np.zeros(whole.size)])
    early = np.zeros(whole.size, dtype=bool)
    for _ in range(steps):
        early |= (state[0] < radius * (1.0 - ROUGHLY)) & (begin.rho > radius)
        slope = rates(*state)
        total, weights = slope, ((0.5, 2.0), (0.5, 2.0), (1.0, 1.0))
        for share, weight in weights:
            slope = rates(*(state + share * dt * slope))
            total = total + weight * slope
        new = state + dt / 6.0 * total
        early |= ~np.all(np.abs(new) < LOST, axis=0)
        state = np.where(early, state, new)
    rho, alpha, theta, length = state
    error = np.where(early, np.inf, wmr.wrap_angle(theta - alpha))
    return ends._replace(heading_error=error, path_length=length, distance=rho)


def rows_of_samples(runs: Runs, rate: float, rng) -> Iterator[Row]:
    """Sampled runs are those of `simulate`, and go to the continuous one as the step shrinks."""
    few = rng.choice(RUNS, 100, replace=False)
    some = runs.of(few)
    short = {"duration": 4.0 / rate, "arrival_radius": 0.0, "dt": 0.04 / rate}
    truth, paths = some.sweep(**short, trajectories=True)
    turns = np.max(np.abs([paths.alpha, paths.theta]), axis=(0, 2)) > 3.1  # sampled laws wrap these
    nudged = some._replace(starts=wmr.Pose(*(each + NUDGE for each in some.starts)))
    for method in ("arc", "euler"):
        options = {"dt": 0.2 / rate, "method": method}
        ends = some.sweep(**options)
        wrong = np.zeros(few.size, dtype=bool)
        for i in range(few.size):
            alone = wmr.arrival(wmr.simulate(*some.one(i), **runs.options | options))
            wrong[i] = not np.allclose(alone, [values[i] for values in ends], rtol=1e-9, atol=1e-9)
        again = nudged.sweep(**options)
        chaotic = (ends.arrived != again.arrived) | ~(apart(again, ends) < CHAOTIC)
        yield some.row(f"{method}: a sweep is many simulates", wrong & ~chaotic, few.size)
        yield Row("runs", f"{method}: chaotic, so not compared", int((wrong & chaotic).sum()), 0)
        steps = [some.sweep(method=method, **short | {"dt": dt / rate}) for dt in STEPS]
        coarse, middle, fine = (apart(each, truth) for each in steps)
        wrong = ~turns & ~(fine < 0.5 * np.maximum(coarse, middle) + 1e-6)
        yield some.row(f"{method}: smaller steps come closer to continuous", wrong, few.size)


STEPS = 0.04, 0.02, 0.005  # of the time of the fastest mode

# Files -------------------------------------------------------------------------------------------

JUNK = {
    "NMEA": ["$GPGSV,1,1,00*79", "!AIVDM,1,1,,A,14eG;o@034o8sd<L9i:a;WF>062D,0*7D", "", "# begin",
             "$GPGGA,1", "$PUBX,00*33", "\x00\x00", "$GPRMC,,V,,,,,,,,,,N*53", "noise \xff\xfe"],
    "CSV": ["", "# begin", ";;;;;", "a,b", ",,", "nan,nan,nan", "1e999,0,0", "91,0,0"],
    "GPX": ["", "<!-- a < b -->", "<trkpt/>", '<trkpt lat="x" lon="1"/>', "</trkseg><trkseg>",
            '<trkpt lat="91" lon="0"/>', "</trkseg></trk><trk><trkseg/><trkseg>",
            '<extensions><o:trkpt xmlns:o="urn:o" lat="1" lon="2"/></extensions>'],
}  # fmt: skip


def nmea(body: str) -> str:
    return f"${body}*{reduce(xor, body.encode()):02X}"


def degrees_minutes(value: float, width: int, letters: str) -> str:
    minutes = round(abs(value) * 60 * 10_000)
    whole, rest = divmod(minutes, 600_000)
    return f"{whole:0{width}d}{rest / 10_000:07.4f},{letters[value < 0.0]}"


def lines_of(kind: str, lat: float, lon: float, second: int) -> str:
    clock = time.gmtime(1_700_000_000 + second)
    if kind == "CSV":
        return f"{lat:.7f},{lon:.7f},{time.strftime('%Y-%m-%dT%H:%M:%SZ', clock)}"
    if kind == "GPX":
        stamp = time.strftime("%Y-%m-%dT%H:%M:%SZ", clock)
        return f'<trkpt lat="{lat:.7f}" lon="{lon:.7f}"><time>{stamp}</time></trkpt>'
    place = f"{degrees_minutes(lat, 2, 'NS')},{degrees_minutes(lon, 3, 'EW')}"
    if second % 2:
        return nmea(f"GPGGA,{time.strftime('%H%M%S', clock)},{place},1,08,1.1,40.8,M,43.6,M,,0000")
    stamp, day = time.strftime("%H%M%S", clock), time.strftime("%d%m%y", clock)
    return nmea(f"GPRMC,{stamp},A,{place},0.2,18.0,{day},,,A")


FRAME = {
    "NMEA": ([], []),
    "CSV": (["lat,lon,time"], []),
    "GPX": (
        ['<gpx version="1.1" xmlns="http://www.topografix.com/GPX/1/1">', "<trk><trkseg>"],
        ["</trkseg></trk>", "</gpx>"],
    ),
}


def attack_files(seed: int) -> list[Row]:
    rng = random.Random(seed)
    wrong: dict[str, list[str]] = {}
    tried: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "file")
        for _ in range(FILES):
            kind = rng.choice(list(FRAME))
            for how, damage in (("lines", damaged_lines), ("bytes", damaged_bytes)):
                held = f"{kind}: {HELD[how]}"
                data, healthy, excused, wild = damage(kind, rng)
                path.write_bytes(data)
                tried[held] += 1
                if trouble := trouble_with(path, healthy, excused, wild):
                    kept = Path(tempfile.gettempdir(), f"wmrlib-stress-{seed}-{tried.total()}")
                    kept.write_bytes(data)
                    wrong.setdefault(held, []).append(f"{kept}: {trouble}")
    return [
        Row("files", held, tried[held], len(wrong.get(held, [])), tuple(wrong.get(held, [])[:3]))
        for held in sorted(tried)
    ]


HELD = {
    "lines": "every undamaged position is used, none is made up",
    "bytes": "a ValueError, or positions on Earth",
}


def trouble_with(path: Path, healthy: set | None, excused: int, wild: int) -> str:
    """What is wrong with how a file is read; empty if nothing is."""
    begin = time.perf_counter()
    try:
        track = wmr.read_track(path)
    except ValueError as error:
        refused = healthy and not wild
        return f"refused: {error}" if refused or not str(error) else ""
    except Exception as error:  # whatever else comes out is a fault
        return f"{type(error).__name__}: {error}"
    if (took := time.perf_counter() - begin) > SLOW:
        return f"takes {took:.0f} s"
    lat, lon = track.points.lat, track.points.lon
    if not (np.all(np.abs(lat) <= 90.0) and np.all(np.abs(lon) <= 180.0)):
        return "positions that are not on Earth"
    if healthy is None:
        return ""
    used = {*zip(*(np.round(both * 1e6).astype(int).tolist() for both in (lat, lon)), strict=True)}
    lost, invented = healthy - used, used - healthy
    # One wrong time costs itself; of several beside each other nobody knows which time is wrong.
    nobody_knows = max(0, wild - 1)
    if len(lost) > excused + nobody_knows or len(invented) > wild:
        return f"lost {sorted(lost)[:3]}, made up {sorted(invented)[:3]}; {track.report!r}"
    return ""


def some_lines(kind: str, rng: random.Random) -> list[tuple[str, tuple[int, int] | None]]:
    """The lines of a whole file, and the position of each in millionths of a degree."""
    head, tail = FRAME[kind]
    begin, lines = rng.randrange(86_400), []
    step = 1 / 600_000 if kind == "NMEA" else 1e-6  # the last digit that the file has, degrees
    for second in range(rng.randrange(1, 60)):
        lat, lon = (rng.randint(-int(end / step), int(end / step)) * step for end in (90.0, 180.0))
        place = round(lat * 1e6), round(lon * 1e6)
        lines.append((lines_of(kind, lat, lon, begin + second), place))
    return [*((line, None) for line in head), *lines, *((line, None) for line in tail)]


def damaged_lines(kind: str, rng: random.Random):
    """A file, what must be found, how much of that need not, and how many may be made up."""
    lines = some_lines(kind, rng)
    first, last = len(FRAME[kind][0]), len(lines) - len(FRAME[kind][1])
    excused = wild = 0
    for _ in range(rng.randrange(1, 5)):
        i = rng.randrange(first, last)
        text, place = lines[i]
        how = rng.choice(["junk", "drop", "twice", "swap", "cut", "flip", "glitch"])
        if how == "junk":
            lines.insert(i, (rng.choice(JUNK[kind]), None))
            last += 1
        elif how == "drop" and last - first > 1:
            del lines[i]
            last -= 1
        elif how == "twice":
            lines.insert(i, lines[i])
            last += 1
        elif how == "swap" and i + 1 < last:
            lines[i : i + 2] = lines[i + 1], lines[i]
            excused += 1
        elif how == "cut" and text:
            lines[i] = text[: rng.randrange(len(text))], None
            wild += 1
        elif how == "flip" and text:
            j = rng.randrange(len(text))
            lines[i] = text[:j] + chr(rng.randrange(32, 127)) + text[j + 1 :], None
            wild += 1
        elif how == "glitch" and place:
            lines[i] = glitched(kind, text, rng), None
            wild += 1
    healthy = {place for _, place in lines if place}
    segments = [[]]
    for text, place in lines:
        segments[-1] += [place] if place else []
        segments += [[]] * ("</trkseg>" in text)
    # So few are no more than what is in disorder.
    excused += sum(0 < len(set(segment)) <= wild + excused for segment in segments)
    end = rng.choice(["\n", "\r\n"])
    return end.join([*(text for text, _ in lines), ""]).encode(), healthy, excused, wild


def glitched(kind: str, text: str, rng: random.Random) -> str:
    """The line with another year."""
    if kind != "NMEA":
        return text.replace("2023-", rng.choice(["2099-", "1980-", "2022-"]))
    body = text[1:-3]
    if body.startswith("GPRMC"):
        body = body.replace("1123,,,A", rng.choice(["1199", "1180", "1122"]) + ",,,A")
    return nmea(body)


def damaged_bytes(kind: str, rng: random.Random):
    data = bytearray("\n".join(text for text, _ in some_lines(kind, rng)).encode())
    for _ in range(rng.randrange(1, 6)):
        i, j = sorted(rng.randrange(len(data) + 1) for _ in range(2))
        how = rng.randrange(6)
        if how == 0:
            data[i : i + 1] = bytes([rng.randrange(256)])
        elif how == 1:
            data[i : i + rng.randrange(1, 20)] = b""
        elif how == 2:
            data[i:i] = rng.randbytes(rng.randrange(1, 20))
        elif how == 3:
            data[j:] = b""
        elif how == 4:
            data[i:i] = data[i:j]
        else:
            data[i : i + 1] = rng.choice(
                [b"\x00", b"\xff\xfe", b'"', b"<", b"&", b"\r", b"-", b"9"]
            )
    return bytes(data), None, 0, 0


# Hosts -------------------------------------------------------------------------------------------

USED = """
import sys, numpy as np, wmrlib as wmr
start, goal, gains = wmr.Pose(0.0, 0.0, 0.0), wmr.Pose(3.0, 2.0, 1.0), wmr.GENTLE_GAINS
said = [*wmr.sweep(wmr.Pose([0.0, 1.0], 0.0, 0.0), goal, gains, progress=False)]
for method in ("arc", "euler", "continuous"):
    said += wmr.arrival(wmr.simulate(start, goal, gains, method=method))
said += [*wmr.modes(gains), *wmr.control_law(1.0, 2.0, 0.5, gains)]
points = wmr.read_track(sys.argv[1]).points
said += [points.lat, points.lon]
import matplotlib
matplotlib.use("agg")
import wmrlib.symbolic, wmrlib.explorer
print([np.round(np.asarray(each, dtype=complex), 6).tolist() for each in said])
"""
FULL = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))"
NOBODY = "import os, pwd; del os.environ['HOME']; pwd.getpwuid = {}.__getitem__"
HOSTS = {  # what the process does before it imports wmrlib, what it is given, and Python's options
    "as it should be": ("", {}, ()),
    "a user without a home or an entry": (NOBODY, {}, ()),
    "a home that is a file": ("", {"HOME": "/dev/null"}, ()),
    "a full disk": (FULL, {}, ()),
    "no folder for temporary files": ("", {"TMPDIR": "/nowhere"}, ()),
    "a cache folder that can't be": ("", {"NUMBA_CACHE_DIR": "/dev/null/x"}, ()),
    "without docstrings and assertions": ("", {}, ("-OO",)),
    "an ASCII locale": ("", {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}, ()),
    "every warning an error": ("", {"PYTHONWARNINGS": "error:::wmrlib"}, ()),
    "without numba's compiler": ("", {"NUMBA_DISABLE_JIT": "1"}, ()),
    "one thread": ("", {"NUMBA_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}, ()),
}


def attack_hosts(seed: int) -> Iterator[Row]:
    rng = random.Random(seed)
    with tempfile.TemporaryDirectory() as folder:
        site, caches = Path(folder, "site"), Path(folder, "caches")
        for place in (Path(folder), site, caches):
            place.mkdir(exist_ok=True)
            place.chmod(0o755)
        ignored = shutil.ignore_patterns("__pycache__")
        shutil.copytree(Path(wmr.__file__).parent, site / "wmrlib", ignore=ignored)
        (site / "wmrlib" / "__pycache__").touch()  # nobody, not even root, makes a folder of it
        log = site / "log.csv"
        log.write_text("lat,lon\n33.27,44.37\n", encoding="utf-8")

        def begin(code: str, settings: dict, options: tuple = ()) -> subprocess.Popen:
            own = {"PYTHONPATH": str(site), "PYTHONDONTWRITEBYTECODE": "1", "HOME": folder}
            own |= {"MPLCONFIGDIR": str(caches)} | settings
            kept = {name: value for name, value in os.environ.items() if name[:6] != "NUMBA_"}
            command = [sys.executable, *options, "-c", f"{code}\n{USED}", str(log)]
            pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
            return subprocess.Popen(command, env=kept | own, cwd=folder, **pipes)

        def row(held: str, process: subprocess.Popen, expected: str | None) -> Row:
            out, errors = process.communicate()
            told = errors.count("can't be kept")
            right = bool(out) and out == (expected or out) and told <= 1 and not process.returncode
            return Row("hosts", f"{held}: it runs, and is right", 1, not right, (errors[-500:],))

        expected = begin("", {"NUMBA_CACHE_DIR": str(caches)}).communicate()[0]
        for held, host in HOSTS.items():
            yield row(held, begin(*host), expected)
        for binary in [path for path in caches.rglob("*") if path.is_file()]:
            content = bytearray(binary.read_bytes())
            i = rng.randrange(len(content) + 1)
            content[i : i + rng.randrange(1, 100)] = rng.randbytes(rng.randrange(50))
            binary.write_bytes(content)
        damaged = begin("", {"NUMBA_CACHE_DIR": str(caches)})
        yield row("each file of the cache is damaged", damaged, expected)
        cold = {"NUMBA_CACHE_DIR": str(caches / "cold")}
        for process in [begin("", cold) for _ in range(4)]:
            yield row("four at once on a cold cache", process, expected)


# The rest ----------------------------------------------------------------------------------------


def attack_properties(examples: int, jobs: int, seed: int) -> list[Row]:
    """The suite's own hypothesis tests; `conftest.py` takes the number of examples from here."""
    command = [sys.executable, "-m", "pytest", "-q", "-m", "hypothesis", "-n", str(jobs)]
    command += ["--hypothesis-profile", "stress", "--hypothesis-seed", str(seed), str(TESTS)]
    done = subprocess.run(
        [*command, "-W", "error"],
        env=os.environ | {"STRESS_EXAMPLES": str(examples)},
        cwd=TESTS.parent, capture_output=True, text=True, check=False,
    )  # fmt: skip
    numbers = dict(
        reversed(each) for each in re.findall(r"(\d+) (passed|failed|error)", done.stdout)
    )
    failed = [line for line in done.stdout.splitlines() if line.startswith(("FAILED", "ERROR"))]
    passed = int(numbers.get("passed", 0))
    held = f"hypothesis tests hold with {examples:,} examples"
    seen = tuple(failed[:5]) if passed else (done.stdout[-2000:] + done.stderr[-2000:],)
    return [Row("properties", held, passed + len(failed), len(failed) or not passed, seen)]


def attack_mutants(mutants: int, jobs: int, seed: int) -> list[Row]:
    options = f"--count {mutants} --jobs {jobs} --seed {seed}".split()
    command = [sys.executable, TESTS / "mutants.py", *options]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    print(done.stdout, done.stderr, sep="\n")
    lived = tuple(re.findall(r"^SURVIVED +(.*)", done.stdout, re.MULTILINE))
    tried = len(re.findall(r"^(?:SURVIVED|killed)", done.stdout, re.MULTILINE))
    return [Row("mutants", "a change of a formula is noticed", tried, len(lived), lived)]


def together(rows: Iterable[Row]) -> list[Row]:
    """The rows of all chunks that hold the same, added up."""
    total: dict[tuple[str, str], Row] = {}
    for row in rows:
        _, _, tried, wrong, seen = total.get(row[:2], Row(*row[:2], 0, 0))
        seen = (*seen, *row.seen)[:5]
        total[row[:2]] = row._replace(tried=tried + row.tried, wrong=wrong + row.wrong, seen=seen)
    return list(total.values())


def chunks(attack: Callable[[int], list[Row]], parts: int, seed: int, jobs: int) -> Iterator[Row]:
    with ProcessPoolExecutor(jobs) as pool:
        for rows in pool.map(attack, range(seed * 1_000_000, seed * 1_000_000 + parts)):
            yield from rows


def main(attacks, runs, files, examples, mutants, jobs, seed) -> None:
    todo = {
        "runs": lambda: chunks(attack_runs, math.ceil(runs / RUNS), seed, jobs),
        "files": lambda: chunks(attack_files, math.ceil(files / FILES / 2), seed, jobs),
        "hosts": lambda: attack_hosts(seed),
        "properties": lambda: attack_properties(examples, jobs, seed),
        "mutants": lambda: attack_mutants(mutants, jobs, seed),
    }
    if unknown := set(attacks) - set(todo):
        sys.exit(f"{', '.join(sorted(unknown))}: no attack; there are {', '.join(todo)}")
    wrong = 0
    for name in attacks or todo:
        begin = time.perf_counter()
        for _, held, tried, found, seen in together(todo[name]()):
            print(f"{name:11}{held:58}{tried:12,}{found:8,}", flush=True)
            for each in seen if found else ():
                print(f"           {each}", flush=True)
            wrong += found if name != "mutants" else found > 0.05 * tried
        print(f"{name:11}took {time.perf_counter() - begin:.0f} s", flush=True)
    sys.exit(f"{wrong:,} wrong" if wrong else None)


if __name__ == "__main__":
    formatter = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=formatter)
    parser.add_argument("attacks", nargs="*", metavar="ATTACK")
    sizes = {"runs": 100_000, "files": 10_000, "examples": 1000, "mutants": 100}
    for option, default in (sizes | {"jobs": 2, "seed": 1}).items():
        parser.add_argument(f"--{option}", type=int, default=default)
    main(**vars(parser.parse_args()))
