//! The instructions of SPIR-V modules, and the edit for reversed depth.

/// Words before the first instruction.
pub const HEADER: usize = 5;
/// Word of the header that is larger than every id.
pub const BOUND: usize = 3;

/// Opcodes, decorations, builtins, capabilities, modes and storage classes of the specification.
pub mod op {
    #[cfg(test)]
    pub const ENTRY_POINT: u32 = 15;
    pub const EXECUTION_MODE: u32 = 16;
    pub const CAPABILITY: u32 = 17;
    pub const TYPE_VOID: u32 = 19;
    pub const TYPE_BOOL: u32 = 20;
    pub const TYPE_INT: u32 = 21;
    pub const TYPE_IMAGE: u32 = 25;
    pub const TYPE_SAMPLER: u32 = 26;
    pub const TYPE_SAMPLED_IMAGE: u32 = 27;
    pub const TYPE_ARRAY: u32 = 28;
    pub const TYPE_POINTER: u32 = 32;
    pub const TYPE_LAST: u32 = 39; // OpTypeForwardPointer
    pub const CONSTANT_TRUE: u32 = 41;
    pub const CONSTANT_FALSE: u32 = 42;
    pub const CONSTANT: u32 = 43;
    pub const SPEC_CONSTANT: u32 = 50;
    pub const SPEC_CONSTANT_OP: u32 = 52;
    pub const VARIABLE: u32 = 59;
    pub const LOAD: u32 = 61;
    pub const ACCESS_CHAIN: u32 = 65;
    pub const FUNCTION: u32 = 54;
    pub const SAMPLE_FIRST: u32 = 87; // OpImageSampleImplicitLod
    pub const SAMPLE_LAST: u32 = 97; // OpImageDrefGather
    pub const PHI: u32 = 245;
    pub const LOOP_MERGE: u32 = 246;
    pub const SELECTION_MERGE: u32 = 247;
    pub const BRANCH: u32 = 249;
    pub const SWITCH: u32 = 251;
    pub const DECORATE: u32 = 71;
    pub const I_ADD: u32 = 128;
    pub const F_ADD: u32 = 129;
    pub const F_SUB: u32 = 131;
    pub const I_MUL: u32 = 132;
    pub const F_MUL: u32 = 133;
    pub const F_DIV: u32 = 136;
    pub const F_REM: u32 = 140;
    pub const F_MOD: u32 = 141;
    pub const VECTOR_TIMES_SCALAR: u32 = 142;
    pub const MATRIX_TIMES_SCALAR: u32 = 143;
    pub const VECTOR_TIMES_MATRIX: u32 = 144;
    pub const MATRIX_TIMES_VECTOR: u32 = 145;
    pub const MATRIX_TIMES_MATRIX: u32 = 146;
    pub const OUTER_PRODUCT: u32 = 147;
    pub const DOT: u32 = 148;
    pub const LOGICAL_OR: u32 = 166;
    pub const LOGICAL_AND: u32 = 167;
    pub const LOGICAL_NOT: u32 = 168;
    pub const SELECT: u32 = 169;
    pub const I_EQUAL: u32 = 170;
    pub const I_NOT_EQUAL: u32 = 171;
    pub const U_GREATER_THAN: u32 = 172;
    pub const BITWISE_AND: u32 = 199;
    pub const NOT: u32 = 200;
    pub const LABEL: u32 = 248;

    pub const SPEC_ID: u32 = 1;
    pub const LOCATION: u32 = 30;
    pub const BINDING: u32 = 33;
    pub const DESCRIPTOR_SET: u32 = 34;
    pub const NO_CONTRACTION: u32 = 42;

    pub const SAMPLED_IMAGE_ARRAY_DYNAMIC_INDEXING: u32 = 29;
    pub const DEPTH_GREATER: u32 = 14;
    pub const DEPTH_LESS: u32 = 15;

    pub const INPUT: u32 = 1;
    pub const OUTPUT: u32 = 3;
    pub const PRIVATE: u32 = 6;
}

/// The instructions of a module: opcode, all words.
pub fn instructions(words: &[u32]) -> impl Iterator<Item = (u32, &[u32])> {
    let mut at = HEADER;
    std::iter::from_fn(move || {
        let count = (*words.get(at)? >> 16) as usize;
        let one = words.get(at..at + count.max(1))?;
        at += count.max(1);
        Some((one[0] & 0xffff, one))
    })
}

/// A module's words for reversed depth. Fragments that declare a depth no nearer than their
/// triangle then declare it for depth that decreases away from the eye.
pub fn depth_less(words: &[u32]) -> Vec<u32> {
    let mut out = words[..HEADER].to_vec();
    for (code, one) in instructions(words) {
        match *one {
            [first, entry, op::DEPTH_GREATER] if code == op::EXECUTION_MODE => {
                out.extend([first, entry, op::DEPTH_LESS]);
            }
            _ => out.extend(one),
        }
    }
    out
}
