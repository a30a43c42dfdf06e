"""The stages of all chapters in one page: every handle, scene and answer, and what is then read."""

from __future__ import annotations

import itertools
import json
import math
import re
import sys

import numpy as np
import pytest

pytest.importorskip("anywidget", reason="what moves needs anywidget")
from faults import violations
from host import TRAITS, mounted

from wmrbook import stages
from wmrbook.ellipsoid import sphere_error
from wmrbook.panel.kit import sources
from wmrbook.stages.parts import off_heading
from wmrlib import (
    GENTLE_GAINS,
    Gains,
    GeoPoint,
    PolarError,
    Pose,
    Receiver,
    advance,
    control_law,
    destination_point,
    haversine_distance,
    initial_bearing,
    local_position,
    modes,
    paper,
    polar_error,
    polar_rate,
    pose_from_polar,
    residual,
    simulate,
    sweep,
    track,
    wheels_to_twist,
)

NAMES = sorted(set(stages.__all__) - stages.PARTS)
UNSOUND = re.compile("NaN|undefined|Infinity|null|\\[object|\N{EN DASH}")
# A clock that goes fifty times as fast: a film is seen whole, in a moment.
QUICK = """(() => {
    const clock = performance.now.bind(performance), begin = clock(),
        next = requestAnimationFrame.bind(window), fast = (now) => begin + 50 * (now - begin);
    performance.now = () => fast(clock());
    window.requestAnimationFrame = (callback) => next((now) => callback(fast(now)));
})();"""
# Another stage in the place of the one that is shown.
INSTEAD = """given => {
    unmount();
    document.body.replaceChildren();
    return mount(...given);
}"""
# Shows a scene, and returns after how many pictures nothing moves any more.
FILMED = """async name => {
    const root = document.querySelector('.stage');
    let frames = 0;
    root.stage.show(name);
    do await new Promise((done) => requestAnimationFrame(done));
    while (root.dataset.done !== 'true' && (frames += 1) < 600);
    return frames;
}"""
# Does all that a hand can do, and returns what is to be seen after each of it.
TRIED = """async ({ knobs, scenes, poses }) => {
    const root = document.querySelector('.stage'), say = root.querySelector('.stage-say'),
        canvas = root.querySelector('canvas'), trouble = root.querySelector('.stage-trouble'),
        report = [], home = structuredClone(panel.get('state'));
    const frame = () => new Promise((done) => requestAnimationFrame(done));
    async function look(at, answer = null) {
        await frame();
        const on = say.querySelector('[data-on=true]'), shown = on.dataset.kind;
        report.push({ at, answer, shown, words: on.textContent, text: say.textContent,
            trouble: trouble.textContent, high: [say.offsetHeight, root.offsetHeight],
            alt: canvas.ariaLabel,
            handles: [...root.querySelectorAll('[data-control]')].filter((it) => !it.hidden)
                .map((it) => it.dataset.control) });
    }
    const put = ({ name, choices }, value) => {
        const row = root.querySelector(`[data-control=${name}]`);
        if (choices) { row.querySelectorAll('.stage-chip')[value].click(); return; }
        const typed = row.querySelector('.wmr-typed');
        typed.value = String(value);
        typed.dispatchEvent(new Event('change'));
    };
    const picture = async () => { await frame(); return canvas.toDataURL(); };
    for (const { name, ask } of scenes) {
        root.stage.show(name);
        await look(`scene ${name}`);
        const chips = [...say.querySelectorAll('[data-on=true] .stage-chip')];
        for (const [k, chip] of ask ? chips.entries() : []) {
            const answer = `${name}, answer ${k}`;
            chip.click();
            await look(`${name} is answered`, answer);
            knobs.forEach((knob) => put(knob, knob.choices ? knob.choices.length - 1 : knob.low));
            await look(`${name} is answered and moved`);
            chip.click();
            await look(`${name} is answered again`, answer);
            root.stage.show(scenes[0].name);
            root.stage.show(name);
            await look(`${name} is seen again`, answer);
        }
    }
    const still = {};
    for (const { name, choices, low, high } of knobs) {
        const has = scenes.find(({ handles }) => !handles || handles.includes(name));
        root.stage.show(has.name);
        const pictures = [];
        for (const k of choices ? choices.keys() : [low, (low + high) / 2, high]) {
            put({ name, choices }, k);
            await look(`${name} ${choices ? choices[k][0] : k}`);
            pictures.push(await picture());
        }
        still[name] = new Set(pictures).size === 1;
    }
    const at = (start, x, y, turn) => [start[0] + x, start[1] + y, start[2] + turn];
    if (poses.start && poses.goal)
        for (const [x, y, turn] of [[0, 0, 0], [0, 0, 1], [1e-4, 0, 2], [0.02, 0, 0], [2, -3, -2],
            [400, -300, 1], [-1, 0, 0]]) {
            panel.set('state', { ...home, start: at(poses.goal, x, y, turn) });
            await look(`start ${x}, ${y}, ${turn} off the goal`);
        }
    return { report, still };
}"""


