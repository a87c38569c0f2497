# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The start-up hook, in real Python processes of a virtual environment for the test."""

from __future__ import annotations

import json
import signal
import subprocess
from pathlib import Path

import pytest

import rmw_manycore_hook as hook
from support import TIMEOUT_S
from support.installs.python_prefix import SHOW, Prefix

pytestmark = pytest.mark.unit

# How a program executes Python with the code in its arguments.
STARTS = (
    "subprocess.run([sys.executable, '-c', *sys.argv[1:]], check=True)",
    "os.execv(sys.executable, [sys.executable, '-c', *sys.argv[1:]])",
)


@pytest.fixture(scope="module")
def prefix(tmp_path_factory: pytest.TempPathFactory) -> Prefix:
    return Prefix(tmp_path_factory.mktemp("prefix"))


def loader_path(shown: dict) -> list[str]:
    """Return LD_LIBRARY_PATH as the dynamic loader read it, before the hook could change it."""
    return next(
        (line.split("=", 1)[1].split(":") for line in shown["loader"] if line.startswith("LD_LIB")),
        [],
    )


def test_the_loader_sees_the_stand_ins_first(prefix: Prefix) -> None:
    shown = prefix.show(LD_LIBRARY_PATH=f"/opt/mine:{prefix.path}/lib")
    assert loader_path(shown) == [str(prefix.stand_ins), *prefix.wheel_libraries, "/opt/mine"]
    assert shown["environ"]["_ROS_WHEELS_BOOTSTRAP_COMPLETE"] == "1"


def test_child_processes_inherit_the_stand_ins(prefix: Prefix) -> None:
    path = prefix.show(LD_LIBRARY_PATH="/opt/mine")["environ"]["LD_LIBRARY_PATH"].split(":")
    assert path == [str(prefix.stand_ins), *prefix.wheel_libraries, "/opt/mine"]


@pytest.mark.parametrize("selection", ["['RMW_IMPLEMENTATION'] = 'other'", ".clear()"])
@pytest.mark.parametrize("call", STARTS)
def test_a_child_that_selects_another_middleware_gets_it(
    prefix: Prefix, call: str, selection: str
) -> None:
    path = "os.environ['LD_LIBRARY_PATH']"
    child = f"path = {path}; os.environ{selection}; {path} = path; {call}"
    shown = prefix.show("-c", f"import os, subprocess, sys; {child}", SHOW)
    assert loader_path(shown) == prefix.wheel_libraries
    assert shown["environ"]["LD_LIBRARY_PATH"].split(":") == prefix.wheel_libraries


@pytest.mark.parametrize("call", STARTS)
def test_a_python_child_is_as_its_parent(prefix: Prefix, call: str) -> None:
    shown = prefix.show("-c", f"import os, subprocess, sys; {call}", SHOW)
    assert loader_path(shown) == [str(prefix.stand_ins), *prefix.wheel_libraries]
    assert set(hook.MALLOC_TUNING) <= {entry.split("=")[0] for entry in shown["loader"]}
    assert not set(hook.MALLOC_TUNING) & set(shown["environ"])


def test_a_child_without_the_search_path_gets_it_anew(prefix: Prefix) -> None:
    child = f"import os, subprocess, sys; del os.environ['LD_LIBRARY_PATH']; {STARTS[0]}"
    assert loader_path(prefix.show("-c", child, SHOW))[0] == str(prefix.stand_ins)


@pytest.mark.parametrize("spelling", ["{0}", "{0}/", "{0}:{1}", "/opt/mine:{0}:{1}"])
def test_stand_ins_of_the_shell_are_for_rmw_manycore_only(prefix: Prefix, spelling: str) -> None:
    path = spelling.format(prefix.stand_ins, f"{prefix.path}/lib")
    for other in ("rmw_fastrtps_cpp", ""):
        shown = prefix.show(RMW_IMPLEMENTATION=other, LD_LIBRARY_PATH=path)
        assert loader_path(shown)[:2] == prefix.wheel_libraries
        assert hook.REPLACED not in shown["environ"]
    assert loader_path(prefix.show(LD_LIBRARY_PATH=path))[0] == str(prefix.stand_ins)


