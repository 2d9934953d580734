"""What the checks of app/bench's scripts share: runs of the script in a folder of their own.

Arguments of each check: the script, the folder of programs.
"""
import os
import pathlib
import subprocess
import sys
import tempfile

script, programs = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
folder = tempfile.TemporaryDirectory()
here = pathlib.Path(folder.name)
out = here / "out"


def run(*arguments):
    line = [sys.executable, "-B", str(script), "--out", str(out), "--programs", str(programs)]
    return subprocess.run([*line, *arguments], capture_output=True, text=True, cwd=here)


def refused(code, words, *arguments):
    """One sentence that says what is wrong, and the documented exit code."""
    done = run(*arguments)
    assert done.returncode == code, (done.returncode, done.stderr)
    assert done.stderr.count("\n") == 1 and words in done.stderr, done.stderr


def skip(reason):
    """Ends the check: on a machine that lacks something, but not in CI."""
    print(f"skipped: {reason}")
    sys.exit(1 if os.environ.get("CI") == "true" else 77)


def finished(done):
    """A run that has to succeed; without OpenGL the check is skipped."""
    if done.returncode == 4:
        skip(done.stderr.strip())
    assert done.returncode == 0, done.stderr
