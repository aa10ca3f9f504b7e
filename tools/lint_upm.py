"""Hold UPM packages to Unity's rules, one line a fault; those of this repository where no folder is given.

Exits 1 if there is any fault. A package that tools/pack_upm.py wrote is checked as it unpacks.
"""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import upm_assemblies
import upm_assets
import upm_manifest
import upm_scripts
from gen_meta import PACKAGES
from upm_package import Package


def faults(folders: Sequence[Path]) -> list[str]:
    """Faults of packages that belong together, one sentence each: file, field, value and what was expected."""
    packages = [Package(folder) for folder in folders]
    versions = {package.name: str(package.manifest.get("version")) for package in packages}
    found = [*upm_assets.guid_faults(packages), *upm_assets.reference_faults(packages)]
    found += [*upm_assets.include_faults(packages), *upm_assemblies.faults(packages)]
    for package in packages:
        found += [*upm_manifest.faults(package, versions), *upm_manifest.page_faults(package)]
        found += [*upm_assets.path_faults(package), *upm_assets.hidden_faults(package)]
        found += [*upm_assets.meta_faults(package), *upm_scripts.faults(package)]
    return sorted(found)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="*", type=Path, default=PACKAGES, help="packages that belong together")
    if found := faults(parser.parse_args().folders):
        sys.exit("\n".join(found))


if __name__ == "__main__":
    main()
