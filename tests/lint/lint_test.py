#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that each lint rule finds the fault in a tree that has one, and finds none in a clean tree."""
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).parent
SPDX = "// SPDX-License-Identifier: Apache-2.0\n"
CORE = "| `codec/core` (hot) | The core. | | |\n"
MESH = "| `codec/mesh` | The mesh. | codec/core | |\n"


class Lint(unittest.TestCase):
    def setUp(self):
        self.root = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.root)
        subprocess.run(["git", "init", "-q", self.root], check=True)
        self.write("codec/ARCHITECTURE.md", CORE + MESH)
        self.write("codec/REFERENCES.md", "**[GH97]** Garland, Heckbert.\n| [PLY] | Turk |\n")
        self.write("codec/mesh/a.cpp", SPDX + '#include "codec/core/a.h"  // [GH97] section 4, [PLY]\n')

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
        for rule in ("spdx", "length", "unfinished", "headers", "top", "modules", "types", "errors", "formats", "references"):
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

    def test_a_function_is_measured_from_its_own_head(self):
        head = "void f(\n    int a) {\n  return;\n}\nvoid g() {\n"
        self.write("codec/core/b.cpp", SPDX + head + "    {\n    }\n" + "  g();\n" * 118 + "}\n")
        self.assertEqual(self.run_rule("length").stdout.count("a function of"), 1)
        self.assert_fault("length", "codec/core/b.cpp:6: a function of 121 lines")

    def test_two_types_of_one_name_are_named(self):
        for module in ("core", "mesh"):
            self.write(f"codec/{module}/b.h", SPDX + "#pragma once\nnamespace vitrine {\nstruct B {\n};\n}\n")
        self.assert_fault("types", "codec/mesh/b.h:4: vitrine::B is a type of codec/core/b.h already")

    def test_a_bare_name_of_two_types_is_named(self):
        self.write("codec/core/b.h", SPDX + "#pragma once\nstruct Part;\nclass B {\n  struct Part {\n  };\n};\n")
        self.assertEqual(self.run_rule("types").returncode, 0)
        self.write("web/src/b.ts", SPDX + "export interface Part {\n}\n")
        self.assert_fault("types", "web/src/b.ts:2: Part is the name of a type in codec/core/b.h:5 already")

    def test_an_error_that_is_moved_is_named(self):
        for spelling in ("std::move(ok.error())", "std::move(ok).error()"):
            self.write("codec/core/b.cpp", SPDX + f"  if (!ok) return tl::unexpected({spelling});\n")
            self.assert_fault("errors", "codec/core/b.cpp:2: an error that is moved")

    def test_a_list_of_formats_that_lacks_one_is_named(self):
        self.write("codec/import/formats.h", SPDX + "".join(f'{{.name = "{name}",\n .extension = "{name.lower()}"}},' for name in ("PLY", "OBJ", "STL", "OFF", "GLB")))
        self.write("codec/README.md", "Reads PLY, OBJ, STL, OFF and GLB: .ply,.obj,.stl,.off,.glb,.pmesh\n")
        self.assertEqual(self.run_rule("formats").returncode, 0)
        self.write("codec/README.md", "Reads OBJ, PLY, STL, OFF and GLB.\n")
        self.assert_fault("formats", "in another order")
        self.write("codec/README.md", "Reads PLY, OBJ, STL and OFF.\n")
        self.assert_fault("formats", "codec/README.md:1:")
        self.write("codec/README.md", "accept: .ply,.obj,.stl,.off\n")
        self.assert_fault("formats", "codec/README.md:1:")

    def test_a_source_without_a_row_and_a_row_without_a_citation_are_named(self):
        self.write("codec/core/b.h", SPDX + "// Usage: b [SEED]. Merges vertices [Hoppe96].\n")
        self.assert_fault("references", "codec/core/b.h:2: codec/REFERENCES.md has no [Hoppe96]")
        self.assertNotIn("SEED", self.run_rule("references").stdout)
        self.write("codec/core/b.h", SPDX)
        self.write("codec/mesh/a.cpp", SPDX + 'int a = b[PLY];  // [GH97]\n')
        self.assert_fault("references", "codec/REFERENCES.md:2: nothing cites [PLY]")

    def test_an_rfc_that_is_cited_without_its_key_is_named(self):
        self.write("codec/core/b.h", SPDX + "// Dates (RFC 9110, section 5.6.7).\n")
        self.assert_fault("references", "codec/core/b.h:2: RFC 9110: write [RFC9110] section N")

    def test_a_test_that_is_skipped_unnoticed_is_named(self):
        self.write("tests/a_test.py", "SKIPPED = 77\nsys.exit(SKIPPED if not tool else 0)\n")
        self.assert_fault("skips", "tests/a_test.py:1: a skipped test")

    def test_unfinished_work_is_named(self):
        self.write("codec/core/b.cpp", SPDX + "// TO" + "DO later\n")
        self.assert_fault("unfinished", "codec/core/b.cpp:2")

    def test_a_header_without_guard_is_named(self):
        self.write("codec/core/b.h", SPDX)
        self.assert_fault("headers", "codec/core/b.h:1")

    def test_a_stray_top_level_file_is_named(self):
        self.write("notes.txt", "x")
        self.assert_fault("top", "notes.txt:1")

    def test_an_include_that_the_table_does_not_permit_is_named(self):
        self.write("codec/core/b.cpp", SPDX + '#include "codec/mesh/a.h"\n')
        self.assert_fault("modules", "codec/core/b.cpp:2: codec/core uses codec/mesh, which codec/ARCHITECTURE.md does not permit")

    def test_a_library_that_the_table_does_not_permit_is_named(self):
        self.write("codec/mesh/b.cpp", SPDX + "#include <OpenMesh/Core/Mesh.hh>\n")
        self.assert_fault("modules", "codec/mesh/b.cpp:2: codec/mesh uses OpenMesh")

    def test_a_relative_include_is_named(self):
        self.write("codec/mesh/b.cpp", SPDX + '#include "../core/a.h"\n')
        self.assert_fault("modules", "is not a path from the root into a module")

    def test_permissions_that_nothing_uses_are_named(self):
        self.write("codec/ARCHITECTURE.md", CORE + MESH.replace("| |", "| fmt |"))
        self.assert_fault("modules", "codec/ARCHITECTURE.md:2: codec/mesh may use fmt and does not")
        self.write("codec/mesh/a.cpp", SPDX)
        self.assert_fault("modules", "codec/ARCHITECTURE.md:2: codec/mesh may use codec/core and does not")

    def test_a_module_that_uses_a_later_one_is_named(self):
        self.write("codec/ARCHITECTURE.md", MESH + CORE)
        self.assert_fault("modules", "codec/mesh reaches up to codec/core, which is listed after it")

    def test_a_folder_without_a_row_is_named(self):
        self.write("codec/attic/a.cpp", SPDX)
        self.assert_fault("modules", "codec/attic/a.cpp:1: codec/ARCHITECTURE.md has no row for codec/attic")

    def test_a_table_of_formats_without_rows_is_named(self):
        self.write("codec/import/formats.h", SPDX)
        self.assert_fault("formats", "codec/import/formats.h:1: has no row")


if __name__ == "__main__":
    unittest.main()
