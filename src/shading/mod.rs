//! Shading by a host's function in place of the library's: its GLSL, compiled with the library's
//! own, and its SPIR-V as bytes for programs without a compiler.
//!
//! The GLSL defines `vec4 host_shade(Surface surface)`. The structure `Surface` is in
//! `shaders-glsl/include/core/host_shading.glsl`. The function returns a linear colour. The data that
//! it reads is in descriptor set 3, which the host binds. A
//! [`Renderer::with_shading`](crate::gpu::Renderer::with_shading) draws with it.
//!
//! The host's text comes after all GLSL of the library, so names of the library are taken. A message
//! about a taken name has the line of the host's text.

#[cfg(feature = "shaderc")]
mod compile;

use crate::error::{Error, ErrorKind, Result};
use crate::settings::DrawStage;
use crate::shader::generated::SOURCES_HASH;
use crate::shader::{Module, instructions, op, shading_modules};
use miniz_oxide::deflate::compress_to_vec_zlib;
use miniz_oxide::inflate::decompress_to_vec_zlib_with_limit;
use std::collections::{BTreeSet, HashMap, HashSet};
use std::fmt;
use std::sync::OnceLock;

/// The first bytes of [`Shading::to_bytes`].
const MAGIC: [u8; 8] = *b"rvmshade";
/// Upper limit on bytes of all modules.
const MOST_BYTES: usize = 1 << 26;
/// The first word of every module.
const SPIRV_MAGIC: u32 = 0x0723_0203;

/// A host's function of shading as SPIR-V, for one stage.
///
/// Modules are compiled when a pipeline first needs them, half a second each; modules that came as
/// bytes are compiled already. Renderers share a shading by `Arc`.
pub struct Shading {
    stage: DrawStage,
    modules: Vec<(Module, OnceLock<Result<Vec<u32>>>)>,
    #[cfg(feature = "shaderc")]
    source: Option<compile::Source>,
}

impl Shading {
    /// Compiles GLSL for a stage. `files` are names and texts: the first defines `host_shade`, the
    /// others are those that it includes, by their names in `#include`.
    ///
    /// # Errors
    /// [`ErrorKind::Content`] with the name of the file, the line and the compiler's message, and for
    /// a text without the function; [`ErrorKind::Usage`] for no files, and for a file with the name
    /// of one of the library's.
    #[cfg(feature = "shaderc")]
    pub fn compile(stage: DrawStage, files: &[(&str, &str)]) -> Result<Self> {
        let made = Self {
            source: Some(compile::Source::new(files)?),
            ..Self::empty(stage)
        };
        // One module shows the faults of the text.
        if let Some((module, _)) = made.modules.first() {
            made.words(module)?;
        }
        Ok(made)
    }

