"""The slips that a line of code can have: each as it would be written, and, where it can be, so that it is chosen at run time
(slip.h beside this file; @ stands for its number)."""

import re

NOT_MUTATED = re.compile(r"(_test|_benchmark)\.(cpp|h)$|/(testing|peers|fuzz|bench)/|/paraview/(?!client/model/)")
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
    ("term left out", r" \+ ", None, " + slip::NoPlus{@} + "),
    ("term left out", r" - ", None, " - slip::NoMinus{@} - "),
]
# Of these the line that chooses the slip compiles if and only if the slip does.
COMPILES_ALIKE = {"another variable", "arguments swapped", "call left out", "return before it"}
KEYWORDS = {"if", "for", "while", "switch", "return", "sizeof", "catch", "decltype", "alignof", "noexcept", "throw", "else", "new", "delete",
            "using", "typename", "case", "struct", "class", "enum", "namespace", "operator", "const", "auto", "template", "public", "void"}
DECLARED = re.compile(r"(?<![\w.>:])(?:const )?([A-Za-z_][\w:]*(?:<[\w:, ]+>)?)[&*]? ([a-z]\w*)(?= = |[,;){]|$)")
DECLARATION = re.compile(r"^(?:const )?[A-Za-z_][\w:<>, ]*[&*]* \w+$")
CALL = re.compile(r"(?<![\w.>:])((?:[a-z_]\w*::)*[a-z_]\w*)\(")
VARIABLE = re.compile(r"(?<![\w.>:&\[])([a-z]\w*)(?![\w(:{]| [-+*/|&]?= )")
SYMMETRIC = re.compile(r"(?:^|::)(?:dot|distance|min|max|hypot|swap)$")  # their arguments may be swapped
ENUM = re.compile(r"\benum class (\w+)(?: : [\w:]+)? \{([^}]*)\}")
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


def term_end(code, begin):
    """Where the term of a sum that starts at `begin` ends; None where that is on another line."""
    depth = 0
    for at in range(begin, len(code)):
        if code[at] in "([{":
            depth += 1
        elif code[at] in ")]}":
            if depth == 0:
                return at
            depth -= 1
        elif depth == 0 and (code[at] in ",;" or re.match(r" (?:[+\-<>=?:|&]|!=)", code[at:])):
            return at
    return None


def clauses_left_out(line, code):
    """Of `a && b` and `a || b` either clause alone."""
    for match in re.finditer(r" (?:&&|\|\|) ", code):
        found = operands(code, *match.span())
        if not found:
            continue
        first, last = found
        left, right, operator = line[first : match.start()], line[match.end() : last], match.group()
        neutral = "slip::on(@) || " if "&" in operator else "!slip::on(@) && "
        yield f"{line[:first]}({left}){line[last:]}", f"{line[:first]}(({left}){operator}({neutral}({right}))){line[last:]}"
        yield f"{line[:first]}({right}){line[last:]}", f"{line[:first]}(({neutral}({left})){operator}({right})){line[last:]}"


def calls_changed(line, code):
    """(name, line with the slip, line that chooses it): neighbours among the arguments swapped, and a function of one left out."""
    for match in CALL.finditer(code):
        end = closing(code, match.end() - 1)
        if not end or match.group(1) in KEYWORDS:
            continue
        places = [match.end() - 1, *end[1], end[0]]
        arguments = [line[a + 1 : b].strip() for a, b in zip(places, places[1:])]
        if any(not argument or DECLARATION.match(argument) for argument in arguments):
            continue
        copied = match.group(1) == "std::move"  # the same value, more slowly
        if len(arguments) == 1 and not copied and re.search(r"[=(,?:+\-*/<>&|] ?$|return $", code[: match.start()]) and arguments[0][0] not in "[{":
            before, after, call = line[: match.start()], line[end[0] + 1 :], line[match.start() : end[0] + 1]
            yield "call left out", f"{before}({arguments[0]}){after}", f"{before}(slip::on(@) ? ({arguments[0]}) : {call}){after}"
        for n, (one, two) in enumerate(zip(arguments, arguments[1:])) if not SYMMETRIC.search(match.group(1)) else ():
            before, after = line[: places[n] + 1] + (" " if n else ""), line[places[n + 2] :]
            either_way = f"slip::on(@) ? ({two}) : ({one}), slip::on(@) ? ({one}) : ({two})"
            yield "arguments swapped", f"{before}{two}, {one}{after}", before + either_way + after


