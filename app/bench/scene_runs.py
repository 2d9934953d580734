"""What scenes.py and flicker.py share: their command line, scenes, and runs of the viewer."""

import argparse
import pathlib
import subprocess

METHODS = "megaviews,manylods,rays,shadow-rays,ism"


class Failure(Exception):
    """One sentence, with the exit code that says the same (docs/command-line.md)."""

    def __init__(self, code, sentence):
        super().__init__(sentence)
        self.code = code


def parser_of(doc, **defaults):
    """The arguments of both, with their defaults; a wrong one is one sentence and exit code 2."""
    parser = argparse.ArgumentParser(description=doc.split("\n")[0])
    parser.error = lambda message: parser.exit(2, f"{parser.prog}: {message}\n")
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--out", type=pathlib.Path)
    parser.add_argument("--programs", type=pathlib.Path, default=pathlib.Path("build"))
    parser.add_argument("--methods")
    parser.add_argument("--resolution")
    parser.set_defaults(**defaults)
    return parser


def parse(parser, line):
    """The arguments, with what stands after -- as args.flags. Makes the folder args.out."""
    end = line.index("--") if "--" in line else len(line)
    args = parser.parse_args(line[:end])
    args.flags = line[end + 1:]
    args.out.mkdir(parents=True, exist_ok=True)
    return args


def scenes_of(places):
    for place in places:
        path = pathlib.Path(place)
        if place.startswith("builtin:"):
            yield place.split(":")[1], place
        elif path.is_dir():
            for file in sorted([*path.rglob("*.glb"), *path.rglob("*.gltf")]):
                yield file.stem, str(file)
        else:
            yield path.stem, place


def run(command):
    """A finished run; what a picture with NaN makes of it (exit code 1) counts as finished."""
    try:
        done = subprocess.run(command, capture_output=True, text=True)
    except OSError as error:
        raise Failure(3, f"'{command[0]}' cannot be run: {error.strerror}") from error
    if done.returncode not in (0, 1):
        said = done.stderr.strip() or f"exit code {done.returncode} of {' '.join(command)}"
        raise Failure(done.returncode if done.returncode > 0 else 3, said)
    return done
