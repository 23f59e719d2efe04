"""What the house checks share: the repository's source files, and C++ text without comments and strings."""
import os
import re

CODE_FOLDERS = ("src", "include", "scenes", "io", "bindings", "apps", "bench", "verify", "examples", "tests")
CODE_ENDINGS = (".h", ".cpp", ".inl")

_TOKEN = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(?P<tag>[^()\s\\]*)\(.*?\)(?P=tag)"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])+\'',
    re.DOTALL,
)


def files(root, folders=CODE_FOLDERS, endings=CODE_ENDINGS):
    """Paths relative to `root`, with forward slashes, in a fixed order."""
    found = []
    for folder in folders:
        for where, subfolders, names in os.walk(os.path.join(root, folder)):
            subfolders.sort()
            found += [os.path.relpath(os.path.join(where, n), root).replace(os.sep, "/") for n in names if n.endswith(endings)]
    return sorted(found)


def read(root, path):
    with open(os.path.join(root, path), encoding="utf-8") as file:
        return file.read()


def _blank(text):
    return re.sub(r"[^\n]", " ", text)


def without_comments(text, keep_strings=False):
    """Comments (and string contents) become spaces; lines keep their numbers."""

    def replace(match):
        token = match.group(0)
        if token.startswith("/"):
            return _blank(token)
        return token if keep_strings else token[0] + _blank(token[1:-1]) + token[-1]

    return _TOKEN.sub(replace, text)
