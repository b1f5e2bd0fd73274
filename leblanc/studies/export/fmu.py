"""The FMU of a scene's run-up, by pythonfmu."""

from __future__ import annotations

import sys
from pathlib import Path
from shutil import copyfile
from tempfile import TemporaryDirectory

from leblanc.core.files import writing
from leblanc.scene.scene import Scene
from leblanc.studies.export.cosimulation import resources, stepped_model
from leblanc.studies.export.tables import extra
from leblanc.studies.runup.study import require_runup
from meshes.errors import InputError

_CLASS = "leblanc_runup"  # module of the class within the FMU


def write_fmu(scene: Scene, path: Path) -> str:
    """Write the FMU and return its liquid model; an `InputError` without a run-up or the extra `export`."""
    pythonfmu = extra("pythonfmu", "fmu")
    require_runup(scene)
    if not scene.text:
        raise InputError("to", "fmu", "another format: no file can say this machine, which the FMU must hold")
    model = stepped_model(scene)
    with TemporaryDirectory() as place, writing(path) as part:
        folder, found = Path(place), list(sys.path)
        script = folder / f"{_CLASS}.py"
        copyfile(Path(__file__).with_name("slave.py"), script)
        files = []
        for name, text in resources(scene, model).items():
            files.append(folder / name)
            files[-1].write_text(text, encoding="utf-8")
        try:
            made = pythonfmu.FmuBuilder.build_FMU(script, dest=folder / "made.fmu", project_files=files)
        finally:
            # It leaves the folder of the script on the path, and its module loaded.
            sys.path[:] = found
            sys.modules.pop(_CLASS, None)
        copyfile(made, part)
    return model
