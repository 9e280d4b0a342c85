//! The program as it is run: command lines, files, exit codes, what it prints.
#![allow(clippy::unwrap_used, clippy::panic)]

mod bad_input;
#[cfg(unix)]
mod bench_command;
mod bench_compare;
mod command_line;
#[cfg(target_os = "linux")]
mod drivers;
mod inputs;
#[cfg(target_os = "linux")]
mod memory;
mod mesh_command;
mod moving_pictures;
#[cfg(feature = "shaderc")]
mod own_search;
mod photographs;
mod pictures;
mod run;
#[cfg(target_os = "linux")] // Mesa has the compiler for AMD's GPUs only there
mod shaders_command;
#[cfg(feature = "shaderc")]
mod shading_command;
mod stability_command;
mod studio;
mod submit_command;
#[cfg(target_os = "linux")]
mod system;
mod warnings;
mod words;
