"""The chapters check the library: with one sign of it flipped, the chapter that derives that formula fails, by an assertion of its own."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
FLIPS = {
    "the theta row (8)": (
        "03_polar_coordinates",
        "motion.py",
        "return -v_over_rho * rho * cos_alpha, turning - omega, turning",
        "return -v_over_rho * rho * cos_alpha, turning - omega, -turning",
    ),
    "omega's second term, which corrects (24)": (
        "04_lyapunov",
        "laws.py",
        "gains.k_alpha * alpha + v_over_rho * sinc(alpha) * (alpha + gains.h * theta)",
        "gains.k_alpha * alpha - v_over_rho * sinc(alpha) * (alpha + gains.h * theta)",
    ),
    "the bearing's arguments (15)": (
        "01_gps_to_metres",
        "geodesy.py",
        "np.arctan2(zeta_x, zeta_y)",
        "np.arctan2(zeta_y, zeta_x)",
    ),
}


@pytest.mark.parametrize("flip", FLIPS)
def test_a_chapter_fails_when_a_sign_flips(tmp_path, flip):
    chapter, module, right, wrong = FLIPS[flip]
    shutil.copytree(
        ROOT / "wmrlib", tmp_path / "wmrlib", ignore=shutil.ignore_patterns("__pycache__")
    )
    source = (tmp_path / "wmrlib" / module).read_text(encoding="utf-8")
    assert right in source
    (tmp_path / "wmrlib" / module).write_text(source.replace(right, wrong), encoding="utf-8")
    shutil.copytree(ROOT / "notebooks", tmp_path / "notebooks")
    (tmp_path / "pytest.ini").touch()
    environment = os.environ | {
        "PYTHONPATH": str(tmp_path),
        "NUMBA_DISABLE_JIT": "1",
    }  # compiling would take longer than the chapter
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-x",
        "--nbval-lax",
        "--nbval-current-env",
        "-p",
        "no:cacheprovider",
        f"notebooks/{chapter}.ipynb",
    ]
    run = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert run.returncode == 1, run.stdout
    assert "AssertionError" in run.stdout
