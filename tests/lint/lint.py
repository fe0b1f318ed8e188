#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The house rules that no compiler checks: lint.py RULE [ROOT]. Prints `file:line: fault` lines."""
import re
import subprocess
import sys
from pathlib import Path

CODE = {".cpp", ".h", ".ts", ".mjs", ".js", ".py", ".css", ".html", ".cmake", ".sh", ".yml", ".yaml"}
TOP = {"CMakeLists.txt", "CMakePresets.json", "server", "codec", "acquisition", "web", "tests", "deploy",
       "README.md", "LICENSE", "NOTICE", "CHANGELOG.md", "CONTRIBUTING.md"}
MAX_FILE_LINES, MAX_FUNCTION_LINES = 600, 120


def files(root):
    """Paths of the work tree that git tracks or would track."""
    listing = subprocess.run(["git", "-c", "safe.directory=*", "-C", root, "ls-files", "-co", "--exclude-standard"],
                             check=True, capture_output=True, text=True).stdout
    return [path for path in map(Path, listing.splitlines()) if (root / path).is_file()]


def text(root, path):
    return (root / path).read_text(encoding="utf-8", errors="replace")


def is_code(root, path):
    if path.suffix in CODE or path.name == "CMakeLists.txt":
        return True
    return not path.suffix and text(root, path).startswith("#!")


def is_source(path):
    return path.suffix in {".cpp", ".h", ".ts"}


def spdx(root):
    for path in files(root):
        if is_code(root, path) and not any(
                "SPDX-License-Identifier: Apache-2.0" in line for line in text(root, path).splitlines()[:3]):
            yield path, 1, "no SPDX-License-Identifier: Apache-2.0 in the first three lines"


def length(root):
    for path in files(root):
        if not is_code(root, path):
            continue
        lines = text(root, path).splitlines()
        if len(lines) > MAX_FILE_LINES:
            yield path, len(lines), f"longer than {MAX_FILE_LINES} lines: which second idea lives in it?"
        for start, end in functions(lines) if is_source(path) else ():
            if end - start > MAX_FUNCTION_LINES:
                yield path, start + 1, f"a function of {end - start} lines; {MAX_FUNCTION_LINES} at most"


def functions(lines):
    """(first, last) line of each block that opens after `)`, found by indentation (code is formatted).
    A test suite's describe() is a list of functions, not one."""
    for start, line in enumerate(lines):
        if re.search(r"\)[^;{}]*\{$", line) and not re.match(r"\s*describe\(", line):
            indent = line[:len(line) - len(line.lstrip())]
            if line.lstrip().startswith(": "):  # a constructor's initialisers
                indent = indent[4:]
            closing = re.compile(re.escape(indent) + r"\}")
            end = next((i for i in range(start + 1, len(lines)) if closing.match(lines[i])), start)
            yield start, end


def unfinished(root):
    mark = re.compile(r"\b(TO" r"DO|FIX" r"ME|XX" r"X)\b")
    for path in files(root):
        if is_code(root, path) or path.suffix == ".md":
            for number, line in enumerate(text(root, path).splitlines(), 1):
                if mark.search(line):
                    yield path, number, f"unfinished by its own words: {line.strip()[:80]}"


def headers(root):
    for path in files(root):
        if path.suffix == ".h" and "#pragma once" not in text(root, path):
            yield path, 1, "no #pragma once"


def top(root):
    for name in sorted({path.parts[0] for path in files(root)}):
        if name not in TOP and not name.startswith("."):
            yield Path(name), 1, "does not belong at the top level"


def read_table(root):
    """rooms.txt as {room: set of what it may use}."""
    table = {}
    for number, line in enumerate(text(root, Path("tests/lint/rooms.txt")).splitlines(), 1):
        if line and not line.startswith("#"):
            room, uses = line.split(":", 1)
            table[room] = set(uses.split())
    return table


def allowed(uses, name):
    library = name.split("::")[0].lower()
    for use in uses:
        if use in ("*", name) or (use.endswith("/*") and name.startswith(use[:-1])):
            return True
        if "/" not in use and library.startswith(use.split("::")[0].lower().replace("-", "_")):
            return True
    return False


