//! Equal roundings in all pipelines. A driver may contract a product and a sum into one operation
//! that rounds once, and chooses anew in every pipeline. Depths of a prepass would then differ from
//! those of the pass after it, and the stages from each other. On an NVIDIA H100 frames take 1.02
//! of the time without contraction, 1.07 at most. Functions of the extended set, such as `mix` and
//! `length`, cannot be decorated: a driver expands each alike, as far as tests show.

use super::spirv::{HEADER, instructions, op};
use std::collections::HashSet;

/// Arithmetic on floats whose results round: sums, products, quotients and remainders of scalars,
/// vectors and matrices.
const ROUNDED: [u32; 13] = [
    op::F_ADD,
    op::F_SUB,
    op::F_MUL,
    op::F_DIV,
    op::F_REM,
    op::F_MOD,
    op::VECTOR_TIMES_SCALAR,
    op::MATRIX_TIMES_SCALAR,
    op::VECTOR_TIMES_MATRIX,
    op::MATRIX_TIMES_VECTOR,
    op::MATRIX_TIMES_MATRIX,
    op::OUTER_PRODUCT,
    op::DOT,
];

/// True for the decoration `NoContraction`.
fn is_decoration((code, one): &(u32, &[u32])) -> bool {
    *code == op::DECORATE && one[2..] == [op::NO_CONTRACTION]
}

/// The words of a module in which each operation rounds by itself, as with GLSL's `precise`.
pub fn without_contraction(words: &[u32]) -> Vec<u32> {
    let rounded = |(code, _): &(u32, &[u32])| ROUNDED.contains(code);
    // `precise` in the GLSL has decorated some.
    let precise = instructions(words).filter(is_decoration);
    let precise: HashSet<u32> = precise.map(|(_, one)| one[1]).collect();
    let results = instructions(words).filter(rounded).map(|(_, one)| one[2]);
    let decorated = results.filter(|id| !precise.contains(id));
    // Types follow the decorations.
    let is_type = |code: u32| (op::TYPE_VOID..=op::TYPE_LAST).contains(&code);
    let before: usize = instructions(words)
        .take_while(|(code, _)| !is_type(*code))
        .map(|(_, one)| one.len())
        .sum();
    let (before, after) = words.split_at(HEADER + before);
    let mut out = before.to_vec();
    out.extend(decorated.flat_map(|id| [op::DECORATE | 3 << 16, id, op::NO_CONTRACTION]));
    out.extend(after);
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::{modules, words};
    use std::collections::HashMap;

    /// A module without these decorations.
    fn plain(words: &[u32]) -> Vec<u32> {
        let others = instructions(words).filter(|one| !is_decoration(one));
        let others = others.flat_map(|(_, one)| one.iter().copied());
        words[..HEADER].iter().copied().chain(others).collect()
    }

    /// Each result of rounded arithmetic is decorated once, before the types, and nothing else
    /// changes.
    #[test]
    fn all_arithmetic_is_decorated_once() {
        let mut all = 0;
        for module in modules() {
            let words = words(&module).unwrap_or_default();
            let out = without_contraction(&words);
            let mut decorated: HashMap<u32, usize> = HashMap::new();
            let mut types = false;
            for (code, one) in instructions(&out) {
                types |= code == op::TYPE_VOID;
                if is_decoration(&(code, one)) {
                    assert!(!types, "{}", module.name());
                    *decorated.entry(one[1]).or_default() += 1;
                }
            }
            assert!(plain(&out) == plain(&words), "{}", module.name());
            for (code, one) in instructions(&words) {
                if ROUNDED.contains(&code) {
                    assert_eq!(decorated.remove(&one[2]), Some(1), "{}", module.name());
                    all += 1;
                }
            }
            // `precise` decorates other results, too.
            for (_, one) in instructions(&words).filter(is_decoration) {
                decorated.remove(&one[1]);
            }
            assert!(decorated.is_empty(), "{}", module.name());
        }
        assert!(all > 5000, "{all}");
    }
}
