"""Man pages and completions of the programs, made from what their --help prints.

    python3 plugin/packaging/help_pages.py BIN VERSION DATE OUT

writes OUT/man/PROGRAM[-COMMAND].1, OUT/bash/PROGRAM and OUT/zsh/_PROGRAM for every program in the folder BIN.
"""

import os
import re
import subprocess
import sys
from dataclasses import dataclass, field

PROGRAMS = ("palpate", "palpate-bench", "palpate-testdata")


@dataclass
class Help:
    """What one --help says."""

    about: list = field(default_factory=list)  # lines
    usage: str = ""
    sections: dict = field(default_factory=dict)  # title -> [(term, text)]
    notes: list = field(default_factory=list)  # lines at the end

    def flags(self):
        """Every option as it is typed, in order."""
        return [flag for title, entries in self.sections.items() if title not in ("Positionals", "Subcommands")
                for term, _ in entries for flag in re.findall(r"(?<![\w-])--?[A-Za-z][\w-]*", term.split(" ")[0])]

    def commands(self):
        return [term for term, _ in self.sections.get("Subcommands", [])]


def parse(text):
    """The help as CLI11 prints it: about, usage, then sections of entries in two columns, then notes."""
    page = Help()
    section = None
    for line in text.splitlines():
        entry = re.match(r"  (\S.*?)(?:\s{2,}(\S.*))?$", line)
        if line.startswith("Usage: "):
            page.usage = line[len("Usage: "):]
        elif not page.usage:
            page.about.append(line)
        elif re.fullmatch(r"\S[^:]*:", line):
            section = page.sections.setdefault(line[:-1], [])
        elif not line.strip():
            continue
        elif section is not None and line.startswith(" " * 20) and section:
            term, said = section[-1]
            section[-1] = (term, f"{said} {line.strip()}".strip())
        elif section is not None and entry:
            section.append((entry[1], entry[2] or ""))
        else:
            page.notes.append(line.strip())
    if not page.usage:
        raise SystemExit(f"help_pages.py: no line 'Usage: ' in:\n{text}")
    return page


def help_of(program, *command):
    shown = subprocess.run([program, *command, "--help"], stdout=subprocess.PIPE, text=True, check=True)
    return parse(shown.stdout)


def roff(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text[:1] in ".'" else text


def man_page(name, page, version, date, others):
    lines = [f'.TH {name.upper()} 1 "{date}" "Palpate {version}" "User Commands"', ".SH NAME",
             f"{roff(name)} \\- {roff(page.about[0].rstrip('.'))}", ".SH SYNOPSIS", f".B {roff(page.usage)}"]
    if any(page.about[1:]):
        lines += [".SH DESCRIPTION"] + [roff(line.strip()) if line.strip() else ".PP" for line in page.about[1:]]
    for title, entries in page.sections.items():
        lines.append(f".SH {title.upper()}")
        for term, said in entries:
            lines += [".TP", f".B {roff(term)}", roff(said)]
    if page.notes:
        lines += [".SH NOTES"] + [roff(line) for line in page.notes]
    if others:
        lines += [".SH SEE ALSO"] + [f".BR {roff(other)} (1)" for other in others]
    return "\n".join(lines) + "\n"


def bash_completion(program, top, pages):
    function = "_" + program.replace("-", "_")
    cases = "\n".join(f"    {command}) words='{' '.join(pages[command].flags())}' ;;" for command in top.commands())
    return f"""# bash completion of {program}, made from its --help
{function}() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} words
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W '{' '.join(top.commands() + top.flags())}' -- "$current")
    return
  fi
  case ${{COMP_WORDS[1]}} in
{cases}
    *) words= ;;
  esac
  case $current in
    -*) mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current") ;;
    *) compopt -o filenames 2>/dev/null; mapfile -t COMPREPLY < <(compgen -f -- "$current") ;;
  esac
}}
complete -F {function} {program}
"""


def zsh_quoted(text):
    return re.sub(r"([\[\]:\\])", r"\\\1", text).replace("'", "'\\''")


def zsh_completion(program, top, pages):
    listed = "\n".join(f"    '{command}:{zsh_quoted(dict(top.sections['Subcommands'])[command])}'" for command in top.commands())
    cases = []
    for command in top.commands():
        options = []
        for title, entries in pages[command].sections.items():
            if title in ("Positionals", "Subcommands"):
                continue
            for term, said in entries:
                takes = " " in term
                for flag in re.findall(r"(?<![\w-])--?[A-Za-z][\w-]*", term.split(" ")[0]):
                    options.append(f"'{flag}[{zsh_quoted(said)}]{':value:_files' if takes else ''}'")
        cases.append(f"    {command}) _arguments {' '.join(options)} '*:file:_files' ;;")
    return f"""#compdef {program}
# made from its --help
local -a commands
if (( CURRENT == 2 )); then
  commands=(
{listed}
  )
  _describe command commands
  _arguments {' '.join(f"'{flag}'" for flag in top.flags())}
else
  local command=$words[2]
  shift words
  (( CURRENT-- ))
  case $command in
{chr(10).join(cases)}
  esac
fi
"""


def write(path, text):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def main(folder, version, date, out):
    for program in PROGRAMS:
        top = help_of(os.path.join(folder, program))
        pages = {command: help_of(os.path.join(folder, program), command) for command in top.commands()}
        names = [f"{program}-{command}" for command in pages]
        write(f"{out}/man/{program}.1", man_page(program, top, version, date, names))
        for command, page in pages.items():
            write(f"{out}/man/{program}-{command}.1", man_page(f"{program}-{command}", page, version, date, [program]))
        write(f"{out}/bash/{program}", bash_completion(program, top, pages))
        write(f"{out}/zsh/_{program}", zsh_completion(program, top, pages))


if __name__ == "__main__":
    main(*sys.argv[1:])
