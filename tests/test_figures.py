"""The chapters' figures: each says its numbers, names its units and draws what it was given."""

import html
import math
import re
from functools import cache

import numpy as np
import pytest
from looks import drawn, heading_of, pixels_of, place_of

import wmrlib as wmr
from wmrbook import figures
from wmrbook.chapters import challenge, routes
from wmrlib import paper

GAINS, GENTLE = paper.OUTDOOR_GAINS, wmr.GENTLE_GAINS
ORIGIN = wmr.Pose(0.0, 0.0, 0.0)
CASE = paper.outdoor()
ROBOT, GOAL = wmr.Pose(0.0, 0.0, math.radians(15)), wmr.Pose(4.0, 5.7, math.radians(-25))
ROBOT_RATES = wmr.polar_rate(1.0, wmr.polar_error(ROBOT, GOAL).alpha, 2.0, 0.0)  # 1 m away


# What the figures are given: computed once a process, and not at collection ---------------------


@cache
def drive(law="corrected", gains=GAINS, x_axis="east", **options):
    case = paper.outdoor(x_axis)
    return wmr.simulate(case.start, case.goal, gains, law=law, method="continuous", **options)


def parked():
    return wmr.simulate(CASE.goal, CASE.goal, GAINS)


@cache
def route(kind):
    way = wmr.Pose(*np.array([(0, 0, 0.1), (25, 2, 0.8), (30, 30, 2.0), (0, 40, 3.0)], float).T)
    gains = wmr.Gains(0.4, 2.0, 1.0, 3.0)
    if kind == "mixed":
        return routes.drive_route(way, gains, stop=[False, True, True])
    if kind == "stuck":
        return routes.drive_route(way._replace(y=np.array([0, 2, 90, 95.0])), gains, duration=20.0)
    if kind == "lost":
        return routes.drive_route(way, wmr.Gains(1e308, 1e308, 1e308, 1e308))
    return routes.drive_route(wmr.Pose(3.0, 4.0, 1.0), gains, start=wmr.Pose(3.0, 4.0, 1.0))


@cache
def score(*gains):
    return challenge.score(wmr.Gains(*gains))


WAY = wmr.Pose(np.linspace(-3.0, 0.0, 20), np.linspace(-2.0, 0.1, 20), np.linspace(1.0, 0.2, 20))
STEPS = np.array([0.02, 0.1, 0.7, 1.0])
MEMORY = np.array([0.0, 3.0, 1e9])  # s
FOUND = {  # distance, m, and heading error, deg
    "10 Hz": (np.array([0.2, 0.5, 1.4]), np.array([80.0, 91.0, 12.0])),
    "1 Hz": (np.array([0.3, 0.6, 1.5]), np.array([70.0, 40.0, 20.0])),
}


def wheel_loops():
    return {"slow": drive(wheels=wmr.Wheels(1.0, lag=0.1)), "at once": drive()}


def time_steps():
    gains = {"the paper's gains": GAINS, "gentle gains": GENTLE}
    return figures.time_steps(CASE.start, CASE.goal, gains, STEPS)


def step(method):
    shares = np.linspace(0.0, 1.0, 5).tolist()
    return [wmr.advance(ORIGIN, 0.6, 0.45, share, method=method) for share in shares]


ASIDE = wmr.Pose(0.9, 0.5, 0.0)


