//! Imports form no circle.
//!
//! The modules of one folder are compared with each other, each with everything below it: one
//! imports another if any of its files names something of it by a path that begins with `crate` or
//! `super`. A name that a module re-exports counts as a name of the module that it comes from. A
//! module and those below it count as one, so a parent may re-export its children, and children
//! may use their parent. Tests and the code of macros are left out.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

type Module = Vec<String>;

/// The imports from one module of a folder to another.
type Arrows<'a> = BTreeMap<(&'a str, String), Vec<String>>;

#[derive(Default)]
struct Source {
    /// Paths that begin with `crate`, `super` or `self`, from the root.
    named: Vec<Module>,
    /// What the module has by `use`, by the name that it has here.
    uses: BTreeMap<String, Module>,
}

/// The sources of a crate by module.
struct Crate(BTreeMap<Module, Source>);

impl Crate {
    fn new<'a>(texts: impl IntoIterator<Item = (&'a str, &'a str)>) -> Self {
        let texts: Vec<(Module, String)> = texts
            .into_iter()
            .map(|(name, text)| (module(name), code(text)))
            .collect();
        let mut all: BTreeMap<Module, Source> = BTreeMap::new();
        for (at, _) in &texts {
            all.insert(at.clone(), Source::default());
        }
        for (at, text) in &texts {
            let mut source = Source::default();
            for (place, _) in text.match_indices(|c: char| c.is_alphanumeric() || c == '_') {
                let before = &text[..place];
                if before.ends_with(|c: char| c.is_alphanumeric() || "_:".contains(c)) {
                    continue;
                }
                let is_use = before.ends_with("use ");
                if before.ends_with("(in ") || !(is_use || starts_path(&text[place..])) {
                    continue;
                }
                for (path, name) in tree(&mut text[place..].chars().peekable(), &[]) {
                    let child = [at.as_slice(), &path[..1]].concat();
                    let from_root = match path[0].as_str() {
                        "crate" => path[1..].to_vec(),
                        "self" => [at, &path[1..]].concat(),
                        "super" => {
                            let up = path.iter().take_while(|part| *part == "super").count();
                            [&at[..at.len().saturating_sub(up)], &path[up..]].concat()
                        }
                        _ if all.contains_key(&child) => [at.as_slice(), &path].concat(),
                        _ => continue,
                    };
                    if is_use {
                        source.uses.insert(name, from_root.clone());
                    }
                    if ["crate", "super"].contains(&path[0].as_str()) {
                        source.named.push(from_root);
                    }
                }
            }
            all.insert(at.clone(), source);
        }
        Self(all)
    }

    /// The module that a path leads to, through re-exports.
    fn target(&self, path: &[String], depth: usize) -> Module {
        let known = |n: &usize| self.0.contains_key(&path[..*n]);
        let n = (0..=path.len()).rev().find(known).unwrap_or(0);
        let (at, rest) = path.split_at(n);
        let used = rest.first().and_then(|name| self.0.get(at)?.uses.get(name));
        match used {
            Some(used) if depth < 8 => self.target(&[used, &rest[1..]].concat(), depth + 1),
            _ => at.to_vec(),
        }
    }

    /// Circles among the modules of each folder: the folder, the modules, and the imports.
    fn circles(&self) -> Vec<[String; 3]> {
        let mut folders: BTreeMap<&[String], Arrows> = BTreeMap::new();
        for (at, source) in &self.0 {
            for path in &source.named {
                let to = self.target(path, 0);
                let same = at.iter().zip(&to).take_while(|(a, b)| a == b).count();
                if same == at.len() || same == to.len() {
                    continue;
                }
                let folder = folders.entry(&at[..same]).or_default();
                let tie = format!("{} -> {}", at.join("::"), path.join("::"));
                let arrow = folder.entry((&at[same], to[same].clone())).or_default();
                arrow.push(tie);
            }
        }
        let mut circles = Vec::new();
        for (folder, arrows) in folders {
            let reached = |from: &str| {
                let (mut seen, mut open) = (BTreeSet::new(), vec![from.to_owned()]);
                while let Some(next) = open.pop() {
                    for (_, to) in arrows.keys().filter(|(from, _)| *from == next) {
                        if seen.insert(to.clone()) {
                            open.push(to.clone());
                        }
                    }
                }
                seen
            };
            let modules: BTreeSet<&str> = arrows.keys().map(|(from, _)| *from).collect();
            let mut done = BTreeSet::new();
            for module in modules {
                let below = reached(module);
                if !below.contains(module) || done.contains(module) {
                    continue;
                }
                let circle: BTreeSet<String> = below
                    .into_iter()
                    .filter(|other| reached(other).contains(module))
                    .collect();
                let names: Vec<String> = circle
                    .iter()
                    .map(|name| [folder, std::slice::from_ref(name)].concat().join("::"))
                    .collect();
                let within = arrows
                    .iter()
                    .filter(|((from, to), _)| circle.contains(*from) && circle.contains(to));
                let ties: Vec<String> = within.flat_map(|(_, ties)| ties.clone()).collect();
                circles.push([folder.join("::"), names.join(", "), ties.join("\n  ")]);
                done.extend(circle);
            }
        }
        circles
    }
}

fn module(name: &str) -> Module {
    let parts = name.split("::").filter(|part| !part.is_empty());
    parts.map(str::to_owned).collect()
}

fn starts_path(text: &str) -> bool {
    ["crate::", "super::"]
        .iter()
        .any(|start| text.starts_with(start))
}

