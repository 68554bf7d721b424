"""Clients that send the largest queries: `python -m tests.faults.heavy PORT CLIENTS SECONDS`.

Prints how often they got which status. Where the service is busy they come again a second later.
"""

import asyncio
import json
import sys
import time
from collections import Counter

from tests.faults.campaign import HEAVY
from tests.faults.load import clients


async def main(port: int, count: int, seconds: float) -> Counter[int]:
    statuses: Counter[int] = Counter()
    end = time.monotonic() + seconds

    async def keep_asking(number: int) -> None:
        async with clients(port, 1) as (client,):
            while time.monotonic() < end:
                answer = await client.ask(HEAVY[number % len(HEAVY)])
                statuses[answer.status] += 1
                if answer.status == 503:
                    await asyncio.sleep(1.0)

    await asyncio.gather(*(keep_asking(number) for number in range(count)))
    return statuses


if __name__ == "__main__":
    port, count, seconds = map(int, sys.argv[1:])
    sys.stdout.write(json.dumps(asyncio.run(main(port, count, seconds))))
