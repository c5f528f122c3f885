# SPDX-License-Identifier: Apache-2.0

"""Builds interfaces for rclpy of which no wheel exists, from their .msg and .srv texts, by ROS's own generators.

build_interfaces.py FOLDER OUTPUT PACKAGE...: reads FOLDER/PACKAGE/msg/*.msg and FOLDER/PACKAGE/srv/*.srv of each
package, and makes OUTPUT/PACKAGE, for PYTHONPATH. A package may use those before it, and all that the environment has.
Does nothing if it has made the same texts before, and waits while another process makes them. A package has a library
with its types and their support for rmw_fastrtps, and an extension module with rclpy's functions.
"""

import concurrent.futures
import fcntl
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import numpy
from rosidl_adapter.msg import convert_msg_to_idl
from rosidl_adapter.srv import convert_srv_to_idl
from rosidl_generator_c import generate_c
from rosidl_generator_py import generate_py
from rosidl_generator_type_description import generate_type_hash
from rosidl_typesupport_c import generate_c as generate_typesupport_c
from rosidl_typesupport_fastrtps_c import generate_typesupport_fastrtps_c
from rosidl_typesupport_introspection_c import generate_c as generate_typesupport_introspection_c

PREFIX = Path(sys.prefix)
SHARE = PREFIX / "share"
# The type supports that rmw_fastrtps needs: to write and read a type, and to describe it for topics.
TYPE_SUPPORTS = ["rosidl_typesupport_fastrtps_c", "rosidl_typesupport_introspection_c"]


def texts_of(package: Path) -> list[Path]:
    return sorted([*package.glob("msg/*.msg"), *package.glob("srv/*.srv")])


def translate(package: Path, output: Path) -> list[Path]:
    """Makes the .idl files of a package, as paths in `output`."""
    for text in texts_of(package):
        convert = convert_msg_to_idl if text.suffix == ".msg" else convert_srv_to_idl
        kind = text.parent.name
        (output / kind).mkdir(parents=True, exist_ok=True)
        convert(package.resolve(), package.name, Path(kind) / text.name, output / kind)
    return sorted(path.relative_to(output) for path in output.glob("*/*.idl"))


def write_arguments(file: Path, generator: str, package: str, idl: Path, names: list[Path], out: Path, more) -> str:
    file.write_text(
        json.dumps(
            {
                "package_name": package,
                "idl_tuples": [f"{idl}:{name}" for name in names],
                "ros_interface_dependencies": [],
                "output_dir": str(out),
                "template_dir": str(SHARE / generator / "resource"),
                "target_dependencies": [],
                "type_description_tuples": [f"{name}:{idl / name.with_suffix('.json')}" for name in names],
                **more,
            }
        )
    )
    return str(file)


def generate(package: Path, work: Path, others: list[str]) -> None:
    """Makes the sources of a package: .c and .cpp under work/c/PACKAGE, .py and .c under work/python/PACKAGE."""
    name = package.name
    idl = work / "share" / name
    names = translate(package, idl)
    c, described, python = (work / kind / name for kind in ("c", "described", "python"))
    folders = [folder / other for other in others for folder in (work / "share", SHARE)]
    paths = [f"{folder.name}:{folder}" for folder in folders if folder.is_dir()]

    def arguments(generator, out, **more):
        out.mkdir(parents=True, exist_ok=True)
        return write_arguments(work / f"{name}_{generator}.json", generator, name, idl, names, out, more)

    generate_type_hash(arguments("rosidl_generator_type_description", idl, include_paths=paths))
    generate_c(arguments("rosidl_generator_c", c))
    generate_typesupport_fastrtps_c(arguments("rosidl_typesupport_fastrtps_c", c))
    # Its sources have the names of others.
    generate_typesupport_introspection_c(arguments("rosidl_typesupport_introspection_c", described))
    generate_typesupport_c(arguments("rosidl_typesupport_c", c), TYPE_SUPPORTS)
    (python / "__init__.py").parent.mkdir(parents=True, exist_ok=True)
    (python / "__init__.py").write_text("")
    generate_py(arguments("rosidl_generator_py", python), ["rosidl_typesupport_c"])
    (c / "msg").mkdir(exist_ok=True)
    for generator in ("rosidl_generator_c", *TYPE_SUPPORTS):
        header = f"{generator}__visibility_control.h"
        template = SHARE / generator / "resource" / f"{header}.in"
        text = template.read_text().replace("@PROJECT_NAME@", name).replace("@PROJECT_NAME_UPPER@", name.upper())
        (c / "msg" / header).write_text(text)


