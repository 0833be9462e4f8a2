"""The mutants that cargo-mutants lists, as sources in which one of them is taken at run time."""

import json
import re
import subprocess

# A function up to its brace. Lengths of arrays have semicolons.
HEAD = re.compile(r"\bfn \w+(?:[^{;\[]|\[(?:[^\[\]]|\[[^\[\]]*\])*\])*\{")
HIDDEN = re.compile(r"//[^\n]*|\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])'")
# The number of the mutant that is taken, 0 for none. On request the first panic ends the program.
SWITCH = """
mod mutant_switch {
    extern crate std;
    pub(crate) fn on(number: u32) -> bool {
        static TAKEN: std::sync::OnceLock<u32> = std::sync::OnceLock::new();
        let read = || {
            if std::env::var_os("MUTANT_ENDS").is_some() {
                std::panic::set_hook(std::boxed::Box::new(|_| std::process::exit(101)));
            }
            std::env::var("MUTANT").ok().and_then(|text| text.parse().ok()).unwrap_or(0)
        };
        *TAKEN.get_or_init(read) == number
    }
}
"""


class Mutant:
    """A wrong formula: where it is, in which function's body, and what stands there instead."""

    def __init__(self, listed, text):
        self.path, self.name, self.text = listed["file"], listed["name"], listed["replacement"]
        lines = [0]
        for line in text.splitlines(keepends=True):
            lines.append(lines[-1] + len(line))
        place = lambda point: lines[point["line"] - 1] + point["column"] - 1  # noqa: E731
        self.start, self.end = place(listed["span"]["start"]), place(listed["span"]["end"])
        self.number, self.body = 0, None
        if listed.get("function"):
            self.body = body(text, place(listed["function"]["span"]["start"]), self.start)


def hidden(text):
    """The same text with comments, strings and characters blanked."""
    return HIDDEN.sub(lambda match: re.sub(r"[^\n]", " ", match.group(0)), text)


def body(text, start, inside):
    """What a function's braces hold; none where it is constant or returns a type without a name.

    A constant function cannot ask at run time, and the branches of the other are of two types.
    """
    code = hidden(text)
    head = HEAD.search(code, start)
    if not head or "-> impl" in head.group(0):
        return None
    if re.search(r"\bconst\b[^)]*$", code[start:head.start()]):
        return None
    depth, at = 1, head.end()
    while depth and at < len(code):
        depth += {"{": 1, "}": -1}.get(code[at], 0)
        at += 1
    return (head.end(), at - 1) if head.end() <= inside < at else None


def listed(crate, features, here):
    """All mutants of a crate."""
    command = ["cargo", "mutants", "--package", crate, "--list", "--json", *features]
    said = subprocess.run(command, cwd=here, check=True, capture_output=True, text=True)
    found = json.loads(said.stdout)
    texts = {name: (here / name).read_text() for name in {mutant["file"] for mutant in found}}
    return [Mutant(mutant, texts[mutant["file"]]) for mutant in found]


def switched(text, mutants):
    """The source with these mutants in it, and on which lines of it each stands."""
    bodies, made, last, lines = {}, "", 0, []
    for mutant in mutants:
        bodies.setdefault(mutant.body, []).append(mutant)
    for (start, end), inside in sorted(bodies.items()):
        # A function within another is left as it is.
        if start < last:
            continue
        made += text[last:start]
        for mutant in inside:
            first = made.count("\n") + 1
            wrong = text[start:mutant.start] + mutant.text + text[mutant.end:end]
            made += f"\nif crate::mutant_switch::on({mutant.number}) {{{wrong}\n}}\nelse "
            lines.append((first, made.count("\n") + 1, mutant))
        made += "{" + text[start:end] + "}\n"
        last = end
    return made + text[last:], lines
