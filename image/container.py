"""One container of the image, under the runtime that Docker uses, locked down as far as it goes."""

import json
import subprocess
import tempfile
from pathlib import Path
from typing import Any, Final

_NONE: Final = ("bounding", "effective", "permitted", "inheritable", "ambient")


class Container:
    """A process with the image's own user, environment and directory, and no capability at all.

    It has a network of its own, so that nothing beyond the loopback is reached.
    """

    def __init__(
        self, work: Path, root: Path, config: dict[str, Any], *args: str, read_only: bool = True
    ) -> None:
        self._runc = ("runc", "--root", str(work / "runc"))
        bundle = Path(tempfile.mkdtemp(prefix="container-", dir=work))
        self._name = f"{work.name}-{bundle.name}"
        subprocess.run(("runc", "spec"), cwd=bundle, check=True)
        path = bundle / "config.json"
        spec = json.loads(path.read_text("utf-8"))
        user, group = (int(number) for number in config["User"].split(":"))
        spec["process"] |= {
            "terminal": False,
            "user": {"uid": user, "gid": group},
            "args": list(args) or [*config["Entrypoint"], *config["Cmd"]],
            "env": config["Env"],
            "cwd": config["WorkingDir"],
            "capabilities": {kind: [] for kind in _NONE},
        }
        spec["root"] = {"path": str(root), "readonly": read_only}
        spec["hostname"] = "mdr"
        spec["linux"]["cgroupsPath"] = f"/{self._name}"
        path.write_text(json.dumps(spec), "utf-8")
        self._log = (bundle / "log").open("w+", encoding="utf-8")
        self._process = subprocess.Popen(
            (*self._runc, "run", "--bundle", str(bundle), self._name),
            stdin=subprocess.DEVNULL,
            stdout=self._log,
            stderr=subprocess.STDOUT,
        )

    def do(self, *args: str, text: str = "") -> "subprocess.CompletedProcess[str]":
        """Run a program inside."""
        words = (*self._runc, "exec", self._name, *args)
        return subprocess.run(words, input=text, capture_output=True, text=True, check=False)

    def ended(self) -> bool:
        return self._process.poll() is not None

    def terminate(self) -> None:
        """Ask the process to stop, as `docker stop` does."""
        subprocess.run((*self._runc, "kill", self._name, "TERM"), check=True)

    def status(self, timeout: float) -> int | None:
        """Return the exit status, None if it goes on for longer than that."""
        try:
            return self._process.wait(timeout)
        except subprocess.TimeoutExpired:
            return None

    def log(self) -> str:
        """Return what was written so far."""
        self._log.seek(0)
        return self._log.read()

    def remove(self) -> None:
        words = (*self._runc, "delete", "--force", self._name)
        subprocess.run(words, capture_output=True, check=False)
        self._process.wait()
        self._log.close()
