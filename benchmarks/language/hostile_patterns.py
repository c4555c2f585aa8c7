"""Which regular expressions of the project cost more than linear time on text written to be slow.

Every pattern is found in the source: calls of ``re``, terminals of lark grammars, routes of Django, literals
of the scripts. From each pattern's parse tree come texts that may make it go back again and again.
Each text grows; a pattern fails if twice the text takes more than 2.5 times the processor time:

    python -m benchmarks.language.hostile_patterns

Exit status: 0 where every pattern is linear, else 1.
"""

from __future__ import annotations

import ast
import builtins
import gc
import importlib
import itertools
import json
import os
import random
import re
import re._constants as opcodes  # type: ignore[import-not-found]
import re._parser as regex_parser  # type: ignore[import-not-found]
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from types import FrameType
from typing import Any, TypeGuard

ROOT = Path(__file__).resolve().parents[2]
ROOMS = ("annotations", "parser_service", "gpsr_site")
METHODS = ("match", "fullmatch", "search", "findall", "finditer", "sub", "subn", "split")
HANDED_ON = ("match",)  # what readers call that get a pattern as an argument
FIRST = (250, 8_000)  # characters with which every text is tried
LATER = (5_000, 20_000)  # characters with which a text is measured that was slow
# Seconds of processor time that make a text worth measuring; clocks may tick each 4 ms.
NOTICED = 0.005
NOISE = 0.02  # seconds of processor time below which nothing is said of growth
LIMIT = 1.0  # seconds of processor time after which one text is given up
GROWTH = 2.8  # between twice the time, for twice the characters, and four times
LOOKS = (3, 30)  # calls at first, and again before a text is called slow; the fastest counts
OFTEN = "a1 \n\t(){}<>\"'$@,=?:|\\/*#;%-_.λ⟨é"
FAILING = ("", "\0", "!", "(", "\n\0")


@dataclass(frozen=True, order=True)
class UsedPattern:
    """One regular expression, where it stands, and the methods that the code calls with it."""

    place: str
    source: str
    flags: int
    methods: tuple[str, ...]


@dataclass(frozen=True)
class SlowText:
    """A text that makes a pattern slow, with seconds of processor time at half its length and at its length."""

    used: UsedPattern
    method: str
    text: str
    half: float
    whole: float

    def __str__(self) -> str:
        return (
            f"{self.used.place} {self.used.source!r}.{self.method}: {self.half:.4f} s, then {self.whole:.4f} s "
            f"for {len(self.text):,} characters that begin with {self.text[:30]!r} and end with {self.text[-5:]!r}"
        )


# -- finding ------------------------------------------------------------------------------------------


class _AnyWord(str):
    """Stands for a value that is known only when the code runs: a word, whatever is asked of it."""

    def __getattr__(self, name: str) -> _AnyWord:
        return self

    def __getitem__(self, key: object) -> _AnyWord:
        return self

    def __call__(self, *arguments: object, **named: object) -> _AnyWord:
        return self


class _Names(dict[str, Any]):
    """The names of a module; a name that only a function knows is a word."""

    def __missing__(self, name: str) -> Any:
        return getattr(builtins, name, _AnyWord("word"))


def python_patterns() -> Iterator[UsedPattern]:
    """Yield the patterns of every call of ``re`` in the rooms of the project, and those that modules hold."""
    files = [path for room in ROOMS for path in sorted((ROOT / room).rglob("*.py"))]
    trees = {
        path: ast.parse(path.read_text("utf-8")) for path in files if "migrations" not in path.parts
    }
    everywhere = _calls_by_name(trees.values())
    for path, tree in trees.items():
        if not any(map(_makes_pattern, ast.walk(tree))):
            continue
        relative = path.relative_to(ROOT)
        module = importlib.import_module(
            ".".join(relative.with_suffix("").parts).removesuffix(".__init__")
        )
        in_module = _calls_by_name([tree])
        names = _Names(vars(module))
        compiled = _assigned(tree)
        for call in filter(_is_of_re, ast.walk(tree)):
            name = compiled.get(call, "")
            calls = in_module if name.startswith("_") else everywhere
            verb = _verb(call)
            methods = {verb} if verb in METHODS else calls.get(name, set())
            source, flags = _pattern_of(call, names)
            yield UsedPattern(
                f"{relative}:{call.lineno}",
                source,
                flags,
                tuple(sorted(methods)) or HANDED_ON,
            )
        for name, value in vars(module).items():
            if isinstance(value, re.Pattern) and name not in compiled.values():
                methods = everywhere.get(name, set(HANDED_ON))
                yield UsedPattern(
                    f"{relative}:{name}", value.pattern, value.flags, tuple(sorted(methods))
                )