def links(cmake):
    """(line, room, names after USES and PRIVATE) of each vitrine_room() call."""
    for call in re.finditer(r"^\s*vitrine_room\(([^)]*)\)", cmake, re.M):
        line = cmake.count("\n", 0, call.start(1)) + 1
        words = re.sub(r"#.*", "", call.group(1)).split()
        names, taking = [], False
        for word in words[1:]:
            if word in ("USES", "PRIVATE", "SOURCES"):
                taking = word != "SOURCES"
            elif taking:
                names.append(word)
        yield line, words[0], names


def rooms(root):
    table = read_table(root)
    reached = {room: {room} for room in table}
    order = list(table)
    for path in files(root):
        if path.name != "CMakeLists.txt" or path.parts[0] in ("tests", "web"):
            continue
        for line, room, names in links(text(root, path)):
            if room not in table:
                yield path, line, f"{room} is not in tests/lint/rooms.txt"
                continue
            for name in names:
                if not allowed(table[room], normal(name)):
                    yield path, line, f"{room} may not link {name} (tests/lint/rooms.txt)"
                elif name in table:
                    reached[room].add(name)
                    if order.index(name) > order.index(room):
                        yield path, line, f"{room} reaches up to {name}, which rooms.txt lists after it"
    for room in order:  # lower rooms come first, so that theirs are complete
        for below in list(reached[room]):
            reached[room] |= reached[below]
    yield from includes(root, table, reached)


def normal(name):
    """Library names as the table spells them."""
    return {"Threads::Threads": "threads", "nlohmann_json::nlohmann_json": "nlohmann-json", "OpenMeshCore": "OpenMesh",
            "OpenMeshTools": "OpenMesh", "SQLite::SQLite3": "SQLite", "PostgreSQL::PostgreSQL": "PostgreSQL", "pugixml::pugixml": "pugixml", "${VITRINE_SECCOMP}": "seccomp",
            "${VITRINE_TURBOJPEG}": "TurboJPEG", "PkgConfig::aravis": "Aravis", "PkgConfig::libusb": "libusb",
            "PkgConfig::umockdev": "umockdev"}.get(name, name)


def includes(root, table, reached):
    for path in files(root):
        room = next((str(folder) for folder in path.parents if str(folder) in table), None)
        if room is None or path.suffix not in {".cpp", ".h"}:
            continue
        for number, line in enumerate(text(root, path).splitlines(), 1):
            quoted = re.match(r'\s*#include "([^"]+)"', line)
            if not quoted:
                continue
            owner = next((str(folder) for folder in Path(quoted.group(1)).parents if str(folder) in table), None)
            if owner is None:
                yield path, number, f'"{quoted.group(1)}" is not a path from the root into a room'
            elif owner not in reached[room]:
                yield path, number, f"{room} includes {owner} without a link edge"


def types(root):
    """A second type of the same full name: the linker takes the members of one for those of the other."""
    seen = {}
    for path in files(root):
        if path.suffix != ".h" or path.parts[0] not in {"codec", "acquisition", "server"}:
            continue
        space = ""
        for number, line in enumerate(text(root, path).splitlines(), 1):
            if opened := re.match(r"namespace ([\w:]+) \{", line):
                space = opened[1]
            defined = re.match(r"(?:struct|class|enum class) (\w+)(?: final)?(?: : .*)? \{", line)
            if defined and (name := f"{space}::{defined[1]}") in seen:
                yield path, number, f"{name} is a type of {seen[name]} already"
            elif defined:
                seen[name] = path


RULES = {rule.__name__: rule for rule in (spdx, length, unfinished, headers, top, rooms, types)}


def main():
    if len(sys.argv) < 2 or sys.argv[1] not in RULES:
        sys.exit("usage: lint.py " + "|".join(RULES) + " [ROOT]")
    root = Path(sys.argv[2] if len(sys.argv) > 2 else ".").resolve()
    faults = [f"{path}:{line}: {fault}" for path, line, fault in RULES[sys.argv[1]](root)]
    print("\n".join(faults) or f"{sys.argv[1]}: clean")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
