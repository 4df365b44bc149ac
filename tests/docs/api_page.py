#!/usr/bin/env python3
"""The public interface on one page, docs/api.md: api_page.py [--check PAGE]. A map by task, and of each header under
include/tegotae its names, signatures and the first sentence of each docstring; the rest stays in the header. Prints the page,
or compares it with PAGE. Fails when a header has no place in the map, and when the page is too long to read."""
import glob
import os
import re
import sys

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
HEADERS = os.path.join(ROOT, "include", "tegotae")
MAX_LINES = 900

# In the order in which they build on each other.
FOLDERS = ["", "core", "mesh", "contact", "resolve", "loop", "coupling", "device", "operator", "transport", "servo", "session",
           "import", "scene_file", "record", "narrowphase", "lp"]

# A task, and the headers for it.
MAP = [
    ("feel a scene with a pen: all that most programs need", "tegotae.hpp session/rig.hpp"),
    ("the same from C, C#, Rust, Unity", "tegotae.h"),
    ("describe a scene",
     "loop/scene.hpp mesh/triangle_mesh.hpp mesh/weld.hpp mesh/color.hpp import/load.hpp scene_file/scene_file.hpp "
     "import/assembly.hpp"),
    ("know a mesh before it is used",
     "mesh/report.hpp mesh/mass.hpp loop/clash.hpp import/isolated_load.hpp import/write.hpp"),
    ("use contacts", "contact/contact_point.hpp core/ids.hpp core/contact_force.hpp contact/contact.hpp"),
    ("change a scene while it runs", "loop/scene_change.hpp loop/initial_contacts.hpp"),
    ("know what a tick did, and why a part lags", "loop/haptic_loop.hpp core/lag_reason.hpp resolve/status.hpp"),
    ("bring a device",
     "device/device.hpp device/simulated_device.hpp device/openhaptics_device.hpp device/input_devices.hpp "
     "device/limits.hpp"),
    ("be the hand of a simulated pen",
     "device/script.hpp device/input_source.hpp device/input_guide.hpp operator/operator.hpp"),
    ("set the feel and the safety chain",
     "coupling/coupling.hpp coupling/stability.hpp servo/safety.hpp transport/mapping.hpp"),
    ("wire servo and contact loop by hand",
     "servo/servo.hpp transport/contact_link.hpp transport/attachment.hpp servo/realtime.hpp transport/channel.hpp "
     "coupling/contact_planes.hpp transport/servo_statistics.hpp core/latency_histogram.hpp"),
    ("write a driver in another language", "device/shm.h"),
    ("run a scene file, record it, watch it", "session/session.hpp record/recorder.hpp record/recording.hpp"),
    ("bring a resolver", "resolve/kind.hpp resolve/resolver.hpp lp/low_rank_matrix.hpp lp/friction_problem.hpp"),
    ("poses, errors, clock, version",
     "core/pose.hpp core/error.hpp core/clock.hpp core/constants.hpp core/up_axis.hpp core/version.hpp core/export.hpp"),
    ("start large scenes sooner", "narrowphase/hierarchy_cache.hpp"),
]

INTRO = """# Public interface

What a program may use: a map by task, then each header with its names and the first sentence about each. The link at a
header leads to its full text: units, frames, errors and threads. Members of a structure are listed by name only.

Everything is in the namespace `tegotae`. SI units everywhere; `X_WF` is the pose of frame F in the world. What may change
from version to version: [package](package.md). `cmake --build build/release --target api` makes this page from
`include/tegotae/`.
"""

# A comment, a string, a line of the preprocessor, or one character.
TOKEN = re.compile(r"""(?P<trailing>///<[^\n]*(?:\n\s*///<[^\n]*)*|/\*\*<.*?\*/)
|(?P<doc>///[^\n]*(?:\n[ ]*///(?!<)[^\n]*)*|/\*\*.*?\*/)
|(?P<note>//[^\n]*|/\*.*?\*/)|(?P<macro>^\#(?:[^\n\\]|\\.|\\\n)*)|(?P<text>"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)')|(?P<char>.)""",
                   re.DOTALL | re.MULTILINE | re.VERBOSE)


class Declaration:
    def __init__(self, doc, text):
        self.doc = doc
        self.text = text
        self.members = None  # of a structure, class or enumeration


