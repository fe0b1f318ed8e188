#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the house rules that no compiler checks: lint.py RULE [ROOT]. Prints `file:line: fault` lines."""
import re
import subprocess
import sys
from pathlib import Path

CODE = {".cpp", ".h", ".ts", ".mjs", ".js", ".py", ".css", ".html", ".cmake", ".sh", ".yml", ".yaml"}
TOP = {"CMakeLists.txt", "CMakePresets.json", "server", "codec", "acquisition", "web", "tests", "deploy",
       "README.md", "LICENSE", "NOTICE", "CHANGELOG.md", "CONTRIBUTING.md"}
MAX_FILE_LINES, MAX_FUNCTION_LINES = 600, 120


def files(root):
    """Returns the files of the work tree that git tracks or would track (neither deleted nor ignored)."""
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
    """Yields (first, last) line of each block that opens after `)`, found by indentation (code is formatted). Skips describe(), a list of tests."""
    for start, line in enumerate(lines):
        if re.search(r"\)[^;{}]*\{$", line) and not re.match(r"\s*describe\(", line):
            first = opening_line(lines, start)
            indent = first[:len(first) - len(first.lstrip())]
            if first.lstrip().startswith(": "):  # a constructor's initialisers
                indent = indent[4:]
            closing = re.compile(re.escape(indent) + r"\}")
            end = next((i for i in range(start + 1, len(lines)) if closing.match(lines[i])), start)
            yield start, end


def opening_line(lines, last):
    """Returns the line on which a block's head begins. `last` is the index of the line on which the head ends.

    Parameters and initialisers may be on lines of their own."""
    depth = 0
    for at in range(last, max(0, last - 20), -1):
        depth += lines[at].count(")") - lines[at].count("(")
        if depth <= 0 and not lines[at - 1].endswith("),"):
            return lines[at]
    return lines[last]


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


ARCHITECTURE = Path("codec/ARCHITECTURE.md")
PUBLIC_HEADER = Path("codec/vitrine.h")  # includes the modules that users of the library see
# The headers whose inclusion shows that a source uses a library of ARCHITECTURE.md.
LIBRARIES = {"Aravis": "arv", "Boost": "boost/", "CURL": "curl/", "Draco": "draco/", "Embree": "embree3/", "LibArchive": "archive",
             "OpenCV": "opencv2/", "OpenMesh": "OpenMesh/", "OpenSSL": "openssl/", "PNG": "png.h", "PostgreSQL": "libpq-fe.h",
             "SQLite": "sqlite3.h", "TIFF": "tiffio.h", "TurboJPEG": "turbojpeg.h", "WebP": "webp/", "ZLIB": "zlib.h", "fmt": "fmt/", "libsystemd": "systemd/", "libusb": "libusb.h",
             "meshoptimizer": "meshoptimizer.h", "nlohmann-json": "nlohmann/", "pugixml": "pugixml.hpp", "seccomp": "seccomp.h", "stb": "stb/",
             "assimp": "assimp/", "threads": ("thread", "future"), "tl-expected": "tl/", "umockdev": "umockdev.h"}


class Module:
    """A module: its row in ARCHITECTURE.md, and the other modules and the libraries that its sources include."""

    def __init__(self, line, cells):
        self.line, self.name = line, cells[0].split("`")[1]
        self.modules, self.libraries = cells[2].split(), cells[3].split()
        self.used_modules, self.used_libraries = set(), set()


def read_architecture(root):
    rows = {}
    for number, line in enumerate(text(root, ARCHITECTURE).splitlines(), 1):
        if line.startswith("| `"):
            module = Module(number, line.strip("|").split("|"))
            rows[module.name] = module
    return rows


def owner(rows, path):
    return next((rows[str(folder)] for folder in Path(path).parents if str(folder) in rows), None)


def modules(root):
    rows = read_architecture(root)
    for path in files(root):
        if path.suffix in {".cpp", ".h"} and path.parts[0] in {"codec", "acquisition", "server"} and path != PUBLIC_HEADER:
            module = owner(rows, path)
            if module is None:
                yield path, 1, f"{ARCHITECTURE} has no row for {path.parent}"
            else:
                yield from check_includes(root, rows, module, path)
    for module in rows.values():
        yield from check_row(list(rows), module)


def check_includes(root, rows, module, path):
    for number, line in enumerate(text(root, path).splitlines(), 1):
        included = re.match(r'\s*#include (["<])([^">]+)[">]', line)
        if not included:
            continue
        if included[1] == "<":
            library = next((name for name, start in LIBRARIES.items() if is_header_of(included[2], start)), None)
            if library:
                module.used_libraries.add(library)
                if library not in module.libraries:
                    yield path, number, f"{module.name} uses {library}, which {ARCHITECTURE} does not permit"
            continue
        used = owner(rows, included[2])
        if used is None:
            yield path, number, f'"{included[2]}" is not a path from the root into a module'
        elif used is not module:
            module.used_modules.add(used.name)
            if used.name not in module.modules:
                yield path, number, f"{module.name} uses {used.name}, which {ARCHITECTURE} does not permit"