def joined(folder: Path) -> list[Path]:
    """Makes one source of all those of a kind in a folder: they include the same headers, which take most of the time.

    Descriptions of types stay alone, because they define static variables with the same names.
    """
    alone: list[Path] = []
    kinds: dict[str, list[Path]] = {}
    for source in sorted(folder.rglob("*.c*")):
        kind = re.sub(r"^.*?(?=__|_s\.)", "", source.name)
        (alone if kind == "__description.c" else kinds.setdefault(kind, [])).append(source)
    for kind, sources in kinds.items():
        alone.append(folder / f"all{kind}")
        alone[-1].write_text("".join(f'#include "{source}"\n' for source in sources))
    return alone


def compile_package(name: str, work: Path, libraries: list[Path]) -> list[Path]:
    """Compiles a package's sources into a library with its types and an extension module; returns both."""
    includes = [work / "c", work / "described", *(PREFIX / "include").iterdir(), PREFIX / "include"]
    includes += [sysconfig.get_paths()["include"], numpy.get_include()]
    flags = ["-fPIC", "-O0", "-w", *(f"-I{include}" for include in includes)]
    of_types = [*joined(work / "c" / name), *joined(work / "described" / name)]
    of_python = joined(work / "python" / name)

    def compile_one(source: Path) -> Path:
        target = source.with_name(f"{source.name}.o")
        compiler = ["g++", "-std=c++17"] if source.suffix == ".cpp" else ["gcc"]
        subprocess.run([*compiler, *flags, "-c", source, "-o", target], check=True)
        return target

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        types, functions = list(pool.map(compile_one, of_types)), list(pool.map(compile_one, of_python))
    suffix = sysconfig.get_config_var("EXT_SUFFIX")
    generated = re.compile(r"rosidl_(generator_(c|py)|typesupport_(c|fastrtps_c|introspection_c))")
    found = [path for path in (PREFIX / "lib").glob("lib*.so") if generated.search(path.name)]
    for each in ("rosidl_runtime_c", "rosidl_typesupport_fastrtps_cpp", "fastcdr"):
        found.append(PREFIX / "lib" / f"lib{each}.so")
    folder = work / "python" / name
    rpaths = [f"-Wl,-rpath,{path}" for path in {PREFIX / "lib", folder, *(each.parent for each in libraries)}]

    def link(target: Path, inputs: list) -> Path:
        flags = ["-Wl,--allow-shlib-undefined", f"-Wl,-soname,{target.name}", *rpaths]
        subprocess.run(["g++", "-shared", "-o", target, *flags, *inputs], check=True)
        return target

    as_needed = ["-Wl,--as-needed", *found, *libraries]
    library = link(folder / f"lib{name}.so", [*types, *as_needed])
    # ROS opens a type support by the name of its library: these are opened with the module, and have no more in them.
    named = [link(folder / f"lib{name}__{each}.so", ["-Wl,--no-as-needed", library]) for each in TYPE_SUPPORTS]
    module = folder / f"{name}_s__rosidl_typesupport_c{suffix}"
    link(module, [*functions, "-Wl,--no-as-needed", library, *named, *as_needed])
    return [library, module]


def build(folder: Path, output: Path, packages: list[str]) -> None:
    digest = hashlib.sha256(Path(__file__).read_bytes())
    for package in packages:
        texts = texts_of(folder / package)
        if not texts:
            sys.exit(f"{folder / package}: no msg/*.msg and no srv/*.srv")
        for text in texts:
            digest.update(f"{text.relative_to(folder)}\n{text.read_text()}\n".encode())
    stamp = output / "built"
    if stamp.exists() and stamp.read_text() == digest.hexdigest():
        return
    shutil.rmtree(output, ignore_errors=True)
    work = output / "work"
    work.mkdir(parents=True)
    libraries: list[Path] = []
    available = sorted(path.name for path in SHARE.iterdir() if (path / "msg").is_dir() or (path / "srv").is_dir())
    for index, package in enumerate(packages):
        generate(folder / package, work, [*packages[:index], *(name for name in available if name not in packages)])
        libraries.extend(compile_package(package, work, libraries))
        (output / package).symlink_to(work / "python" / package)
    stamp.write_text(digest.hexdigest())


def main() -> None:
    folder, output = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    output.parent.mkdir(parents=True, exist_ok=True)
    with output.with_name(output.name + ".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        build(folder, output, sys.argv[3:])


if __name__ == "__main__":
    main()