def words_of(comment):
    lines = re.sub(r"^/\*\*<?|\*/$", "", comment).split("\n")
    return " ".join(re.sub(r"^\s*(///<?|\*)?\s*", "", line).strip() for line in lines).strip()


class Reader:
    """Declarations of a header, level by level."""

    def __init__(self, text):
        self.tokens = [(match.lastgroup, match.group()) for match in TOKEN.finditer(text)]
        self.at = 0
        self.file_doc = ""

    def skip_body(self):
        depth = 1
        while depth:
            kind, text = self.tokens[self.at]
            self.at += 1
            if kind == "char":
                depth += {"{": 1, "}": -1}.get(text, 0)

    def level(self, separator=";", access="public"):
        """The declarations up to the brace that ends the level, the public ones."""
        found, doc, text, nested = [], "", "", 0
        hidden, last = access == "private", None
        while self.at < len(self.tokens):
            kind, token = self.tokens[self.at]
            self.at += 1
            if kind == "trailing":
                if last and not text.strip():
                    last.doc = last.doc or words_of(token)
                else:
                    doc = doc or words_of(token)  # of the last enumerator, which no comma follows
            elif kind == "doc":
                doc = words_of(token)
                if doc.startswith("@file"):
                    self.file_doc, doc = doc[len("@file"):].strip(), ""
                elif doc.startswith("@def"):
                    doc = ""
            elif kind == "note" and token.startswith("/*") and not found and not self.file_doc:
                self.file_doc = words_of(token.replace("/*", "/**", 1))
            elif kind == "macro":
                name = re.match(r"#define (\w+)(\([^)]*\))?", token)
                if name and doc:
                    found.append(Declaration(doc, "#define " + name.group(1) + (name.group(2) or "")))
                    doc = ""
            elif kind in ("text", "char"):
                label = re.search(r"(public|protected|private)\s*$", text) if token == ":" and not nested else None
                if label and self.tokens[self.at][1] != ":":
                    hidden, text, doc = label.group(1) == "private", "", ""
                elif token == "{" and not nested and not re.search(r"=\s*$", text):
                    last = self.block(found, doc, text, hidden)
                    if last is not None or not re.match(r'\s*(namespace|extern "C")', text):
                        doc = ""
                    text = ""
                elif token == "}" and not nested:
                    if text.strip() and separator == ",":
                        found.append(Declaration(doc, text))
                    return found
                elif token == separator and not nested:
                    last = Declaration(doc, text)
                    if text.strip() and not hidden:
                        found.append(last)
                    doc, text = "", ""
                else:
                    nested += (token in "({") - (token in ")}") if kind == "char" else 0
                    text += token
        return found

    def block(self, found, doc, text, hidden):
        """What stands before an opening brace: a scope, a type, or a function with its body."""
        if re.match(r'\s*(inline\s+)?(namespace|extern "C")', text):
            found.extend(self.level())
            return None
        declaration = Declaration(doc, text)
        kind = re.match(r"\s*(?:template\s*<[^>]*>\s*)?(?:typedef\s+)?(class|struct|union|enum)\b", text)
        if kind and "(" not in re.sub(r"alignas\([^)]*\)|TEGOTAE_SHM_ALIGN", "", text):
            declaration.members = self.level("," if kind.group(1) == "enum" else ";",
                                             "private" if kind.group(1) == "class" else "public")
            rest = self.tokens[self.at:]
            self.at += next(i for i, (_, token) in enumerate(rest) if token == ";") + 1
        else:
            self.skip_body()
        if not hidden:
            found.append(declaration)
        return declaration


def plain(text):
    """A declaration in one line, without what only the compiler reads."""
    if text.startswith("#"):
        return text
    text = re.sub(r"\b(TEGOTAE_\w*EXPORT|TEGOTAE_SHM_ALIGN|static constexpr)\s+", "", text)
    text = re.sub(r"\b(inline|explicit|virtual|override|final)\b", "", text)
    text = re.sub(r"\s+", " ", text).strip()
    if "(" in text:
        text = re.sub(r"\)( const)?( noexcept)?\s*:[^:].*$", r")\1\2", text)  # what a constructor initializes
        text = re.sub(r" = 0$", "", text)
    return text.replace("( ", "(")


def without_templates(text):
    while True:
        shorter = re.sub(r"<[^<>]*>", "", text)
        if shorter == text:
            return text
        text = shorter


