"""Run all cases against the service, and write the page and, beside it, the table of all cases."""

import sys
from pathlib import Path

from tests.conftest import running_client

from verification.run import page, results, table


def main() -> int:
    """Write page and table, and return 1 if a case misses its bound."""
    with running_client() as client:
        rows = results(client)
    target = Path(sys.argv[1])
    target.write_text(page(rows), "utf-8")
    target.with_suffix(".csv").write_text(table(rows), "utf-8")
    missed = [row for row in rows if not row.met]
    for row in missed:
        print(f"{row.case.source} {row.case.case}: {row.deviation:.1e} > {row.case.bound:.0e}")
    print(
        f"{len(rows)} cases from {len({row.case.source for row in rows})} sources, "
        f"{len(missed)} beyond their bounds"
    )
    return bool(missed)


if __name__ == "__main__":
    sys.exit(main())
