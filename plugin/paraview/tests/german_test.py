"""Every text of the panel has a German translation: those that Qt's own lupdate finds in the sources, against palpate_de.ts.

Arguments: lupdate, the client's folder, a scratch folder.
"""

import os
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

LUPDATE, CLIENT, SCRATCH = sys.argv[1:4]


def texts(path):
    """(context, source): translation. Qt asks with the class alone or with its namespace."""
    found = {}
    for context in ElementTree.parse(path).getroot().findall("context"):
        name = context.find("name").text.split("::")[-1]
        for message in context.findall("message"):
            translation = message.find("translation")
            done = translation is not None and translation.get("type") is None
            found[name, message.find("source").text] = (translation.text or "") if done else ""
    return found


def places(text):
    return sorted(re.findall(r"%[0-9]", text))


os.makedirs(SCRATCH, exist_ok=True)
fresh = os.path.join(SCRATCH, "fresh.ts")
if os.path.exists(fresh):
    os.remove(fresh)
subprocess.run([LUPDATE, "-silent", CLIENT, "-ts", fresh], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
wanted = texts(fresh)
german = texts(os.path.join(CLIENT, "language", "palpate_de.ts"))
anywhere = {source: translation for (_, source), translation in german.items()}
wrong = []
for context, source in wanted:
    # lupdate does not know the class of a text in a header that has no Q_OBJECT.
    translation = german.get((context, source)) or (anywhere.get(source) if context == "plugin" else None)
    if not translation:
        wrong.append(f"{context}: not translated: {source!r}")
    elif places(translation) != places(source):
        wrong.append(f"{context}: other numbers: {source!r}: {translation!r}")
if len(wanted) < 300:
    wrong.append(f"lupdate found {len(wanted)} texts alone")
if wrong:
    sys.exit("\n".join(wrong))
print(f"{len(wanted)} texts are translated")
