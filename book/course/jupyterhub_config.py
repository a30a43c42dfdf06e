"""JupyterHub for a class: jupyterhub --config=book/course/jupyterhub_config.py

Each student gets students.zip, which package.py makes, into ~/robot. Where the system can cage
processes, their servers see neither the course nor the homes of others.
"""

import sys
from pathlib import Path

COURSE = Path(__file__).resolve().parent
sys.path.insert(0, str(COURSE))
import cage  # noqa: E402
import exchange  # noqa: E402

c = get_config()  # noqa: F821  (JupyterHub provides it)


def hand_out(spawner):
    """Unpack the package, and let the server see of all homes only this one."""
    name = spawner.user.name
    home = Path(getattr(spawner, "home_dir", "") or f"~{name}").expanduser()
    (home / "robot").mkdir(parents=True, exist_ok=True)
    exchange.hand_out(home, COURSE / "students.zip")
    if cage.holds():
        ours = (COURSE.parents[1].joinpath(each) for each in ("wmrlib", "book/wmrbook"))
        # Inside, where the hub runs as root, each user is called so, without any right of root's.
        server = [*SERVER, "--allow-root"]
        spawner.cmd = cage.caged(server, reads=[Path("/etc"), *ours], writes=[home], network=True)


SERVER = [str(Path(sys.executable).parent / "jupyterhub-singleuser")]
c.Spawner.cmd = SERVER
c.Spawner.pre_spawn_hook = hand_out
# The first process in such a place hears no signal but the one that can't be refused.
c.LocalProcessSpawner.interrupt_timeout = c.LocalProcessSpawner.term_timeout = 1
c.Spawner.notebook_dir = "~/robot"
c.Spawner.default_url = "/lab/tree/notebooks/00_from_gps_to_a_parked_robot.ipynb"
# The guide's table says what 1 GB holds; systemd's and Docker's spawners enforce it.
c.Spawner.mem_limit = "1G"
