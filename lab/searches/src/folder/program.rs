//! Tables that a folder's program makes: the outline as JSON on its standard input, numbers on its
//! standard output.

use super::Folder;
use crate::watchdog::{limit, limit_in_words};
use revmap::error::{Error, ErrorKind, Result};
use revmap::search::SearchTable;
use revmap::surface::{Chain, Contour};
use shaderc_link::modules::Fnv;
use std::fmt::Write as _;
use std::io::{Read, Write};
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// The most numbers of a table.
const NUMBERS: usize = 1 << 22;
/// The most bytes that are read of them.
const BYTES: usize = 32 * NUMBERS;
/// Tables that are kept, so that each pass of a benchmark need not run the program again.
const KEPT: usize = 32;

static TABLES: Mutex<Vec<(u64, SearchTable)>> = Mutex::new(Vec::new());

/// The table of a solid with its offset.
pub fn table(folder: &Folder, contour: &Contour, rows: u32) -> Result<SearchTable> {
    let input = input(folder, contour, rows);
    let key = Fnv::of([&folder.hash.to_le_bytes()[..], input.as_bytes()]);
    let kept = TABLES.lock().ok().and_then(|all| {
        let found = all.iter().find(|(known, _)| *known == key);
        found.map(|(_, table)| table.clone())
    });
    if let Some(table) = kept {
        return Ok(table);
    }
    let words = folder.manifest.table.as_ref().map(|t| t.program.as_slice());
    let words = words.unwrap_or_default();
    let named = |message: String| {
        let message = format!("the program `{}` {message}", words.join(" "));
        Error::new(ErrorKind::Content, message).in_file(&folder.path)
    };
    let output = run(folder, words, input).map_err(named)?;
    let table = parsed(&output, rows).map_err(named)?;
    if let Ok(mut tables) = TABLES.lock() {
        if tables.len() >= KEPT {
            tables.remove(0);
        }
        tables.push((key, table.clone()));
    }
    Ok(table)
}

/// The program's input, one JSON object.
fn input(folder: &Folder, contour: &Contour, rows: u32) -> String {
    let points = |chain: &Chain| {
        let closing = chain.points.first().filter(|_| chain.closed);
        let all = chain.points.iter().chain(closing);
        let all: Vec<[f64; 2]> = all.map(|p| [p.x, p.y]).collect();
        format!("{all:?}")
    };
    let chains: Vec<String> = contour.chains.iter().map(points).collect();
    let mut text = format!("{{\"rows\": {rows}, \"parameters\": {{");
    for (k, (name, value)) in folder.values.iter().enumerate() {
        let comma = if k == 0 { "" } else { ", " };
        let _ = write!(text, "{comma}\"{name}\": {value}");
    }
    let _ = writeln!(text, "}}, \"chains\": [{}]}}", chains.join(", "));
    text
}

/// The standard output of the program, which runs in its folder.
fn run(folder: &Folder, words: &[String], input: String) -> std::result::Result<String, String> {
    let [program, arguments @ ..] = words else {
        return Err("has no name".to_owned());
    };
    let own = folder.path.join(program);
    let full = own.canonicalize().ok().filter(|path| path.is_file());
    let mut child = Command::new(full.unwrap_or_else(|| program.into()))
        .args(arguments)
        .current_dir(&folder.path)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|e| format!("cannot be started ({e}); name one of the folder or of the PATH"))?;
    if let Some(mut pipe) = child.stdin.take() {
        // A program need not read its input.
        std::thread::spawn(move || drop(pipe.write_all(input.as_bytes())));
    }
    let output = read(child.stdout.take(), BYTES);
    let complaint = read(child.stderr.take(), 1 << 16);
    let begin = Instant::now();
    let text = output.recv_timeout(limit());
    let status = loop {
        let late = text.is_err() || begin.elapsed() > limit();
        let large = text.as_ref().is_ok_and(|text| text.len() > BYTES);
        match child.try_wait() {
            Ok(Some(status)) if !late && !large => break status,
            Err(e) => return Err(format!("was lost ({e})")),
            Ok(None) if !late && !large => std::thread::sleep(Duration::from_millis(2)),
            Ok(_) => {
                let _ = child.kill().and_then(|()| child.wait());
                return Err(match large {
                    true => format!("wrote more than {} MB", BYTES >> 20),
                    false => format!("took more than {} and was ended", limit_in_words()),
                });
            }
        }
    };
    if !status.success() {
        let said = complaint
            .recv_timeout(Duration::from_secs(1))
            .unwrap_or_default();
        let said = String::from_utf8_lossy(&said);
        let last = said.lines().rfind(|line| !line.trim().is_empty());
        let last = last
            .map(|line| format!(": {}", line.trim()))
            .unwrap_or_default();
        return Err(format!("failed ({status}){last}"));
    }
    String::from_utf8(text.unwrap_or_default()).map_err(|_| "wrote what is no text".to_owned())
}

/// Reads a pipe on a thread of its own, up to one byte more than allowed.
fn read(pipe: Option<impl Read + Send + 'static>, most: usize) -> Receiver<Vec<u8>> {
    let (send, receive) = channel();
    std::thread::spawn(move || {
        let mut bytes = Vec::new();
        if let Some(pipe) = pipe {
            let _ = pipe.take(most as u64 + 1).read_to_end(&mut bytes);
        }
        let _ = send.send(bytes);
    });
    receive
}

/// A table of numbers between white space or commas, four a vector.
fn parsed(text: &str, rows: u32) -> std::result::Result<SearchTable, String> {
    let words = text.split(|c: char| c.is_whitespace() || c == ',');
    let mut numbers = Vec::new();
    for word in words.filter(|word| !word.is_empty()) {
        match word.parse::<f32>() {
            Ok(number) if number.is_finite() => numbers.push(number.to_bits()),
            _ => {
                let (count, start) = (numbers.len() + 1, word.chars().take(40).collect::<String>());
                return Err(format!(
                    "wrote {start:?} as number {count}; write finite numbers"
                ));
            }
        }
        if numbers.len() > NUMBERS {
            return Err(format!("wrote more than {NUMBERS} numbers"));
        }
    }
    if numbers.is_empty() || numbers.len() % 4 != 0 {
        let count = numbers.len();
        return Err(format!("wrote {count} numbers; write four for each vector"));
    }
    let vectors: Vec<[u32; 4]> = numbers.as_chunks().0.to_vec();
    let length = u32::try_from(vectors.len()).unwrap_or(u32::MAX);
    Ok(SearchTable {
        vectors,
        before: 0,
        facts: [length, rows, 0],
    })
}