def _module(name: str):
    """The module of a stage, which is imported when the stage is first asked for."""
    return sys.modules[getattr(stages, name).__module__]


def _one_by_one(page, **options):
    """Show the stages of all chapters in one page, one after another."""
    mounted(page, stages.first_drive(), **options)
    for name in NAMES:
        stage = getattr(stages, name)()
        page.evaluate(INSTEAD, [stage.get_state(TRAITS), sources(stage.program)])
        yield name, stage


def test_whatever_a_hand_does_a_stage_says_what_came_out(browser_page):
    for name, stage in _one_by_one(browser_page, width=350, motion="reduce"):
        tried, verdicts = browser_page.evaluate(TRIED, stage.setup), {}
        for before, seen in itertools.pairwise([tried["report"][0], *tried["report"]]):
            where = f"{name}, {seen['at']}"
            assert not seen["trouble"], f"{where}: {seen['trouble']}"
            assert not UNSOUND.search(seen["text"]), f"{where}: {seen['text']}"
            assert len(seen["alt"].split()) > 8, where
            assert seen["high"] == before["high"], f"{where}: the box grows"
            assert (seen["shown"] == "verdict") is bool(seen["answer"]), where
            verdict = verdicts.setdefault(seen["answer"], seen["words"])
            assert not seen["answer"] or seen["words"] == verdict, f"{where}: not what was asked"
        rows = {f"scene {it['name']}": it.get("handles") for it in stage.setup["scenes"]}
        knobs = {knob["name"] for knob in stage.setup["knobs"]}
        for seen in tried["report"]:
            wanted = rows.get(seen["at"])
            if seen["at"] in rows:
                assert {*seen["handles"]} == (knobs if wanted is None else {*wanted}), name
        idle = [knob for knob, still in tried["still"].items() if still]
        assert not idle, f"{name}: {idle} change nothing"


def test_every_film_comes_to_its_end(browser_page):
    browser_page.add_init_script(QUICK)
    for name, stage in _one_by_one(browser_page, width=620, motion="no-preference"):
        for scene in stage.setup["scenes"]:
            frames = browser_page.evaluate(FILMED, scene["name"])
            assert frames < 600, f"{name}, {scene['name']}"


@pytest.mark.needs("npm")
def test_everybody_can_use_a_stage(browser_page):
    mounted(browser_page, stages.moving_goal("ask"), width=620)  # sliders, chips and a question
    assert not violations(browser_page, ".stage")
    browser_page.emulate_media(color_scheme="dark")
    assert not violations(browser_page, ".stage", runOnly=["color-contrast"])


def test_a_goal_that_is_dragged_onto_the_start_is_reached_at_once(browser_page):
    panel = mounted(browser_page, stages.first_drive(), width=620)
    page, start = browser_page, panel.handle("start", "move").bounding_box()
    goal = panel.handle("goal", "move").bounding_box()
    panel.drag(panel.handle("goal", "move"), start["x"] - goal["x"], start["y"] - goal["y"])
    assert panel.get("goal")[:2] == pytest.approx(panel.get("start")[:2], abs=0.5)
    assert not UNSOUND.search(page.locator(".stage-say").inner_text())


def _end(start, goal, gains, **options) -> str:
    """Return when a run ends and how far off its heading, as a stage writes it."""
    run = simulate(start, goal, gains, **options)
    return f"{run.t[-1]:.1f} s, {off_heading(run):.0f}°"


def _late() -> str:
    start, goal, _, _ = paper.outdoor()
    run = simulate(start, goal, GENTLE_GAINS, method="arc", dt=0.5)
    far, off = 100 * run.rho[-1], off_heading(run)
    return f"After {len(run.t)} looks it stops {far:.1f} cm from its goal, {off:.0f}° off"


