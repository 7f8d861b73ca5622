"""The slips that a line of code can have: each as it would be written, and, where it can be, so that it is chosen at run time
(slip.h beside this file; @ stands for its number)."""

import re

NOT_MUTATED = re.compile(r"(_test|_benchmark|_main)\.(cpp|h)$|/(testing|peers|fuzz|paraview|bench)/")
SKIPPED_LINE = re.compile(r"^\s*(#|using |namespace|template|static_assert|friend |public:|private:|case |///|//|\*)")

# Each: a name, what is looked for in code without comments and strings, what takes its place, and what lets either be chosen.
SWAPS = [
    ("plus for minus", r" \+ ", " - ", " + slip::Plus{@} + "),
    ("minus for plus", r" - ", " + ", " - slip::Minus{@} - "),
    ("times for over", r" \* ", " / ", " * slip::Times{@} * "),
    ("over for times", r" / ", " * ", " / slip::Over{@} / "),
    ("add for subtract", r" \+= ", " -= ", None),
    ("subtract for add", r" -= ", " += ", None),
    ("less for not more", r" < ", " <= ", " < slip::Less{@} < "),
    ("not more for less", r" <= ", " < ", " <= slip::NotMore{@} <= "),
    ("more for not less", r" > ", " >= ", " > slip::More{@} > "),
    ("not less for more", r" >= ", " > ", " >= slip::NotLess{@} >= "),
    ("turned comparison", r" < ", " > ", " < slip::LessTurned{@} < "),
    ("turned comparison", r" > ", " < ", " > slip::MoreTurned{@} > "),
    ("equal for different", r" == ", " != ", " == slip::Equal{@} == "),
    ("different for equal", r" != ", " == ", " != slip::Different{@} != "),
    ("and for or", r" && ", " || ", None),
    ("or for and", r" \|\| ", " && ", None),
    ("least for most", r"\bstd::min\b", "std::max", "slip::Min{@}"),
    ("most for least", r"\bstd::max\b", "std::min", "slip::Max{@}"),
    ("no negation", r"(?<=[ (])!(?=[A-Za-z(])", "", "slip::No{@} ->* "),
    ("other sign", r"(?<=[=(,?:] )-(?=[A-Za-z0-9(])|(?<=\()-(?=[A-Za-z(])|(?<=return )-(?=[A-Za-z0-9(])", "",
     "slip::Negative{@} ->* "),
    ("y for x", r"\.x\b(?!\()", ".y", "[slip::on(@) ? 1 : 0]"),
    ("z for y", r"\.y\b(?!\()", ".z", "[slip::on(@) ? 2 : 1]"),
    ("x for z", r"\.z\b(?!\()", ".x", "[slip::on(@) ? 0 : 2]"),
    ("down for up", r"\+\+(?=[A-Za-z])", "--", "slip::Up{@} ->* "),
    ("false for true", r"\btrue\b", "false", "(!slip::on(@))"),
    ("true for false", r"\bfalse\b", "true", "(slip::on(@))"),
]
NUMBER = re.compile(r"(?<![\w.])(\d+\.\d+(?:e-?\d+)?|\d+)(?![\w.])")
ROOM = re.compile(r"^\s*[\w:<>]+ \w+\[$|\bstd::array<[\w:]+, $")  # an array's length: more of it changes nothing
STATEMENT = re.compile(r"^\s+(?:[\w.\[\]>-]+ [+\-*/|&]?= .*|(?:\+\+|--)?[\w.:>-]+\([^;]*\)|(?:\+\+|--)[\w.>-]+);\s*$")
NO_STATEMENT = re.compile(r"^\s*(return|throw|const|auto|static|delete|break|continue)\b")


def masked(text):
    """The text with comments and strings blanked, place by place."""
    pattern = r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\''
    return re.sub(pattern, lambda m: re.sub(r"[^\n]", " ", m.group()), text, flags=re.S)


def closing(code, begin):
    """Where the parenthesis that opens at `begin` closes, and its commas; None where that is on another line."""
    depth, commas = 0, []
    for at in range(begin, len(code)):
        if code[at] in "([{":
            depth += 1
        elif code[at] in ")]}":
            depth -= 1
            if depth == 0:
                return at, commas
        elif code[at] == "," and depth == 1:
            commas.append(at)
    return None