def test_stand_ins_behind_the_library_itself_do_no_harm(prefix: Prefix) -> None:
    path = f"{prefix.path}/lib:{prefix.stand_ins}"
    shown = prefix.show(RMW_IMPLEMENTATION="rmw_fastrtps_cpp", LD_LIBRARY_PATH=path)
    assert loader_path(shown) == path.split(":")


@pytest.mark.parametrize("other", ["rmw_fastrtps_cpp", "rmw_manycore_cpp", ""])
def test_other_processes_are_left_alone(prefix: Prefix, other: str) -> None:
    shown = prefix.show(RMW_IMPLEMENTATION=other)
    assert "LD_LIBRARY_PATH" not in shown["environ"]


def test_the_hook_is_not_even_imported_by_other_processes(prefix: Prefix) -> None:
    code = "import sys; print('rmw_manycore_hook' in sys.modules)"
    assert prefix.run("-c", code, RMW_IMPLEMENTATION="").stdout == "False\n"


def test_an_ordinary_ros_install_is_left_alone(tmp_path: Path) -> None:
    prefix = Prefix(tmp_path)
    (tmp_path / "lib/librmw_fastrtps_cpp.so").unlink()
    assert "LD_LIBRARY_PATH" not in prefix.show()["environ"]


def test_a_launcher_saves_the_second_start(prefix: Prefix) -> None:
    environment = hook.substituted_environment(
        {"RMW_IMPLEMENTATION": "rmw_manycore"}, str(prefix.path)
    )
    process = subprocess.Popen(
        [prefix.python, "-c", SHOW], env=environment, stdout=subprocess.PIPE, text=True
    )
    shown = json.loads(process.communicate(timeout=TIMEOUT_S)[0])
    assert loader_path(shown)[0] == str(prefix.stand_ins)
    assert hook.REPLACED not in "".join(shown["loader"])


def test_a_launcher_leads_to_fast_dds_too(prefix: Prefix) -> None:
    """From a shell of rmw_manycore, and from a Python with other wheels."""
    known = f"/opt/other/lib:{prefix.stand_ins}:{prefix.path}/lib"
    environment = hook.plain_environment({"LD_LIBRARY_PATH": known}, str(prefix.path))
    assert environment["LD_LIBRARY_PATH"].split(":") == [*prefix.wheel_libraries, "/opt/other/lib"]
    assert environment["_ROS_WHEELS_BOOTSTRAP_COMPLETE"] == "1"


def test_a_launcher_in_a_substituted_shell_leaves_settings_to_its_nodes(prefix: Prefix) -> None:
    """A node of `manycore run` with `malloc_tuning: false` is not restarted with it."""
    variables = {"RMW_IMPLEMENTATION": "rmw_manycore", hook.REPLACED: hook.PARENT}
    environment = hook.substituted_environment(variables, str(prefix.path))
    del environment["RMW_IMPLEMENTATION"]
    loader = "".join(prefix.show(**environment)["loader"])
    assert "MALLOC" not in loader


def test_the_environment_of_an_ordinary_ros_is_not_changed(tmp_path: Path) -> None:
    assert hook.substituted_environment({"A": "b"}, str(tmp_path)) == {"A": "b"}


@pytest.fixture
def beside_ros(tmp_path: Path) -> Prefix:
    """A prefix with rmw_manycore but no ROS 2, which is installed elsewhere."""
    prefix = Prefix(tmp_path)
    (tmp_path / "lib/librmw_fastrtps_cpp.so").unlink()
    (tmp_path / hook.OWN_LIBRARY).touch()
    return prefix


def test_a_sourced_ros_finds_the_middleware_after_its_own_libraries(beside_ros: Prefix) -> None:
    sourced = {"AMENT_PREFIX_PATH": "/opt/ros", "LD_LIBRARY_PATH": "/opt/ros/lib"}
    path = ["/opt/ros/lib", f"{beside_ros.path}/lib"]
    shown = beside_ros.show(**sourced)
    assert loader_path(shown) == path
    assert shown["environ"]["AMENT_PREFIX_PATH"] == f"/opt/ros:{beside_ros.path}"
    assert hook.WHEELS_BOOTSTRAPPED not in shown["environ"]
    again = beside_ros.show(**sourced | {"LD_LIBRARY_PATH": ":".join(path)})
    assert hook.REPLACED not in again["environ"]  # not started twice