def _noisy(gains=GENTLE_GAINS, radius=None, turn=None, **receiver) -> str:
    module = _module("noisy_fixes")
    ends = sweep(
        module.START,
        module.GOAL,
        gains,
        receiver=Receiver(sigma=np.full(module.DAYS, module.SIGMA), **receiver),
        seed=module.SEED,
        arrival_radius=module.RADIUS if radius is None else radius,
        last_turn=turn,
        method="arc",
        dt=module.DT,
        duration=module.SECONDS,
    )
    far, off = ends.distance.max(), np.degrees(abs(ends.heading_error)).max()
    size = f"{far:.1f} m" if far >= 0.995 else f"{100 * far:.0f} cm"
    return f"stops up to {size} and {off:.0f}° off"


def _printed() -> str:
    start, goal, gains, _ = paper.outdoor()
    options = {"method": "continuous"}
    blue, pink = (_end(start, goal, gains, law=law, **options) for law in ("corrected", "printed"))
    return f"Blue stops after {blue} off its heading, pink stops after {pink} off its heading"


def _crooked() -> str:
    module = _module("crooked_compass")
    run = module.driven(bias=module.BIAS)
    return f"stops {100 * run.rho[-1]:.1f} cm from its goal, {off_heading(run):.0f}° off"


def _race() -> str:
    module = _module("race_of_laws")
    options = {"method": "arc", "dt": module.DT, "wheels": module.WHEELS}
    graceful, ours = (
        _end(module.START, module.GOAL, module.TUNED[law], law=law, **options)
        for law in ("graceful", "corrected")
    )
    return f"The corrected law stops after {ours} off.*; Graceful stops after {graceful} off"


def _seam() -> str:
    module = _module("seam")
    around = math.radians(module.HAIR)
    place = module.AWAY * math.cos(around), module.AWAY * math.sin(around)
    end = _end(Pose(*place, math.pi), module.GOAL, GENTLE_GAINS, method="arc", dt=0.02)
    return f"different sides.*Blue stops after {end}"


def _digits() -> str:
    module = _module("gps_points")
    origin = paper.GPS_POINT_1
    goal = destination_point(
        origin, math.hypot(*module.GOAL[:2]), math.atan2(module.GOAL.x, module.GOAL.y)
    )
    near = GeoPoint(lat=round(goal.lat, module.FIRST), lon=round(goal.lon, module.FIRST))
    far, bearing = haversine_distance(origin, goal), math.degrees(initial_bearing(origin, goal))
    missed = haversine_distance(goal, near)
    return f"{far:.1f} m apart.*at {bearing:.1f}° from north.*a place {missed:.2f} m from its goal"


def _twist() -> str:
    v, omega = wheels_to_twist(0.3, 0.5, _module("two_wheels").TRACK_WIDTH)
    return f"v = {v:.3f} m/s and ω = {omega:.3f} rad/s"


def _seen() -> str:
    module = _module("three_numbers")
    run = simulate(module.START, module.GOAL, GENTLE_GAINS, method="continuous")
    return f"stops after {run.t[-1]:.2f} s, {off_heading(run):.0f}° off its heading"


def _downhill() -> str:
    rises, all_park = _module("downhill")._outcome(GENTLE_GAINS)
    return f"{7 if all_park else '[0-6]'} of 7 park .* V {'rises' if rises else 'never rises'}"


def _two() -> str:
    start, goal, gains, _ = paper.outdoor()
    theirs, yours = (
        _end(start, goal, tried, method="continuous") for tried in (gains, GENTLE_GAINS)
    )
    return f"it stops after {theirs} off its heading.*it stops after {yours} off its heading"


def _kappa() -> str:
    module, gains = _module("two_numbers"), paper.OUTDOOR_GAINS
    _, off = module._drive(gains)
    sooner = "sooner" if modes(gains).slower < 1 else "no sooner"
    return f"κ = {modes(gains).kappa:.3f} .*settles {sooner} than.* s, {off:.0f}° off"


def _gap() -> str:
    run = track(paper.circle, paper.CIRCLE_START, paper.CIRCLE_GAINS, duration=40.0)
    return f"the gap is {100 * residual(run):.2f} cm"


