"""Texts of the lab in its source that somebody may read and that are no messages.

A text is a string, or a string with places for values, that is not a docstring, nothing only for the program, and
has a word in it.
"""

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Final

import skisnow.web

HERE: Final = Path(skisnow.web.__file__).parent
_UNREAD: Final = """
    classes props style on element add_head_html run_javascript run_method add_api_route compile getLogger Formatter
    open startswith endswith replace removeprefix removesuffix split join getattr hasattr import_module attrgetter
    read_text write_text encode decode mkdtemp TemporaryDirectory create query_params execute text debug info warning
    error set_cookie setdefault get pop page api_route simplefilter filterwarnings strptime strftime TypeVar isinstance
    Message template count_message PageRequest NewEntry partial cast Environment PackageLoader get_template fullmatch
    sub finditer glob ParameterError ContentError StoreError
"""
UNREAD_CALLS: Final = frozenset(_UNREAD.split())
"""Arguments of these are read by programs, or their translation is checked elsewhere (`Message`)."""
NO_PAGES: Final = frozenset({"replay_addresses.py", "guard.py", "server.py"})
"""Files whose words are printed where the lab was started, or answered to programs."""
NO_WORDS: Final = frozenset(
    {
        *("Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"),  # of English dates
        "Limits",  # names of classes that other files load late
        "Lab",
        "Given",
        "name = {}",  # a line of a file
        "\n[screening]\nexclude = {}\n",
        'attachment; filename="{}"',
        "default-src 'none'; style-src 'unsafe-inline'; sandbox",
        'out = "{}"',
        "scenario = {}",
        ", log = true",
        "is being written by another run",  # looked for in what the command says
        "default-src 'none'; style-src 'unsafe-inline'; img-src data:; frame-ancestors 'none'; sandbox",
        "beside above",  # classes of the stylesheet
        "card ask",
        'multiple accept=".toml,.csv"',
        "main then",
        "quiet progress",
        "quiet range",
        "small switch-kg",
    }
)
LEAST_LETTERS: Final = 3
_WORD: Final = re.compile(r"[A-Za-zÀ-ž]{2,}")
_CODE: Final = re.compile(r"[\w.\-/:#*]+|[\w\-]+=.*|.*[{}<>].*|\(.*=>.*|/.*", re.DOTALL)


def shown_texts() -> dict[str, str]:
    """The texts, each with the first file that has it."""
    found: dict[str, str] = {}
    for place in sorted(HERE.rglob("*.py")):
        for text in _texts(ast.parse(place.read_text(encoding="utf-8"))):
            found.setdefault(text, place.relative_to(HERE).as_posix())
    return {text: file for text, file in found.items() if file not in NO_PAGES and text not in NO_WORDS}


def _texts(tree: ast.Module) -> Iterator[str]:
    unread = {id(each) for node in ast.walk(tree) for each in _unread(node)}
    waiting: list[ast.AST] = [tree]
    while waiting:
        node = waiting.pop()
        if id(node) in unread:
            continue
        text = _text(node)
        if text is None:
            waiting.extend(ast.iter_child_nodes(node))
        elif _is_read(text):
            yield text
        if isinstance(node, ast.JoinedStr):
            waiting.extend(each.value for each in node.values if isinstance(each, ast.FormattedValue))


def _text(node: ast.AST) -> str | None:
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    if isinstance(node, ast.JoinedStr):
        return "".join(str(each.value) if isinstance(each, ast.Constant) else "{}" for each in node.values)
    return None


def _unread(node: ast.AST) -> Iterator[ast.AST]:
    """Docstrings, annotations, comparisons, keys, and what other programs read; attributes of elements among them."""
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
        yield node.value
    if isinstance(node, ast.AnnAssign):
        yield node.annotation
    if isinstance(node, ast.Compare):
        yield from (
            each for each in (node.left, *node.comparators) if isinstance(each, ast.Constant | ast.Tuple | ast.Set)
        )
    if isinstance(node, ast.Dict):
        yield from (key for key in node.keys if isinstance(key, ast.Constant))
    if isinstance(node, ast.Subscript):
        yield node.slice
    if isinstance(node, ast.arg) and node.annotation is not None:
        yield node.annotation
    if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and node.returns is not None:
        yield node.returns
    if isinstance(node, ast.Call):
        name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
        if name in UNREAD_CALLS:
            yield from (*node.args, *(each.value for each in node.keywords))


def _is_read(text: str) -> bool:
    plain = text.replace("{}", "")
    if not _WORD.search(plain) or ("{}" in text and sum(map(str.isalpha, plain)) < LEAST_LETTERS):
        return False
    return (" " in plain.strip() and not _CODE.fullmatch(plain)) or (
        plain[:1].isupper() and plain.strip(" :.%()").isalpha()
    )
