"""The list of parts (SPDX 2.3, JSON) of a package: what its programs and libraries are made with and load.

    python3 plugin/packaging/sbom.py NAME VERSION COMMIT EPOCH LICENSES.md ROOT > NAME.spdx.json

ROOT is the package's tree. A shared library that a program of it needs and that LICENSES.md has no row for is an error.
"""

import datetime
import glob
import hashlib
import json
import os
import re
import subprocess
import sys


def rows(table):
    """(library, Debian packages, names of shared libraries, how, license) of every row."""
    with open(table, encoding="utf-8") as file:
        lines = [line for line in file if line.startswith("| ")]
    cells = [[cell.strip() for cell in line.strip().strip("|").split("|")] for line in lines]
    return [(row[0], row[1].split(), row[2].split(), row[3], row[4]) for row in cells if row[0] != "library"]


def needed(root):
    """The shared libraries that the programs and libraries below `root` name, but for those that are there too."""
    own, named = set(), set()
    for path in glob.glob(f"{root}/**/*", recursive=True):
        if os.path.isfile(path) and not os.path.islink(path):
            own.add(os.path.basename(path))
            with open(path, "rb") as file:
                if file.read(4) == b"\x7fELF":
                    said = subprocess.run(["readelf", "-d", path], stdout=subprocess.PIPE, text=True, check=True).stdout
                    named.update(re.findall(r"\(NEEDED\).*\[(.*)\]", said))
    return named - own


def installed(package):
    """Version and source of a Debian package, or None."""
    asked = subprocess.run(["dpkg-query", "-W", "-f=${Version} ${source:Package}", package],
                           stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    return asked.stdout.split(" ") if asked.returncode == 0 and asked.stdout else None


def matches(library, stem):
    name = library.split(".so")[0]
    return name == stem or re.match(re.escape(stem) + r"[-.\d]", name) or (
        stem in ("libvtk", "libpq", "libQt5", "libQt6") and name.startswith(stem))


def main(name, version, commit, epoch, table, root):
    table = rows(table)
    libraries = needed(root)
    unknown = sorted(library for library in libraries if not any(matches(library, stem) for row in table for stem in row[2]))
    if unknown:
        sys.exit(f"sbom.py: {name} needs {', '.join(unknown)}: give it a row in plugin/docs/licenses.md")

    parts = [{"SPDXID": "SPDXRef-Package", "name": name, "versionInfo": version, "downloadLocation": "NOASSERTION",
              "filesAnalyzed": False, "licenseConcluded": "Apache-2.0", "licenseDeclared": "Apache-2.0",
              "copyrightText": "NOASSERTION"}]
    relations = [{"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES", "relatedSpdxElement": "SPDXRef-Package"}]
    for library, packages, stems, how, license_name in table:
        present = [(package, installed(package)) for package in packages if installed(package)]
        loaded = sorted(one for one in libraries if any(matches(one, stem) for stem in stems))
        if not present or (stems and not loaded):
            continue
        package, (package_version, source) = present[0]
        identity = "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", package)
        parts.append({"SPDXID": identity, "name": library, "versionInfo": package_version, "downloadLocation": "NOASSERTION",
                      "filesAnalyzed": False, "licenseConcluded": "NOASSERTION", "licenseDeclared": license_name,
                      "copyrightText": "NOASSERTION", "comment": " ".join([how] + loaded),
                      "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                                        "referenceLocator": f"pkg:deb/debian/{source}@{package_version}?arch=source"}]})
        kind = "DYNAMIC_LINK" if stems else "CONTAINS"
        relations.append({"spdxElementId": "SPDXRef-Package", "relationshipType": kind, "relatedSpdxElement": identity})
    # By what it holds, so that two builds of the same give the same.
    seal = hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()[:32]
    made = datetime.datetime.fromtimestamp(int(epoch), datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")
    json.dump({"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": f"{name}-{version}",
               "documentNamespace": f"urn:palpate:spdx:{name}:{version}:{commit}:{seal}",
               "creationInfo": {"created": made, "creators": ["Tool: palpate plugin/packaging/sbom.py"]},
               "packages": parts, "relationships": relations}, sys.stdout, indent=1)
    print()


if __name__ == "__main__":
    main(*sys.argv[1:])