def operands(code, begin, end):
    """Where the operands of a logical operator at begin..end start and end; None where one is on another line."""
    depth, first = 0, None
    for at in range(begin - 1, -1, -1):
        if code[at] in ")]}":
            depth += 1
        elif code[at] in "([{":
            if depth == 0:
                first = at + 1
                break
            depth -= 1
        elif depth == 0:
            ends = next((word for word in ("|| ", "? ", " : ", ", ", "; ", " = ", "return ") if code.startswith(word, at)), None)
            if ends:
                first = at + len(ends)
                break
    depth = 0
    for at in range(end, len(code)):
        if code[at] in "([{":
            depth += 1
        elif code[at] in ")]}":
            if depth == 0:
                return (first, at) if first is not None else None
            depth -= 1
        elif depth == 0 and (code[at] in ",;" or code.startswith((" ?", " :", " ||"), at)):
            return (first, at) if first is not None and code[at : at + 3] != " ::" else None
    return None


def either(line, code, match, other):
    """A line whose logical operator at `match` is chosen between what it is and `other`."""
    found = operands(code, *match.span())
    if not found:
        return None
    first, last = found
    left, right = line[first : match.start()], line[match.end() : last]
    return f"{line[:first]}(slip::on(@) ? (({left}){other}({right})) : (({left}){match.group()}({right}))){line[last:]}"


def slips_of(line, code):
    """(name, line with the slip, line that chooses it or None) for each slip that a line of code can have."""
    found = []
    for name, pattern, other, chooses in SWAPS:
        for match in re.finditer(pattern, code):
            before, after = line[: match.start()], line[match.end() :]
            together = None
            if chooses:
                together = before + chooses + after
            elif "&" in other or "|" in other:
                together = either(line, code, match, other)
            elif re.match(r"[^;]*;\s*$", code[match.end() :]):  # += and -=
                end = code.rindex(";")
                value = line[match.end() : end]
                together = f"{before}{match.group()}(slip::on(@) ? -({value}) : ({value})){line[end:]}"
            found.append((name, before + other + after, together))
    for match in NUMBER.finditer(code):
        if ROOM.search(code[: match.start()]):
            continue
        number = match.group()
        other = "1" if float(number) == 0 else "2" if float(number) == 1 else None
        if other is None:
            other = str(2 * float(number)) if re.search(r"[.e]", number) else str(2 * int(number))
        elif "." in number:
            other += ".0"
        before, after = line[: match.start()], line[match.end() :]
        found.append(("another number", before + other + after, f"{before}(slip::on(@) ? {other} : {number}){after}"))
    for match in re.finditer(r"\bstd::clamp\(", code):
        end = closing(code, match.end() - 1)
        if end and len(end[1]) == 2:
            before, value, after = line[: match.start()], line[match.end() : end[1][0]], line[end[0] + 1 :]
            whole = line[match.start() : end[0] + 1]
            found.append(("no clamp", f"{before}({value}){after}", f"{before}(slip::on(@) ? ({value}) : {whole}){after}"))
    for match in re.finditer(r"\bif \((?!constexpr)", code):
        end = closing(code, match.end() - 1)
        if end:
            before, value, after = line[: match.end()], line[match.end() : end[0]], line[end[0] :]
            found.append(("no guard", f"{before}false && ({value}){after}", f"{before}!slip::on(@) && ({value}){after}"))
    if STATEMENT.match(code) and not NO_STATEMENT.match(code):
        indent = re.match(r"\s*", line).group()
        end = code.rindex(";") + 1
        found.append(("statement left out", indent + ";", f"{indent}{{ if (!slip::on(@)) {line[len(indent):end]} }}{line[end:]}"))
    return found


def at_run_time(line):
    """A constant of the compiler's becomes one of the program's, so that its value can be chosen."""
    if line is None or not re.search(r"\bconstexpr\b.* = ", line):
        return line
    return re.sub(r"\bconstexpr\b", "const", re.sub(r"\bstatic constexpr\b", "static inline const", line))


def slips_by_line(text, wanted=None):
    """(line number, its slips) of each line that can have one; only of the lines `wanted`, if these are given."""
    result = []
    for number, (line, code) in enumerate(zip(text.splitlines(), masked(text).splitlines()), 1):
        if (wanted is not None and number not in wanted) or SKIPPED_LINE.match(line):
            continue
        slips = [(name, after, at_run_time(together)) for name, after, together in slips_of(line, code) if after != line]
        if slips:
            result.append((number, slips))
    return result