CASES = {
    "path": lambda: figures.path(drive()),
    "path of two": lambda: figures.path([drive(), parked()], ["one", "two"]),
    "twist": lambda: figures.twist(drive()),
    "spherical_triangle": lambda: figures.spherical_triangle(
        wmr.GeoPoint(lat=5.0, lon=0.0), wmr.GeoPoint(lat=35.0, lon=70.0)
    ),
    "chord": lambda: figures.chord(math.radians(60)),
    "curvature_radii": lambda: figures.curvature_radii(30.0, 0.3),
    "sphere_error_map": lambda: figures.sphere_error_map(paper.GPS_POINT_1, math.radians(9.6274)),
    "coordinate_system": lambda: figures.coordinate_system(
        wmr.Pose(2.0, 1.5, math.radians(35.0)), 1.0, 0.25
    ),
    "robot_loops": lambda: figures.robot_loops(0.2, 4.0),
    "third_angle": lambda: figures.third_angle(ROBOT, GOAL),
    "velocity_split": lambda: figures.velocity_split(ROBOT, GOAL, 2.0),
    "velocity_split, backwards": lambda: figures.velocity_split(ROBOT, GOAL, -0.5),
    "path_choices": lambda: figures.path_choices(
        {"one": WAY, "two": wmr.Pose(WAY.x, 0.5 * WAY.y, 0.0)}, ORIGIN
    ),
    "angles_over_time": lambda: figures.angles_over_time(drive()),
    "angles_over_time of two": lambda: figures.angles_over_time([drive(), drive("aicardi")]),
    "figures_8_to_12": lambda: figures.figures_8_to_12(
        {"one": drive(), "two": drive("printed", x_axis="north")}
    ),
    "heading_to_go": lambda: figures.heading_to_go({"one": drive()}),
    "endpoints": lambda: figures.endpoints(
        np.array([1.0, 2.0, 4.0]), {"one": np.array([1.0, -9.0, 4.0]), "two": np.zeros(3)}
    ),
    "snapshots, tall": lambda: figures.snapshots(drive(), [0.0, 5.0, 10.0, drive().t[-1]]),
    "snapshots, wide": lambda: figures.snapshots(drive(x_axis="north"), [0.0, 5.0, 14.0]),
    "block_diagram": lambda: figures.block_diagram(0.2, 4.0),
    "root_locus": lambda: figures.root_locus(GAINS, "k_alpha", np.linspace(0.1, 20.0, 100)),
    "three_steps": lambda: figures.three_steps(
        {"euler": step("euler"), "again": step("euler"), "arc": step("arc")}, ASIDE
    ),
    "time_steps": time_steps,
    "inner_loops": lambda: figures.inner_loops({"one": wheel_loops(), "two": {"slow": drive()}}),
    "memories": lambda: figures.memories(MEMORY, FOUND),
    "verdicts": lambda: figures.verdicts(
        {"equations": {"holds": 21, "typo": 3}, "figures": {"holds": 7, "typo": 0}}
    ),
    "route": lambda: figures.route(route("mixed")),
    "route, stuck": lambda: figures.route(route("stuck")),
    "route, one pose": lambda: figures.route(route("point")),
    "challenge_paths": lambda: figures.challenge_paths(score(0.128, 1.089, 1.42, 7.528)),
    "challenge_paths, wild": lambda: figures.challenge_paths(score(5.0, 0.1, 5.0, 20.0)),
    "beliefs": lambda: figures.beliefs(
        np.arange(4.0), {"all": (np.array([5.0, -9.0, 1.0, 1.0]), np.array([4.0, 4.0, 2.0, 1.0]))}
    ),
}
picture = cache(lambda name: CASES[name]())


# Every figure -----------------------------------------------------------------------------------


def degrees_left(run):
    return f"{math.degrees(wmr.arrival(run).heading_error):.0f} deg"


def sight_turns(method):
    end = step(method)[-1]
    after, before = math.atan2(0.5 - end.y, 0.9 - end.x), math.atan2(0.5, 0.9)
    return round(math.degrees(after - before))


def beside(driven):
    """How far the route passes its first waypoint."""
    way = driven.waypoints
    return np.hypot(driven.x - way.x[0], driven.y - way.y[0]).min()


@cache
def graceful():
    docking, options = wmr.Gains(1.0, 2.0, 3.0, 1.0), {"method": "continuous", "law": "graceful"}
    return wmr.simulate(wmr.Pose(-1.5, 1.0, 0.0), ORIGIN, docking, **options)