def is_header_of(header, start):
    return header in start if isinstance(start, tuple) else header.startswith(start)


def check_row(order, module):
    for name in module.modules:
        if name not in order:
            yield ARCHITECTURE, module.line, f"{module.name} uses {name}, which has no row"
        elif order.index(name) > order.index(module.name):
            yield ARCHITECTURE, module.line, f"{module.name} reaches up to {name}, which is listed after it"
        elif name not in module.used_modules:
            yield ARCHITECTURE, module.line, f"{module.name} may use {name} and does not"
    for name in module.libraries:
        if name not in module.used_libraries:
            yield ARCHITECTURE, module.line, f"{module.name} may use {name} and does not"


# Idioms that are hard to read, each with its replacement.
IDIOMS = {
    r"\bwhoever\b": "name the person or program: client, visitor, operator",
    r"(?:^\s*(?://+|#+|\*|/\*\*)\s*|[.:;] )(?:What|Who|Whom|Of) (?![^.]*\?)": "begin the sentence with its subject",
    r"\b(?:nothing|none) (?:where|if|when)\b": "say what it returns: nullopt if, empty if, an error if",
    r"\b(?:is|are|be) told\b": "say who reports what: the client receives, the log names",
    r"\banew\b": "again, or rebuilds, rereads",
    r"\ball the same\b": "anyway, or leave it out",
    r"\bwhere there (?:is|are) no(?:ne)?\b": "if there is no, or without",
    r"\b(?:takes?|taken|taking) back\b": "undo",
    r"\breckon": "estimate, compute",
    r"\b(?:goes|going|go|went) on\b": "continue",
    r"\bDESIGN(?:\.md)?,? section|(?<!\w)the paper\b(?!')": "cite a key of codec/REFERENCES.md with section or equation",
}


def words(root):
    """Reports places in comments, messages and documents that contain one of IDIOMS."""
    for path in files(root):
        if "corpus" in path.parts or not (is_code(root, path) or path.suffix == ".md") or path.parts[-1] in {"lint.py", "lint_test.py"}:
            continue
        for number, line in enumerate(text(root, path).splitlines(), 1):
            prose = line if path.suffix == ".md" else " ".join(re.findall(r"(?://|(?<![\w&$])#(?!include)|\*|/\*\*) ?.*|\"[^\"]*\"|'[^']* [^']*'|`[^`]*`", line))
            for idiom, instead in IDIOMS.items():
                if found := re.search(idiom, prose):
                    yield path, number, f'"{found[0].strip()}": {instead}'


# Names that are too general for several types. At most one type may have each; other types need a longer name, such as ChartPart.
BARE_NAMES = "Part|View|Target|Kind|Fault|Connection|Axis|Box|Place"
BARE_TYPE = re.compile(rf"\s*(?:export )?(?:struct|class|enum|enum class|interface|type|using) ({BARE_NAMES})\b(?!;)")


def types(root):
    """Reports types with the same full name, because the linker would mix up their members. Reports each of BARE_NAMES that two types have."""
    seen, bare = {}, {}
    for path in files(root):
        if not is_source(path) or path.parts[0] not in {"codec", "acquisition", "server", "web", "tests"}:
            continue
        lines = text(root, path).splitlines()
        if path.suffix == ".h" and path.parts[0] not in {"web", "tests"}:
            yield from same_full_names(path, lines, seen)
        for number, line in enumerate(lines, 1):
            if (defined := BARE_TYPE.match(line)) and (other := bare.setdefault(defined[1], f"{path}:{number}")) != f"{path}:{number}":
                yield path, number, f"{defined[1]} is the name of a type in {other} already; say of what"


def same_full_names(path, lines, seen):
    space = ""
    for number, line in enumerate(lines, 1):
        if opened := re.match(r"namespace ([\w: ]+) \{", line):
            space = opened[1]
        defined = re.match(r"(?:struct|class|enum class) (\w+)(?: final)?(?: : .*)? \{", line)
        if defined and (name := f"{space}::{defined[1]}") in seen:
            yield path, number, f"{name} is a type of {seen[name]} already"
        elif defined:
            seen[name] = path


MOVED_ERROR = re.compile(r"std::move\(\w+(?:\.error\(\)\)|\)\.error\(\))")


def errors(root):
    """Reports errors that are not passed up in the one spelling that CONTRIBUTING.md states."""
    for path in files(root):
        if path.suffix in {".cpp", ".h"}:
            for number, line in enumerate(text(root, path).splitlines(), 1):
                if MOVED_ERROR.search(line):
                    yield path, number, "an error that is moved; write tl::unexpected(result.error())"


FORMAT_TABLES = (Path("codec/import/formats.h"), Path("codec/export/write_mesh.h"))
FORMAT_ROW = re.compile(r'\.name = "(\w+)",\s+\.extension = "(\w+)"')
NAME_LIST = re.compile(r"\b(?:[A-Z0-9]{3,4}|glTF)(?:, (?:[A-Z0-9]{3,4}|glTF))+,? (?:and|or|und|oder) (?:[A-Z0-9]{3,5}|glTF)\b")
EXTENSION_LIST = re.compile(r"(?<!\w)\.?(?:[a-z0-9]{3,4}(?:,|, |\"?, \"|\|)\.?){2,}(?:(?:or|and) \.?)?[a-z0-9]{3,4}\b")