def _makes_pattern(node: ast.AST) -> bool:
    """Return whether a call makes a pattern: one of ``re``, or one that reads it from a word file."""
    of_file = isinstance(node, ast.Call) and getattr(node.func, "attr", "") == "expression"
    return of_file or _is_of_re(node)


def _is_of_re(node: ast.AST) -> TypeGuard[ast.Call]:
    return (
        isinstance(node, ast.Call)
        and isinstance(node.func, ast.Attribute)
        and isinstance(node.func.value, ast.Name)
        and node.func.value.id == "re"
        and node.func.attr in (*METHODS, "compile")
    )


def _verb(call: ast.Call) -> str:
    """Return which function of ``re`` is called."""
    assert isinstance(call.func, ast.Attribute)
    return call.func.attr


def _calls_by_name(trees: Any) -> dict[str, set[str]]:
    """Return the methods of patterns that are called on each name."""
    calls: dict[str, set[str]] = {}
    for node in itertools.chain.from_iterable(map(ast.walk, trees)):
        if isinstance(node, ast.Attribute) and node.attr in METHODS:
            owner = node.value
            name = owner.id if isinstance(owner, ast.Name) else getattr(owner, "attr", "")
            calls.setdefault(name, set()).add(node.attr)
    return calls


def _assigned(tree: ast.Module) -> dict[ast.AST, str]:
    """Return the name that each ``re.compile`` of a module is assigned to."""
    assignments = (node for node in ast.walk(tree) if isinstance(node, ast.Assign))
    return {
        node.value: node.targets[0].id
        for node in assignments
        if _is_of_re(node.value) and isinstance(node.targets[0], ast.Name)
    }


def _pattern_of(call: ast.Call, names: _Names) -> tuple[str, int]:
    def value(node: ast.expr) -> Any:
        return eval(compile(ast.Expression(node), "pattern", "eval"), {}, names)

    at = {"sub": 4, "subn": 4, "split": 3, "compile": 1}.get(_verb(call), 2)
    flags = [each.value for each in call.keywords if each.arg == "flags"] + call.args[at : at + 1]
    source = value(call.args[0])
    source = source.pattern if isinstance(source, re.Pattern) else source
    return str(source), int(value(flags[0])) if flags else 0


def lark_patterns() -> Iterator[UsedPattern]:
    """Yield the terminals of every lark grammar; a lexer matches them at a place."""
    from lark import Lark

    for path in sorted(ROOT.glob("annotations/**/*.lark")):
        starts = re.findall(r"^\??([a-z]\w*)\s*:", path.read_text("utf-8"), re.MULTILINE)
        for terminal in Lark(path.read_text("utf-8"), parser="lalr", start=starts).terminals:
            yield UsedPattern(
                f"{path.relative_to(ROOT)}:{terminal.name}",
                terminal.pattern.to_regexp(),
                0,
                ("match", "finditer"),
            )


def route_patterns() -> Iterator[UsedPattern]:
    """Yield the expression of every route and converter of the site; Django searches or matches an address."""
    from django.urls import get_resolver

    def walk(patterns: Any) -> Iterator[tuple[str, str]]:
        for each in patterns:
            source, below = each.pattern.regex.pattern, getattr(each, "url_patterns", ())
            # django.urls.resolvers.RegexPattern.match and RoutePattern.match
            is_whole = not below and source.endswith(("$", r"\Z"))
            yield source, "fullmatch" if is_whole else "search"
            yield from walk(below)

    for source, method in sorted(set(walk(get_resolver().url_patterns))):
        yield UsedPattern(f"route {source}", source, 0, (method,))


def validator_patterns() -> Iterator[UsedPattern]:
    """Yield the expressions of the validators of every model's columns."""
    from django.apps import apps
    from django.core.validators import RegexValidator

    for model in apps.get_models():
        if model.__module__.startswith(ROOMS):
            for field in model._meta.get_fields():
                for validator in getattr(field, "validators", ()):
                    if isinstance(validator, RegexValidator):
                        place = f"{model.__name__}.{field.name}"
                        regex = re.compile(validator.regex)
                        yield UsedPattern(place, regex.pattern, regex.flags, ("search",))


