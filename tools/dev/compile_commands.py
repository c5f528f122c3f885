#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0

"""Knows how each source and header is compiled in the preset `dev`, where CMake knows it of sources alone.

As a program, it writes build/lint/compile_commands.json, which has the sources and the headers that are given. Without
an entry, clang-tidy takes the command of a source with a similar name, which may lack the folders of a library.

    tools/dev/compile_commands.py [HEADER...]
"""

import json
import pathlib
import shlex
import subprocess
import sys

top = pathlib.Path(__file__).resolve().parents[2]


def commands():
    """Returns the compile command of each source of the preset `dev`, without its source and output."""
    subprocess.run(["tools/dev/install-packages"], cwd=top, check=True)
    for step in (["--preset", "dev"], ["--build", "--preset", "dev", "--target", "cohort_idl_generate"]):
        subprocess.run(["cmake", *step], cwd=top, check=True, stdout=subprocess.DEVNULL)
    kept = {}
    for entry in json.loads((top / "build/dev/compile_commands.json").read_text()):
        words = shlex.split(entry["command"])
        # The launcher (ccache) stands before the compiler.
        compilers = ("c++", "g++", "clang++", "cc", "gcc", "clang")
        words = words[next(i for i, word in enumerate(words) if pathlib.Path(word).name in compilers) :]
        for option in ("-o", "-c"):
            at = words.index(option)
            del words[at : at + 2]
        kept[pathlib.Path(entry["file"])] = words
    return kept


def command_for(file, by_source):
    """Returns the command of a source, and for a header that of a source with its name, of one that includes it, or else
    of a neighbour."""
    if file.suffix != ".hpp":
        return by_source.get(file)
    if file.with_suffix(".cpp") in by_source:
        return by_source[file.with_suffix(".cpp")]
    line = f'#include "{file.relative_to(top)}"'
    for source, command in by_source.items():
        if source.suffix == ".cpp" and top / "build" not in source.parents and line in source.read_text():
            return command
    for folder in file.parents:
        for source, command in by_source.items():
            if folder in source.parents and source.suffix == ".cpp":
                return command
        if folder == top:
            return None
    return None


def main():
    by_source = commands()
    headers = [pathlib.Path(name).resolve() for name in sys.argv[1:]]
    by_file = by_source | {header: command_for(header, by_source) for header in headers}
    entries = [
        {"directory": str(top / "build/dev"), "file": str(file), "command": shlex.join([*command, "-c", str(file)])}
        for file, command in by_file.items()
        if command
    ]
    (top / "build/lint").mkdir(parents=True, exist_ok=True)
    (top / "build/lint/compile_commands.json").write_text(json.dumps(entries))


if __name__ == "__main__":
    main()