TRUTHS = {
    "gps_points": ({}, _digits),
    "two_wheels": ({}, _twist),
    "three_numbers": ({}, _seen),
    "downhill": ({}, _downhill),
    "two_drives": ({}, _two),
    "two_numbers": ({}, _kappa),
    "moving_goal": ({}, _gap),
    "late_looks": ({}, _late),
    "noisy_fixes": ({}, _noisy),
    "as_printed": ({}, _printed),
    "crooked_compass": ({"arm": 0.0}, _crooked),
    "race_of_laws": ({}, _race),
    "seam": ({}, _seam),
}


# A scene, the numbers that a hand types, or none if it drags the start, and what is then false.
NO_LONGER = [
    ("two_drives", "whole", {"k_rho": 0.05, "radius": 0.01}, "Both arrive"),
    ("two_drives", "whole", {}, "Both arrive"),
    ("two_drives", "given", {}, "that the paper gives"),
    ("two_drives", "errors", {"radius": 0.3}, "shrink to nearly nothing"),
    ("course_from_gps", "whole", {"sigma": 3.0}, "within about"),
]


def test_a_claim_that_a_hand_has_made_false_is_gone(browser_page):
    shown = browser_page.locator(".stage-words[data-on=true]")
    for name, scene, typed, claim in NO_LONGER:
        panel = mounted(browser_page, getattr(stages, name)(scene), width=620)
        assert claim in shown.text_content(), f"{name}, {scene}: says nothing of it"
        for knob, number in typed.items():
            field = panel.control(knob).locator(".wmr-typed")
            field.fill(str(number))
            field.press("Enter")
        if not typed:
            panel.drag(panel.handle("start", "move"), -40, 0)
        panel.settled()
        assert claim not in shown.text_content(), f"{name}, {scene}"


def as_stored(stage):
    """Return a stage as a page or a deck has it from a notebook, which sorts what it stores."""
    stage.setup = json.loads(json.dumps(stage.setup, sort_keys=True))
    return stage


def test_a_stage_says_what_wmrlib_computes(browser_page):
    for name, (places, truth) in TRUTHS.items():
        stage = as_stored(getattr(stages, name)())
        panel = mounted(browser_page, stage, width=620).set(**places)
        said = browser_page.locator(".stage-words[data-on=true]").text_content()
        said = said.replace("\N{NO-BREAK SPACE}", " ")
        assert re.search(truth(), said), f"{name}: {said}, not {truth()}"
        assert not panel.troubled()


def _refereed() -> dict[str, tuple[str, ...]]:
    """Return what the scenes of chapter 10 must say, by wmrlib."""
    _, goal, gains, _ = paper.outdoor()
    turned = math.degrees(math.atan2(6 * math.sin(math.pi / 4), 10 - 6 * math.cos(math.pi / 4)))
    pose = pose_from_polar(PolarError(10.0, -math.pi / 4, 0.0), goal)
    alpha = math.degrees(polar_error(advance(pose, 0.5, 0.5, 3.0), goal).alpha)
    near = pose_from_polar(PolarError(0.35, math.pi / 4, 0.0), goal)
    options = {"method": "continuous", "dt": 0.02, "duration": 2.0, "arrival_radius": 0.0}
    V = simulate(near, goal, gains, law="printed", **options).V
    gaps = [
        residual(track(paper.circle, paper.CIRCLE_START, paper.CIRCLE_GAINS, law=law))
        for law in ("corrected", "printed")
    ]
    return {
        "sight": (f"by {turned:.0f}°",),
        "inequality": (f"\N{MINUS SIGN}{-alpha:.0f}°",),
        "rises": (f"{(V / V[0]).max():.1f} times",),
        "circle": tuple(f"{100 * gap:.2g}" for gap in gaps),
    }


def test_a_referees_scenes_say_what_wmrlib_computes(browser_page):
    for scene, truths in _refereed().items():
        mounted(browser_page, as_stored(stages.as_printed(scene)), width=620)
        said = browser_page.locator(".stage-words[data-on=true]").text_content()
        for truth in truths:
            assert truth in said.replace("\N{NO-BREAK SPACE}", " "), scene


