#!/usr/bin/env python3
"""Looks at what `samestep view` serves.

Usage: view_test.py PROGRAM
"""

import re
import signal
import subprocess
import sys
import tempfile
import unittest
import urllib.error
import urllib.parse
import urllib.request
from pathlib import Path

PROGRAM = sys.argv.pop()
NAME = "a match & more.rec"


class ViewTest(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)
        (self.folder / "viewer").mkdir()
        (self.folder / "viewer/index.html").write_text("the viewer", encoding="utf-8")
        (self.folder / "viewer/core.wasm").write_bytes(b"\0asm")
        (self.folder / "secret").write_text("not to be served", encoding="utf-8")
        self.recording = self.folder / NAME
        subprocess.run([PROGRAM, "record", "example", "--ticks", "5", "-o", self.recording], check=True,
                       stdout=subprocess.DEVNULL)

    def start(self):
        server = subprocess.Popen([PROGRAM, "view", "--no-open", "--viewer", self.folder / "viewer", self.recording],
                                  stdout=subprocess.PIPE, text=True)
        self.addCleanup(server.stdout.close)
        self.addCleanup(server.wait, 10)
        self.addCleanup(server.send_signal, signal.SIGINT)
        address = server.stdout.readline().strip()
        self.assertRegex(address, r"^http://127\.0\.0\.1:\d+/\?file=\S+$")
        return address

    def get(self, address, path, **headers):
        request = urllib.request.Request(urllib.parse.urljoin(address, path), headers=headers)
        with urllib.request.urlopen(request, timeout=10) as answer:
            return answer.headers.get("Content-Type"), answer.read()

    def refused(self, address, path, **headers):
        with self.assertRaises(urllib.error.HTTPError) as caught:
            self.get(address, path, **headers)
        caught.exception.close()
        return caught.exception.code

    def test_the_viewer_and_the_recording_are_served(self):
        address = self.start()
        self.assertEqual(self.get(address, "/"), ("text/html", b"the viewer"))
        self.assertEqual(self.get(address, "/core.wasm"), ("application/wasm", b"\0asm"))
        name = re.search(r"file=(\S+)", address)[1]
        self.assertEqual(urllib.parse.unquote(name), NAME)
        self.assertEqual(self.get(address, f"/recordings/{name}")[1], self.recording.read_bytes())

    def test_nothing_else_is_served_and_to_nobody_else(self):
        address = self.start()
        for path in ("/recordings/secret", "/%2e%2e/secret", "/recordings/%2e%2e%2fsecret", "/none"):
            self.assertEqual(self.refused(address, path), 404, path)
        self.assertEqual(self.refused(address, "/", Host="example.org"), 403)

    def test_what_cannot_be_shown_is_said(self):
        for arguments, reason in ((["--viewer", self.folder / "none"], "scripts/web builds it"),
                                  (["--viewer", self.folder / "viewer", self.folder / "secret"], "secret")):
            done = subprocess.run([PROGRAM, "view", "--no-open", *arguments], capture_output=True, text=True,
                                  check=False, timeout=10)
            self.assertEqual(done.returncode, 2)
            self.assertIn(reason, done.stderr)


if __name__ == "__main__":
    unittest.main()
