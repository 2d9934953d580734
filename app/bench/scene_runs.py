"""What cuts.py, flicker.py, paper.py and scenes.py share: their command line, scenes, runs of the viewer, what is kept."""

import argparse
import functools
import hashlib
import json
import os
import pathlib
import subprocess
import sys

METHODS = "megaviews,manylods,rays,shadow-rays,ism,vir"
VIEWS = ("guide views", "trace views", "choose views", "sort views", "view hierarchy")


class Failure(Exception):
    """One sentence, with the exit code that says the same (docs/command-line.md)."""

    def __init__(self, code, sentence):
        super().__init__(sentence)
        self.code = code


def parser_of(doc, **defaults):
    """The arguments of all, with their defaults; a wrong one is one sentence and exit code 2."""
    parser = argparse.ArgumentParser(description=doc.split("\n")[0])
    parser.error = lambda message: parser.exit(2, f"{parser.prog}: {message}\n")
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--out", type=pathlib.Path)
    parser.add_argument("--programs", type=pathlib.Path, default=pathlib.Path("build"))
    if "methods" in defaults:
        parser.add_argument("--methods")
    parser.add_argument("--resolution")
    parser.set_defaults(**defaults)
    return parser


def parse(parser, line):
    """The arguments, with what stands after -- as args.flags, the methods, where there are some, as
    a list of known ones, and the program's version and content. Makes the folder args.out."""
    end = line.index("--") if "--" in line else len(line)
    args = parser.parse_args(line[:end])
    args.flags = line[end + 1:]
    args.out.mkdir(parents=True, exist_ok=True)
    viewer = str(args.programs / "megaviews")
    version = run([viewer, "--version"]).stdout.splitlines()[0]
    args.version = f"{version}, {hashlib.sha256(pathlib.Path(viewer).read_bytes()).hexdigest()}"
    if "methods" not in args:
        return args
    known = run([viewer, "--list", "methods"]).stdout.split()
    args.methods = args.methods.split(",")
    for method in args.methods:
        if method not in known:
            raise Failure(2, f"--methods has no '{method}'; there are {', '.join(known)}")
    return args


def scenes_of(places):
    """Names and places of all scenes; a name that was had already is followed by a number."""
    found = []
    for place in places:
        path = pathlib.Path(place)
        if place.startswith("builtin:"):
            found.append((place.split(":")[1], place))
        elif path.is_dir():
            files = sorted([*path.rglob("*.glb"), *path.rglob("*.gltf")])
            if not files:
                raise Failure(3, f"'{place}' holds no .glb and no .gltf file")
            found += [(file.stem, str(file)) for file in files]
        else:
            found.append((path.stem, place))
    times = {}
    for name, place in found:
        times[name] = times.get(name, 0) + 1
        yield (name if times[name] == 1 else f"{name}-{times[name]}"), place


def milliseconds(stats):
    """Of views, maps, gather with its filter, from the stages of --stats."""
    stages = dict(stats["shared"]["ms"], **stats["methods"][0]["ms"])
    ms = {name: value["median"] for name, value in stages.items()}
    views = sum(ms.get(name, 0) for name in VIEWS)
    gather = sum(ms.get(name, 0) for name in ("gather cull", "gather", "near field", "filter"))
    maps = sum(ms.get(name, 0) for name in
               ("traverse", "fill", "fuse", "rasterise", "make points", "splat points",
                "pull and push", "march tree"))
    return views, maps, gather


def write_whole(file, text):
    """The file as it was or, once all of it is written, with this text."""
    aside = file.with_name(f".{file.name}.part")
    try:
        aside.write_text(text)
        os.replace(aside, file)
    finally:
        aside.unlink(missing_ok=True)


@functools.cache
def content_of(viewer, place):
    """A hash of what a scene's files hold."""
    said = run([viewer, place, "--info=json", "--no-config"]).stdout
    return json.loads(said)["scene"]["hash"]


def asked(args, place, *words):
    """What decides a measurement: program, scene, and the words that ask for it."""
    return [args.version, content_of(str(args.programs / "megaviews"), place), place, *words]


def beside(base, ending):
    """BASE.ENDING; a name may hold dots."""
    return base.with_name(f"{base.name}.{ending}")


def kept(file, asked, measure):
    """What `measure` gives, from the file if that was asked before in the same words."""
    try:
        before = json.loads(file.read_text())
        if before["asked"] == asked:
            return before["row"]
    except (OSError, ValueError, KeyError, TypeError):
        pass  # there is none, or it is damaged
    row = measure()
    write_whole(file, json.dumps({"asked": asked, "row": row}, indent=1))
    return row


def run(command, also=()):
    """A finished run; what a picture with NaN makes of it (exit code 1) counts as finished, and so
    do the codes `also`."""
    try:
        done = subprocess.run(command, capture_output=True, text=True)
    except OSError as error:
        raise Failure(3, f"'{command[0]}' cannot be run: {error.strerror}") from error
    if done.returncode not in (0, 1, *also):
        lines = [line for line in done.stderr.splitlines() if not line.startswith("info: ")]
        said = "\n".join(lines) or f"exit code {done.returncode} of {' '.join(command)}"
        raise Failure(done.returncode if done.returncode > 0 else 3, said)
    return done


def measure_scenes(args, script, rows_of, table):
    """rows_of(name, scene) gives a scene's rows; OUT/<script>.md and .json have all so far.

    A scene that fails is said on stderr, and the others follow. Returns the exit code.
    """
    code, rows = 0, []
    for name, scene in scenes_of(args.scenes):
        try:
            for row in rows_of(name, scene):
                rows.append(row)
                print(json.dumps(row), flush=True)
        except Failure as failure:
            print(f"{script}.py: {failure}", file=sys.stderr)
            code = failure.code
        write_whole(args.out / f"{script}.md", table(rows))
        write_whole(args.out / f"{script}.json", json.dumps(rows, indent=1))
    return code


def run_script(body):
    """Ends the program with what `body` returns, or one sentence and the code that says the same."""
    def end(code, sentence):
        print(f"{pathlib.Path(sys.argv[0]).name}: {sentence}", file=sys.stderr)
        sys.exit(code)
    try:
        sys.exit(body())
    except Failure as failure:
        end(failure.code, failure)
    except KeyboardInterrupt:
        end(130, "interrupted; what was measured is kept")
    except OSError as error:
        end(5, f"'{error.filename}': {error.strerror}" if error.filename else error.strerror)
