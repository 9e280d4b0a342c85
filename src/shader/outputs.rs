//! Outputs of fragments at the locations of a host's attachments. Modules that draw a list of planes
//! write all of them; one edit of the words moves each variable to its attachment, and makes those
//! without an attachment private, so that the driver removes what only they need.

use std::collections::HashMap;

/// Words before the first instruction.
const HEADER: usize = 5;
/// Word of the header that is larger than every id.
const BOUND: usize = 3;

/// Opcodes, decorations and storage classes of the SPIR-V specification.
mod op {
    pub const TYPE_POINTER: u32 = 32;
    pub const VARIABLE: u32 = 59;
    pub const DECORATE: u32 = 71;
    pub const LOCATION: u32 = 30;
    pub const OUTPUT: u32 = 3;
    pub const PRIVATE: u32 = 6;
}

/// The words of a fragment module whose output at location `n` is at `locations[n]`. Outputs beyond
/// the list, and those with `None`, are private.
///
/// The module must write its outputs as whole variables, and be of SPIR-V 1.4 or later, where an
/// entry point lists its private variables, too. A test checks both.
#[must_use]
pub fn with_locations(words: &[u32], locations: &[Option<u32>]) -> Vec<u32> {
    let instructions = || {
        let mut at = HEADER;
        std::iter::from_fn(move || {
            let count = (*words.get(at)? >> 16) as usize;
            let one = words.get(at..at + count.max(1))?;
            at += count.max(1);
            Some((one[0] & 0xffff, one))
        })
    };
    let outputs: Vec<u32> = instructions()
        .filter(|(code, one)| *code == op::VARIABLE && one[3] == op::OUTPUT)
        .map(|(_, one)| one[2])
        .collect();
    let at: HashMap<u32, Option<u32>> = instructions()
        .filter(|(code, one)| *code == op::DECORATE && one[2] == op::LOCATION)
        .filter(|(_, one)| outputs.contains(&one[1]))
        .map(|(_, one)| (one[1], locations.get(one[3] as usize).copied().flatten()))
        .collect();
    let is_private = |id: &u32| at.get(id) == Some(&None);
    let pointee: HashMap<u32, u32> = instructions()
        .filter(|(code, _)| *code == op::TYPE_POINTER)
        .map(|(_, one)| (one[1], one[3]))
        .collect();

    let mut out = words[..HEADER].to_vec();
    let mut private_types: HashMap<u32, u32> = HashMap::new();
    for (code, one) in instructions() {
        match code {
            op::DECORATE if one[2] == op::LOCATION && at.contains_key(&one[1]) => {
                if let Some(location) = at[&one[1]] {
                    out.extend([one[0], one[1], one[2], location]);
                }
            }
            op::VARIABLE if is_private(&one[2]) => {
                let of = pointee[&one[1]];
                let pointer = *private_types.entry(of).or_insert_with(|| {
                    let new = out[BOUND];
                    out[BOUND] += 1;
                    out.extend([op::TYPE_POINTER | 4 << 16, new, op::PRIVATE, of]);
                    new
                });
                out.extend([one[0], pointer, one[2], op::PRIVATE]);
            }
            _ => out.extend(one),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::settings::Plane;
    use crate::shader::tests::instructions;
    use crate::shader::{modules, words};

    /// Variables with a location, of one storage class.
    fn located(words: &[u32], class: u32) -> Vec<u32> {
        let all = instructions(words);
        let variables = all
            .iter()
            .filter(|(c, w)| *c == op::VARIABLE && w[2] == class);
        let ids: Vec<u32> = variables.map(|(_, w)| w[1]).collect();
        let decorations = all
            .iter()
            .filter(|(c, w)| *c == op::DECORATE && w[1] == op::LOCATION && ids.contains(&w[0]));
        let mut found: Vec<u32> = decorations.map(|(_, w)| w[2]).collect();
        found.sort_unstable();
        found
    }

    /// All modules of lists have every plane as a whole variable; moving some leaves exactly these,
    /// at their new locations.
    #[test]
    fn outputs_move_or_become_private() {
        const VERSION_1_4: u32 = 0x1_0400;
        const ACCESS_CHAINS: [u32; 2] = [65, 66];
        let mut found = 0;
        for module in modules().iter().filter(|m| m.name().ends_with(".list")) {
            let words = words(module).unwrap();
            assert!(words[1] >= VERSION_1_4);
            let every: Vec<u32> = (0..Plane::COUNT as u32).collect();
            assert_eq!(located(&words, op::OUTPUT), every, "{}", module.name());
            let mut locations = [None; Plane::COUNT];
            locations[Plane::Motion.location() as usize] = Some(0);
            locations[Plane::Color.location() as usize] = Some(1);
            let moved = with_locations(&words, &locations);
            assert_eq!(located(&moved, op::OUTPUT), [0, 1]);
            assert_eq!(located(&moved, op::PRIVATE), [] as [u32; 0]);
            let all = instructions(&moved);
            let is_private = |w: &&[u32]| w[2] == op::PRIVATE;
            let variables = all.iter().filter(|(c, _)| *c == op::VARIABLE);
            let private: Vec<u32> = variables
                .map(|(_, w)| *w)
                .filter(is_private)
                .map(|w| w[1])
                .collect();
            assert!(private.len() >= Plane::COUNT - 2);
            let chained =
                |(c, w): &(u32, &[u32])| ACCESS_CHAINS.contains(c) && private.contains(&w[2]);
            assert!(!all.iter().any(chained), "{}", module.name());
            found += 1;
        }
        assert_eq!(found, 5);
    }
}
