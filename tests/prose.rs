//! Plain English in documents and comments: replaced words, first words, and the length of sentences.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// Words and phrases with a plainer replacement. Texts in backticks and the phrases of `ALLOWED` are not searched.
const REPLACED: &[&str] = &[
    "anew",
    "once more",
    "beside",
    "whoever",
    "who",
    "nobody",
    "somebody",
    "so many",
    "told",
    "tell",
    "tells",
    "stand",
    "stands",
    "go on",
    "goes on",
    "gone on",
    "going on",
    "comes to",
    "comes of",
    "came of",
    "of before",
    "of one's own",
    "of its own",
    "of their own",
    "of your own",
    "of our own",
    "at hand",
    "elsewhere",
    "foretell",
    "foretells",
    "foretold",
    "for ever",
    "forever",
    "whole one",
    "hear",
    "hears",
    "know",
    "knows",
    "known",
    "want",
    "wants",
    "wanted",
    "remember",
    "remembers",
    "remembered",
    "stranger",
    "strangers",
    "is none",
    "are none",
    "in the place of",
    "forget",
    "forgets",
    "forgotten",
    "live",
    "lives",
    "lived",
    "asks for",
    "ask for",
    "ask whether",
    "asks whether",
    "said",
    "say",
    "says",
    "meet",
    "meets",
];
const ALLOWED: &[&str] = &[
    "ask and tell",
    "ask-and-tell",
    "ask/tell",
    "well-known",
    "well known",
    "farsa live",
    "live page",
    "live pages",
    "{{live}}",
];
/// No sentence begins with these.
const FIRST: &[&str] = &["What", "How", "Whether", "Who", "Whoever", "Of", "Those", "Nobody"];
/// Abbreviations whose period ends no sentence.
const ABBREVIATIONS: &[&str] =
    &["e.g", "i.e", "eq", "eqs", "Eq", "fig", "Fig", "cf", "vs", "al", "no", "ch", "sec", "p", "pp"];

/// The counts of one file, with the findings in words.
#[derive(Default)]
struct Counts {
    words: usize,
    sentences: usize,
    long: usize,
    semicolons: usize,
    findings: Vec<String>,
}

impl Counts {
    fn add(&mut self, line: usize, paragraph: &str) {
        let plain = without_code(paragraph);
        let lower = plain.to_lowercase();
        let allowed = ALLOWED.iter().fold(lower, |text, phrase| text.replace(phrase, "X"));
        for phrase in REPLACED {
            if contains_words(&allowed, phrase) {
                self.findings.push(format!("line {line}: `{phrase}` in: {}", shortened(paragraph)));
            }
        }
        for sentence in sentences(&plain) {
            let words: Vec<&str> = words(&sentence).collect();
            let Some(first) = words.first() else { continue };
            if FIRST.contains(first) {
                self.findings.push(format!("line {line}: begins with {first}: {}", shortened(&sentence)));
            }
            if words.len() < 3 {
                continue;
            }
            self.sentences += 1;
            self.words += words.len();
            self.long += usize::from(words.len() > 30);
            self.semicolons += sentence.matches(';').count();
        }
    }

    /// The findings and the statistics that are out of bounds.
    fn faults(mut self) -> Vec<String> {
        let n = self.sentences;
        if n >= 10 && self.words > 18 * n {
            self.findings.push(format!("{} words in {n} sentences: more than 18 on average", self.words));
        }
        if n >= 10 && 100 * self.long > 3 * n.max(34) {
            self.findings.push(format!("{} of {n} sentences have more than 30 words", self.long));
        }
        if 100 * self.semicolons > 5 * n.max(20) {
            self.findings.push(format!("{} semicolons in {n} sentences", self.semicolons));
        }
        self.findings
    }
}

fn shortened(text: &str) -> String {
    text.chars().take(90).collect()
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !(c.is_alphanumeric() || "'_-".contains(c)))
        .filter(|word| word.starts_with(char::is_alphanumeric))
}

/// Whether a phrase occurs between word borders.
fn contains_words(text: &str, phrase: &str) -> bool {
    text.match_indices(phrase).any(|(at, _)| {
        let border = |c: Option<char>| !c.is_some_and(|c| c.is_alphanumeric() || c == '_');
        border(text[..at].chars().next_back()) && border(text[at + phrase.len()..].chars().next())
    })
}

/// The text with `X` for each span in backticks, and without the targets of links.
fn without_code(text: &str) -> String {
    let mut plain = String::new();
    for (index, part) in text.split('`').enumerate() {
        plain.push_str(if index % 2 == 0 { part } else { "X" });
    }
    while let Some(at) = plain.find("](") {
        let Some(end) = plain[at..].find(')') else { break };
        plain.replace_range(at + 1..=at + end, "");
    }
    plain
}

/// Splits after `.`, `!` or `?` before a space and a capital letter.
fn sentences(text: &str) -> Vec<String> {
    let mut all = Vec::new();
    let mut current = String::new();
    let words: Vec<&str> = text.split_whitespace().collect();
    for (index, word) in words.iter().enumerate() {
        if !current.is_empty() {
            current.push(' ');
        }
        current.push_str(word);
        let bare = word.trim_end_matches(['"', '\'', ')', ']', '*']);
        let stem = bare.trim_end_matches(['.', '!', '?']);
        let next = words.get(index + 1).map(|next| next.trim_start_matches(['"', '\'', '(', '[', '*']));
        let begins = next.is_some_and(|next| next.starts_with(|c: char| c.is_uppercase() || c.is_ascii_digit()));
        if bare.len() > stem.len() && begins && !ABBREVIATIONS.contains(&stem.trim_start_matches(['(', '['])) {
            all.push(std::mem::take(&mut current));
        }
    }
    if !current.is_empty() {
        all.push(current);
    }
    all
}

