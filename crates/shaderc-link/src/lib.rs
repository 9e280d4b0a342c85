//! [`shaderc`], re-exported. This crate's build script adds the archives that Debian's and Ubuntu's
//! `libshaderc-dev` leave out of `libshaderc_combined.a`; where shaderc is whole it adds nothing.

pub use shaderc::*;
