//! The SPIR-V of this crate's modules.

use crate::list::modules;
use revmap::error::{Error, ErrorKind, Result};
use revmap::search::{SearchModule, Words, unpacked};

/// Sizes and hashes of the files from `build.rs`.
#[allow(clippy::unreadable_literal, dead_code)]
pub mod generated {
    include!(concat!(env!("OUT_DIR"), "/modules.rs"));

    /// The packed bytes of each module of the list, in its order.
    pub fn packed() -> impl Iterator<Item = &'static [u8]> {
        let mut rest: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/modules.bin"));
        MODULE_BYTES.iter().map(move |size| {
            let (module, after) = rest.split_at_checked(*size).unwrap_or_default();
            rest = after;
            module
        })
    }
}

/// The modules of a file of `published/`.
macro_rules! words {
    ($hook:literal) => {
        $crate::modules::embedded(&|module| $crate::modules::found($hook, module))
    };
}
pub(crate) use words;

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
        .zip(generated::packed())
        .find(|(listed, _)| listed.hook == hook && listed.module.serves(wanted))
        .and_then(|(_, packed)| unpacked(packed))
        .ok_or_else(|| {
            let message = format!("no shader of {hook} is {}", wanted.name());
            Error::new(ErrorKind::Other, message)
        })
}
