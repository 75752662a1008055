"""The language server with a real client: Neovim, without a screen."""

import json
import os
import pathlib
import shutil
import subprocess

import tmcl_host
from tmcl_host import DEADLINE, TemporaryFolderTest, tmcl_path

SESSION = pathlib.Path(__file__).with_name("neovim_session.lua")

SOURCE = """\
// A table that goes there and back.
#include TMCLParam.tmc
#include speeds.inc
Turn: MPV REL, Motor0, 51200
  JA Turn
Last: SAP APMaxPositioningSpeed,0,Slow
  JA Last
"""
CORRECTED = SOURCE.replace("MPV", "MVP").rstrip("\n")


class Neovim(TemporaryFolderTest):
    def setUp(self):
        super().setUp()
        neovim = shutil.which("nvim")
        self.assertIsNotNone(neovim, "nvim is missing: the Debian package neovim")
        self.write("speeds.inc", "Slow = 100\n")
        environment = {
            **os.environ,
            "TMCL": tmcl_path(),
            "TMCL_SOURCE": self.write("table.tmc", SOURCE),
            "TMCL_RESULT": self.path("result.json"),
            # Neither the settings nor the log of whoever runs the test.
            "HOME": self.folder,
            "XDG_CONFIG_HOME": self.path("config"),
            "XDG_DATA_HOME": self.path("data"),
            "XDG_STATE_HOME": self.path("state"),
            "XDG_CACHE_HOME": self.path("cache"),
        }
        done = subprocess.run([neovim, "--headless", "-u", "NONE", "-i", "NONE", "-n", "-c", "luafile %s" % SESSION],
                              env=environment, capture_output=True, text=True, timeout=DEADLINE + 20, check=False,
                              stdin=subprocess.DEVNULL)
        self.assertTrue(os.path.exists(self.path("result.json")), done.stderr)
        self.result = json.loads(self.read("result.json"))

    def test_shows_completes_jumps_renames_and_formats(self):
        self.assertNotIn("failure", self.result, self.result)
        self.assertEqual([("unknown-instruction", 3, 6)],
                         [(found["code"], found["line"], found["column"]) for found in self.result["diagnostics"]])
        self.assertIn("did you mean MVP?", self.result["diagnostics"][0]["message"])
        self.assertEqual(CORRECTED, self.result["corrected"])
        self.assertIn("label, address 0", self.result["hover"])
        self.assertEqual(["GE", "GT"], sorted(self.result["completion"]))
        self.assertEqual([4, 0], self.result["jumped_to"])
        self.assertEqual("'GE' is a word of the language", self.result["refused"])
        self.assertEqual(CORRECTED.replace("Turn", "Again"), self.result["renamed"])
        formatted = self.result["formatted"].splitlines()
        self.assertIn("    MVP REL, Motor0, 51200", formatted)
        self.assertIn("    SAP APMaxPositioningSpeed, 0, Slow", formatted)
        self.assertEqual("Slow = 100", self.result["included"])
        self.assertEqual(0, self.result["exit_code"])


if __name__ == "__main__":
    tmcl_host.main()
