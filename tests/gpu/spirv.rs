//! Edits of SPIR-V that make a software driver compute as GPUs may: with contracted products, without
//! denormals, with filter weights of 8 bits; and planted faults. Opcodes are those of the SPIR-V
//! specification 1.6.

use std::collections::{HashMap, HashSet};

/// Words before the first instruction, and the place of the bound on ids among them.
const HEADER: usize = 5;
const BOUND: usize = 3;

mod op {
    pub const EXT_INST_IMPORT: u32 = 11;
    pub const EXT_INST: u32 = 12;
    pub const CAPABILITY: u32 = 17;
    pub const TYPE_BOOL: u32 = 20;
    pub const TYPE_INT: u32 = 21;
    pub const TYPE_FLOAT: u32 = 22;
    pub const TYPE_VECTOR: u32 = 23;
    pub const TYPE_SAMPLED_IMAGE: u32 = 27;
    pub const CONSTANT: u32 = 43;
    pub const CONSTANT_COMPOSITE: u32 = 44;
    pub const CONSTANT_NULL: u32 = 46;
    pub const FUNCTION: u32 = 54;
    pub const LOAD: u32 = 61;
    pub const DECORATE: u32 = 71;
    pub const SAMPLE_EXPLICIT_LOD: u32 = 88;
    pub const GATHER: u32 = 96;
    pub const IMAGE: u32 = 100;
    pub const QUERY_SIZE_LOD: u32 = 103;
    pub const S_TO_F: u32 = 111;
    pub const F_CONVERT: u32 = 115;
    pub const QUANTIZE_TO_F16: u32 = 116;
    pub const F_ADD: u32 = 129;
    pub const F_SUB: u32 = 131;
    pub const F_MUL: u32 = 133;
    pub const F_DIV: u32 = 136;
    pub const VECTOR_TIMES_SCALAR: u32 = 142;
    pub const DOT: u32 = 148;
    pub const SELECT: u32 = 169;
    pub const F_ORD_LESS_THAN: u32 = 184;
}
const FLOAT64: u32 = 10;
const IMAGE_QUERY: u32 = 50;
const NO_CONTRACTION: u32 = 42;
const ROUND_EVEN: u32 = 2;
const F_ABS: u32 = 4;

/// The operations whose results round.
const ROUNDED: [u32; 6] = [
    op::F_ADD,
    op::F_SUB,
    op::F_MUL,
    op::F_DIV,
    op::VECTOR_TIMES_SCALAR,
    op::DOT,
];

/// A way to compute.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Arithmetic {
    /// Every sum with a product, and every dot product, is rounded once where the module permits it.
    Permitted,
    /// The same wherever it can be.
    Fused,
    /// Results below the smallest normal number are 0.
    Flushed,
    /// Coordinates of look-ups through a sampler are rounded to so many parts of a texel.
    Sampled(f32),
    /// A planted fault: products keep 11 bits.
    Coarse,
}

/// A module in pieces.
struct Editor {
    head: Vec<u32>,
    capabilities: Vec<Vec<u32>>,
    decorations: Vec<Vec<u32>>,
    /// Types and constants that are found or added.
    globals: Vec<Vec<u32>>,
    /// Instructions in place of those of the functions.
    body: Vec<Vec<u32>>,
    edits: usize,
}

/// A module that computes in another way, and how many of its operations changed.
pub fn edited(words: &[u32], how: Arithmetic) -> (Vec<u32>, usize) {
    let mut all = Vec::new();
    let mut at = HEADER;
    while at < words.len() {
        let count = ((words[at] >> 16) as usize).max(1);
        all.push(words[at..at + count].to_vec());
        at += count;
    }
    let begin = all.iter().position(|one| code(one) == op::FUNCTION);
    let begin = begin.unwrap_or(all.len());
    let functions = all.split_off(begin);
    let mut editor = Editor {
        head: words[..HEADER].to_vec(),
        capabilities: Vec::new(),
        decorations: Vec::new(),
        globals: all,
        body: Vec::new(),
        edits: 0,
    };
    let decorated = |one: &&Vec<u32>| code(one) == op::DECORATE && one[2] == NO_CONTRACTION;
    let separate: HashSet<u32> = editor
        .globals
        .iter()
        .filter(decorated)
        .map(|one| one[1])
        .collect();
    let known: HashMap<u32, Vec<u32>> = (functions.iter())
        .filter(|one| one.len() > 2)
        .map(|one| (one[2], one.clone()))
        .collect();
    for one in functions {
        let done = match how {
            Arithmetic::Permitted if one.len() > 2 && separate.contains(&one[2]) => None,
            Arithmetic::Permitted => editor.fuse(&one, &known),
            Arithmetic::Fused => editor.fuse(&one, &known),
            Arithmetic::Flushed => editor.flush(&one),
            Arithmetic::Sampled(parts) => editor.sample(&one, parts, &known),
            Arithmetic::Coarse => editor.coarse(&one),
        };
        match done {
            Some(()) => editor.edits += 1,
            None => editor.body.push(one),
        }
    }
    let edits = editor.edits;
    (editor.words(), edits)
}