SAYS = {  # what the text must say, in numbers that come from elsewhere
    "twist": lambda: [
        "Over time: v goes from 4.0 to 0.4 m/s, within 5 % of its peak, 4.0 m/s, from 0.0 to "
        f"{drive().t[drive().v > 0.95 * GAINS.v_max][-1]:.1f} s; omega goes from 0.2 to -4.1 "
        "rad/s, within 5 % of its peak, -4.3 rad/s, from 15.4 to 15.5 s."
    ],
    "spherical_triangle": lambda: [
        "c = 70.8 deg long and leaves point 1 at the bearing br = 54.6 deg"
    ],
    "chord": lambda: ["60.0 deg apart", "is 1.000 long and the arc 1.047", "sin(c/2) = 0.500"],
    "curvature_radii": lambda: ["its length N is 1.07 equatorial", "its radius M is 0.60"],
    "sphere_error_map": lambda: [
        "from -0.45 % at the poles to +0.56 % northwards on the equator, with -0.11 % eastwards"
    ],
    "third_angle": lambda: [
        "Yousif and Ali: theta = 80 deg, turned from the goal's heading to the line of sight",
        "Siegwart: beta = -80 deg, turned back from the line of sight to the goal's heading; Corke",
    ],
    "velocity_split": lambda: [
        f"{-ROBOT_RATES[0]:.2f} m/s along the line of sight and {ROBOT_RATES[2]:.2f} m/s across it"
    ],
    "path_choices": lambda: ["one: ends 0.10 m from the goal, its heading 11 deg off"],
    "endpoints": lambda: ["3 runs end", "one: 67 % are within 5 deg; two: 100 % are"],
    "root_locus": lambda: [
        "for k_alpha from 0.1 to 20. "
        f"The pair runs on a circle of {8.0 * math.sqrt(0.3):.2f} rad/s to the real axis and parts"
    ],
    "inner_loops": lambda: [
        f"one, slow: {degrees_left(wheel_loops()['slow'])}; one, at once: {degrees_left(drive())}"
    ],
    "three_steps": lambda: [
        f"turns: euler {sight_turns('euler')} deg, again {sight_turns('euler')} deg, "
        f"arc {sight_turns('arc')} deg."
    ],
    "memories": lambda: [
        "from white to constant: 10 Hz, from 0.2 m and about 80 deg to 1.4 m and 10 deg, "
        "the heading worst, about 90 deg, at 3 s; 1 Hz, "
    ],
    "route": lambda: [
        "Path from (0.0, 0.0) m to (",
        "3 of 3 waypoints reached, 2 to stop at and 1 to pass "
        f"(at most {beside(route('mixed')):.1f} m aside); ",
        f"in {route('mixed').time:.1f} s.",
    ],
    "route, stuck": lambda: [
        "1 of 3 waypoints reached, 3 to stop at and 0 to pass; ",
        "s without reaching the rest.",
    ],
    "beliefs": lambda: ["all: 4.0 to 1.0 deg, error inside 75 % of the time."],
}


def test_every_figure_of_the_chapters_is_in_the_table():
    others = {"COLOURS", "LINES", "Picture"}  # test_plots
    assert {re.split("[, ]", name)[0] for name in CASES} | others == set(figures.__all__)
    assert SAYS.keys() <= CASES.keys()


@pytest.mark.parametrize("name", CASES)
def test_every_figure_draws_and_says_what_it_shows(name):
    shown = picture(name)
    bundle = shown._repr_mimebundle_()
    assert bundle["text/plain"] == f"<Picture: {shown.alt}>"
    assert bundle["text/html"].startswith(f'<img alt="{html.escape(shown.alt)}" width=')
    assert len(shown.alt) > 60
    assert shown.alt.endswith(".")
    assert not re.search(r"nan|-0\.0*(?![\d.])", shown.alt)
    for words in SAYS.get(name, list)():
        assert words in shown.alt
    pixels = pixels_of(shown)
    full = 0.9 if name == "sphere_error_map" else 0.7
    assert 0.01 < np.mean(pixels.min(axis=2) < 0.9) < full  # neither blank nor flooded
    for axes in shown.figure.axes:
        if not axes.axison or axes.get_label() == "<colorbar>":
            continue
        x = axes.get_xlabel() or shown.figure.get_supxlabel()
        y = axes.get_ylabel() or shown.figure.get_supylabel()
        assert "[" in x or not axes.xaxis.get_tick_params().get("labelbottom", True)
        assert "[" in y or not axes.yaxis.get_tick_params().get("labelleft", True)