/// Without comments and without what is compiled for tests alone. As rustfmt writes it, an item ends
/// where a line of its own depth ends it.
fn code(text: &str) -> String {
    let mut lines = text
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"));
    let mut code = String::new();
    while let Some(line) = lines.next() {
        if !line.trim_start().starts_with("#[cfg(test)]") {
            code.extend([line.trim(), "\n"]);
            continue;
        }
        let depth = line.len() - line.trim_start().len();
        let ends = |line: &&str| {
            line.len() - line.trim_start().len() == depth && line.ends_with(['}', ';', ','])
        };
        lines.find(ends);
    }
    code
}

/// The paths of a tree of imports, or the one path of an expression, with the name of each.
fn tree(
    text: &mut std::iter::Peekable<std::str::Chars>,
    before: &[String],
) -> Vec<(Module, String)> {
    let mut path = before.to_vec();
    loop {
        while text.next_if(|c| c.is_whitespace()).is_some() {}
        if text.next_if_eq(&'{').is_some() {
            let mut all = Vec::new();
            loop {
                while text.next_if(|c| c.is_whitespace() || *c == ',').is_some() {}
                if text.next_if_eq(&'}').is_some() || text.peek().is_none() {
                    return all;
                }
                all.extend(tree(text, &path));
            }
        }
        let mut name = String::new();
        while let Some(c) = text.next_if(|c| c.is_alphanumeric() || "_*".contains(*c)) {
            name.push(c);
        }
        if name == "self" && !path.is_empty() {
            name.clear();
        }
        if !name.is_empty() {
            path.push(name);
        }
        if text.next_if_eq(&':').is_none() || text.next_if_eq(&':').is_none() {
            break;
        }
    }
    let Some(mut name) = path.last().cloned() else {
        text.next();
        return Vec::new();
    };
    let rest: String = text.clone().take(60).collect();
    if let Some(other) = rest.strip_prefix(" as ") {
        name = other
            .chars()
            .take_while(|c| c.is_alphanumeric() || *c == '_')
            .collect();
        text.by_ref().take(4 + name.len()).for_each(drop);
    }
    vec![(path, name)]
}

/// The files of a folder and of those below it, by module, without tests.
fn sources(folder: &Path, at: &str, all: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap();
        let inner = format!("{at}::{name}");
        if path.is_dir() {
            sources(&path, &inner, all);
        } else if path.extension().is_some_and(|e| e == "rs") && name != "tests" {
            let is_root = ["lib", "main", "mod"].contains(&name);
            let text = fs::read_to_string(&path).unwrap();
            all.push((if is_root { at.to_owned() } else { inner }, text));
        }
    }
}

#[test]
fn modules_of_a_folder_do_not_import_each_other_in_a_circle() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut crates = vec![root.to_owned()];
    for half in ["crates", "lab"] {
        let inner = fs::read_dir(root.join(half)).unwrap();
        crates.extend(inner.map(|entry| entry.unwrap().path()));
    }
    let mut ties = String::new();
    for folder in crates.iter().filter(|folder| folder.join("src").is_dir()) {
        let mut all = Vec::new();
        sources(&folder.join("src"), "", &mut all);
        let texts = all
            .iter()
            .map(|(name, text)| (name.as_str(), text.as_str()));
        let name = match folder == root {
            true => "revmap".into(),
            false => folder.file_name().unwrap().to_string_lossy(),
        };
        for [_, modules, tie] in Crate::new(texts).circles() {
            ties += &format!("{name}: {modules}\n  {tie}\n");
        }
    }
    assert!(ties.is_empty(), "circles of imports:\n{ties}");
}

/// The circles of planted sources.
fn planted(texts: &[(&str, &str)]) -> Vec<String> {
    let circles = Crate::new(texts.iter().copied()).circles();
    circles.into_iter().map(|[_, modules, _]| modules).collect()
}

#[test]
fn planted_circles_are_found() {
    let root = ("", "mod a;\nmod b;\npub use b::{self, Inner as B, c};");
    let b = ("b", "mod c;\npub use c::Inner;");
    let a = ("a", "pub struct A;\nfn a() -> crate::b::c::Inner {}");
    let c = (
        "b::c",
        "use crate::{\n    a::{A, self},\n};\npub struct Inner;",
    );
    assert_eq!(planted(&[root, a, b, c]), ["a, b"]);
    let c = ("b::c", "use super::super::a::A;\npub struct Inner;");
    assert_eq!(planted(&[root, a, b, c]), ["a, b"]);
    // By a name that the root re-exports.
    let renamed = ("a", "use super::B as C;\npub struct A;");
    assert_eq!(planted(&[root, renamed, b, c]), ["a, b"]);
    let three = [
        ("b::d", "use super::e::E;"),
        ("b::e", "use super::{c, f};"),
        ("b::c", "use super::d;"),
        ("b::f", ""),
    ];
    assert_eq!(
        planted(&[&[root, b, a], &three[..]].concat()),
        ["b::c, b::d, b::e"]
    );
}

#[test]
fn what_is_no_circle_is_not_found() {
    let root = ("", "mod a;\nmod b;\npub use b::Inner;");
    let a = ("a", "use crate::b::Inner;\npub(in crate::b) struct A;");
    let b = ("b", "mod c;\npub use c::Inner;\npub struct Parent;");
    let tests =
        "use super::Parent;\n// crate::a::A\n#[cfg(test)]\nmod tests {\n    use crate::a::A;\n}\n";
    assert!(planted(&[root, a, b, ("b::c", tests)]).is_empty());
}