def test_the_scenes_of_the_last_chapter_say_what_wmrlib_computes(browser_page):
    module = _module("seam")
    goal, start = module.GOAL, Pose(module.AWAY, 0.0, math.pi)
    options = {"method": "continuous", "dt": 0.02, "arrival_radius": 0.01}

    def words(scene: str, **places: object) -> str:
        mounted(browser_page, stages.seam(scene), width=620).set(**places)
        return _words(browser_page)

    for name, gains in (("gentle", GENTLE_GAINS), ("paper", paper.OUTDOOR_GAINS)):
        taken = simulate(start, goal, gains, **options).t[-1]
        straight = simulate(start, goal._replace(heading=math.pi), gains, **options).t[-1]
        said = words("soon", gains=name)
        assert f"after {straight:.3g} s. Blue is there after {taken:.3g} s" in said
        for apart, metres in module.BESIDE.items():
            near = options | {"arrival_radius": metres / 100}
            run = simulate(Pose(0.0, -metres, 0.0), goal, gains, **near)
            swing = math.degrees(abs(run.theta - run.alpha).max())
            assert f"up to {swing:.0f}° off" in words("beside", gains=name, apart=apart)
    for facing, cusps in ((30.0, "once"), (95.0, "never"), (90.0, "never"), (0.0, "once")):
        assert cusps in words("cusp", facing=facing)
    sight, swarm = math.radians(module.NOISE), module.SWARM
    options = {"method": "arc", "dt": swarm["dt"], "arrival_radius": swarm["radius"]}
    options |= {"receiver": Receiver(sight=np.full(40, sight)), "seed": swarm["seed"]}
    for hysteresis in (0.0, 0.05, 0.2):
        options["hysteresis"] = hysteresis
        ends = sweep(Pose(module.CLOSE, 0.0, math.pi), goal, paper.OUTDOOR_GAINS, **options)
        lost = np.sum(np.abs(ends.heading_error) > math.pi / 2)
        assert f"{lost} of 40" in words("hysteresis", hysteresis=hysteresis)


@pytest.mark.parametrize("law", ["graceful", "printed"])
def test_robots_back_into_a_dock_and_turn_at_the_end_as_wmrlib_does(browser_page, law):
    """Backwards is forwards with both headings turned round; a last turn takes its time."""
    stage = stages.race_of_laws("dock")
    race, called = _module("race_of_laws"), dict(stage.setup["data"]["names"])
    start, goal = (it._replace(heading=it.heading + math.pi) for it in (race.START, race.GOAL))
    options = {"law": law, "method": "arc", "dt": race.DT, "wheels": race.WHEELS}
    backed = simulate(start, goal, race.TUNED[law], **options)
    ahead = simulate(race.START, race.GOAL, race.TUNED[law], **options)
    width, fast = race.WHEELS.track_width, race.WHEELS.max_speed
    spin = abs(ahead.heading_error[-1]) * width / (2 * fast)
    turned = ahead.t[-1] + race.DT * math.ceil(spin / race.DT)
    truths = {
        "backwards": f"{backed.t[-1]:.1f} s, {off_heading(backed):.0f}°",
        "turn": f"{turned:.1f} s, 0°",
    }
    for way, truth in truths.items():
        stage = as_stored(stages.race_of_laws("dock"))
        mounted(browser_page, stage, width=620).set(law=law, drives=way)
        said = browser_page.locator(".stage-words[data-on=true]").text_content()
        said = said.replace("\N{NO-BREAK SPACE}", " ")
        assert f"{called[law]} stops after {truth}" in said, way


def _said_of_the_race(page, scene: str, **places: object) -> str:
    mounted(page, as_stored(stages.race_of_laws(scene)), width=620).set(**places)
    said = page.locator(".stage-words[data-on=true]").text_content()
    return said.replace("\N{NO-BREAK SPACE}", " ")


@pytest.mark.parametrize("law", ["graceful", "printed"])
def test_a_clock_that_runs_ahead_ends_each_drive_in_time(browser_page, law):
    race = _module("race_of_laws")
    run = simulate(
        race.START, race.GOAL, race.TUNED[law], law=law, method="arc", dt=race.DT, duration=60.0
    )
    ticks = math.ceil(run.t[-1] / (1 + run.t[-1] / race.BY) / (race.DT / 5))
    said = _said_of_the_race(browser_page, "time", law=law)
    truth = f"{race.DT / 5 * ticks:.2f} s, {off_heading(run):.0f}°"
    assert f"{race.NAMES[law]} stops after {truth}" in said


