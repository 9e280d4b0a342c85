//! Constants in place of indices into arrays of textures that vary, for which Vulkan demands the
//! feature `shaderSampledImageArrayDynamicIndexing`. Kept modules have the short form.

use super::spirv::{BOUND, HEADER, instructions, op};
use std::collections::{HashMap, HashSet};

/// A texture of an array: the access and the load.
#[derive(Clone, Copy)]
struct Access {
    pointer_type: u32,
    array: u32,
    index: u32,
    /// Type of the loaded texture; 0 before it is loaded.
    of: u32,
}

/// The declarations of a module that the edit reads.
#[derive(Default)]
struct Declared {
    integer: u32,
    /// Number of textures, by arrays and their types.
    lengths: HashMap<u32, u32>,
    constants: HashMap<u32, u32>,
    /// By the ids of pointers and of loaded textures.
    varying: HashMap<u32, Access>,
}

impl Declared {
    fn new(words: &[u32]) -> Self {
        let mut all = Self::default();
        let mut textures = HashSet::new();
        for (code, one) in instructions(words) {
            match *one {
                [_, id, 32, _] if code == op::TYPE_INT => all.integer = id,
                [_, id, _] if code == op::TYPE_SAMPLED_IMAGE => {
                    textures.insert(id);
                }
                [_, _, id, value] if code == op::CONSTANT => {
                    all.constants.insert(id, value);
                }
                [_, id, of, length] if code == op::TYPE_ARRAY && textures.contains(&of) => {
                    let length = all.constants.get(&length).copied();
                    let length = length.filter(|length| *length > 0);
                    all.lengths.extend(length.map(|length| (id, length)));
                }
                [_, id, _, of] if code == op::TYPE_POINTER => all.copy_length(of, id),
                [_, of, id, ..] if code == op::VARIABLE => all.copy_length(of, id),
                [_, pointer_type, id, array, index] if code == op::ACCESS_CHAIN => {
                    let varies = !all.constants.contains_key(&index);
                    if varies && all.lengths.contains_key(&array) {
                        let access = Access {
                            pointer_type,
                            array,
                            index,
                            of: 0,
                        };
                        all.varying.insert(id, access);
                    }
                }
                [_, of, id, pointer, ..] if code == op::LOAD => {
                    let access = all.varying.get(&pointer).copied();
                    all.varying
                        .extend(access.map(|access| (id, Access { of, ..access })));
                }
                _ => {}
            }
        }
        all
    }

    fn copy_length(&mut self, of: u32, id: u32) {
        let length = self.lengths.get(&of).copied();
        self.lengths.extend(length.map(|length| (id, length)));
    }

    /// The access of an instruction that samples a texture.
    fn sampled(&self, code: u32, one: &[u32]) -> Option<Access> {
        let samples = (op::SAMPLE_FIRST..=op::SAMPLE_LAST).contains(&code);
        one.get(3)
            .filter(|_| samples)
            .and_then(|id| self.varying.get(id))
            .copied()
    }
}

/// The number of indices into arrays of textures that vary.
#[cfg(test)]
pub fn varying_textures(words: &[u32]) -> usize {
    let all = Declared::new(words).varying;
    all.values().filter(|access| access.of == 0).count()
}

/// A module's words with the capability for indices that vary, which the compiler of GLSL leaves out,
/// if there are any.
pub fn with_varying_textures(words: &[u32]) -> Vec<u32> {
    let (head, rest) = words.split_at(HEADER);
    let mut out = head.to_vec();
    if !Declared::new(words).varying.is_empty() {
        put(
            &mut out,
            op::CAPABILITY,
            &[op::SAMPLED_IMAGE_ARRAY_DYNAMIC_INDEXING],
        );
    }
    out.extend(rest);
    out
}

/// A module's words with a switch over constant indices in place of each look-up in an array of
/// textures by an index that varies. A loop's header, which cannot be divided, keeps its look-ups.
pub fn with_constant_textures(words: &[u32]) -> Vec<u32> {
    let declared = Declared::new(words);
    if declared.varying.is_empty() || headers_sample(words, &declared) {
        return words.to_vec();
    }
    let most = declared.lengths.values().max().copied().unwrap_or_default();
    let mut bound = words[BOUND];
    let mut id = || {
        bound += 1;
        bound - 1
    };
    let numbers: Vec<u32> = (0..most).map(|_| id()).collect();
    let mut out = words[..HEADER].to_vec();
    // The last part of each divided block, by its label.
    let mut parts = HashMap::new();
    let (mut block, mut begun) = (0, false);
    for (code, one) in instructions(words) {
        if code == op::FUNCTION && !begun {
            begun = true;
            for (&number, value) in numbers.iter().zip(0..) {
                put(&mut out, op::CONSTANT, &[declared.integer, number, value]);
            }
        }
        if code == op::LABEL {
            block = one[1];
        }
        let varies = |at: usize| {
            one.get(at)
                .is_some_and(|id| declared.varying.contains_key(id))
        };
        if matches!(code, op::ACCESS_CHAIN | op::LOAD) && varies(2) {
            continue;
        }
        let Some(access) = declared.sampled(code, one) else {
            out.extend(one);
            continue;
        };
        let count = declared.lengths[&access.array] as usize;
        let merge = id();
        let labels: Vec<u32> = (0..count).map(|_| id()).collect();
        put(&mut out, op::SELECTION_MERGE, &[merge, 0]);
        let cases = (1u32..)
            .zip(&labels[1..])
            .flat_map(|(k, label)| [k, *label]);
        let cases: Vec<u32> = [access.index, labels[0]].into_iter().chain(cases).collect();
        put(&mut out, op::SWITCH, &cases);
        let mut results = vec![one[1], one[2]];
        for (&label, &number) in labels.iter().zip(&numbers) {
            let [pointer, texture, result] = [id(), id(), id()];
            put(&mut out, op::LABEL, &[label]);
            let chain = [access.pointer_type, pointer, access.array, number];
            put(&mut out, op::ACCESS_CHAIN, &chain);
            put(&mut out, op::LOAD, &[access.of, texture, pointer]);
            out.extend([one[0], one[1], result, texture]);
            out.extend(&one[4..]);
            put(&mut out, op::BRANCH, &[merge]);
            results.extend([result, label]);
        }
        put(&mut out, op::LABEL, &[merge]);
        put(&mut out, op::PHI, &results);
        parts.insert(block, merge);
    }
    out[BOUND] = bound;
    name_parts(&mut out, &parts);
    out
}

fn put(out: &mut Vec<u32>, code: u32, operands: &[u32]) {
    out.push(code | (operands.len() as u32 + 1) << 16);
    out.extend(operands);
}

/// Names the last part of a divided block where a later block says which block it comes from.
fn name_parts(words: &mut [u32], parts: &HashMap<u32, u32>) {
    let mut at = HEADER;
    while let Some(first) = words.get(at).copied() {
        let end = at + ((first >> 16) as usize).max(1);
        if first & 0xffff == op::PHI {
            for parent in words[at + 3..end].iter_mut().skip(1).step_by(2) {
                *parent = parts.get(parent).copied().unwrap_or(*parent);
            }
        }
        at = end;
    }
}

/// True if a block that begins a loop samples such a texture.
fn headers_sample(words: &[u32], declared: &Declared) -> bool {
    let mut samples = false;
    instructions(words).any(|(code, one)| {
        samples &= code != op::LABEL;
        samples |= declared.sampled(code, one).is_some();
        samples && code == op::LOOP_MERGE
    })
}
