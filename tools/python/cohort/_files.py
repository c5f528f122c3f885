# SPDX-License-Identifier: Apache-2.0

"""Folders and files that come with Cohort."""

import difflib
import os
import pathlib
import sys

_package = pathlib.Path(__file__).absolute().parent


def _first_folder(*candidates):
    return next((each for each in candidates if each.is_dir()), None)


def worlds_folder():
    """Returns the folder of the worlds that come with Cohort."""
    folder = _first_folder(
        _package / "share/cohort/worlds",  # in a wheel
        _package.parent.parent / "share/cohort/worlds",  # in a build tree
        pathlib.Path(sys.prefix) / "share/cohort/worlds",
        pathlib.Path("/usr/share/cohort/worlds"),
    )
    if folder is None:
        raise FileNotFoundError("the worlds of Cohort are not installed (share/cohort/worlds)")
    return folder


def page_folder():
    """Returns the folder of the built web page of the view."""
    folder = worlds_folder().parent / "view"
    if not (folder / "index.html").is_file():
        raise FileNotFoundError(
            f"the web page of the view is missing from '{folder}'. To build it, install node 18 and npm "
            "(tools/dev/install-packages tools/dev/packages-node.txt), then run "
            "cmake --build build/release --target view_page"
        )
    return folder


def model_folders():
    """Returns the folders of the models that come with Cohort."""
    return [worlds_folder() / "robots", worlds_folder() / "objects"]


def plugin_folders():
    """Returns the folders that are searched for controllers named without a path."""
    folders = [pathlib.Path(each) for each in os.environ.get("COHORT_PLUGIN_PATH", "").split(":") if each]
    prefixes = [
        pathlib.Path("/usr/local/lib"),
        pathlib.Path("/usr/lib"),
        *sorted(pathlib.Path("/usr/lib").glob("*-linux-gnu")),
    ]
    return [
        *folders,
        _package / "lib/cohort/controllers",  # in a wheel
        _package.parent.parent / "lib/controllers",  # in a build tree
        *(prefix / "cohort/controllers" for prefix in prefixes),
    ]


def examples():
    """Returns the names of the experiments that come with Cohort, in alphabetical order."""
    return sorted(each.stem for each in (worlds_folder() / "experiments").glob("*.yaml"))


def experiment_called(name):
    """Returns the file of an experiment: a path, or the name of a bundled experiment if no such file exists.

    Raises FileNotFoundError if there is neither.
    """
    path = pathlib.Path(name)
    if path.exists() or len(path.parts) != 1 or path.suffix:
        return path
    known = examples()
    if str(name) in known:
        return worlds_folder() / "experiments" / f"{name}.yaml"
    near = difflib.get_close_matches(str(name), known, n=3)
    suggestion = f"; did you mean {' or '.join(near)}?" if near else ""
    raise FileNotFoundError(f"no file or example is named '{name}'{suggestion}")