fn code(one: &[u32]) -> u32 {
    one[0] & 0xffff
}

fn instruction(code: u32, operands: &[u32]) -> Vec<u32> {
    let mut one = vec![code | (operands.len() as u32 + 1) << 16];
    one.extend(operands);
    one
}

impl Editor {
    fn words(self) -> Vec<u32> {
        let is_type = |one: &Vec<u32>| (op::TYPE_BOOL - 1..=39).contains(&code(one));
        let types = self.globals.iter().position(is_type).unwrap_or(0);
        let (before, after) = self.globals.split_at(types);
        let parts = [
            &self.capabilities[..],
            before,
            &self.decorations,
            after,
            &self.body,
        ];
        let words = parts.into_iter().flatten().flatten().copied();
        self.head.iter().copied().chain(words).collect()
    }

    fn id(&mut self) -> u32 {
        self.head[BOUND] += 1;
        self.head[BOUND] - 1
    }

    fn capability(&mut self, capability: u32) {
        let wanted = instruction(op::CAPABILITY, &[capability]);
        if !self.capabilities.contains(&wanted) && !self.globals.contains(&wanted) {
            self.capabilities.push(wanted);
        }
    }

    /// The id of a type with these operands.
    fn type_of(&mut self, code_of: u32, operands: &[u32]) -> u32 {
        let same = |one: &&Vec<u32>| code(one) == code_of && one[2..] == *operands;
        if let Some(known) = self.globals.iter().find(same) {
            return known[1];
        }
        let id = self.id();
        self.globals
            .push(instruction(code_of, &[&[id], operands].concat()));
        id
    }

    fn constant(&mut self, code_of: u32, of: u32, operands: &[u32]) -> u32 {
        let id = self.id();
        self.globals
            .push(instruction(code_of, &[&[of, id], operands].concat()));
        id
    }

    /// The components of a type of floats of 32 bits: 1 of a scalar; `None` of another type.
    fn components(&self, of: u32) -> Option<u32> {
        let defined = |id: u32| {
            self.globals
                .iter()
                .find(move |one| one.len() > 2 && one[1] == id)
        };
        let one = defined(of)?;
        match code(one) {
            op::TYPE_FLOAT => (one[2] == 32).then_some(1),
            op::TYPE_VECTOR => {
                let scalar = defined(one[2])?;
                (code(scalar) == op::TYPE_FLOAT && scalar[2] == 32).then_some(one[3])
            }
            _ => None,
        }
    }

    /// The type with these components; 1 is the scalar itself.
    fn vector(&mut self, scalar: u32, components: u32) -> u32 {
        match components {
            1 => scalar,
            n => self.type_of(op::TYPE_VECTOR, &[scalar, n]),
        }
    }

    /// A constant with one value in all components.
    fn splat(&mut self, value: f32, components: u32) -> u32 {
        let scalar = self.type_of(op::TYPE_FLOAT, &[32]);
        let one = self.constant(op::CONSTANT, scalar, &[value.to_bits()]);
        match components {
            1 => one,
            n => {
                let of = self.vector(scalar, n);
                self.constant(op::CONSTANT_COMPOSITE, of, &vec![one; n as usize])
            }
        }
    }

    /// Adds an operation to the body; returns its result.
    fn emit(&mut self, code_of: u32, of: u32, operands: &[u32]) -> u32 {
        let id = self.id();
        self.put(code_of, of, id, operands);
        id
    }

    fn put(&mut self, code_of: u32, of: u32, id: u32, operands: &[u32]) {
        self.body
            .push(instruction(code_of, &[&[of, id], operands].concat()));
    }

    /// The number of an instruction of the extended set.
    fn extended(&mut self, number: u32, operands: &[u32]) -> Vec<u32> {
        let import = self
            .globals
            .iter()
            .find(|one| code(one) == op::EXT_INST_IMPORT);
        [&[import.unwrap()[1], number], operands].concat()
    }

    /// `a * b + c` by doubles, which hold the product exactly; and dot products.
    fn fuse(&mut self, one: &[u32], known: &HashMap<u32, Vec<u32>>) -> Option<()> {
        match code(one) {
            op::DOT => self.fuse_dot(one, known),
            op::F_ADD | op::F_SUB => self.fuse_sum(one, known),
            _ => None,
        }
    }

    /// The type of doubles with these components.
    fn wide(&mut self, components: u32) -> u32 {
        self.capability(FLOAT64);
        let double = self.type_of(op::TYPE_FLOAT, &[64]);
        self.vector(double, components)
    }

