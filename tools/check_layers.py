#!/usr/bin/env python3
"""Checks the layers of the design: reads the #include lines and looks for a few forbidden words.

usage: check_layers.py [ROOT]     ROOT is the repository (default: the folder above this file)

Prints one line for each violation, FILE:LINE: the problem and its solution, and exits 1 if there is any.
"""

import re
import sys
from pathlib import Path

# A stage (a folder of src/prostm/) may include directly the stages that its prostm_stage(…) in CMakeLists.txt links;
# every stage may include core. Programs and modules may include every stage that their folder's CMakeLists.txt links,
# directly or indirectly. A folder detail/ is private to its stage; tests, benchmarks and the lab may include it too.
STAGE = re.compile(r"^\s*prostm_stage\((\w+)([^)]*)\)", re.M)
LINKED = re.compile(r"^\s*(?:target_link_libraries|prostm_lab)\(([^)]*)\)", re.M)
OURS = re.compile(r"\bprostm_(\w+)\b")
PROGRAMS = ("apps", "python", "bench", "lab", "fuzz")
MAY_LOOK_INSIDE = ("tests", "bench", "lab")
STAGES = "src/prostm/"
# These programs are shipped: they include headers of stages and of their own folder alone, and nothing that is shipped
# links the lab, benchmarks or tests.
SHIPPED = ("apps/", "python/")
NOT_SHIPPED = re.compile(r"\bprostm_(?:\w+_lab|\w+_bench|rows|test_support)\b"
                         r"|(?<![\w-])(?:\.\./)*(?:tests|lab|bench)/[\w./-]*")
LISTS = ("CMakeLists.txt", "apps/CMakeLists.txt", "python/CMakeLists.txt")
OF_ALL = (STAGES + "prostm.hpp", STAGES + "version.hpp", STAGES + "commit.hpp")

# Rooms, the folders inside a stage, by rank: a room includes rooms of lower ranks, itself with its subfolders, and the
# headers directly in the stage's folder. detail/ of a stage is for its rooms, too.
RANKS = {
    "acoustics": (("acoustics/array",), ("acoustics/field",), ("acoustics/focus", "acoustics/skin")),
    "core": (("core/file",), ("core/text",)),
    "device": (("device/detail",), ("device/safety",),
               ("device/simulated", "device/stream", "device/autd3", "device/ultraleap"), ("device/autd3_sdk",)),
    "io": (("io/detail",), ("io/field", "io/hand")),
    "pipeline": (("pipeline/smoke",), ("pipeline/realtime",)),
    "plan": (("plan/quasi_static", "plan/detail"), ("plan/detail/paper", "plan/detail/fit")),
    "study": (("study/protocol",), ("study/task",), ("study/session",), ("study/analysis",), ("study/live",)),
}
RANK_OF = {room: rank for ranks in RANKS.values() for rank, rooms in enumerate(ranks) for room in rooms}
# Headers of a stage that use its rooms, so no room includes them.
ABOVE_ROOMS = ("plan/planner.hpp", "device/device_kinds.hpp")

# Only these may use threads, mutexes and clocks.
MAY_USE_THREADS = tuple(STAGES + place for place in
                        ("core/worker_pool.", "track/live/", "track/detail/", "device/", "pipeline/", "study/live/", "viewer/"))
MAY_USE_CLOCKS = (STAGES + "core/stage_timer.",) + MAY_USE_THREADS[1:]
THREAD_HEADERS = {"thread", "mutex", "condition_variable", "shared_mutex", "stop_token", "semaphore", "barrier",
                  "latch", "future"}
CLOCK_HEADERS = {"chrono", "ctime", "time.h", "sys/time.h"}
PRINTING_HEADERS = {"iostream", "print", "syncstream"}
LANGUAGE_HEADERS = {"format", "expected", "source_location", "generator", "coroutine"}

# Words that need no header of their own: (pattern, allowed places, problem).
WORDS = [
    (re.compile(r"\bstd::(this_thread|j?thread|mutex|\w+_mutex|condition_variable\w*|async|call_once)\b"),
     MAY_USE_THREADS, "threads and mutexes live in core/worker_pool, track/live, device, pipeline, study/live and viewer"),
    (re.compile(r"\b(std::chrono|clock_gettime|gettimeofday|std::time|std::clock)\b"),
     MAY_USE_CLOCKS, "clocks live in core/stage_timer, track/live, device, pipeline, study/live and viewer"),
    (re.compile(r"\b(std::(cout|cerr|clog|printf|puts|print|println)|f?printf|puts|fmt::print(ln)?)\b"),
     (), "nothing in src/ prints: return it, or throw"),
    (re.compile(r"\bstd::(views|ranges::views)::|\|\s*views::"),
     (), "std::views is not accepted by clang 14: write the loop"),
    (re.compile(r"\bco_(await|yield|return)\b"), (), "coroutines are not used"),
]