@pytest.mark.parametrize("speed", ["0.1", "0.4"])
def test_at_a_given_speed_a_robot_is_steered_by_the_chapters_law(browser_page, speed):
    race = _module("race_of_laws")
    v, c, clock, rates = float(speed), race.SETTLES, 0.0, []
    robot, goal = (it._replace(heading=it.heading + math.pi) for it in (race.START, race.GOAL))
    while (error := polar_error(robot, goal)).rho > 0.05:
        rho, alpha, theta = error
        tan, cos = math.tan(alpha), math.cos(alpha)
        zeta = tan + c * theta
        rates.append(v * cos / rho * (tan + cos**2 * (c * tan + c * zeta + theta)))
        step = 0.002 * rho / v
        robot, clock = advance(robot, v, rates[-1], step), clock + step
    said = _said_of_the_race(browser_page, "speed", speed=speed)
    taken, turn = re.search(
        r"\(13.3\) stops after ([\d.]+) s, 0° off.* up to ([\d.]+) °", said
    ).groups()
    assert float(taken) == pytest.approx(clock, abs=race.DT + 0.05)
    assert float(turn) == pytest.approx(math.degrees(max(map(abs, rates))), rel=0.1)


@pytest.mark.parametrize(
    ("left", "right", "does"),
    [
        (0.3, 0.6, "turns about a point 0.750 m to its left"),
        (-0.6, -0.3, "turns about a point 0.750 m to its right"),
        (0.6, 0.0, "turns about a point 0.250 m to its right"),
        (-0.3, 0.3, "turns on the spot"),
        (0.6, 0.6, "drives straight on"),
        (-0.2, -0.2, "drives straight back"),
        (0.0, 0.0, "stands still"),
    ],
)
def test_two_wheels_turn_about_the_point_about_which_wmrlib_turns_them(
    browser_page, left, right, does
):
    panel = mounted(browser_page, stages.two_wheels("centre"), width=620)
    answer = browser_page.locator(".stage-chip", has_text="to its left")
    found = "() => document.querySelector('.stage').found().tracks[0].n"
    assert browser_page.evaluate(found) == 1  # a drive would answer the question
    answer.click()
    panel.settled().set(left=left, right=right, answer=-1)
    assert f"It {does}." in _words(browser_page)
    v, omega = wheels_to_twist(left, right, 0.5)
    if v and omega:  # the wheels roll round that point
        metres, side = re.search("point (.*) m to its (left|right)", does).groups()
        assert (1 if side == "left" else -1) * float(metres) == pytest.approx(v / omega)


@pytest.mark.parametrize(
    ("left", "right", "moves"),
    [
        (0.15, 0.25, "Forward, left, back, right"),
        (-0.25, -0.15, "Back, left, forward, right"),
        (0.25, 0.15, "Forward, right, back, left"),
        (-0.15, -0.25, "Back, right, forward, left"),
        (0.2, 0.2, "Forward, back"),
    ],
)
def test_four_moves_are_named_as_they_are_driven(browser_page, left, right, moves):
    mounted(browser_page, stages.two_wheels("aside"), width=620).set(left=left, right=right)
    v, omega = wheels_to_twist(left, right, 0.5)
    pose = Pose(0.0, 0.0, 0.0)
    for drive, turn in ((v, 0.0), (0.0, omega), (-v, 0.0), (0.0, -omega)):
        pose = advance(pose, drive, turn, 3.0)
    words = _words(browser_page)
    assert words.startswith(f"{moves}.")
    parts = [(pose.x, "ahead", "back"), (-pose.y, "to its right", "to its left")]
    for by, more, less in parts:
        assert (f"{abs(by):.3f} m {more if by > 0 else less}" in words) == (abs(by) > 1e-3)


@pytest.mark.parametrize("digits", [3, 4, 6])
def test_degrees_and_metres_of_a_stage_are_of_the_digits_that_it_shows(browser_page, digits):
    origin, goal = (
        GeoPoint(lat=round(it.lat, digits), lon=round(it.lon, digits))
        for it in (paper.GPS_POINT_1, paper.GPS_POINT_2)
    )
    east, north = local_position(origin, goal)
    panel = mounted(browser_page, stages.gps_points("degrees"), width=620).set(digits=digits)
    latitudes, longitudes = (
        f"{there - here:.{digits}f}°, which is (.*?) m"
        for here, there in ((origin.lat, goal.lat), (origin.lon, goal.lon))
    )
    metres = re.search(f"differ by {latitudes}.*longitudes by {longitudes}", _words(browser_page))
    assert [float(it) for it in metres.groups()] == pytest.approx([north, east], abs=0.06)
    panel.set(scene="line", digits=digits)
    length = re.search("line to the goal is (.*?) m long", _words(browser_page))
    assert float(length.group(1)) == pytest.approx(math.hypot(east, north), abs=0.06)


