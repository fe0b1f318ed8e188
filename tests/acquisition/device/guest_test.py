#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Drives boards through the Linux kernel's USB stack in a virtual machine.

Usage: guest_test.py KERNEL BIN TESTS. KERNEL is the folder into which deploy/setup unpacks a
kernel. BIN and TESTS hold the programs. QEMU emulates the guest, so the test needs no privileges.
The test is skipped if a tool or the kernel is missing; it fails instead if VITRINE_NO_SKIPS is set.

In the guest, drive_board drives two devices. One is QEMU's usb-serial, which the kernel takes for
an FTDI chip; serve_firmware answers it outside the guest. The other is g_serial, a CDC-ACM device;
serve_firmware answers it inside the guest.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

SKIPPED, FAILED = 77, 1
MODULES = ("usb-common usbcore xhci-hcd xhci-pci usbserial ftdi_sio cdc-acm configfs udc-core libcomposite "
           "dummy_hcd u_serial usb_f_acm g_serial").split()
KERNEL, BIN, TESTS = (Path(word) for word in sys.argv[1:4])
PROGRAMS = [TESTS / "drive_board", TESTS / "serve_firmware", BIN / "vitrine-guardian"]
FTDI, ACM = "0403:6001", "0525:a4a7"
TIMEOUT = 240  # time limit in seconds; enough on a busy machine


def missing():
    """Returns the reason why the test cannot run on this machine, or an empty text if it can."""
    for tool in ("qemu-system-x86_64", "busybox", "cpio"):
        if not shutil.which(tool):
            return f"there is no {tool}"
    return "" if list(KERNEL.glob("boot/vmlinuz-*")) else f"there is no kernel in {KERNEL}"


def put(root, source, target):
    """Copies the file to the guest's root."""
    (root / target).parent.mkdir(parents=True, exist_ok=True)
    shutil.copy(source, root / target)


def libraries(program):
    """Returns the paths of the loader and of all libraries that it maps."""
    said = subprocess.run(["ldd", program], text=True, capture_output=True, check=True).stdout
    return re.findall(r"(/\S+) \(0x", said)


def initramfs(folder):
    """Writes the guest's files to an archive, and returns its path."""
    root = folder / "root"
    put(root, shutil.which("busybox"), "bin/busybox")
    put(root, Path(__file__).with_name("guest_init"), "init")
    (root / "init").chmod(0o755)
    for program in PROGRAMS:
        put(root, program, f"bin/{program.name}")
        for library in libraries(program):
            put(root, library, library[1:])
    for module in MODULES:
        put(root, next(KERNEL.glob(f"lib/modules/**/{module}.ko")), f"{module}.ko")
    (root / "modules").write_text("".join(f"/{module}.ko\n" for module in MODULES))
    names = "\n".join(str(path.relative_to(root)) for path in root.rglob("*"))
    with open(folder / "initramfs", "wb") as archive:
        subprocess.run(["cpio", "--quiet", "-o", "-H", "newc"], cwd=root, input=names.encode(), stdout=archive,
                       check=True)
    return folder / "initramfs"


def boot(folder, line):
    """Starts the guest; its console is its standard output."""
    return subprocess.Popen(
        ["qemu-system-x86_64", "-M", "q35", "-accel", "tcg", "-m", "1024", "-nodefaults", "-no-reboot",
         "-display", "none", "-serial", "stdio", "-kernel", next(KERNEL.glob("boot/vmlinuz-*")),
         "-initrd", initramfs(folder), "-append", "console=ttyS0 quiet panic=-1", "-device", "qemu-xhci",
         "-chardev", f"socket,id=line,path={line},server=on,wait=on", "-device", "usb-serial,chardev=line"],
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace")


def serve(line):
    """Starts the firmware at the host's end of the serial line as soon as that end exists."""
    while not line.exists():
        time.sleep(0.01)
    return subprocess.Popen([TESTS / "serve_firmware", line], stdout=subprocess.PIPE, text=True)


def run():
    """Runs the guest until it ends. Returns the guest's output and the output of the firmware at
    the host's end.
    """
    with tempfile.TemporaryDirectory() as name:
        line = Path(name) / "line"
        guest = boot(Path(name), line)
        timer = threading.Timer(TIMEOUT, guest.kill)
        timer.start()
        firmware = serve(line)
        console = ""
        for said in guest.stdout:
            console += said
            if "waits to be unplugged" in said:
                firmware.kill()
        guest.wait()
        timer.cancel()
        return console, firmware.communicate()[0]


class Guest(unittest.TestCase):
    """Boots the guest once. Each test checks a part of the output."""
    @classmethod
    def setUpClass(cls):
        cls.console, cls.ftdi_board = run()
        print(cls.console)

    def assertInOrder(self, text, *lines):
        """Checks that the output contains these lines in this order."""
        at = 0
        for line in lines:
            found = text.find(line, at)
            self.assertGreaterEqual(found, 0, f"no '{line}' after:\n{text[:at]}\n--- in:\n{text}")
            at = found + len(line)

    def drives(self, board):
        says = [f"{board}: {what}" for what in (
            "opened Horus 0.2", "stands anywhere", "set:0", "turn:45", "laser:on", "laser:off", "stands at 45.000",
            "closed", "opened Horus", "laser:on",  # this process is then killed
            "opened Horus", "stands at 45.000", "turn:90", "closed")]
        self.assertInOrder(self.console, *says)

    def test_ftdi_board_is_driven(self):
        self.drives(FTDI)
        self.assertInOrder(self.ftdi_board, "table at 45.000", "laser on", "laser off", "laser on", "laser off",
                           "table at 90.000", "laser on")

    def test_cdc_acm_board_is_driven(self):
        self.drives(ACM)
        self.assertInOrder(self.console, "ttyGS0: motor on", "ttyGS0: table at 45.000", "ttyGS0: laser on",
                           "ttyGS0: laser off", "ttyGS0: motor off", f"{ACM}: closed", "ttyGS0: table at 90.000")

    def test_killed_process_leaves_the_board_dark(self):
        self.assertInOrder(self.console, f"{ACM}: closed", "ttyGS0: laser on", "ttyGS0: laser off",
                           f"{ACM}: its guardian has ended", f"{ACM}: opened Horus", f"{ACM}: stands at 45.000")

    def test_board_unplugged_is_gone(self):
        self.assertInOrder(self.console, f"{FTDI}: waits to be unplugged",
                           f"{FTDI}: ended: USB board {FTDI} is gone; check its cable and power", f"{FTDI}: closed")


if __name__ == "__main__":
    if reason := missing():
        print(f"left out: {reason}; run deploy/setup test")
        sys.exit(FAILED if "VITRINE_NO_SKIPS" in os.environ else SKIPPED)
    unittest.main(argv=sys.argv[:1])
