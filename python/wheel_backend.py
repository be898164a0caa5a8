"""Builds the wheel for `pip install .` (PEP 517): CMake builds the module, a zip file holds it."""
import base64
import hashlib
import pathlib
import re
import subprocess
import sys
import sysconfig
import zipfile

root = pathlib.Path(__file__).resolve().parent.parent
version = re.search(r"project\(ballast VERSION (\S+)", (root / "CMakeLists.txt").read_text())[1]
about = """Metadata-Version: 2.1
Name: ballast
Version: %s
Summary: Rigid-body contact with friction: problems, solvers, their judge, scenes
Requires-Python: >=3.9
Requires-Dist: numpy
Requires-Dist: scipy
""" % version


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    subprocess.run(["cmake", "--preset", "default", "-DBALLAST_PYTHON_MODULE=ON",
                    "-DPython3_EXECUTABLE=" + sys.executable], cwd=root, check=True)
    subprocess.run(["cmake", "--build", "--preset", "default", "--target", "ballast_python"],
                   cwd=root, check=True)
    cpython = "cp%d%d" % sys.version_info[:2]
    platform = re.sub(r"[-.]", "_", sysconfig.get_platform())
    tag = "-".join([cpython, cpython, platform])
    head = "Wheel-Version: 1.0\nGenerator: ballast\nRoot-Is-Purelib: false\nTag: %s\n" % tag
    notes = "ballast-%s.dist-info/" % version
    files = {notes + "METADATA": about.encode(), notes + "WHEEL": head.encode()}
    built = root / "build" / "default" / "python" / "ballast"
    for file in sorted(built.iterdir()):
        if file.is_file():
            files["ballast/" + file.name] = file.read_bytes()
    scenes = root / "problems" / "scenes"
    for file in sorted([*scenes.glob("*.toml"), *scenes.glob("meshes/*.obj")]):
        files["ballast/scenes/" + file.relative_to(scenes).as_posix()] = file.read_bytes()
    record = ""
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).decode().rstrip("=")
        record += "%s,sha256=%s,%d\n" % (name, digest, len(content))
    files[notes + "RECORD"] = (record + notes + "RECORD,,\n").encode()
    wheel = "ballast-%s-%s.whl" % (version, tag)
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / wheel, "w", zipfile.ZIP_DEFLATED) as out:
        for name, content in files.items():
            out.writestr(name, content)
    return wheel
