"""The package itself."""

from __future__ import annotations

import pathlib
import subprocess
import sys

import grashof


def test_importing_is_quick_and_needs_no_other_package(tmp_path: pathlib.Path) -> None:
    code = (
        "import sys, time; begin = time.process_time(); import grashof; "
        "print(time.process_time() - begin); "
        "print(*[name for name in ('numpy', 'pandas', 'xarray', 'matplotlib', 'scipy', 'control', 'pint') if name in sys.modules])"
    )

    def run() -> list[str]:
        # elsewhere, lest the sources be imported
        done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True, cwd=tmp_path)
        return done.stdout.splitlines()

    runs = [run() for _ in range(3)]
    assert min(float(run[0]) for run in runs) < 0.15
    assert all(run[1] == "" for run in runs)


def test_the_version_is_that_of_the_library() -> None:
    assert grashof.__version__.count(".") == 2


def test_everything_public_has_a_docstring() -> None:
    for name in grashof.__all__:
        public = getattr(grashof, name)
        assert public.__doc__, name
        for key, member in vars(public).items() if isinstance(public, type) else ():
            if not key.startswith("_") and (callable(member) or isinstance(member, property)):
                assert member.__doc__, f"{name}.{key}"
