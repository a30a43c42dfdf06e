"""Chapter 10: where V rises under (24) as printed."""

from __future__ import annotations

import math

from wmrbook.live.parts import Knob, Live, choose
from wmrlib import lyapunov_rate, paper


def rising() -> Live:
    """Where V rises under (24) as printed, at a distance and with a weight of the distance in V."""
    gains, (alpha, theta) = paper.OUTDOOR_GAINS, (45.0, 0.0)

    def rises(rho: float, L: float) -> bool:
        here = rho, math.radians(alpha), math.radians(theta)
        return bool(lyapunov_rate(*here, gains, law="printed", L=L) > 0.0)

    heavy, away = 1e-3, 0.35  # m^2, m
    return Live(
        "rising",
        "At {rho} from the goal, {alpha} and {theta}, with {L}, V changes at {rate} under (24) "
        "as printed: it {fate}. It rises in {share} of the angles at this distance.",
        {
            "alpha": Knob(alpha, -180.0, 180.0, 5.0, "alpha, degrees", "°", "alpha"),
            "theta": Knob(theta, -180.0, 180.0, 5.0, "theta, degrees", "°", "theta"),
            "rho": Knob(away, 0.001, 1.0, None, "the distance, rho", "m", "rho"),
            "L": Knob(1.0, 0.001, 10.0, None, "L: a small one lets the distance count", "m²", "L"),
        },
        data={
            "gains": gains._asdict(),
            "asked": {"alpha": alpha, "theta": theta, "rho": away},
        },
        ask=choose(
            "Here V rises. Now let the distance count a thousand times as much in V, with "
            "L = 0.001 m². What does V do?",
            "The distance's part of V' fades with the square of the distance, so near enough the "
            "angles decide, whatever L is.",
            answers={
                "it rises all the same": rises(away, heavy),
                "it falls, here and nearer": not rises(away, heavy) and not rises(1e-6, heavy),
                "it falls here, but rises nearer": not rises(away, heavy) and rises(1e-6, heavy),
            },
            wrong=(
                "The distance now outweighs the angles here.",
                "The distance's part fades with its square, so nearer to the goal the angles win.",
                "",
            ),
            asked=({"L": 0.001},),
        )
        if rises(away, 1.0)
        else None,
    )
