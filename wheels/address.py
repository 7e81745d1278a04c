"""Writes the public address of the repository into what a release is made from.

    python wheels/address.py [ADDRESS]

No address stands in the sources, as each copy of them has its own; a workflow tells the one that it
runs in by GITHUB_SERVER_URL and GITHUB_REPOSITORY. `[project.urls]` of pyproject.toml,
`repository-code` of CITATION.cff and `about` of the recipe get it; where they have one, it stays.
"""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def address_of(arguments: list[str], environment: dict[str, str]) -> str:
    """The address that is given, or that of the workflow.

    Raises:
        ValueError: There is none, or it is no address of the web.
    """
    if len(arguments) > 1:
        raise ValueError(f"address.py takes one address, not {' '.join(arguments)!r}")
    names = ("GITHUB_SERVER_URL", "GITHUB_REPOSITORY")
    told = "/".join(environment[name] for name in names) if environment.keys() >= {*names} else ""
    address = arguments[0] if arguments else told
    if not re.fullmatch(r"https://[^\s/\"']+/[^\s\"']+", address):
        raise ValueError(
            f"the address must be https://HOST/PATH, not {address!r}; "
            f"give it, or set {' and '.join(names)}"
        )
    return address.rstrip("/")


def urls(address: str) -> dict[str, str]:
    """The addresses of `[project.urls]` by their well-known labels."""
    return {
        "Source": address,
        "Documentation": f"{address}/tree/HEAD/docs",
        "Issues": f"{address}/issues",
        "Changelog": f"{address}/blob/HEAD/CHANGELOG.md",
    }


def write(root: Path, address: str) -> None:
    """Writes it into the files of a checkout that have none."""
    table = "".join(f'{label} = "{url}"\n' for label, url in urls(address).items())
    insert(
        root / "pyproject.toml",
        "[project.urls]\n",
        before="[project.scripts]\n",
        text=f"[project.urls]\n{table}\n",
    )
    insert(
        root / "CITATION.cff",
        "repository-code:",
        before="license: ",
        text=f"repository-code: {address}\n",
    )
    insert(
        root / "recipe" / "recipe.yaml",
        "  repository:",
        before="  license: ",
        text=f"  homepage: {address}\n  repository: {address}\n",
    )


def insert(path: Path, head: str, *, before: str, text: str) -> None:
    """Inserts a text before the line that begins so, unless a line begins with its head."""
    content = path.read_text("utf-8")
    if re.search(f"^{re.escape(head)}", content, re.M):
        return
    found = re.search(f"^{re.escape(before)}", content, re.M)
    if not found:
        raise ValueError(f"{path} must have a line that begins with {before.strip()!r}")
    beside = path.with_suffix(".part")
    beside.write_text(content[: found.start()] + text + content[found.start() :], "utf-8")
    beside.replace(path)


def main() -> int:
    """Writes it; the exit status."""
    try:
        address = address_of(sys.argv[1:], dict(os.environ))
        write(ROOT, address)
    except (OSError, ValueError) as error:
        print(f"address: {error}", file=sys.stderr)
        return 2
    print(f"the address of the project is {address}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