def is_function(text):
    return "(" in re.sub(r"\[.*\]", "", without_templates(text)).split("=")[0] or "operator" in text


def is_noise(text):
    """Destructors, copies and the like, which every class has or forbids, and names of types that follow or are private."""
    return bool(re.match(r"(class|struct) \w+$|static_assert|friend|using [\w:]+$|TEGOTAE_SHM_ASSERT", text)
                or re.search(r"~|= (delete|default)$|operator=\(", text)
                or re.match(r"(\w+)\((const )?\1\s*&&?\s*\w*\)", text))


def name_of(field):
    """The name of a field or enumerator."""
    return re.findall(r"\w+", re.sub(r"\[[^\]]*\]", "", re.split(r"\s=|=|\{", without_templates(field))[0]))[-1]


def sentence(doc):
    """The first sentence, safe in Markdown."""
    doc = re.sub(r"^@\w+\s+", "", doc)
    first = re.split(r"(?<=[.])(?<!e\.g\.)(?<!i\.e\.)\s+(?=[A-Z0-9`(|\"])", doc + " ", maxsplit=1)[0].strip()
    return re.sub(r"([*<])", r"\\\1", first)


def bullet(indent, declaration, text):
    doc = sentence(declaration.doc)
    return "  " * indent + "- `" + text + "`" + (": " + doc if doc else "")


def lines_of(declarations, indent=0):
    lines = []
    for declaration in declarations:
        text = plain(declaration.text)
        if declaration.members is None and is_noise(text):
            continue
        if declaration.members is None:
            lines.append(bullet(indent, declaration, text))
            continue
        is_enum = text.startswith("enum")
        text = re.sub(r" : .*", "", text) if is_enum else re.sub(r" : public ", " : ", text)
        fields = [m for m in declaration.members if m.members is None and (is_enum or not is_function(plain(m.text)))]
        fields = [m for m in fields if not is_noise(plain(m.text))]
        names = ", ".join("`" + name_of(plain(m.text)) + "`" for m in fields)
        line = bullet(indent, declaration, text)
        if names:
            line += ("" if line.endswith(".") else "." if declaration.doc else ":") + " " + names
        lines.append(line)
        lines += lines_of([m for m in declaration.members if m not in fields], indent + 1)
    return lines


def headers():
    found = []
    for folder in FOLDERS:
        found += sorted(path for path in glob.glob(os.path.join(HEADERS, folder, "*")) if os.path.isfile(path))
    return [os.path.relpath(path, HEADERS).replace(os.sep, "/") for path in found]


def faults(names):
    every = [os.path.relpath(os.path.join(folder, file), HEADERS) for folder, _, files in os.walk(HEADERS) for file in files]
    mapped = " ".join(task[1] for task in MAP).split()
    for name in sorted(set(every) - set(names)):
        yield name + " is in a folder that FOLDERS does not have"
    for name in sorted(set(names) ^ set(mapped)):
        yield name + " is not both in MAP and in include/tegotae"


def anchor(name):
    return "tegotae" + re.sub(r"[^\w]", "", name)


def page(names):
    lines = [INTRO, "| to ... | headers under `tegotae/` |", "|---|---|"]
    for task, members in MAP:
        links = " ".join("[%s](#%s)" % (name, anchor(name)) for name in members.split())
        lines.append("| %s | %s |" % (task, links))
    folder = None
    for name in names:
        if os.path.dirname(name) != folder:
            folder = os.path.dirname(name)
            lines += ["", "## " + (folder or "the door")]
        with open(os.path.join(HEADERS, name), encoding="utf-8") as file:
            reader = Reader(file.read())
        body = lines_of(reader.level())
        lines += ["", "### [`tegotae/%s`](../include/tegotae/%s)" % (name, name)]
        if reader.file_doc:
            lines.append(sentence(reader.file_doc))
        lines += body
    return "\n".join(lines) + "\n"


def main():
    names = headers()
    wrong = list(faults(names))
    text = page(names)
    if text.count("\n") > MAX_LINES:
        wrong.append("the page has more than %d lines" % MAX_LINES)
    if sys.argv[1:2] == ["--check"]:
        with open(sys.argv[2], encoding="utf-8") as file:
            if file.read() != text:
                wrong.append("%s is not what the headers say; make it with --target api" % sys.argv[2])
    else:
        sys.stdout.write(text)
    for fault in wrong:
        print("api_page: " + fault, file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