/// The paragraphs of a document with the lines at which they begin, without code, tables and headings.
fn paragraphs<'a>(lines: impl Iterator<Item = (usize, Option<&'a str>)>) -> Vec<(usize, String)> {
    let mut all: Vec<(usize, String)> = Vec::new();
    let (mut open, mut fenced) = (false, false);
    for (number, line) in lines {
        let Some(text) = line.map(str::trim) else {
            (open, fenced) = (false, false);
            continue;
        };
        if text.starts_with("```") {
            fenced = !fenced;
            open = false;
            continue;
        }
        let skipped = ["#", "|", "<", "!["].iter().any(|mark| text.starts_with(mark));
        if fenced || text.is_empty() || skipped {
            open = false;
            continue;
        }
        let item = ["- ", "* "].iter().find_map(|mark| text.strip_prefix(mark));
        match (item, all.last_mut()) {
            (None, Some((_, paragraph))) if open => {
                let _ = write!(paragraph, " {text}");
            }
            _ => all.push((number, item.unwrap_or(text).to_owned())),
        }
        open = true;
    }
    all
}

fn counted(path: &Path, text: &str) -> Counts {
    let numbered = (1..).zip(text.lines());
    let all = if path.extension().is_some_and(|extension| extension == "md") {
        // Four spaces are code.
        paragraphs(numbered.map(|(number, line)| (number, Some(if line.starts_with("    ") { "" } else { line }))))
    } else {
        paragraphs(numbered.map(|(number, line)| {
            let line = line.trim_start();
            // A fence that depends on a feature is an attribute.
            let fence = line.ends_with("doc = \"```\")]").then_some("```");
            (number, ["///", "//!", "//"].iter().find_map(|mark| line.strip_prefix(mark)).or(fence))
        }))
    };
    let mut counts = Counts::default();
    for (line, paragraph) in all {
        counts.add(line, &paragraph);
    }
    counts
}

/// Documents and sources, except fixtures and texts of other authors.
fn files(folder: &Path, all: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        if path.is_dir() {
            if !["target", "runs", "node_modules", "fixtures", "corpus"].contains(&name.as_str())
                && !name.starts_with('.')
            {
                files(&path, all);
            }
        } else if path.extension().is_some_and(|extension| extension == "md" || extension == "rs") {
            all.push(path);
        }
    }
}

#[test]
fn documents_and_comments_are_plain() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut all = Vec::new();
    files(root, &mut all);
    assert!(all.len() > 500, "only {} files", all.len());
    let mut faulty = Vec::new();
    for path in all {
        let name = path.strip_prefix(root).expect("within").to_string_lossy().replace('\\', "/");
        // The list of the words, and titles of other authors.
        if ["tests/prose.rs", "REFERENCES.md"].contains(&name.as_str()) {
            continue;
        }
        let faults = counted(&path, &fs::read_to_string(&path).expect("a text")).faults();
        if !faults.is_empty() {
            faulty.push(format!("{name}\n  {}", faults.join("\n  ")));
        }
    }
    assert!(faulty.is_empty(), "{} files:\n{}", faulty.len(), faulty.join("\n"));
}

#[test]
fn faults_are_counted() {
    let of = |text: &str| counted(Path::new("x.md"), text).faults();
    assert_eq!(of("It reads a file. `told` is a name. We use ask and tell."), Vec::<String>::new());
    assert_eq!(of("A file stands here.").len(), 1);
    assert_eq!(of("Nothing. What is read is written.").len(), 1);
    assert_eq!(of(&"This is so; that is not. ".repeat(20)).len(), 1);
    let long = format!("This {} ends. ", "long ".repeat(40));
    assert_eq!(of(&long.repeat(10)).len(), 2);
    let code = counted(Path::new("x.rs"), "/// Who reads this?\nfn told() {} // anew\nlet a = \"anew\";");
    assert_eq!(code.faults().len(), 2, "a sentence and a word in one comment");
}

#[test]
fn documents_have_their_sizes() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let most =
        [("README", 8000), ("ARCHITECTURE", 10_000), ("CONTRIBUTING", 5000), ("SECURITY", 2000), ("CHANGELOG", 6000)];
    for (name, most) in most {
        let size = fs::read(root.join(format!("{name}.md"))).expect("a document").len();
        println!("{name}.md has {size} of {most} bytes");
        assert!(size <= most, "{name}.md has {size} bytes, at most {most}");
    }
    let mut all = Vec::new();
    files(root, &mut all);
    let documents = all.iter().filter(|path| path.extension().is_some_and(|extension| extension == "md"));
    let sum: u64 = documents.map(|path| fs::metadata(path).expect("a file").len()).sum();
    println!("all documents have {sum} bytes");
    assert!(sum <= 330_000, "all documents have {sum} bytes, at most 330 000");
}
