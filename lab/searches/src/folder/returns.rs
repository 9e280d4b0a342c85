//! Functions that can end without a return, found in words that are not optimised. The compiler gives
//! no warning: it returns an undefined value.

/// The functions that a folder defines for the library.
const CALLED: [&str; 3] = ["search", "own_search", "starts_in_table"];

const OP_UNDEF: u32 = 1;
const OP_NAME: u32 = 5;
const OP_FUNCTION: u32 = 54;
const OP_RETURN_VALUE: u32 = 254;

/// The first function of a folder that can return an undefined value.
pub(super) fn missing(words: &[u32]) -> Option<&'static str> {
    let mut called: Vec<(u32, &'static str)> = Vec::new();
    let mut undefined: Vec<u32> = Vec::new();
    let mut here: Option<&'static str> = None;
    let mut rest = words.get(5..)?;
    while let Some(&first) = rest.first() {
        let length = (first >> 16) as usize;
        let (instruction, next) = rest.split_at_checked(length.max(1))?;
        rest = next;
        match (first & 0xffff, &instruction[1..]) {
            (OP_NAME, [id, name @ ..]) => {
                let name = text(name);
                let name = name.split('(').next().unwrap_or_default();
                let known = CALLED.into_iter().find(|called| *called == name);
                called.extend(known.map(|name| (*id, name)));
            }
            (OP_FUNCTION, [_, id, ..]) => {
                here = called.iter().find(|(f, _)| f == id).map(|(_, name)| *name);
            }
            (OP_UNDEF, [_, id]) => undefined.push(*id),
            (OP_RETURN_VALUE, [id]) if undefined.contains(id) && here.is_some() => {
                return here.map(|name| name.trim_start_matches("own_"));
            }
            _ => {}
        }
    }
    None
}

/// A string of SPIR-V.
fn text(words: &[u32]) -> String {
    let bytes = words.iter().flat_map(|word| word.to_le_bytes());
    let bytes: Vec<u8> = bytes.take_while(|byte| *byte != 0).collect();
    String::from_utf8_lossy(&bytes).into_owned()
}
