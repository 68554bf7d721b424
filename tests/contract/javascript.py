"""Run the modules of the explorer that need no browser, in the Node.js that Playwright carries."""

import json
import subprocess
from pathlib import Path
from typing import Any

from playwright._impl._driver import compute_driver_executable

import mdr_service

EXPLORER = Path(mdr_service.__file__).with_name("explorer")


def evaluated(module: str, function: str, arguments: list[Any]) -> list[Any]:
    """Return the result of a function of a module for each list of its arguments."""
    script = f"""
        import {{ readFileSync }} from "node:fs";
        import {{ {function} }} from "{(EXPLORER / module).as_uri()}";
        const calls = JSON.parse(readFileSync(0, "utf-8"));
        const result = (call) => {{
            try {{ return {function}(...call); }}
            catch (error) {{ return {{ error: error.message }}; }}
        }};
        console.log(JSON.stringify(calls.map(result)));
    """
    node = compute_driver_executable()[0]
    done = subprocess.run(
        [node, "--input-type=module", "--eval", script],
        input=json.dumps(arguments),
        capture_output=True,
        text=True,
        check=True,
    )
    results: list[Any] = json.loads(done.stdout)
    return results
