"""The language server with Emacs and eglot, set up as docs/editors.md says."""

import json
import os
import pathlib
import re
import shutil
import subprocess

import tmcl_host
from tmcl_host import DEADLINE, TemporaryFolderTest, tmcl_path

SESSION = pathlib.Path(__file__).with_name("emacs_session.el")
PAGE = pathlib.Path(__file__).parents[2] / "docs" / "editors.md"

SOURCE = "Speed = 100\nTurn: ROR 0, Sped\n  JA Turn\n"


class Emacs(TemporaryFolderTest):
    def test_shows_jumps_and_formats_with_the_set_up_of_the_page(self):
        emacs = shutil.which("emacs")
        self.assertIsNotNone(emacs, "emacs is missing: the Debian packages emacs-nox and elpa-eglot")
        set_up = re.search(r"```elisp\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL).group(1)
        os.mkdir(self.path("bin"))
        os.symlink(tmcl_path(), self.path("bin/tmcl"))
        environment = {
            **os.environ,
            # Neither the settings nor the files of whoever runs the test.
            "HOME": self.folder,
            "PATH": self.path("bin") + os.pathsep + os.environ["PATH"],
            "TMCL_SET_UP": self.write("set_up.el", set_up),
            "TMCL_SOURCE": self.write("turn.tmc", SOURCE),
            "TMCL_RESULT": self.path("result.json"),
        }
        done = subprocess.run([emacs, "--batch", "--no-init-file", "--load", str(SESSION)], env=environment,
                              capture_output=True, text=True, timeout=DEADLINE + 20, check=False, stdin=subprocess.DEVNULL)
        self.assertTrue(os.path.exists(self.path("result.json")), done.stderr)
        result = json.loads(self.read("result.json"))
        self.assertEqual(["tmcl-mode", "// ", "pd1161"], [result[key] for key in ("mode", "comment", "module")])
        self.assertEqual("Sped", result["marked"])
        self.assertIn("did you mean Speed?", result["diagnostic"])
        self.assertEqual(2, result["defined_in_line"])
        self.assertEqual("Speed = 100\nTurn:\n    ROR 0, Sped\n    JA Turn\n", result["formatted"])


if __name__ == "__main__":
    tmcl_host.main()
