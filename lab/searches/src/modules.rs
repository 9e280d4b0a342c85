//! The SPIR-V of this crate's modules.

use crate::list::modules;
use revmap::error::{Error, ErrorKind, Result};
use revmap::search::{SearchModule, Words, unpacked};

/// The packed modules of the list, and hashes, from `build.rs`.
#[allow(clippy::unreadable_literal, dead_code)]
pub mod generated {
    include!(concat!(env!("OUT_DIR"), "/modules.rs"));
}

/// Words that `words` returns: those of [`found`] for a file of `published/`.
pub(crate) const fn embedded(
    words: &'static (dyn Fn(&SearchModule) -> Result<Vec<u32>> + Send + Sync),
) -> Words {
    // SAFETY: build.rs has compiled the list by the library's own files, and hooks of this crate
    // read by the library's functions and count their steps.
    #[allow(unsafe_code)]
    unsafe {
        Words::new(words)
    }
}

pub(crate) fn found(hook: &str, wanted: &SearchModule) -> Result<Vec<u32>> {
    modules()
        .iter()
        .zip(generated::MODULES)
        .find(|(listed, _)| listed.hook == hook && listed.module == *wanted)
        .and_then(|(_, packed)| unpacked(packed))
        .ok_or_else(|| {
            let message = format!("no shader of {hook} is {}", wanted.name());
            Error::new(ErrorKind::Other, message)
        })
}