# What is drawn is what was given ----------------------------------------------------------------


def axes_of(name):
    return picture(name).figure.axes


def test_paths_and_angles_are_those_of_the_runs():
    alpha, theta = axes_of("angles_over_time")
    np.testing.assert_allclose(alpha.lines[0].get_ydata(), np.degrees(drive().alpha))
    np.testing.assert_allclose(theta.lines[0].get_ydata(), np.degrees(drive().theta))
    (axes,) = figures.path_choices({"one": WAY}, ORIGIN).figure.axes
    assert axes.get_aspect() == 1.0
    assert [heading_of(it) for it in drawn(axes, "pose")] == pytest.approx([1.0, 0.0])
    assert [heading_of(it) for it in drawn(axes, "robot")] == pytest.approx([0.2])


def test_a_wrapped_angle_is_not_joined_across_its_jump():
    far = wmr.pose_from_polar(wmr.PolarError(10.0, np.radians(90.0), np.radians(175.0)), ORIGIN)
    picture = figures.angles_over_time(wmr.simulate(far, ORIGIN, GAINS, method="arc", dt=0.02))
    drawn = picture.figure.axes[1].lines[0].get_ydata()
    assert np.isnan(drawn).sum() == 1
    assert np.nanmax(np.abs(np.diff(drawn))) < 10.0


def test_the_papers_figures_are_drawn_from_the_runs_with_a_style_for_each():
    runs = {"one": drive(), "two": drive("printed", x_axis="north")}
    path, *fields = axes_of("figures_8_to_12")
    for axes, name in zip(fields, ("v", "omega", "x_error", "y_error"), strict=True):
        one, two = axes.lines[-2:]
        assert np.array_equal(one.get_ydata(), getattr(runs["one"], name))
        assert np.array_equal(two.get_ydata(), getattr(runs["two"], name))
        assert one.get_linestyle() != two.get_linestyle()  # never colour alone
    assert np.array_equal(path.lines[0].get_xdata(), runs["one"].x)


def test_the_distance_to_go_shrinks_to_the_right():
    (axes,) = axes_of("heading_to_go")
    left, right = axes.get_xlim()
    assert left > right
    assert axes.lines[-1].get_ydata()[-1] == pytest.approx(
        math.degrees(drive().heading_error[-1]), abs=0.01
    )


def test_snapshots_show_the_robot_where_it_was_and_how_it_looked():
    run = drive()
    moments = (0.0, 5.0, 10.0, run.t[-1])
    for axes, moment in zip(axes_of("snapshots, tall"), moments, strict=True):
        k = int(np.abs(run.t - moment).argmin())
        (goal,), (robot,) = drawn(axes, "pose"), drawn(axes, "robot")
        for patch, pose in ((goal, CASE.goal), (robot, (run.x[k], run.y[k], run.heading[k]))):
            assert heading_of(patch) == pytest.approx(math.remainder(pose[2], math.tau))
            np.testing.assert_allclose(place_of(patch), pose[:2], atol=1e-6)
        so_far = np.column_stack([run.x, run.y])[: k + 1]
        assert np.array_equal(axes.lines[1].get_xydata(), so_far)
        assert axes.get_aspect() == 1.0


def test_an_end_is_drawn_without_its_sign_over_the_distance_of_its_start():
    dots = axes_of("endpoints")[0].lines[0].get_xydata()
    assert dots.tolist() == [[1.0, 1.0], [2.0, 9.0], [4.0, 4.0]]


