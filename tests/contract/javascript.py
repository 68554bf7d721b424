"""Run the modules of the explorer that need no browser, in the Node.js that Playwright carries."""

import json
import subprocess
from pathlib import Path
from typing import Any

from playwright._impl._driver import compute_driver_executable

import mdr_service

EXPLORER = Path(mdr_service.__file__).with_name("explorer")


def evaluated(module: str, expression: str, calls: list[Any]) -> list[Any]:
    """Return the value of a JavaScript expression of `module` and `call` for each of the calls.

    The value of a call that throws an exception is its message, as the member `error`.
    """
    script = f"""
        import {{ readFileSync }} from "node:fs";
        import * as module from "{(EXPLORER / module).as_uri()}";
        const result = (call) => {{
            try {{
                return {expression};
            }} catch (error) {{
                return {{ error: error.message }};
            }}
        }};
        console.log(JSON.stringify(JSON.parse(readFileSync(0, "utf-8")).map(result)));
    """
    node = compute_driver_executable()[0]
    done = subprocess.run(
        [node, "--input-type=module", "--eval", script],
        input=json.dumps(calls),
        capture_output=True,
        text=True,
        check=True,
    )
    results: list[Any] = json.loads(done.stdout)
    return results
