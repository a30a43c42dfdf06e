"""Installs the node, its launch file and its parameters, as colcon wants it."""

from setuptools import setup

share = "share/wmr_park"
setup(
    name="wmr_park",
    version="0.1.0",
    packages=["wmr_park"],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/wmr_park"]),
        (share, ["package.xml"]),
        (f"{share}/launch", ["launch/park.launch.py"]),
        (f"{share}/config", ["config/my_robot.yaml"]),
    ],
    install_requires=["wmrlib"],
    entry_points={"console_scripts": ["park = wmr_park.node:main"]},
)