def test_the_crosses_are_the_roots():
    (cross,) = [line for line in axes_of("root_locus")[0].lines if line.get_marker() == "x"]
    roots = np.roots([1.0, 1.0, 0.3 * 8.0**2])
    np.testing.assert_allclose(sorted(cross.get_ydata()), sorted(roots.imag))
    np.testing.assert_allclose(cross.get_xdata(), roots.real)


def test_time_steps_draw_each_run_and_each_limit():
    axes = axes_of("time_steps")[0]
    drawn = {line.get_label(): line for line in axes.lines}
    for method in ("arc", "euler"):
        wanted = []
        for dt in STEPS.tolist():
            end = wmr.arrival(wmr.simulate(CASE.start, CASE.goal, GAINS, method=method, dt=dt))
            wanted.append(abs(math.degrees(end.heading_error)) if end.arrived else math.nan)
        np.testing.assert_allclose(drawn[method].get_ydata(), wanted)
        limit = {wmr.longest_step(GAINS, method)}
        assert any(set(line.get_xdata()) == limit for line in axes.lines)


def test_a_step_is_drawn_with_its_chord_and_its_angle_chi():
    axes = axes_of("three_steps")[1]  # the arc's, the larger panel
    path, chord, *_, angle = axes.lines
    end = step("arc")[-1]
    np.testing.assert_allclose(path.get_xydata()[-1], [end.x, end.y])
    np.testing.assert_allclose(chord.get_xydata(), [[0.0, 0.0], [end.x, end.y]])
    x, y = angle.get_xydata()[-1]
    assert math.atan2(y, x) == pytest.approx(0.45 / 2)  # half of the turn


def test_a_route_is_drawn_as_it_was_driven():
    """Arrows for the wanted headings, and a marker each for a stop, a pass and what was missed."""
    way, mixed = route("mixed").waypoints, route("mixed")
    (axes,) = figures.route(mixed).figure.axes
    np.testing.assert_array_equal(axes.lines[0].get_xydata().T, [mixed.x, mixed.y])
    arrows = [note for note in axes.texts if not note.get_text()]
    for k, note in enumerate(arrows):
        tail, tip = np.array(note.get_position()), np.array(note.xy)
        assert tail.tolist() == [way.x[k], way.y[k]]
        assert math.atan2(*(tip - tail)[::-1]) == pytest.approx(way.heading[k])
    assert [note.get_text() for note in axes.texts if note.get_text()] == ["1", "2", "3"]
    for kind, wanted in (("mixed", "oss"), ("stuck", "ssxsx")):
        lines = figures.route(route(kind)).figure.axes[0].lines
        markers = [line.get_marker() for line in lines]
        assert (
            "".join(marker for marker in markers if marker in "sox" and len(marker) == 1) == wanted
        )
    legend = [text.get_text() for text in axes.get_legend().get_texts()]
    assert legend == ["path", "start", "stop", "passed"]


# Bad input --------------------------------------------------------------------------------------