# A literal stands where a value may stand: after an opening bracket, a comma, an operator or a colon.
_LITERAL = re.compile(
    r"(?:^|[(,=:\[!&|?]) *+/(?P<source>(?![*/ ])(?:[^/\\\[\n]|\\.|\[(?:[^\]\\\n]|\\.)*+\])++)/(?P<flags>[a-z]*)"
)


def script_patterns() -> Iterator[UsedPattern]:
    """Yield the literals of the front end's modules, and the expressions that a module puts together of them."""
    for path in sorted((ROOT / "static" / "src").glob("*.js")):
        place = str(path.relative_to(ROOT))
        lines = [line.split(" // ")[0] for line in path.read_text("utf-8").splitlines()]
        for number, line in enumerate(lines, start=1):
            for match in _LITERAL.finditer(line.strip()):
                yield UsedPattern(
                    f"{place}:{number}", match["source"], 0, ("replace", "match", "split")
                )


# -- texts --------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class HostileText:
    """A text of any length: a head, a unit that is repeated, and a tail that spoils the match."""

    head: str
    unit: str
    tail: str

    def of(self, size: int) -> str:
        """Return the text with about ``size`` characters between head and tail."""
        return self.head + self.unit * (size // len(self.unit)) + self.tail


def hostile_texts(source: str, flags: int = 0) -> list[HostileText]:
    """Return texts that may be slow, from the parse tree of a pattern."""
    tree = regex_parser.parse(source, flags)
    texts: dict[HostileText, None] = {}
    literals = sorted({character for _, _, character in _leaves(tree)})[:24]
    alphabet = list(dict.fromkeys([*literals, *OFTEN]))

    def repeated(head: str, unit: str, tail: str) -> None:
        texts[HostileText(head, unit, tail)] = None

    for sign in alphabet:
        repeated("", sign, "")
    whole = _sample(tree, 0)
    for pump, before in _repeats(tree, ""):
        for unit in {each for each in pump if each}:
            for tail in FAILING:
                repeated(before, unit, tail)
            repeated("", before + unit, "\0")
            repeated("", unit + before, "")
            repeated(before, unit + "\n", "\0")
            repeated(before, unit, whole)
    if whole:
        repeated("", whole, "\0")
        repeated("", whole[:-1] or whole, "")
        repeated("", f"{whole} ", "\0")
    for pair in itertools.permutations(alphabet[:14], 2):
        repeated("", "".join(pair), "\0")
    chance = random.Random(1)
    for _ in range(3):
        letters = "".join(chance.choices(alphabet, k=40))
        repeated("", letters, "\0")
    return list(texts)


def _leaves(tree: Any) -> Iterator[tuple[Any, Any, str]]:
    for operation, value in tree:
        if operation in (opcodes.LITERAL, opcodes.NOT_LITERAL):
            yield operation, value, chr(value)
        elif operation is opcodes.IN:
            for sign in _class_signs(value):
                yield operation, value, sign
        else:
            for part in _parts(operation, value):
                yield from _leaves(part)


def _parts(operation: Any, value: Any) -> list[Any]:
    """Return the patterns inside one operation."""
    if operation in (opcodes.MAX_REPEAT, opcodes.MIN_REPEAT, opcodes.POSSESSIVE_REPEAT):
        return [value[2]]
    if operation is opcodes.SUBPATTERN:
        return [value[3]]
    if operation is opcodes.BRANCH:
        return list(value[1])
    if operation in (opcodes.ASSERT, opcodes.ASSERT_NOT):
        return [value[1]]
    if operation is opcodes.ATOMIC_GROUP:
        return [value]
    return []


def _class_signs(items: Any) -> list[str]:
    """Return up to six characters that a class takes, blanks, letters and digits first."""
    expression = re.compile(_class_source(items))
    low = [each[1][0] for each in items if each[0] is opcodes.RANGE] + [
        each[1] for each in items if each[0] is opcodes.LITERAL
    ]
    pool = dict.fromkeys([*" a1_-", *map(chr, low), *OFTEN])
    return [sign for sign in pool if expression.fullmatch(sign)][:6]


_CATEGORIES = {
    opcodes.CATEGORY_DIGIT: r"\d", opcodes.CATEGORY_NOT_DIGIT: r"\D", opcodes.CATEGORY_SPACE: r"\s",
    opcodes.CATEGORY_NOT_SPACE: r"\S", opcodes.CATEGORY_WORD: r"\w", opcodes.CATEGORY_NOT_WORD: r"\W",
}  # fmt: skip


def _class_source(items: Any) -> str:
    said = []
    for operation, value in items:
        if operation is opcodes.NEGATE:
            said.append("^")
        elif operation is opcodes.LITERAL:
            said.append(re.escape(chr(value)))
        elif operation is opcodes.RANGE:
            said.append(f"{re.escape(chr(value[0]))}-{re.escape(chr(value[1]))}")
        elif operation is opcodes.CATEGORY:
            said.append(_CATEGORIES[value])
    return f"[{''.join(said)}]"


def _sample(tree: Any, choice: int, least: int = 0) -> str:
    """Return a text that the pattern takes or nearly takes, with the ``choice``-th sign of each class."""
    said = ""
    for operation, value in tree:
        if operation is opcodes.LITERAL:
            said += chr(value)
        elif operation is opcodes.NOT_LITERAL:
            said += "a" if value != ord("a") else "b"
        elif operation is opcodes.ANY:
            said += "a"
        elif operation is opcodes.IN:
            signs = _class_signs(value) or ["a"]
            said += signs[choice % len(signs)]
        elif operation in (opcodes.MAX_REPEAT, opcodes.MIN_REPEAT, opcodes.POSSESSIVE_REPEAT):
            said += _sample(value[2], choice) * max(min(int(value[0]), 100), least)
        elif operation is opcodes.BRANCH:
            said += _sample(value[1][choice % len(value[1])], choice)
        elif operation in (opcodes.SUBPATTERN, opcodes.ATOMIC_GROUP):
            said += _sample(_parts(operation, value)[0], choice)
    return said


def _repeats(tree: Any, before: str) -> Iterator[tuple[list[str], str]]:
    """Yield what each open repetition may repeat, with a text that leads to it."""
    for index, (operation, value) in enumerate(tree):
        lead = before + _sample(tree[:index], 0)
        full = before + _sample(tree[:index], 1, least=1)
        if (
            operation in (opcodes.MAX_REPEAT, opcodes.MIN_REPEAT, opcodes.POSSESSIVE_REPEAT)
            and int(value[1]) > 20
        ):
            signs = [_sample(value[2], choice, least=1) for choice in range(6)]
            yield signs, lead
            yield signs, full
        for part in _parts(operation, value):
            yield from _repeats(part, lead)


# -- measuring ----------------------------------------------------------------------------------------


class _TooLong(Exception):
    pass


def seconds(run: Callable[[], object], repeats: int = 1) -> float:
    """Return the least seconds of processor time of a call; ``LIMIT`` where it was given up.

    The engine of ``re`` looks at signals while it searches, so a timer of processor time stops it. Garbage is
    not collected meanwhile: that takes as long as the whole program has objects, whatever the call does.
    """

    def give_up(signum: int, frame: FrameType | None) -> None:
        raise _TooLong

    least = LIMIT
    previous = signal.signal(signal.SIGVTALRM, give_up)
    was_collecting = gc.isenabled()
    gc.disable()
    try:
        for _ in range(repeats):
            signal.setitimer(signal.ITIMER_VIRTUAL, LIMIT)
            start = time.process_time()
            try:
                run()
            except _TooLong:
                break
            finally:
                signal.setitimer(signal.ITIMER_VIRTUAL, 0)
            least = min(least, time.process_time() - start)
    finally:
        signal.signal(signal.SIGVTALRM, previous)
        if was_collecting:
            gc.enable()
    return least


def _runner(expression: re.Pattern[str], method: str, text: str) -> Callable[[], object]:
    if method in ("sub", "subn"):
        return lambda: getattr(expression, method)("", text)
    if method == "finditer":
        return lambda: sum(1 for _ in expression.finditer(text))
    return lambda: getattr(expression, method)(text)


def slow_text(used: UsedPattern) -> SlowText | None:
    """Return a text that costs the pattern more than linear time, or None.

    Few characters are tried first: what is linear takes microseconds there, what is quadratic milliseconds.
    """
    expression = re.compile(used.source, used.flags)
    for hostile, method in itertools.product(hostile_texts(used.source, used.flags), used.methods):
        if all(seconds(_runner(expression, method, hostile.of(size))) < NOTICED for size in FIRST):
            continue
        for size in LATER:
            run_half, run_whole = (
                _runner(expression, method, hostile.of(each)) for each in (size // 2, size)
            )
            half = whole = LIMIT
            for repeats in LOOKS:
                half = min(half, seconds(run_half, repeats))
                whole = min(whole, seconds(run_whole, repeats))
                if whole < LIMIT and (whole <= NOISE or whole <= GROWTH * half):
                    break
            else:
                return SlowText(used, method, hostile.of(size), half, whole)
    return None


# Node stops a script of a context of its own after the milliseconds that it is given.
_NODE = """
const vm = require("vm");
const [limit, repeats] = process.argv.slice(1).map(Number);
const context = vm.createContext({ text: "", pattern: / /g });
const script = new vm.Script("text.replace(pattern, '')");
function milliseconds() {
  const start = process.cpuUsage().user;
  try { script.runInContext(context, { timeout: limit }); } catch { return limit; }
  return (process.cpuUsage().user - start) / 1000;
}
let said = "";
process.stdin.on("data", (part) => (said += part)).on("end", () => {
  for (const { source, head, unit, tail, sizes } of JSON.parse(said)) {
    context.pattern = new RegExp(source, "g");
    const times = [];
    for (const n of sizes) {
      context.text = head + unit.repeat(Math.floor(n / unit.length)) + tail;
      let least = limit;
      for (let i = 0; i < repeats && least >= 1; i++) least = Math.min(least, milliseconds());
      times.push(least);
      if (least === limit) break;
    }
    console.log(JSON.stringify(times));
  }
});
"""


def slow_script_texts(patterns: list[UsedPattern]) -> Iterator[SlowText]:
    """Yield the texts that cost literals of the scripts more than linear time in V8, one for each literal.

    Raises:
        RuntimeError: there is no Node on the path.
    """
    node = shutil.which("node")
    if node is None:
        raise RuntimeError("Node is not on the path. Install Node 18 or newer.")
    texts = [
        (used, hostile)
        for used in patterns
        # Python's names for the groups, and its spelling of a class that begins with a bracket.
        for hostile in hostile_texts(
            re.sub(r"\(\?<(?![=!])", "(?P<", used.source).replace("[()[", r"[()\[")
        )
    ]
    first, again = LOOKS
    told = set()
    for (used, hostile), times in zip(texts, _script_times(node, texts, first), strict=True):
        if used in told or not _is_slow_script(times):
            continue
        (later,) = _script_times(node, [(used, hostile)], again)
        # A text that was given up at its shorter length has no time of the longer one.
        least = [min(pair) for pair in itertools.zip_longest(times, later, fillvalue=LIMIT)]
        if _is_slow_script(least):
            told.add(used)
            yield SlowText(used, "replace", hostile.of(LATER[len(least) - 1]), least[0], least[-1])


def _script_times(
    node: str, texts: list[tuple[UsedPattern, HostileText]], repeats: int
) -> list[list[float]]:
    """Return the least seconds of V8 for each text at each of ``LATER``, up to the one that was given up."""
    asked = [{"source": used.source, "sizes": LATER, **asdict(text)} for used, text in texts]
    answer = subprocess.run(
        [node, "-e", _NODE, str(int(LIMIT * 1000)), str(repeats)],
        input=json.dumps(asked),
        capture_output=True,
        text=True,
        check=True,
    )
    return [[each / 1000 for each in json.loads(line)] for line in answer.stdout.splitlines()]


def _is_slow_script(times: list[float]) -> bool:
    half, whole = times[0], times[-1]
    # Four times the text: linear work takes four times as long.
    return whole >= LIMIT or (whole > NOISE and whole > 2 * GROWTH * half)


def all_patterns() -> list[UsedPattern]:
    """Return every pattern that Python reads with, each source and method once."""
    found = itertools.chain(
        python_patterns(), lark_patterns(), route_patterns(), validator_patterns()
    )
    once = {(each.source, each.flags, each.methods): each for each in found}
    return sorted(once.values())


def main() -> int:
    import django

    os.environ.setdefault("DJANGO_SETTINGS_MODULE", "gpsr_site.settings")
    django.setup()
    patterns, scripts = all_patterns(), list(script_patterns())
    print(f"{len(patterns)} patterns of Python, {len(scripts)} of scripts")
    slow = 0
    for complaint in itertools.chain(map(slow_text, patterns), slow_script_texts(scripts)):
        if complaint:
            slow += 1
            print(complaint, flush=True)
    return 1 if slow else 0


if __name__ == "__main__":
    sys.exit(main())