def formats(root):
    """Reports lists of four or more mesh formats that differ from all FORMAT_TABLES in content or order. A list may also contain other
    names, such as PMESH and ZIP. A list of extensions in code may have its own order, such as that of a menu."""
    tables = {path: FORMAT_ROW.findall(text(root, path)) for path in FORMAT_TABLES if (root / path).exists()}
    yield from ((path, 1, "has no row with .name and .extension") for path, rows in tables.items() if not rows)
    names = [[name for name, _ in rows] for rows in tables.values()]
    extensions = [[extension for _, extension in rows] for rows in tables.values()]
    for path in files(root):
        if path in tables or path.parts[0] == "tests" or path.name == "CHANGELOG.md" or not (is_code(root, path) or path.suffix == ".md"):
            continue
        for number, line in enumerate(text(root, path).splitlines(), 1):
            for pattern, known in ((NAME_LIST, names), (EXTENSION_LIST, extensions)):
                for found in pattern.finditer(line):
                    listed = [word for word in re.findall(r"[A-Za-z0-9]{3,5}", found[0]) if word in set().union(*known)]
                    has_own_order = pattern is EXTENSION_LIST and path.suffix != ".md"
                    is_known = any(listed == table or (has_own_order and set(listed) == set(table)) for table in known)
                    if len(listed) > 3 and not is_known:
                        yield path, number, f'"{found[0]}" lists other formats, or in another order, than the tables in {", ".join(map(str, tables))}'


REFERENCES = Path("codec/REFERENCES.md")
REFERENCE_ROW = re.compile(r"(?:\*\*|\| )\[([^\]]+)\]")
COMMENT = re.compile(r"(?://|/\*\*|^\s*[*#]|\"\"\").*")
# A name in brackets that looks like a key: "[Hoppe96]", "[RFC9110]". Arguments such as "[SEED]" and "[FILE]" do not.
KEY = re.compile(r"(?:^|(?<=[\s(]))\[([A-Z](?=[\w-]*[a-z0-9])[\w-]+)\](?![(`])")
UNMARKED_RFC = re.compile(r"\bRFC ?\d{4}\b(?!\])")


def references(root):
    """Reports keys of sources that the page of references lacks, keys that nothing cites, and RFCs that are cited without a key."""
    rows = {row[1]: number for number, line in enumerate(text(root, REFERENCES).splitlines(), 1) if (row := REFERENCE_ROW.match(line))}
    cited = set()
    for path in files(root):
        if path in {REFERENCES, Path("CHANGELOG.md")} or path.is_relative_to("tests/lint") or "corpus" in path.parts:
            continue
        if path.suffix == ".md" or is_code(root, path):
            for number, line in enumerate(text(root, path).splitlines(), 1):
                prose = line if path.suffix == ".md" else " ".join(COMMENT.findall(line))
                cited |= {key for key in re.findall(r"\[([\w-]+)\]", prose) if key in rows}
                yield from ((path, number, f"{REFERENCES} has no [{key}]") for key in KEY.findall(prose) if key not in rows)
                yield from ((path, number, f"{rfc}: write [{rfc.replace(' ', '')}] section N") for rfc in UNMARKED_RFC.findall(prose))
    yield from ((REFERENCES, number, f"nothing cites [{key}]") for key, number in rows.items() if key not in cited)


# How each kind of test says that it is skipped.
SKIPS = re.compile(r"\bGTEST_SKIP\(|\bskipUnless\(|\bskipIf\(|\bskipTest\(|\bSKIPPED = 77$|\breturn \{ skip:", re.MULTILINE)


def skips(root):
    """A test that skips itself must fail instead if VITRINE_NO_SKIPS is set, so that no part goes untested unnoticed."""
    for path in files(root):
        if not path.is_relative_to("tests") or path.is_relative_to("tests/lint") or not is_code(root, path):
            continue
        content = text(root, path)
        found = SKIPS.search(content)
        if found and "VITRINE_NO_SKIPS" not in content:
            yield path, content[:found.start()].count("\n") + 1, "a skipped test that VITRINE_NO_SKIPS does not make fail"


RULES = {rule.__name__: rule for rule in (spdx, length, unfinished, headers, top, modules, types, errors, formats, words, references, skips)}


def main():
    if len(sys.argv) < 2 or sys.argv[1] not in RULES:
        sys.exit("Usage: lint.py " + "|".join(RULES) + " [ROOT]")
    root = Path(sys.argv[2] if len(sys.argv) > 2 else ".").resolve()
    faults = [f"{path}:{line}: {fault}" for path, line, fault in RULES[sys.argv[1]](root)]
    print("\n".join(faults) or f"{sys.argv[1]}: clean")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
