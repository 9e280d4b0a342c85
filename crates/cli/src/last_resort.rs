//! The end of memory. A request that fails and is no error of the library's ends the program in one
//! line, with exit code 1. An allocator must not unwind.
#![allow(unsafe_code)] // an allocator

use revmap::host_memory;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};

#[global_allocator]
static ALLOCATOR: LastResort = LastResort;

/// The system's allocator, whose failures end the program.
struct LastResort;

// SAFETY: all calls go to the system's allocator, with the caller's arguments.
unsafe impl GlobalAlloc for LastResort {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as above.
        checked(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as above.
        checked(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as above.
        checked(unsafe { System.realloc(at, layout, size) }, size)
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(at, layout) }
    }
}

fn checked(at: *mut u8, bytes: usize) -> *mut u8 {
    if at.is_null() && !host_memory::is_handled() {
        end_without_memory(bytes);
    }
    at
}

thread_local! {
    static ENDING_HERE: Cell<bool> = const { Cell::new(false) };
}
static ENDING: AtomicBool = AtomicBool::new(false);

/// Ends the program, without a request of its own that must succeed.
fn end_without_memory(bytes: usize) -> ! {
    if ENDING_HERE.replace(true) {
        end();
    }
    if ENDING.swap(true, Ordering::SeqCst) {
        // Another thread is ending the program.
        loop {
            std::thread::park();
        }
    }
    let mut line = [0; 256];
    let mut rest = &mut line[..];
    let _ = writeln!(
        rest,
        "revmap: no memory for {bytes} more bytes; give smaller input, a smaller --size or --map-rows, or more memory"
    );
    let left = rest.len();
    let _ = std::io::stderr().write_all(&line[..line.len() - left]);
    revmap_files::remove_unfinished();
    end()
}

/// Ends the program at once: functions that run at an exit may need memory.
fn end() -> ! {
    #[cfg(unix)]
    {
        unsafe extern "C" {
            safe fn _exit(code: i32) -> !;
        }
        _exit(1)
    }
    #[cfg(not(unix))]
    std::process::exit(1)
}
