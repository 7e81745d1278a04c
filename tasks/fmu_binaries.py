"""The libraries that FMUs carry, compiled for all platforms on this one."""

from __future__ import annotations

import json
import shutil
import tempfile
from pathlib import Path

from tasks.environment import BIN, ROOT, STAMP, install, quietly, write_stamp
from tasks.machine import stop

BESIDE_FMU = (
    "bindings/contradictions.cpp",
    *("capi/device_parameters.cpp", "capi/drive.cpp", "capi/stepper.cpp"),
)

# What FMI 3 calls a platform, what the compiler does, and how its libraries end.
FMU_PLATFORMS = {
    "x86_64-linux": ("x86_64-linux-gnu.2.17", "so"),
    "aarch64-linux": ("aarch64-linux-gnu.2.17", "so"),
    "x86_64-windows": ("x86_64-windows-gnu", "dll"),
    "aarch64-windows": ("aarch64-windows-gnu", "dll"),
    "x86_64-darwin": ("x86_64-macos", "dylib"),
    "aarch64-darwin": ("aarch64-macos", "dylib"),
}

# Small, and linked as C: fmu/runtime.cpp takes the place of what a runtime of C++ adds. Nothing
# is thrown, so that no frame needs a table to unwind it: on Windows these are a tenth of the file.
FMU_COMPILE = (
    *("-std=c++17", "-Os", "-Xclang", "-Oz", "-g0", "-DPINDRIVE_WITHIN", "-ffp-contract=off"),
    *("-fno-math-errno", "-fno-exceptions", "-fno-rtti", "-ffunction-sections", "-fdata-sections"),
    *("-fomit-frame-pointer", "-fno-stack-protector"),
    *("-fno-unwind-tables", "-fno-asynchronous-unwind-tables"),
)
FMU_COMPILE_FOR = {
    "so": ("-fPIC", "-fvisibility=hidden"),
    "dll": (),  # there the functions of FMI alone are exported
    "dylib": ("-fPIC", "-fvisibility=hidden"),
}
FMU_LINK_FOR = {
    "so": ("-Wl,--gc-sections", "-Wl,--version-script=fmu/exports.map"),
    "dll": ("-Os", "-Wl,--gc-sections"),
    "dylib": ("-Wl,-dead_strip", "-Wl,-x"),
}

# Zig's own runtime would come whole, a quarter of the library: what is called of it is in
# fmu/runtime.cpp.
FMU_LINK_WINDOWS = (
    *("-OReleaseSmall", "-fstrip", "--gc-sections", "--build-id=none"),
    *("-lc", "-fno-compiler-rt", "-fno-emit-implib"),
)


def fmu_binaries(platforms: list[str]) -> int:
    """The libraries that FMUs carry for the platforms named, or all; then installs them."""
    unknown = [name for name in platforms if name not in FMU_PLATFORMS]
    if unknown:
        stop(f"no platform {unknown[0]!r}; there are {', '.join(FMU_PLATFORMS)}")
    install({"fmu"}, project=False)
    for name in platforms or FMU_PLATFORMS:
        library = fmu_binary(name)
        print(f"{library.relative_to(ROOT)}: {library.stat().st_size / 1e3:.0f} kB", flush=True)
    write_stamp({**json.loads(STAMP.read_text("utf-8")), "sources": None})
    install({"fmu"})
    return 0


def fmu_binary(name: str) -> Path:
    """The library that an FMU carries for a platform, compiled here."""
    target, suffix = FMU_PLATFORMS[name]
    sources = [*sorted((ROOT / "fmu").glob("*.cpp")), *(ROOT / n for n in BESIDE_FMU)]
    headers = [f"-I{ROOT / folder}" for folder in ("include", "bindings", "capi", "fmu")]
    library = ROOT / "build" / "fmu" / name / f"pindrive.{suffix}"
    library.parent.mkdir(parents=True, exist_ok=True)
    zig = [str(BIN / "python"), "-m", "ziglang"]
    with tempfile.TemporaryDirectory() as folder:
        objects = [str(Path(folder, f"{source.stem}.o")) for source in sources]
        for source, compiled in zip(sources, objects, strict=True):
            options = [*FMU_COMPILE, *FMU_COMPILE_FOR[suffix], *headers]
            compiling = [
                *zig,
                "c++",
                "-target",
                target,
                *options,
                "-c",
                str(source),
                "-o",
                compiled,
            ]
            quietly(f"compiling {source.name} for {name}", compiling)
        part = Path(folder, library.name)
        if name == "x86_64-windows":
            linking = [*zig, "build-lib", "-dynamic", "-target", target, *FMU_LINK_WINDOWS]
            quietly(f"linking for {name}", [*linking, *objects, f"-femit-bin={part}"])
        else:
            linking = [*zig, "cc", "-target", target, "-shared", "-s", *FMU_LINK_FOR[suffix]]
            quietly(f"linking for {name}", [*linking, *objects, "-o", str(part)])
        beside = library.with_name("part")
        shutil.copyfile(part, beside)
        beside.replace(library)
    return library
