//! The index of the view in vertex shaders of a pass with several views (multiview). The modules of
//! the catalogue have a specialisation constant in its place, so that they need no capability; one
//! edit of the words turns the constant into the builtin `ViewIndex`.

use super::generated::VIEW_INDEX_ID;
use super::spirv::{BOUND, HEADER, instructions, op};

/// The words of a module of vertices that read the index of their view. The module must have one
/// function and be of SPIR-V 1.4 or later; a test checks both. A module without the constant stays
/// as it is.
#[must_use]
pub fn with_view_index(words: &[u32]) -> Vec<u32> {
    let is_id = |one: &[u32]| one[2] == op::SPEC_ID && one[3] == VIEW_INDEX_ID;
    let constant = instructions(words)
        .find(|(code, one)| *code == op::DECORATE && is_id(one))
        .map(|(_, one)| one[1]);
    let of_constant =
        |code: u32, one: &[u32]| code == op::SPEC_CONSTANT && Some(one[2]) == constant;
    let kind = instructions(words)
        .find(|(code, one)| of_constant(*code, one))
        .map(|(_, one)| one[1]);
    let (Some(constant), Some(kind)) = (constant, kind) else {
        return words.to_vec();
    };
    let (pointer, variable) = (words[BOUND], words[BOUND] + 1);
    let mut out = words[..HEADER].to_vec();
    out[BOUND] += 2;
    out.extend([op::CAPABILITY | 2 << 16, op::MULTIVIEW]);
    let mut in_first_block = false;
    let mut loads = true;
    for (code, one) in instructions(words) {
        if in_first_block && loads && code != op::VARIABLE {
            out.extend([op::LOAD | 4 << 16, kind, constant, variable]);
            loads = false;
        }
        in_first_block |= code == op::LABEL;
        if code == op::ENTRY_POINT {
            out.push(one[0] + (1 << 16));
            out.extend(&one[1..]);
            out.push(variable);
        } else if code == op::DECORATE && one[1] == constant {
            out.extend([
                op::DECORATE | 4 << 16,
                variable,
                op::BUILTIN,
                op::VIEW_INDEX,
            ]);
        } else if of_constant(code, one) {
            out.extend([op::TYPE_POINTER | 4 << 16, pointer, op::INPUT, kind]);
            out.extend([op::VARIABLE | 4 << 16, pointer, variable, op::INPUT]);
        } else {
            out.extend(one);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::shader::{modules, words};

    /// All modules of vertices have the constant and one function; after the edit they load the
    /// builtin instead. Drivers check the rest in `tests/gpu/embedding_stereo.rs`.
    #[test]
    fn vertices_load_the_index_of_their_view() {
        const FUNCTION: u32 = 54;
        let mut found = 0;
        for module in modules() {
            let words = words(&module).unwrap();
            let edited = with_view_index(&words);
            if !module.entry.file().ends_with(".vert") {
                assert_eq!(edited, words, "{}", module.name());
                continue;
            }
            let count = |of: u32| {
                instructions(&edited)
                    .filter(|(code, _)| *code == of)
                    .count()
            };
            assert_eq!(count(FUNCTION), 1, "{}", module.name());
            assert_eq!(
                edited.len(),
                words.len() + 2 + 1 + 4 + 4,
                "{}",
                module.name()
            );
            let is_builtin = |(code, one): &(u32, &[u32])| {
                *code == op::DECORATE && one[2..] == [op::BUILTIN, op::VIEW_INDEX]
            };
            assert_eq!(instructions(&edited).filter(is_builtin).count(), 1);
            found += 1;
        }
        assert_eq!(found, 4);
    }
}
