#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Each lint rule finds its fault in a tree made for it, and none in a clean one."""
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).parent
SPDX = "// SPDX-License-Identifier: Apache-2.0\n"
CORE = "vitrine_room(codec/core SOURCES a.cpp USES)\n"
MESH = "vitrine_room(codec/mesh SOURCES a.cpp USES codec/core)\n"


class Lint(unittest.TestCase):
    def setUp(self):
        self.root = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.root)
        subprocess.run(["git", "init", "-q", self.root], check=True)
        self.write("tests/lint/rooms.txt", (HERE / "rooms.txt").read_text())
        self.write("codec/core/CMakeLists.txt", "#" + SPDX[2:] + CORE)
        self.write("codec/mesh/CMakeLists.txt", "#" + SPDX[2:] + MESH)
        self.write("codec/mesh/a.cpp", SPDX + '#include "codec/core/a.h"\n')

    def write(self, path, content):
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(content)

    def run_rule(self, rule):
        return subprocess.run([sys.executable, HERE / "lint.py", rule, self.root], capture_output=True, text=True)

    def assert_fault(self, rule, words):
        result = self.run_rule(rule)
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertIn(words, result.stdout)

    def test_a_clean_tree_passes_every_rule(self):
        for rule in ("spdx", "length", "unfinished", "headers", "top", "rooms", "types"):
            result = self.run_rule(rule)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_a_file_without_licence_line_is_named(self):
        self.write("codec/core/b.cpp", "int b;\n")
        self.assert_fault("spdx", "codec/core/b.cpp:1")

    def test_a_long_file_is_named(self):
        self.write("codec/core/b.cpp", SPDX + "int b;\n" * 600)
        self.assert_fault("length", "longer than 600 lines")

    def test_a_long_function_is_named_with_its_line(self):
        self.write("codec/core/b.cpp", SPDX + "void b() {\n" + "  b();\n" * 120 + "}\n")
        self.assert_fault("length", "codec/core/b.cpp:2: a function of 121 lines")

    def test_two_types_of_one_name_are_named(self):
        for room in ("core", "mesh"):
            self.write(f"codec/{room}/b.h", SPDX + "#pragma once\nnamespace vitrine {\nstruct B {\n};\n}\n")
        self.assert_fault("types", "codec/mesh/b.h:4: vitrine::B is a type of codec/core/b.h already")

    def test_unfinished_work_is_named(self):
        self.write("codec/core/b.cpp", SPDX + "// TO" + "DO later\n")
        self.assert_fault("unfinished", "codec/core/b.cpp:2")

    def test_a_header_without_guard_is_named(self):
        self.write("codec/core/b.h", SPDX)
        self.assert_fault("headers", "codec/core/b.h:1")

    def test_a_stray_top_level_file_is_named(self):
        self.write("notes.txt", "x")
        self.assert_fault("top", "notes.txt:1")

    def test_an_include_without_link_edge_is_named(self):
        self.write("codec/mesh/b.cpp", SPDX + '#include "codec/progressive/manifest.h"\n')
        self.assert_fault("rooms", "codec/mesh includes codec/progressive without a link edge")

    def test_a_relative_include_is_named(self):
        self.write("codec/mesh/b.cpp", SPDX + '#include "../core/a.h"\n')
        self.assert_fault("rooms", "is not a path from the root into a room")

    def test_a_link_that_the_table_forbids_is_named(self):
        self.write("codec/mesh/CMakeLists.txt", MESH.replace("codec/core", "codec/core\n  OpenMeshCore"))
        self.assert_fault("rooms", "codec/mesh may not link OpenMeshCore")

    def test_a_link_upwards_is_named(self):
        self.write("codec/core/CMakeLists.txt", CORE.replace("USES", "USES codec/mesh"))
        self.assert_fault("rooms", "codec/core may not link codec/mesh")

    def test_a_room_that_the_table_does_not_know_is_named(self):
        self.write("codec/attic/CMakeLists.txt", CORE.replace("core", "attic"))
        self.assert_fault("rooms", "codec/attic is not in")


if __name__ == "__main__":
    unittest.main()