def test_without_a_sourced_ros_there_is_nothing_to_find(beside_ros: Prefix) -> None:
    assert "LD_LIBRARY_PATH" not in beside_ros.show()["environ"]


def test_memory_of_large_messages_is_kept_by_this_process_only(prefix: Prefix) -> None:
    shown = prefix.show()
    loader = dict(entry.split("=", 1) for entry in shown["loader"] if "=" in entry)
    assert {name: loader.get(name) for name in hook.MALLOC_TUNING} == hook.MALLOC_TUNING
    assert not [name for name in shown["environ"] if name.startswith("MALLOC_")]


def test_settings_of_malloc_that_are_there_stay(prefix: Prefix) -> None:
    own = {"MALLOC_TRIM_THRESHOLD_": "65536"}
    assert prefix.show(**own)["environ"]["MALLOC_TRIM_THRESHOLD_"] == "65536"


def test_options_and_arguments_survive(prefix: Prefix, tmp_path: Path) -> None:
    (tmp_path / "shown.py").write_text(SHOW)
    script = str(tmp_path / "shown.py")
    for start in (["-X", "utf8", script], ["-u", "-X", "utf8=1", "-W", "ignore", script]):
        shown = prefix.show(*start, "--ros-args", "-r", "a:=b c")
        assert shown["orig_argv"] == [*start, "--ros-args", "-r", "a:=b c"]
        assert shown["argv"] == [script, "--ros-args", "-r", "a:=b c"]
        assert shown["flags"] == 1


def test_modules_start_as_modules(prefix: Prefix) -> None:
    (prefix.site_packages / "shown.py").write_text(SHOW)
    shown = prefix.show("-m", "shown", "x")
    assert shown["orig_argv"] == ["-m", "shown", "x"]
    assert shown["argv"] == [str(prefix.site_packages / "shown.py"), "x"]
    assert loader_path(shown)[0] == str(prefix.stand_ins)


def test_a_program_on_standard_input_is_read_once(prefix: Prefix) -> None:
    done = subprocess.run(
        [prefix.python, "-"],
        input=SHOW,
        capture_output=True,
        text=True,
        timeout=TIMEOUT_S,
        env={"RMW_IMPLEMENTATION": "rmw_manycore"},
    )
    assert loader_path(json.loads(done.stdout))[0] == str(prefix.stand_ins)


def test_a_lost_library_path_is_reported_and_not_retried(prefix: Prefix) -> None:
    """If something clears LD_LIBRARY_PATH on the way, Python must not restart forever."""
    done = subprocess.run(
        ["bash", "-c", f"{hook.REPLACED}=$$ exec {prefix.python} -c 'print(1)'"],
        env={"PATH": "/usr/bin:/bin", "RMW_IMPLEMENTATION": "rmw_manycore"},
        capture_output=True,
        text=True,
        timeout=TIMEOUT_S,
    )
    assert done.stdout == "1\n"
    assert "LD_LIBRARY_PATH was lost" in done.stderr


def test_no_interruption_is_lost_between_two_starts(prefix: Prefix) -> None:
    """Python would record a SIGINT during `os.execve()`, and be replaced before it acts."""
    exec_and_interruption = "os.execve = lambda *_: signal.raise_signal(signal.SIGINT)"
    code = f"import os, signal, rmw_manycore_hook as hook; {exec_and_interruption}; "
    done = prefix.run("-c", code + "hook.restart({}); print('went on')")
    assert (done.returncode, done.stdout, done.stderr) == (-signal.SIGINT, "", "")


def test_an_ignored_interruption_stays_ignored(prefix: Prefix) -> None:
    """As in background jobs of a shell."""
    code = "import signal; print(signal.getsignal(signal.SIGINT) == signal.SIG_IGN)"
    script = f"trap '' INT; exec {prefix.python} -c '{code}'"
    done = subprocess.run(
        ["bash", "-c", script],
        env={"PATH": "/usr/bin:/bin", "RMW_IMPLEMENTATION": "rmw_manycore"},
        capture_output=True,
        text=True,
        timeout=TIMEOUT_S,
    )
    assert (done.stdout, done.stderr) == ("True\n", "")


def test_the_hook_comes_before_that_of_the_wheels() -> None:
    assert sorted(["ros_wheels_bootstrapper.pth", "rmw_manycore.pth"])[0] == "rmw_manycore.pth"
