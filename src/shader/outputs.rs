//! Outputs of fragments at the locations of a host's attachments. Modules that draw a list of planes
//! write all of them; one edit of the words moves each variable to its attachment, and makes those
//! without an attachment private, so that the driver removes what only they need. Outputs of vertices
//! that the fragments of their pipeline do not read become private, too.

use super::spirv::{BOUND, HEADER, instructions, op};
use std::collections::HashMap;

/// More than the locations of any module.
const MOST_LOCATIONS: u32 = 64;

/// The variables of a storage class that have a location: ids, locations.
fn located(words: &[u32], class: u32) -> HashMap<u32, u32> {
    let variables: Vec<u32> = instructions(words)
        .filter(|(code, one)| *code == op::VARIABLE && one[3] == class)
        .map(|(_, one)| one[2])
        .collect();
    instructions(words)
        .filter(|(code, one)| *code == op::DECORATE && one[2] == op::LOCATION)
        .filter(|(_, one)| variables.contains(&one[1]))
        .map(|(_, one)| (one[1], one[3]))
        .collect()
}

/// The words of a vertex module that passes only what a fragment module reads. Vertices write the
/// inputs of all fragments.
pub fn with_outputs_for(vertex: &[u32], fragment: &[u32]) -> Vec<u32> {
    let read = located(fragment, op::INPUT);
    let kept = |n: u32| read.values().any(|known| *known == n).then_some(n);
    let locations: Vec<_> = (0..MOST_LOCATIONS).map(kept).collect();
    with_locations(vertex, &locations)
}

/// The words of a fragment module whose output at location `n` is at `locations[n]`. Outputs beyond
/// the list, and those with `None`, are private.
///
/// The module must write its outputs as whole variables, and be of SPIR-V 1.4 or later, where an
/// entry point lists its private variables, too. A test checks both.
pub fn with_locations(words: &[u32], locations: &[Option<u32>]) -> Vec<u32> {
    let at: HashMap<u32, Option<u32>> = located(words, op::OUTPUT)
        .into_iter()
        .map(|(id, n)| (id, locations.get(n as usize).copied().flatten()))
        .collect();
    let is_private = |id: &u32| at.get(id) == Some(&None);
    let pointee: HashMap<u32, u32> = instructions(words)
        .filter(|(code, _)| *code == op::TYPE_POINTER)
        .map(|(_, one)| (one[1], one[3]))
        .collect();

    let mut out = words[..HEADER].to_vec();
    let mut private_types: HashMap<u32, u32> = HashMap::new();
    for (code, one) in instructions(words) {
        match code {
            // Location and interpolation go with the interface.
            op::DECORATE if is_private(&one[1]) => {}
            op::DECORATE if one[2] == op::LOCATION && at.contains_key(&one[1]) => {
                let location = at[&one[1]].unwrap_or_default();
                out.extend([one[0], one[1], one[2], location]);
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
    use super::*;
    use crate::settings::Plane;
    use crate::shader::catalogue::{Entry, Module, modules};
    use crate::shader::words;
    use std::collections::BTreeSet;

    /// Locations of variables of one storage class, in order.
    fn locations(words: &[u32], class: u32) -> Vec<u32> {
        let mut found: Vec<u32> = located(words, class).into_values().collect();
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
            assert_eq!(locations(&words, op::OUTPUT), every, "{}", module.name());
            let mut to = [None; Plane::COUNT];
            to[Plane::Motion.location() as usize] = Some(0);
            to[Plane::Color.location() as usize] = Some(1);
            let moved = with_locations(&words, &to);
            assert_eq!(locations(&moved, op::OUTPUT), [0, 1]);
            assert_eq!(locations(&moved, op::PRIVATE), [] as [u32; 0]);
            let private: Vec<u32> = instructions(&moved)
                .filter(|(code, one)| *code == op::VARIABLE && one[3] == op::PRIVATE)
                .map(|(_, one)| one[2])
                .collect();
            assert!(private.len() >= Plane::COUNT - 2);
            let mut chains = instructions(&moved).filter(|(c, _)| ACCESS_CHAINS.contains(c));
            let chained = chains.any(|(_, one)| private.contains(&one[3]));
            assert!(!chained, "{}", module.name());
            found += 1;
        }
        assert_eq!(found, 4);
    }

    /// Vertices write all that fragments read; validation layers report outputs that none reads.
    #[test]
    fn vertices_pass_what_fragments_read() {
        let mut counts = BTreeSet::new();
        for module in modules() {
            let entries: &[Entry] = match module.entry {
                Entry::Tree => &[Entry::BoxVertex],
                Entry::Walk => &[Entry::WalkVertex],
                Entry::Cells => &[Entry::CellVertex],
                _ => &[],
            };
            let fragment = words(&module).unwrap();
            let read = locations(&fragment, op::INPUT);
            for &entry in entries {
                let vertex = words(&Module::plain(entry)).unwrap();
                let fit = with_outputs_for(&vertex, &fragment);
                assert_eq!(locations(&fit, op::OUTPUT), read, "{}", module.name());
                counts.insert(read.len());
            }
        }
        // Depths read less than colours, and those of walks least.
        assert!(counts.len() > 3, "{counts:?}");
    }
}
