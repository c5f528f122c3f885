# SPDX-License-Identifier: Apache-2.0

"""Controllers as clients of a server, over DDS."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from typing import NoReturn

from cohort import _client
from cohort._hosting import Maker, portable_calls
from cohort.controller import Controller, TeamController


class ClientError(RuntimeError):
    """The error that a client did not drive its robots until the run finished. The message gives the reason."""


def host(
    controller: type[Controller] | type[TeamController],
    robots: str | Sequence[object] = "all",
    *,
    server: str | None = None,
    domain: int | None = None,
    secure: str | os.PathLike | None = None,
) -> None:
    """Drives robots of a running server until the run ends.

    Args:
        controller: a class derived from `cohort.Controller`, with one object per robot, or from
            `cohort.TeamController`.
        robots: selectors, separated by commas or as a list: `all`, `3`, `0..7`, `explorers/sbot_7`, `explorers/*`.
        server: IPv4 address or host name; by default $COHORT_SERVER, or this machine.
        domain: the server's DDS domain; by default $COHORT_DOMAIN, or 0.
        secure: folder of an identity; by default $COHORT_SECURE, or none.

    Waits until there is a server. Raises ClientError if the run fails, if another client drives these robots or takes
    them over, or if the server is lost. Raises KeyboardInterrupt after Ctrl-C.
    """
    selectors = (
        [each for each in robots.split(",") if each] if isinstance(robots, str) else [str(each) for each in robots]
    )
    if not selectors:
        raise ValueError("robots is empty, expected at least one selector")
    with portable_calls():
        end, error = _client.host(
            Maker(controller), selectors, server or "", -1 if domain is None else domain, os.fspath(secure or "")
        )
    if end == "interrupted":
        raise KeyboardInterrupt
    if end != "finished":
        raise ClientError(f"{end.replace('_', ' ')}: {error}" if error else end)


def main(controller: type[Controller] | type[TeamController], arguments: Sequence[str] | None = None) -> NoReturn:
    """Runs a controller as a program with the options `--robots`, `--server`, `--domain`, `--secure` and `--help`.

        if __name__ == "__main__":
            cohort.main(Wanderer)

    Ends the process. The exit code is 0 if the run finished, 1 if the run or the controller failed, 2 for invalid
    options or a refused claim, and 130 if interrupted.

    Args:
        controller: a class derived from `cohort.Controller` or `cohort.TeamController`.
        arguments: options of the program; by default those of the command line.
    """
    arguments = sys.argv if arguments is None else [sys.argv[0], *arguments]
    with portable_calls():
        sys.exit(_client.run_program(Maker(controller), arguments))
