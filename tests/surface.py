"""Count what a user sees: options, lines of help, and lines that commands print.

    python -m tests.surface [--printed]

With --printed also count the output of `pick`, `budget` and `run`, which takes minutes.
"""

import argparse
import subprocess
import sys

from normalbench.bench.door.cli.app import command_line

PRINTED = ("pick --storage rg8", "budget --bytes 16", "run")


def options() -> dict[str, int]:
    """Return how many options the program and each command have, without --help."""
    program = command_line()
    of_all = {"normalbench": program, **program.commands}
    return {name: sum(p.param_type_name == "option" for p in command.params) for name, command in of_all.items()}


def lines(words: str) -> int:
    """Return how many lines a command prints to standard output."""
    done = subprocess.run([sys.executable, "-m", "normalbench", *words.split()], capture_output=True, text=True)
    return done.stdout.count("\n")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0] if __doc__ else "")
    parser.add_argument("--printed", action="store_true", help="Run pick, budget and run as well.")
    counts = options()
    print(f"options: {sum(counts.values())} of {len(counts) - 1} commands; the most: {max(counts, key=counts.get)}")
    for words in ("--help", "--help-all", "pick --help", "pick --help-all", "run --help"):
        print(f"lines of {words}: {lines(words)}")
    for words in PRINTED if parser.parse_args().printed else ():
        print(f"lines of {words}: {lines(words)}")


if __name__ == "__main__":
    main()
