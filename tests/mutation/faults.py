"""Single faults that a person might make: the kinds, and where in a file each can be planted.

A fault replaces a piece of one line by another piece of the same line; the number of lines stays. Comments, texts,
documentation strings and preprocessor lines are left alone. Lines that only give memory back are left alone too: no
result depends on them, and the sanitizers hold them."""

import dataclasses
import io
import re
import tokenize


@dataclasses.dataclass(frozen=True)
class Fault:
    """One fault: the text of its line, which of the lines with that text it is, where in it, and what is there instead."""

    path: str
    kind: str
    line: str
    occurrence: int  # 0: the first line of the file that reads so
    begin: int
    end: int
    new: str

    def number(self, lines):
        """The line's number from 0 on; None if the file has no such line any more."""
        same = [n for n, line in enumerate(lines) if line == self.line]
        return same[self.occurrence] if self.occurrence < len(same) else None

    def planted(self, text):
        """The file with the fault, or None where its line is gone."""
        lines = text.split("\n")
        at = self.number(lines)
        if at is None:
            return None
        lines[at] = self.line[: self.begin] + self.new + self.line[self.end :]
        return "\n".join(lines)

    @property
    def change(self):
        old = self.line[self.begin : self.end]
        return f"{self.kind}: {old.strip()!r} -> {self.new.strip()!r} in {self.line.strip()!r}"


# ---- What is code ----


def blank(text):
    return re.sub(r"[^\n]", " ", text)


def code_of_c(text):
    """The text with everything that is not code blanked, in its place."""
    pieces = r"/\*.*?\*/|//[^\n]*|\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])*'|^[ \t]*#(?:[^\n]*\\\n)*[^\n]*"
    return re.sub(pieces, lambda m: blank(m[0]), text, flags=re.S | re.M)


def code_of_python(text):
    lines = [list(line) for line in text.split("\n")]
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type in (tokenize.STRING, tokenize.COMMENT):
            for row in range(token.start[0] - 1, token.end[0]):
                begin = token.start[1] if row == token.start[0] - 1 else 0
                end = token.end[1] if row == token.end[0] - 1 else len(lines[row])
                lines[row][begin:end] = " " * (end - begin)
    return "\n".join("".join(line) for line in lines)


# ---- Kinds ----
# Each takes a line of code and gives (begin, end, new) for every place in it.

OPERAND = r"(?<![\w.>])[A-Za-z_]\w*(?:(?:\.|->)\w+|\[[^\[\]]*\]|\([^()]*\))*(?![\w(\[])"
LITERAL = r"(?<![\w.])(?:\d+\.\d*(?:e[-+]?\d+)?|\d+e[-+]?\d+|\.\d+)(?![\w.])"
ENDS = r"(?=\s*(?:[;,)\]}]|$|[<>=!]=?|&&|\|\||\?|:| [+-] ))"  # a sum ends here, or goes on


def sign(code):
    for m in re.finditer(r"(?<=[\w\)\]] )[+-](?= [\w(!~-])", code):
        yield m.start(), m.end(), "-" if m[0] == "+" else "+"
    for m in re.finditer(r"[+-](?== )", code):
        yield m.start(), m.end(), "-" if m[0] == "+" else "+"
    for m in re.finditer(r"(?:(?<=[=,?:] )|(?<=[(\[])|(?<=return ))-(?=[A-Za-z(])", code):
        yield m.start(), m.end(), ""


def factor(code):
    for m in re.finditer(LITERAL, code):
        small = re.fullmatch(r"1e-\d\d+", m[0]) or re.search(r"[<>]=? $", code[: m.start()]) and re.fullmatch(r"1e-\d+", m[0])
        if float(m[0]) != 0 and not small:  # twice a tolerance is as good a one; 10,000 times it is `relaxed_bound`
            yield m.start(), m.end(), repr(2 * float(m[0]))
    for m in re.finditer(r"(?<=[\w\)\]] )[*/](?= [\w(-])", code):
        yield m.start(), m.end(), "/" if m[0] == "*" else "*"
    for m in re.finditer(r"(?<![\w.])(?<!\de-)[2-9](?= \* )|(?<=\* )[2-9](?![\w.])", code):
        yield m.start(), m.end(), str(int(m[0]) + 1)


def off_by_one(code):
    for m in re.finditer(r"(?<=[\w\)\]]) [+-] 1(?![\w.])", code):
        yield m.start(), m.end(), ""
    loop = re.search(r"\bfor \((?:[\w ]*?\b\w+ = (\w+)[^;]*)?;[^;]* <=? ([^;&|]+);", code)
    if loop:
        if loop[1] == "0":
            yield loop.start(1), loop.end(1), "1"
        yield loop.end(2), loop.end(2), " - 1"
    for m in re.finditer(r"\brange\(([\w.]+)\)", code):
        yield m.start(1), m.end(1), f"1, {m[1]}"