HERE = wmr.GeoPoint(lat=5.0, lon=0.0)
FIVE = {str(k): STEPS for k in range(6)}
BAD = [
    ("a GeoPoint is needed, not a tuple", "spherical_triangle", ((5, 0), HERE)),
    ("a GeoPoint is needed, not a tuple", "sphere_error_map", ((5, 0), 0.0)),
    (r"angle = 0\.0 is not allowed", "chord", (0.0,)),
    (r"lat = 90\.0 is not allowed", "curvature_radii", (90.0, 0.3)),
    (r"track_width = 0\.0 .* above 0", "coordinate_system", (ORIGIN, 0.0, 0.1)),
    (r"wheel_radius = -0\.1 .* above 0", "coordinate_system", (ORIGIN, 1.0, -0.1)),
    ("v = 0.0 .* a speed other than 0", "velocity_split", (ROBOT, GOAL, 0.0)),
    ("tracks has 0 entries, .* 1 to 4 are needed", "path_choices", ({}, ORIGIN)),
    ("a Pose is needed, not a tuple", "path_choices", ({"one": WAY}, (0, 0, 0))),
    ("runs has 0 entries", "angles_over_time", ([],)),
    ("runs has 5 entries, .* 1 to 4 are needed", "path", ([0] * 5,)),
    ("labels has 2 entries", "path", ([0], ["one", "two"])),
    (r"labels = 'ab' is not allowed: a list with a str for each run", "path", ([0, 0], "ab")),
    ("labels = .* a list with a str for each run", "path", ([0, 0], [1, 2])),
    ("runs has 0 entries, .* 1 to 5 are needed", "figures_8_to_12", ({},)),
    ("runs has 6 entries", "heading_to_go", (FIVE,)),
    (r"runs\['one'\] = 3 .* a Trajectory is needed", "figures_8_to_12", ({"one": 3},)),
    (r"distance = 0\.0 is not allowed", "endpoints", (0.0, {"one": 1.0})),
    ("mismatched lengths", "endpoints", (np.ones(2), {"one": np.ones(3)})),
    ("runs = .* is not allowed: a Mapping is needed", "heading_to_go", ([3],)),
    ("a Trajectory is needed", "snapshots", (3, [0.0, 1.0])),
    ("one = .* is not allowed", "endpoints", (1.0, {"one": np.array([math.nan])})),
    (r"time_step = 0\.0 is not allowed", "block_diagram", (0.0, 10.0)),
    ("gains has 1 .* 2 are needed", "time_steps", (ROBOT, GOAL, {"one": GAINS}, STEPS)),
    ("cases has 0 entries", "inner_loops", ({},)),
    ("paths has 1 .* 3 are needed", "three_steps", ({"one": [ORIGIN]}, ASIDE)),
    ("series has 0 entries, .* 1 to 4 are needed", "memories", (MEMORY, {})),
    ("mismatched lengths", "memories", (MEMORY, {"one": (np.ones(3), np.ones(2))})),
    ("counts has 0 entries", "verdicts", ({},)),
    ("a Route is needed, not a Pose", "route", (WAY,)),
    ("a Score is needed, not a Gains", "challenge_paths", (GAINS,)),
    ("runs has 0 entries, .* 1 to 4 are needed", "beliefs", (MEMORY, {})),
    ("mismatched lengths", "beliefs", (np.ones(2), {"one": (np.ones(3), np.ones(2))})),
]


def test_a_run_without_a_sample_is_named_and_so_is_a_picture_without_a_drive():
    lost = wmr.simulate(wmr.Pose(0, 0, 0), wmr.Pose(5, 1, 0), wmr.Gains(*[1e308] * 4))
    several, one = {"far": drive(), "lost": lost}, {"run": (lost,), "moments": (lost, [0.0, 1.0])}
    cases = [
        ("twist", one["run"], "run"),
        ("path", ([drive(), lost],), "runs[1]"),
        ("angles_over_time", (lost,), "runs[0]"),
        ("snapshots", one["moments"], "run"),
        ("figures_8_to_12", (several,), "runs['lost']"),
        ("inner_loops", ({"near": several, "far": several},), "cases['near']['lost']"),
    ]
    for name, arguments, culprit in cases:
        with pytest.raises(ValueError, match=re.escape(f"{culprit} has no sample")):
            getattr(figures, name)(*arguments)
    with pytest.raises(ValueError, match="shows no drive to play"):
        figures.third_angle(wmr.Pose(1, 2, 0), wmr.Pose(0, 0, 1)).motion()


def test_bad_input_is_named():
    beside_a_run = [
        ("times has 1 entries, .* 2 to 6", "snapshots", (drive(), [0.0])),
        (r"times = .* at most 15\.5", "snapshots", (drive(), [0.0, 99.0])),
        ("driven has no sample", "route", (route("lost"),)),
    ]
    for message, name, arguments, *named in BAD + beside_a_run:
        with pytest.raises(ValueError, match=message):
            getattr(figures, name)(*arguments, **dict(*named))