@pytest.mark.parametrize(("x", "y", "nearer"), [(9.7, 57.25, "nearer to"), (60, 5, "farther from")])
def test_a_stage_says_how_much_farther_the_sphere_is_than_the_ellipsoid(browser_page, x, y, nearer):
    origin = paper.GPS_POINT_1
    far, bearing = math.hypot(x, y), math.atan2(x, y)
    off = 100 * far * abs(1 - 1 / (1 + sphere_error(origin.lat, bearing)))
    mounted(browser_page, stages.gps_points("ellipsoid"), width=620).set(goal=[x, y, 0.0])
    centimetres = re.search(f"and (.*?) cm {nearer} the start", _words(browser_page)).group(1)
    assert float(centimetres) == pytest.approx(off, abs=0.06)


def test_a_stage_drives_with_the_wrong_sign_as_wmrlib_does(browser_page):
    stage = stages.three_numbers()
    module = _module("three_numbers")
    where, options = (module.START, module.GOAL, GENTLE_GAINS), {"method": "arc", "dt": module.DT}
    run = simulate(*where, law=module.mistaken, **options)
    mounted(browser_page, stage, width=620).set(sign="wrong")
    said = _words(browser_page)
    assert f"stops after {run.t[-1]:.1f} s, {off_heading(run):.0f}° off its heading" in said


def test_a_stage_of_noisy_fixes_stops_where_wmrlib_does(browser_page):
    module = _module("noisy_fixes")
    early = Gains(*(module.EARLY[name] for name in ("k_rho", "k_alpha", "h")), GENTLE_GAINS.v_max)
    ends = {
        "lasting": _noisy(memory=module.MEMORIES["lasting"]),
        "early": _noisy(early, module.EARLY["radius"]),
        "turn": _noisy(turn=module.TURN),
    }
    for scene, truth in ends.items():
        mounted(browser_page, stages.noisy_fixes(scene), width=620)
        assert truth in _words(browser_page)
    for late, field in (("position", "delay"), ("heading", "heading_delay")):
        where, receiver = (
            (module.START, module.GOAL, GENTLE_GAINS),
            Receiver(**{field: module.LATE}),
        )
        options = {"method": "arc", "dt": module.DT, "duration": module.SECONDS}
        end = sweep(*where, receiver=receiver, arrival_radius=module.RADIUS, **options)
        mounted(browser_page, stages.noisy_fixes("late"), width=620).set(late=late, answer=-1)
        off = np.degrees(abs(end.heading_error))
        truth = f"{off:.0f}° off" if end.arrived else "has not stopped after a minute"
        assert truth in _words(browser_page)


def test_a_stage_splits_the_velocity_as_wmrlib_does(browser_page):
    stage = stages.three_numbers("split")
    module = _module("three_numbers")
    error = polar_error(module.START, module.GOAL)
    v, omega = control_law(*error, GENTLE_GAINS)
    closing, _, turning = polar_rate(error.rho, error.alpha, v, omega)
    mounted(browser_page, stage, width=620)
    said = _words(browser_page)
    across = v * math.sin(error.alpha)
    assert f"Of v = {v:.2f} m/s, {-closing:.2f} m/s go along" in said
    assert f"{across:.2f} m/s across it. The line turns at {math.degrees(turning):.2f} °/s" in said


def test_a_scene_of_its_start_stays_there_whatever_a_hand_moves(browser_page):
    panel = mounted(browser_page, stages.moving_goal("frame"), width=620, motion="reduce")
    panel.drag(panel.handle("start", "move"), 60, 0)
    pictures = set()
    for k_rho in (1.9, 0.5):  # another drive, from the same start
        panel.set(k_rho=k_rho)
        pictures.add(browser_page.evaluate("document.querySelector('canvas').toDataURL()"))
    assert len(pictures) == 1


def _words(page) -> str:
    """Return what a stage says, with plain spaces and minuses."""
    said = page.locator(".stage-words[data-on=true]").text_content()
    return " ".join(said.replace("\N{MINUS SIGN}", "-").split())
