"""`leblanc view` on the command line: files, JSON, and one line for whatever is wrong."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from leblanc import cli
from leblanc.cli import main
from leblanc.view.picture import prepare_off_screen
from meshes.errors import InputError

Capture = pytest.CaptureFixture[str]
ROOT = Path(cli.__file__).parents[2]
RUNUP = str(ROOT / "examples" / "runup.toml")
TABLE = str(ROOT / "examples" / "vibratory_table.toml")


@pytest.fixture
def _screen() -> None:
    try:
        prepare_off_screen()
    except InputError as error:
        pytest.skip(str(error))


@pytest.mark.usefixtures("_screen")
def test_a_picture_goes_to_the_scene_s_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["view", RUNUP]) == 0
    assert (tmp_path / "out" / "Run-up" / "view.png").stat().st_size > 10_000
    printed = capfd.readouterr()
    assert "954.9 rpm" in printed.out
    assert "times larger" in printed.out
    # Not even VTK says anything.
    assert printed.err == ""


@pytest.mark.usefixtures("_screen")
def test_json_says_what_is_drawn(tmp_path: Path, capsys: Capture) -> None:
    path = tmp_path / "deep" / "a.png"
    assert main(["view", RUNUP, "--speed", "24 rad/s", "--screenshot", str(path), "--json"]) == 0
    (line,) = capsys.readouterr().out.splitlines()
    found = json.loads(line)
    assert found["speed"] == 24.0
    assert found["dry_patch"] is True
    assert found["deflection_factor"] == found["depth_factor"] == 1.0
    assert found["volume_drawn"] == found["volume"] == [5e-4]
    assert found["screenshot"] == str(path)
    assert path.exists()


@pytest.mark.usefixtures("_screen")
def test_a_mode_and_a_table(tmp_path: Path, capsys: Capture) -> None:
    path = str(tmp_path / "a.png")
    assert main(["view", RUNUP, "--mode", "2", "--screenshot", path, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["crests"] == 1
    assert main(["view", TABLE, "--screenshot", path]) == 0
    assert "2 balls" not in capsys.readouterr().err


@pytest.mark.usefixtures("_screen")
def test_a_film_of_the_speeds(tmp_path: Path, capsys: Capture) -> None:
    text = Path(RUNUP).read_text(encoding="utf-8").partition("[runup]")[0]
    text = text.replace('"model.friction", "runup"', '"model.friction"')
    scene = tmp_path / "steady.toml"
    scene.write_text(text, encoding="utf-8")
    path = tmp_path / "film.gif"
    assert main(["view", str(scene), "--animate", str(path), "--frames", "3", "--json"]) == 0
    printed = capsys.readouterr()
    assert json.loads(printed.out)["animation"] == str(path)
    assert "3 frames" in printed.err


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--speed", "-3"], "--speed"),
        (["--speed", "0"], "--speed"),
        (["--speed", "fast"], "--speed"),
        (["--speed", "3 kg"], "--speed"),
        (["--factor", "0"], "--factor"),
        (["--factor", "nan"], "--factor"),
        (["--factor", "1e9"], "--factor"),
        (["--screenshot", "a.bmp"], ".png or .html"),
        (["--screenshot", "a"], ".png or .html"),
        (["--animate", "a.avi"], ".gif or .mp4"),
        (["--animate", "a.gif", "--frames", "1"], "--frames"),
        (["--frames", "100000"], "--frames"),
        (["--mode", "0"], "--mode"),
        (["--mode", "1000"], "--mode"),
        (["--mode", "1", "--chamber", "2"], "--chamber"),
        (["--mode", "1", "--speed", "-1"], "--speed"),
        (["--browser", "--mode", "1"], "--browser"),
        (["--browser", "--screenshot", "a.png"], "--browser"),
        (["--browser", "--port", "70000"], "--port"),
        (["--window", "--animate", "a.gif"], "--window"),
        (["--nonsense"], "--nonsense"),
    ],
)
def test_wrong_options(options: list[str], said: str, capsys: Capture, tmp_path: Path) -> None:
    assert main(["view", RUNUP, *options]) == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    (line,) = printed.err.splitlines()
    assert said in line


@pytest.mark.parametrize("options", [["--browser"], ["--animate", "a.gif"]])
def test_a_table_with_balls_has_no_film(options: list[str], capsys: Capture) -> None:
    if "--browser" in options:
        pytest.importorskip("trame_vtk")
    assert main(["view", TABLE, *options]) == 2
    assert "exciter" in capsys.readouterr().err


def test_no_window_without_a_screen(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    assert main(["view", RUNUP, "--window"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "no display" in line


def test_nothing_to_draw_with(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    from leblanc.view import picture as view_picture

    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.setattr(view_picture, "_loads", lambda library: False)
    assert main(["view", RUNUP, "--screenshot", "a.png"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "libegl1" in line


def test_no_ffmpeg(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    assert main(["view", RUNUP, "--animate", "a.mp4"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "no ffmpeg" in line


def test_a_page_without_its_extra(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    from leblanc.view import files as view_browser

    monkeypatch.setattr(view_browser, "find_spec", lambda name: None)
    assert main(["view", RUNUP, "--browser"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "leblanc[browser]" in line


def test_the_command_line_stays_light() -> None:
    code = """if True:
        import sys
        from leblanc.cli import main
        main(["view", "--help"])
        sys.exit(", ".join({"numpy", "pyvista", "trame", "matplotlib"} & set(sys.modules)) or 0)
    """
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
        env=dict(os.environ),
    )
    assert done.returncode == 0, done.stderr