# The question whether a text is empty: the second letter answers it as well, but for texts of one.
EMPTY = r"(?=\] [!=]= {5})"  # what stands between quotes is blank here
SYMMETRIC = ("strcmp", "strcasecmp", "strncmp", "strncasecmp", "memcmp")  # where they ask whether two are equal


def exchanged_index(code):
    for begin, end, new in exchanged_indices(code):
        if not re.search(r"\bsizeof \(?[\w.>-]*(?:\[\w*\])*\[?$", code[:begin]):  # all items of an array are as large
            yield begin, end, new


def exchanged_indices(code):
    for m in re.finditer(r"\[([^\[\]]+)\]\[([^\[\]]+)\]", code):
        if m[1] != m[2] and m[1].strip() and m[2].strip():  # no text
            yield m.start(), m.end(), f"[{m[2]}][{m[1]}]"
    for m in re.finditer(rf"(?<=[\w\])]\[)(?!0{EMPTY})[0-2](?=\])", code):
        yield m.start(), m.end(), {"0": "1", "1": "0", "2": "1"}[m[0]]
    declared = re.match(r"\s*(?:static |const |unsigned |struct )*\w+ \*?\w+\[", code)
    for m in [] if declared else re.finditer(r"(?<=[\w\])]\[)[a-dijk](?=\])", code):
        yield m.start(), m.end(), "0"
    for m in re.finditer(rf"\b(\w+)\(({OPERAND}), ({OPERAND})(?=[,)])", code):
        equality = m[1] in SYMMETRIC and re.match(r"[^;&|]*\) [=!]= 0", code[m.end():])
        if m[2] != m[3] and m[1] not in ("fmin", "fmax", "min", "max") and not equality:
            yield m.start(2), m.end(3), f"{m[3]}, {m[2]}"


def dropped_term(code):
    for m in re.finditer(rf"(?<=[\w\)\]]) [+-] {OPERAND}{ENDS}", code):
        yield m.start(), m.end(), ""
    for m in re.finditer(rf"(?<=[=(,] ){OPERAND} [+] (?=[\w(])|(?<=[(\[]){OPERAND} [+] (?=[\w(])|(?<=return ){OPERAND} [+] (?=[\w(])", code):
        yield m.start(), m.end(), ""
    for m in re.finditer(rf" \* {OPERAND}{ENDS}", code):
        yield m.start(), m.end(), ""
    for m in re.finditer(r"(?<![\w)\] ])!(?=[\w(])|(?<=[&|=] )!(?=[\w(])", code):
        yield m.start(), m.end(), ""
    for word in (" && ", " || ", " and ", " or "):
        for begin, end in clauses(code, word):
            yield begin, end, ""


def clauses(code, word):
    """Where clauses after `word` stand, with the word: to the end of the condition that they are in, or the next one."""
    at = code.find(word)
    while at >= 0:
        depth, k = 0, at + len(word)
        while k < len(code):
            depth += {"(": 1, "[": 1, ")": -1, "]": -1}.get(code[k], 0)
            if depth < 0 or code[k] in ";?{:" and depth == 0 or code.startswith((" && ", " || ", " and ", " or "), k) and depth == 0:
                break
            k += 1
        if k < len(code):
            yield at, k
        at = code.find(word, at + 1)


STATEMENT = re.compile(r"(?!(?:return|case|if|for|while|else|typedef)\b)(?:[^=!<>]+ (?:[-+*/|&^]|<<|>>)?= .*;|[^=]+(?:\+\+|--);|[a-z_]\w*\(.*\);)")
DECLARATION = re.compile(r"(?:static |const |unsigned |struct )*[A-Za-z_]\w* \*?[A-Za-z_]\w*(?:\[.*?\])*(?: = |;|,)")
GIVES_BACK = re.compile(r"\w*(?:free|Free|close|Close|destroy|unmap|Release)\w*\(|\(void\)")


def dropped_line(code, before, python):
    stripped = code.strip()
    begin = len(code) - len(code.lstrip())
    if python:
        if re.fullmatch(rf"{OPERAND} (?:[-+*/]?)= .*|{OPERAND}\(.*\)", stripped) and stripped.count("(") == stripped.count(")"):
            yield begin, len(code), "pass"
    elif (STATEMENT.fullmatch(stripped) and not DECLARATION.match(stripped) and not GIVES_BACK.match(stripped)
          and re.search(r"[;{}:]\s*$", before)):
        yield begin, len(code.rstrip()), ";"


# What orders records: `a != b` stands before the first, and in the second the other half makes up for it.
ORDERS = re.compile(r"\s*return .* [<>] .* \? -?1 : -?1;|.*\((.+) > (.+)\) - \(\1 < \2\)")


# What `open` gives: 0 is the standard input's, so that `> 0` asks the same as `>= 0`.
HANDLE = re.compile(r"\b(\w+) = open\(")