    /// A shading that [`Shading::to_bytes`] has written.
    ///
    /// # Errors
    /// [`ErrorKind::Content`] for bytes of another version of the library, and for damaged bytes.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let refused = |why: &str| Error::new(ErrorKind::Content, format!("shading: {why}"));
        let damaged = || refused("the bytes are damaged, or no shading; compile the shading again");
        let (head, rest) = bytes.split_first_chunk::<8>().ok_or_else(damaged)?;
        let (hash, packed) = rest.split_first_chunk::<8>().ok_or_else(damaged)?;
        if *head != MAGIC {
            return Err(damaged());
        }
        if u64::from_le_bytes(*hash) != SOURCES_HASH {
            return Err(refused(
                "the bytes are of another version of revmap; compile the shading with this version",
            ));
        }
        let all = decompress_to_vec_zlib_with_limit(packed, MOST_BYTES).map_err(|_| damaged())?;
        let words = all.chunks_exact(4).map(|b| [b[0], b[1], b[2], b[3]]);
        let mut words = words.map(u32::from_le_bytes);
        // Under the checksum: modules of both stages may be as many.
        let made = Self::empty(match words.next() {
            Some(0) => DrawStage::Fragment,
            Some(1) => DrawStage::Compute,
            _ => return Err(damaged()),
        });
        for (_, module) in &made.modules {
            let count = words.next().ok_or_else(damaged)? as usize;
            let own: Vec<u32> = words.by_ref().take(count).collect();
            if own.len() != count || own.first() != Some(&SPIRV_MAGIC) {
                return Err(damaged());
            }
            let _ = module.set(Ok(own));
        }
        match words.next() {
            None => Ok(made),
            Some(_) => Err(damaged()),
        }
    }

    /// All modules as bytes for [`Shading::from_bytes`] of the same version of the library, for
    /// programs that are built without a compiler. Compiles the modules that no pipeline has needed
    /// yet.
    ///
    /// # Errors
    /// [`ErrorKind::Content`] if a module does not compile: code under a macro of the library.
    pub fn to_bytes(&self) -> Result<Vec<u8>> {
        let stage: u32 = match self.stage {
            DrawStage::Fragment => 0,
            DrawStage::Compute => 1,
        };
        let mut all = stage.to_le_bytes().to_vec();
        for (module, _) in &self.modules {
            let words = self.words(module)?;
            all.extend((words.len() as u32).to_le_bytes());
            all.extend(words.iter().flat_map(|word| word.to_le_bytes()));
        }
        let packed = compress_to_vec_zlib(&all, 9);
        Ok([&MAGIC[..], &SOURCES_HASH.to_le_bytes(), &packed].concat())
    }

    /// The stage that it shades in.
    #[must_use]
    pub fn stage(&self) -> DrawStage {
        self.stage
    }

    /// The words of the module that replaces `module` of the library.
    pub(crate) fn words(&self, module: &Module) -> Result<&[u32]> {
        let none = || Error::new(ErrorKind::Other, format!("no shading is {}", module.name()));
        let own = self.modules.iter().find(|(own, _)| own == module);
        let (own, words) = own.ok_or_else(none)?;
        let words = words.get_or_init(|| {
            #[cfg(feature = "shaderc")]
            if let Some(source) = &self.source {
                return source.words(own);
            }
            let message = format!("a shading of bytes lacks {}", own.name());
            Err(Error::new(ErrorKind::Other, message))
        });
        words.as_deref().map_err(Clone::clone)
    }

    /// `(set, binding)` of all descriptors that its compiled modules read.
    pub(crate) fn bindings(&self) -> BTreeSet<(u32, u32)> {
        self.compiled().flat_map(bindings).collect()
    }

    /// The largest number of textures of a set that one of its compiled modules reads.
    pub(crate) fn textures(&self, set: u32) -> u32 {
        let counts = self.compiled().map(|words| textures(words, set));
        counts.max().unwrap_or_default()
    }

    fn compiled(&self) -> impl Iterator<Item = &[u32]> {
        let compiled = self.modules.iter().filter_map(|(_, words)| words.get());
        compiled.filter_map(|words| words.as_deref().ok())
    }

    fn empty(stage: DrawStage) -> Self {
        let all = shading_modules(stage == DrawStage::Compute).into_iter();
        Self {
            stage,
            modules: all.map(|module| (module, OnceLock::new())).collect(),
            #[cfg(feature = "shaderc")]
            source: None,
        }
    }
}

impl fmt::Debug for Shading {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Shading({})", self.stage.name())
    }
}

/// `(set, binding)` of a module's descriptors.
fn bindings(words: &[u32]) -> Vec<(u32, u32)> {
    let of = |what: u32| {
        let all = instructions(words).filter(|(code, _)| *code == op::DECORATE);
        all.filter(move |(_, one)| one[2] == what)
            .map(|(_, one)| (one[1], one[3]))
    };
    let set = |id: u32| of(op::DESCRIPTOR_SET).find(|(known, _)| *known == id);
    of(op::BINDING)
        .filter_map(|(id, binding)| Some((set(id)?.1, binding)))
        .collect()
}

/// The number of textures of a set that a module declares: combined image samplers, and samplers and
/// sampled images by themselves.
fn textures(words: &[u32], set: u32) -> u32 {
    let (mut counts, mut constants) = (HashMap::new(), HashMap::new());
    let (mut of_set, mut all) = (HashSet::new(), 0);
    for (code, one) in instructions(words) {
        let count = match (code, one) {
            (op::DECORATE, [_, id, op::DESCRIPTOR_SET, number]) if *number == set => {
                of_set.insert(*id);
                None
            }
            (op::CONSTANT, [_, _, id, value]) => {
                constants.insert(*id, *value);
                None
            }
            (op::TYPE_SAMPLED_IMAGE | op::TYPE_SAMPLER, [_, id, ..]) => Some((*id, 1)),
            // Images that are no storage images.
            (op::TYPE_IMAGE, [_, id, _, _, _, _, _, 1, ..]) => Some((*id, 1)),
            (op::TYPE_ARRAY, [_, id, of, length]) => {
                let length = constants.get(length).copied().unwrap_or(1);
                counts.get(of).map(|count| (*id, count * length))
            }
            (op::TYPE_POINTER, [_, id, _, of]) => counts.get(of).map(|count| (*id, *count)),
            (op::VARIABLE, [_, of, id, ..]) if of_set.contains(id) => {
                all += counts.get(of).copied().unwrap_or(0);
                None
            }
            _ => None,
        };
        counts.extend(count);
    }
    all
}

#[cfg(test)]
mod tests;