    fn fuse_dot(&mut self, one: &[u32], known: &HashMap<u32, Vec<u32>>) -> Option<()> {
        let (of, id, x, y) = (one[1], one[2], one[3], one[4]);
        let components = known.get(&x).and_then(|v| self.components(v[1]))?;
        let (double, wide) = (self.wide(1), self.wide(components));
        let [x, y] = [x, y].map(|id| self.emit(op::F_CONVERT, wide, &[id]));
        let sum = self.emit(op::DOT, double, &[x, y]);
        self.put(op::F_CONVERT, of, id, &[sum]);
        Some(())
    }

    fn fuse_sum(&mut self, one: &[u32], known: &HashMap<u32, Vec<u32>>) -> Option<()> {
        let (of, id, x, y) = (one[1], one[2], one[3], one[4]);
        let products = [op::F_MUL, op::VECTOR_TIMES_SCALAR];
        let product = |id: u32| known.get(&id).filter(|p| products.contains(&code(p)));
        let (is_first, product) = match (product(x), product(y)) {
            (Some(product), _) => (true, product),
            (None, product) => (false, product?),
        };
        let components = self.components(of)?;
        let wide = self.wide(components);
        // The second factor is a vector, too, or a scalar.
        let second = match code(product) {
            op::F_MUL => wide,
            _ => self.wide(1),
        };
        let a = self.emit(op::F_CONVERT, wide, &[product[3]]);
        let b = self.emit(op::F_CONVERT, second, &[product[4]]);
        let c = self.emit(op::F_CONVERT, wide, &[if is_first { y } else { x }]);
        let product = self.emit(code(product), wide, &[a, b]);
        let ordered = if is_first { [product, c] } else { [c, product] };
        let sum = self.emit(code(one), wide, &ordered);
        self.put(op::F_CONVERT, of, id, &[sum]);
        Some(())
    }

    fn flush(&mut self, one: &[u32]) -> Option<()> {
        let components = self
            .components(*one.get(1)?)
            .filter(|_| ROUNDED.contains(&code(one)))?;
        let (of, id) = (one[1], one[2]);
        let raw = self.emit(code(one), of, &one[3..]);
        let least = self.splat(f32::MIN_POSITIVE, components);
        let truth = self.type_of(op::TYPE_BOOL, &[]);
        let truth = self.vector(truth, components);
        let zero = self.constant(op::CONSTANT_NULL, of, &[]);
        let size = self.extended(F_ABS, &[raw]);
        let size = self.emit(op::EXT_INST, of, &size);
        let below = self.emit(op::F_ORD_LESS_THAN, truth, &[size, least]);
        self.put(op::SELECT, of, id, &[below, zero, raw]);
        Some(())
    }

    fn coarse(&mut self, one: &[u32]) -> Option<()> {
        if code(one) != op::F_MUL || self.components(one[1]).is_none() {
            return None;
        }
        let raw = self.emit(op::F_MUL, one[1], &one[3..]);
        self.put(op::QUANTIZE_TO_F16, one[1], one[2], &[raw]);
        Some(())
    }

    /// `u` becomes `(round((u n - 1/2) parts) / parts + 1/2) / n`, in look-ups of plane images of `n`
    /// texels.
    fn sample(&mut self, one: &[u32], parts: f32, known: &HashMap<u32, Vec<u32>>) -> Option<()> {
        if ![op::SAMPLE_EXPLICIT_LOD, op::GATHER].contains(&code(one)) {
            return None;
        }
        let loaded = known.get(&one[3]).filter(|l| code(l) == op::LOAD)?[1];
        let sampled = |g: &&Vec<u32>| code(g) == op::TYPE_SAMPLED_IMAGE && g[1] == loaded;
        let image = self.globals.iter().find(sampled)?[2];
        self.capability(IMAGE_QUERY);
        let float = self.type_of(op::TYPE_FLOAT, &[32]);
        let (plane, int) = (self.vector(float, 2), self.type_of(op::TYPE_INT, &[32, 1]));
        let ints = self.vector(int, 2);
        let level = self.constant(op::CONSTANT, int, &[0]);
        let [half, parts] = [0.5, parts].map(|value| self.splat(value, 2));
        let image = self.emit(op::IMAGE, image, &[one[3]]);
        let size = self.emit(op::QUERY_SIZE_LOD, ints, &[image, level]);
        let size = self.emit(op::S_TO_F, plane, &[size]);
        let texels = self.emit(op::F_MUL, plane, &[one[4], size]);
        let texels = self.emit(op::F_SUB, plane, &[texels, half]);
        let all = self.emit(op::F_MUL, plane, &[texels, parts]);
        let round = self.extended(ROUND_EVEN, &[all]);
        let round = self.emit(op::EXT_INST, plane, &round);
        let texels = self.emit(op::F_DIV, plane, &[round, parts]);
        let texels = self.emit(op::F_ADD, plane, &[texels, half]);
        let at = self.emit(op::F_DIV, plane, &[texels, size]);
        let mut sample = one.to_vec();
        sample[4] = at;
        self.body.push(sample);
        Some(())
    }
}