def relaxed_bound(code, after, integers, python):
    if ORDERS.match(code):
        return
    loop = re.match(r"\s*for\b", code)  # one turn more or less is `off_by_one`; one past an array is for sanitizers
    for m in [] if loop else re.finditer(rf"({OPERAND}|\d+) (<=?|>=?) ({OPERAND}|\d+)(?![\w.(\[*])", code):
        if is_integer(m[1], integers) and is_integer(m[3], integers):
            yield m.start(2), m.end(2), m[2][0] if m[2].endswith("=") else m[2] + "="
    for m in re.finditer(r"(?<=[<>] )1e-\d+\b", code):
        yield m.start(), m.end(), repr(1e4 * float(m[0]))
    for m in re.finditer(r"\b(fmin|fmax|min|max)\(", code):
        other = {"fmin": "fmax", "fmax": "fmin", "min": "max", "max": "min"}[m[1]]
        yield m.start(1), m.end(1), other
    if python:
        m = re.match(r"\s*(?:if|elif) (.+):\s*$", code)
        if m:
            yield m.start(1), m.end(1), f"False and ({m[1]})"
    else:
        m = re.match(r"\s*(?:\} else )?if \((.+)\) \{\s*$", code)
        if m and not GIVES_BACK.match(after.strip()) and not HINT.search(after):
            yield m.start(1), m.end(1), f"0 && ({m[1]})"


# The size of an array where it is declared: one that is too large changes nothing, one too small is for sanitizers.
ARRAY = re.compile(r"\s*(?:static |const |unsigned |struct |_Alignas\(\w+\) )*[A-Za-z_]\w* \w+((?:\[[^\[\]]*\])+)(?= =|[;,])")

# The same of a block of memory: in the count of RG_NEW no factor is raised and no spare item left out. (One item less is
# made up for by the gap that alignment leaves behind every block.)
BLOCK = re.compile(r"RG_NEW\([\w ]+\*?, ((?:[^(),]|\([^()]*(?:\([^()]*\)[^()]*)*\))*)\)")

# What lets something begin early, and nothing else: memory on its way to the cache, messages on theirs, bytes to the disk.
# Whoever needs them waits for them.
HINT = re.compile(r"\w*(?:prefetch|_poll|Testall|madvise|start_sync)\w*\(")


def is_integer(operand, integers):
    name = re.split(r"\.|->", re.sub(r"\[[^\]]*\]|\([^)]*\)", "", operand))[-1]
    return operand.isdigit() or name in integers


KINDS = ("sign", "factor", "off by one", "exchanged index", "dropped term", "dropped line", "relaxed bound")


def integers_of(text):
    """Names that the file declares as whole numbers and not also as others."""
    declared = r"\b(?:size_t|u?int\d*_t|int|rg_gid|unsigned|long) ((?:\*?\w+(?: = [^,;()]*)?(?:\[[^\]]*\])?, )*\*?\w+)(?= =|[;,)\[(])"
    whole = {name for m in re.finditer(declared, text) for name in re.findall(r"\w+", re.sub(r"=[^,]*", "", m[1]))}
    real = {name for m in re.finditer(r"\b(?:double|rg_real|float|rg_v\w*) ((?:\*?\w+, )*\*?\w+)", text) for name in re.findall(r"\w+", m[1])}
    return whole - real - set(HANDLE.findall(text))


def faults_of(path, text):
    """Every fault that can be planted in a file, by kind."""
    python = not path.endswith((".c", ".h"))
    lines, code = text.split("\n"), (code_of_python if python else code_of_c)(text).split("\n")
    integers = integers_of(text)
    seen, found, before, hint = {}, {kind: [] for kind in KINDS}, "{", False
    for line, line_code, after in zip(lines, code, [*code[1:], ""]):
        occurrence = seen[line] = seen.get(line, -1) + 1
        if not line_code.strip():
            continue
        hint = hint and line != "}" or line[0].isalpha() and HINT.search(line_code) is not None
        if hint or HINT.search(line_code):
            before = line_code
            continue
        if not re.match(r"\s*(?:import|from|def|class|assert) ", line_code) and not GIVES_BACK.match(line_code.strip()):
            places = {
                "sign": sign(line_code),
                "factor": factor(line_code),
                "off by one": off_by_one(line_code),
                "exchanged index": exchanged_index(line_code) if "(" not in line_code or not is_head(line_code) else (),
                "dropped term": dropped_term(line_code),
                "dropped line": dropped_line(line_code, before, python),
                "relaxed bound": relaxed_bound(line_code, after, integers, python),
            }
            sizes = [m.span(1) for m in [ARRAY.match(line_code)] if m]
            blocks = [m.span(1) for m in BLOCK.finditer(line_code)]
            for kind, where in places.items():
                for b, e, new in where:
                    spare = kind == "off by one" or new.isdigit() or new == "-" and line[e:e + 2] == " 1"
                    spared = sizes + (blocks if spare else [])
                    if not any(first <= b < end for first, end in spared):
                        found[kind].append(Fault(path, kind, line, occurrence, b, e, new))
        before = line_code
    return found


def is_head(code):
    """The head of a function in C: names there are declared, not used."""
    return re.match(r"[a-z]", code) is not None