def other_words(line, code, variables, enums):
    """(name, line with the slip, line that chooses it): another variable of a type, another value of an enumeration."""
    declared_here = {match.group(2) for match in DECLARED.finditer(code)}
    for match in VARIABLE.finditer(code):
        name, before, after = match.group(), line[: match.start()], line[match.end() :]
        others = [other for other, kind in variables.items() if other != name and kind == variables.get(name)]
        if name in variables and name not in declared_here and others:
            yield "another variable", before + others[-1] + after, f"{before}(slip::on(@) ? {others[-1]} : {name}){after}"
    for match in re.finditer(r"\b((?:\w+::)*(\w+)::)(\w+)\b(?![(:])", code):
        values = enums.get(match.group(2), [])
        if match.group(3) in values and len(values) > 1:
            other = match.group(1) + values[(values.index(match.group(3)) + 1) % len(values)]
            before, after = line[: match.start()], line[match.end() :]
            yield "another enumerator", before + other + after, f"{before}(slip::on(@) ? {other} : {match.group()}){after}"


def slips_of(line, code, variables=None, enums=None):
    """(name, line with the slip, line that chooses it or None) for each slip that a line of code can have.

    `variables` has the type of each that may be in scope, `enums` the values of each enumeration."""
    found = [("clause left out", *slip) for slip in clauses_left_out(line, code)]
    found += [*calls_changed(line, code), *other_words(line, code, variables or {}, enums or {})]
    for match in re.finditer(r" \? ", code):
        both = operands(code, *match.span())
        if both and " : " in code[match.end() :]:
            before, condition, after = line[: both[0]], line[both[0] : match.start()], line[match.start() :]
            found.append(("branches swapped", f"{before}!({condition}){after}", f"{before}(slip::on(@) != static_cast<bool>({condition})){after}"))
    for match in re.finditer(r"\bfor \(.*?[\w\])](?= < )", code):
        before, after = line[: match.end()], line[match.end() :]
        found.append(("end of a loop", f"{before} + 1{after}", f"{before} + (slip::on(@) ? 1 : 0){after}"))
    for name, pattern, other, chooses in SWAPS:
        for match in re.finditer(pattern, code):
            before, after = line[: match.start()], line[match.end() :]
            if other is None:
                end = term_end(code, match.end())
                if end:
                    found.append((name, before + line[end:], before + chooses + after))
                continue
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
        for value in ("", " {}"):  # one of them does not compile
            found.append(("return before it", f"{indent}return{value};", f"{indent}if (slip::on(@)) return{value}; {line[len(indent):]}"))
    return found


def enumerations(text):
    """The values of each `enum class` in a text."""
    return {name: re.findall(r"\w+", re.sub(r"=[^,]*", "", values)) for name, values in ENUM.findall(masked(text))}


def variables_before(codes, number):
    """The types of the variables in scope on a line (from 1), by indentation, of those that its function declares above it. A
    function begins in the first column."""
    first = next((n for n in range(number - 2, -1, -1) if re.match(r"[A-Za-z\[]", codes[n])), number - 1)
    declared = []
    for code in codes[first:number]:
        indent = len(code) - len(code.lstrip())
        if code.strip():
            declared = [known for known in declared if known[0] <= indent]
        inner = indent + bool(re.match(r"\s*(?:for|if|while|switch) \(|\S.*\($|\S.*\{$", code))
        declared += [(inner, name, kind) for kind, name in DECLARED.findall(code) if kind not in KEYWORDS]
    here = {name for _, name in DECLARED.findall(codes[number - 1])}
    return {name: kind for _, name, kind in declared if name not in here}


def at_run_time(line):
    """A constant of the compiler's becomes one of the program's, so that its value can be chosen."""
    if line is None or not re.search(r"\bconstexpr\b.* = ", line):
        return line
    return re.sub(r"\bconstexpr\b", "const", re.sub(r"\bstatic constexpr\b", "static inline const", line))


def slips_by_line(text, wanted=None, enums=None):
    """(line number, its slips) of each line that can have one; only of the lines `wanted`, if these are given."""
    result, codes = [], masked(text).splitlines()
    for number, (line, code) in enumerate(zip(text.splitlines(), codes), 1):
        if (wanted is not None and number not in wanted) or SKIPPED_LINE.match(line):
            continue
        found = slips_of(line, code, variables_before(codes, number), enums)
        slips = [(name, after, at_run_time(together)) for name, after, together in found if after != line]
        if slips:
            result.append((number, slips))
    return result
