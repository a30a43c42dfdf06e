"""The action `Park` built from the wheels of PyPI, where there is no colcon.

    python book/robot/ros2/interfaces.py FOLDER

With a ROS 2 of its own, `colcon build` does this instead.
"""

from __future__ import annotations

import os
import subprocess
import sys
import sysconfig
from pathlib import Path

HERE = Path(__file__).parent
_BUILT_WITH = "/opt/python/cp{0}{1}-cp{0}{1}".format(*sys.version_info)


def build(folder: Path) -> Path:
    """Build into `folder`, unless it is there, and return where it is installed."""
    prefix, venv = folder / "install", Path(sys.prefix)
    if (prefix / "share").exists():
        return prefix
    headers = f"{_BUILT_WITH}/include/python3.{sys.version_info.minor}"
    for file in (venv / "share").rglob("*.cmake"):  # the wheels name paths of where they were built
        text = file.read_text(encoding="utf-8")
        if _BUILT_WITH in text:
            text = text.replace(headers, sysconfig.get_path("include"))
            file.write_text(text.replace(_BUILT_WITH, str(venv)), encoding="utf-8")
    path = f"{venv / 'bin'}{os.pathsep}{os.environ['PATH']}"
    environment = os.environ | {"PATH": path, "AMENT_PREFIX_PATH": str(venv)}
    options = {"CMAKE_PREFIX_PATH": venv, "CMAKE_INSTALL_PREFIX": prefix}
    options |= {"Python3_EXECUTABLE": sys.executable, "CMAKE_C_FLAGS": "-O0"}
    options |= {"CMAKE_CXX_FLAGS": "-O0"}
    named = [f"-D{name}={value}" for name, value in options.items()]
    configure = ["cmake", "-GNinja", "-S", HERE / "wmr_interfaces", "-B", folder / "build", *named]
    for command in (configure, ["cmake", "--build", folder / "build", "--target", "install"]):
        done = subprocess.run(command, env=environment, capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(f"{done.stdout}{done.stderr}")
    return prefix


def environment(prefix: Path, domain: int = 0) -> dict[str, str]:
    """Variables for a process that uses it, alone on a domain of this machine."""
    packages = f"lib/python3.{sys.version_info.minor}/site-packages"
    paths = [prefix / packages, HERE / "wmr_park", HERE, HERE.parent, HERE.parents[2]]
    libraries = [str(prefix / "lib"), os.environ.get("LD_LIBRARY_PATH", "")]
    return os.environ | {
        "PYTHONPATH": os.pathsep.join(map(str, paths)),
        "LD_LIBRARY_PATH": os.pathsep.join(filter(None, libraries)),
        "ROS_DOMAIN_ID": str(domain),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        "FASTDDS_BUILTIN_TRANSPORTS": "UDPv4",  # shared memory leaves locks behind
    }


if __name__ == "__main__":
    print(build(Path(sys.argv[1])))
