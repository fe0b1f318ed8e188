#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that the shipped programs are hardened, as codec/cmake/modules.cmake states: stack protector, _FORTIFY_SOURCE,
_GLIBCXX_ASSERTIONS, read-only relocations, immediate binding, random addresses and no executable stack.

Environment: VITRINE_BIN, the folder of the programs, and VITRINE_BUILD, the folder of their build."""
import json
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

# The programs, each with the protections that it may lack: the guardian calls no function that _FORTIFY_SOURCE checks.
PROGRAMS = {"vitrine": set(), "vitrined": set(), "vitrine-guardian": {"_FORTIFY_SOURCE"}}
ASSERTION = "_ZSt21__glibcxx_assert_failPKciS0_S0_"  # std::__glibcxx_assert_fail, which a failed assertion calls


ARCHITECTURE = Path(__file__).parents[2] / "codec/ARCHITECTURE.md"


def modules():
    """Returns the modules, each with whether it is marked (hot), which exempts it from the checks of indices."""
    rows = re.findall(r"^\| `([^`]+)`( \(hot\))? \|", ARCHITECTURE.read_text(), re.M)
    return {name: bool(mark) for name, mark in rows}


def flags_of_modules():
    """Returns the flags with which the sources of each module are compiled."""
    found = {}
    for entry in json.loads((Path(os.environ["VITRINE_BUILD"]) / "compile_commands.json").read_text()):
        if target := re.search(r"/vitrine_(\w+)\.dir/", entry["command"]):
            found.setdefault(target[1], []).append(set(entry["command"].split()))
    return {name: found[name.replace("/", "_")] for name in modules() if name.replace("/", "_") in found}


def readelf(flag, program):
    return subprocess.run(["readelf", "--wide", flag, program], check=True, text=True, capture_output=True).stdout


def faults_of(program):
    """Returns the protections that the program lacks."""
    headers, dynamic, symbols = (readelf(flag, program) for flag in ["--program-headers", "--dynamic", "--dyn-syms"])
    stack = re.search(r"GNU_STACK.*", headers)
    imports = {name.split("@")[0] for name in re.findall(r"UND (\S+)", symbols)}
    checked = {name for name in imports if re.fullmatch(r"__\w+_chk", name)}
    protections = {
        "random addresses (PIE)": re.search(r"FLAGS_1.*\bPIE\b", dynamic),
        "read-only relocations (RELRO)": "GNU_RELRO" in headers,
        "immediate binding (-z now)": re.search(r"FLAGS_1.*\bNOW\b", dynamic),
        "a stack that is not executable": stack and "RWE" not in stack[0],
        "code that is not writable": not re.search(r"LOAD.* RWE ", headers) and "TEXTREL" not in dynamic,
        "libraries from the system only": "RPATH" not in dynamic and "RUNPATH" not in dynamic,
        "stack protector": "__stack_chk_fail" in imports,
        "_FORTIFY_SOURCE": checked,
        "_GLIBCXX_ASSERTIONS": ASSERTION in imports,
    }
    return {name for name, is_there in protections.items() if not is_there}


class Hardening(unittest.TestCase):
    def test_every_shipped_program_has_every_protection(self):
        for name, may_lack in PROGRAMS.items():
            self.assertLessEqual(faults_of(Path(os.environ["VITRINE_BIN"]) / name), may_lack, name)

    def test_every_module_has_the_flags_that_its_row_states(self):
        is_hot = modules()
        self.assertLess(sum(is_hot.values()), len(is_hot) / 4, "most modules check indices")
        compiled = flags_of_modules()
        self.assertGreater(len(compiled), len(is_hot) / 2)
        for name, commands in compiled.items():
            for flags in commands:
                self.assertEqual("-D_GLIBCXX_ASSERTIONS" in flags, not is_hot[name], name)
                self.assertLessEqual({"-fstack-protector-strong", "-D_FORTIFY_SOURCE=2"}, flags, name)

    def test_a_program_without_protections_is_noticed(self):
        source = "int main() { return 0; }"
        program = Path(self.enterContext(tempfile.TemporaryDirectory())) / "plain"
        subprocess.run(["g++", "-x", "c++", "-no-pie", "-fno-pie", "-z", "norelro", "-z", "lazy", "-z", "execstack", "-o", program, "-"],
                       input=source, text=True, check=True)
        for protection in ["random addresses (PIE)", "read-only relocations (RELRO)", "immediate binding (-z now)",
                           "a stack that is not executable", "stack protector", "_FORTIFY_SOURCE", "_GLIBCXX_ASSERTIONS"]:
            self.assertIn(protection, faults_of(program))


if __name__ == "__main__":
    unittest.main()
