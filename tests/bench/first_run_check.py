"""app/bench/first_run.sh: its eight steps, and that it wants hardware unless it is told otherwise.

Arguments: first_run.sh, the folder of programs. Programs that only say what they were asked stand in
for those that take half an hour; the real ones are asked whether they know the words.
"""
import pathlib
import subprocess
import sys
import tempfile

script, programs = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
folder = tempfile.TemporaryDirectory()
here = pathlib.Path(folder.name)


def run(code, *options):
    """What a run prints whose programs end with the code."""
    for name in ("megaviews", "megaviews-bench"):
        (here / name).write_text(f'#!/bin/sh\necho "asked: {name} $*"\nexit {code}\n')
        (here / name).chmod(0o755)
    done = subprocess.run([script, *options, here, "builtin:cornell", here / "out", "2K"],
                          capture_output=True, text=True)
    assert done.stdout == (here / "out" / "log.txt").read_text()
    return done


def refused(code, words, *arguments):
    done = subprocess.run([script, *arguments], capture_output=True, text=True)
    assert done.returncode == code and words in done.stderr, done


refused(2, "PROGRAMS SCENE OUT", here)
refused(3, f"'{here}/megaviews': there is no such file", here, "builtin:cornell", here / "out")

done = run(4)
refused(3, "'absent.glb': there is no such file", here, "absent.glb", here / "out")
refused(2, "'many' is no count of views", here, "builtin:cornell", here / "out", "many")
assert done.returncode == 4 and done.stdout.count("asked:") == 2, done.stdout  # --version, selftest

done = run(0)
asked = [line.split()[1:] for line in done.stdout.splitlines() if line.startswith("asked:")][1:]
assert done.returncode == 0 and all("--require-hardware" in line for line in asked), done.stdout
assert {line[3] for line in done.stdout.splitlines() if line.startswith("== ") and line[3].isdigit()
        } == set("12345678")
assert any("32K" in line for line in asked), "sixteen times as many"
assert not any("--require-hardware" in line.split() for line in run(0, "--software").stdout.splitlines())

# A wrong word is found before anything is loaded; a scene that is not there comes after it.
for program, *words in asked:
    words = [word for word in words if word != "--require-hardware"]
    if "builtin:cornell" in words:
        words[words.index("builtin:cornell")] = "absent.glb"
        known = subprocess.run([programs / program, *words], capture_output=True, text=True, cwd=here)
        assert known.returncode == 3 and "absent.glb" in known.stderr, (words, known)