# Words of the language rule are checked everywhere, the others in src/ only.
EVERYWHERE = WORDS[3:]

OLD_NAMES = re.compile(r"(_old\b|_old[_.]|[-_.]old\.|\.bak$|\.orig$|~$|_v[0-9]+(\.[0-9]+)*\.|_copy\.|_backup\b)")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
TEXT_OR_COMMENT = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"([^(\s]*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])+\'', re.S)


def read_layers(root):
    """Returns stage -> the stages that it may include, from CMakeLists.txt; a stage comes after those that it links."""
    layers = {}
    for stage, linked in STAGE.findall((root / "CMakeLists.txt").read_text(encoding="utf-8")):
        names = OURS.findall(linked)
        layers[stage] = [name for name in names if name in layers]
    return layers


def reachable(layers, names):
    """Returns the stages among names, and all stages that they link, directly or indirectly."""
    found, queue = set(), [name for name in names if name in layers]
    while queue:
        name = queue.pop()
        if name not in found:
            found.add(name)
            queue += layers[name]
    return found


def read_programs(root, layers):
    """Returns folder of programs -> the stages that it may include, from its CMakeLists.txt."""
    out = {}
    for top in PROGRAMS:
        lists = root / top / "CMakeLists.txt"
        if lists.is_file():
            linked = " ".join(LINKED.findall(lists.read_text(encoding="utf-8")))
            out[top] = reachable(layers, OURS.findall(linked)) | {"core"}
    return out


def without_text(source):
    """Returns the source with comments and string literals blanked out, lines kept."""
    return TEXT_OR_COMMENT.sub(lambda m: "\n" * m.group(0).count("\n") or " ", source)


def room_of(path):
    """Returns the innermost room that holds a file or header, or None; `path` begins with the stage."""
    return max((room for room in RANK_OF if path.startswith(room + "/")), key=len, default=None)


def closed_to(room, header):
    """Returns the header or the room of it that files in `room` must not include, or None; `header` is of the same stage."""
    if room is None:
        return None
    if header in ABOVE_ROOMS:
        return header
    other = room_of(header)
    return other if other not in (None, room) and RANK_OF[other] >= RANK_OF[room] else None


def check_stage_include(place, stage, header, layers):
    """Returns the problem if the file at place (in its stage) includes the header, both as stage/…, or None."""
    layer = header.split("/")[0]
    allowed = [stage, "core"] + layers[stage]
    if layer not in allowed:
        return f"{stage} must not include {layer}: it may include {', '.join(sorted(set(allowed)))}"
    if layer != stage and "/detail/" in header:
        return f'"prostm/{header}" is private to {layer}'
    closed = closed_to(room_of(place), header) if layer == stage else None
    return f"{room_of(place)} must not include {closed}" if closed else None


def check_program_include(top, header, layers, programs):
    """The same for a file outside src/: it may include only stages that its folder links, and, except in tests,
    benchmarks and the lab, nothing private."""
    layer = header.split("/")[0]
    if top in programs and layer not in programs[top]:
        return f"{top} must not include {layer}: no target of {top}/CMakeLists.txt links prostm_{layer}"
    if "/detail/" in header and top not in MAY_LOOK_INSIDE:
        return f'"prostm/{header}" is private to {layer}'
    return None


def check_include(path, stage, quoted, name, layers, programs):
    """Returns the problem of one #include line, or None. `stage` is None outside src/."""
    if name in LANGUAGE_HEADERS and not quoted:
        return f"<{name}> is not accepted by both compilers"
    header = name.removeprefix("prostm/")
    is_ours = header != name and header.split("/")[0] in layers
    if stage is None:
        top = path.split("/")[0]
        return check_program_include(top, header, layers, programs) if is_ours and quoted else None
    if not quoted:
        if name in THREAD_HEADERS and not path.startswith(MAY_USE_THREADS):
            return f"<{name}>: " + WORDS[0][2]
        if name in CLOCK_HEADERS and not path.startswith(MAY_USE_CLOCKS):
            return f"<{name}>: " + WORDS[1][2]
        if name in PRINTING_HEADERS:
            return f"<{name}>: " + WORDS[2][2]
        return f"<{name}> is one of our own headers: include it with quotes" if is_ours else None
    if name.startswith("."):
        return f'"{name}" is relative: include from src/, as "prostm/stage/file.hpp"'
    if not is_ours:
        return f'"{name}" is not a header of a stage: stages include "prostm/stage/file.hpp"'
    return check_stage_include(path.removeprefix(STAGES), stage, header, layers)


def check_own_include(root, file, name):
    """Returns the problem of a quoted #include of a shipped program, or None: a header that is of no stage must lie in the
    program's own folder."""
    if name.startswith("prostm/"):
        return None
    top, *rest = file.relative_to(root).parts
    own = root / top / rest[0] if len(rest) > 1 else root / top
    for place in (file.parent, own):
        header = (place / name).resolve()
        if header.is_file() and header.is_relative_to(own.resolve()):
            return None
    folder = own.relative_to(root).as_posix()
    return f'"{name}" is no header of {folder}/: what is shipped uses nothing of lab, bench or tests'


def check_lists(root):
    """Returns the violations of the CMake files of what is shipped, as 'file:line: message'."""
    found = []
    for name in LISTS:
        if not (root / name).is_file():
            continue
        for number, line in enumerate((root / name).read_text(encoding="utf-8").split("\n"), 1):
            match = NOT_SHIPPED.search(line.split("#")[0])
            if match:
                found.append(f"{name}:{number}: {match.group(0)} is not for what is shipped: move the code into a stage")
    return found


def check_file(root, file, layers, programs):
    """Returns the violations of one C++ file, as (line, message)."""
    path = file.relative_to(root).as_posix()
    if path in OF_ALL:
        return []
    folder = path.removeprefix(STAGES).split("/")[0] if path.startswith("src/") else None
    if folder is not None and (folder not in layers or not path.startswith(STAGES)):
        return [(1, f"{path} is in no layer: it belongs into {STAGES}STAGE/, with prostm_stage(STAGE …) in CMakeLists.txt")]
    source = file.read_text(encoding="utf-8")
    found = []
    for number, line in enumerate(source.split("\n"), 1):
        include = INCLUDE.match(line)
        if include:
            wrong = check_include(path, folder, include.group(1) == '"', include.group(2), layers,
                                  programs)
            if not wrong and include.group(1) == '"' and path.startswith(SHIPPED):
                wrong = check_own_include(root, file, include.group(2))
            if wrong:
                found.append((number, wrong))
    for number, line in enumerate(without_text(source).split("\n"), 1):
        for pattern, allowed, wrong in WORDS if folder else EVERYWHERE:
            match = None if INCLUDE.match(line) else pattern.search(line)
            if match and not path.startswith(allowed or ("\0",)):
                found.append((number, f"'{match.group(0)}': {wrong}"))
    return found


def names_twice(root):
    """Types that two files define in the namespace prostm: a program that links both breaks the one-definition rule."""
    opening = re.compile(r"namespace ([\w:]*) ?\{")
    definition = re.compile(r"(?:struct|class|enum class) (\w+)(?: final)?(?: :[^:].*)? \{")
    first = {}
    for path in sorted(file for top in ("src", "apps") for file in (root / top).rglob("*.[hc]pp")):
        spaces = []
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if space := opening.match(line):
                spaces.append(space[1])
            elif line.startswith("}  // namespace") and spaces:
                spaces.pop()
            elif (found := definition.match(line)) and "" not in spaces:
                name = "::".join([*spaces, found[1]])
                place = f"{path.relative_to(root).as_posix()}:{number}"
                if name in first:
                    yield f"{place}: {name} is also the name of a type in {first[name]}"
                first.setdefault(name, place)


def check_tree(root):
    """Returns all violations below root, as 'file:line: message', sorted by file."""
    layers = read_layers(root)
    programs = read_programs(root, layers)
    lines = check_lists(root)
    for top in ("src", "apps", "python", "bench", "lab", "examples", "fuzz", "tests", "tools", "docs", "cmake"):
        for file in sorted((root / top).rglob("*")):
            if not file.is_file() or "__pycache__" in file.parts:
                continue
            path = file.relative_to(root).as_posix()
            if OLD_NAMES.search(file.name):
                lines.append(f"{path}:1: the name of an old copy: git is the archive")
            if file.suffix in (".hpp", ".cpp", ".h", ".cc"):
                lines += [f"{path}:{number}: {wrong}" for number, wrong in check_file(root, file, layers, programs)]
    return lines


def main():
    if len(sys.argv) > 2 or sys.argv[1:] in (["-h"], ["--help"]):
        print(__doc__.strip())
        return 0 if len(sys.argv) == 2 else 2
    root = Path(sys.argv[1]) if len(sys.argv) == 2 else Path(__file__).resolve().parent.parent
    for needed in ("src", "CMakeLists.txt"):
        if not (root / needed).exists():
            print(f"check_layers: {root} has no {needed}", file=sys.stderr)
            return 2
    lines = [*check_tree(root), *names_twice(root)]
    for line in lines:
        print(line)
    if not lines:
        print("layers: every #include is of a stage that CMake links")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
