//! Results, and the last failure of each thread.

use revmap::error::ErrorKind;
use std::any::Any;
use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The result of a function: success, or the kind of its failure. A failure changes only what the
/// failing function's documentation says, and leaves a text for revmap_last_error_text().
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RevmapResult {
    /// Done.
    Ok = 0,
    /// Invalid arguments: a null pointer, a wrong size, an unknown number, a call out of order.
    Usage = 1,
    /// A value of a scene, profile or map that cannot be drawn; the text begins with its name.
    Content = 2,
    /// A file that cannot be read or written; the text begins with its name.
    File = 3,
    /// No Vulkan device, or one that lacks a feature, a format or an extension.
    Unsupported = 4,
    /// More pixels, texels, copies or tables than the device or the library takes.
    TooLarge = 5,
    /// The host's memory is full.
    OutOfHostMemory = 6,
    /// The device's memory, or its budget, is full.
    OutOfDeviceMemory = 7,
    /// The device was lost: destroy all that was made on it, and open it again.
    DeviceLost = 8,
    /// A fault of the driver, or messages of the validation layers.
    Other = 9,
    /// A handle that is null, destroyed or of another kind.
    Handle = 10,
    /// A handle that another thread uses at this moment.
    Busy = 11,
    /// A fault of the library. The handles of the call can only be destroyed.
    Internal = 12,
}

/// The reason why a call fails.
#[derive(Debug)]
pub(crate) struct Fault {
    pub result: RevmapResult,
    pub text: String,
}

impl Fault {
    pub fn new(result: RevmapResult, text: impl Into<String>) -> Self {
        Self {
            result,
            text: text.into(),
        }
    }

    pub fn usage(text: impl Into<String>) -> Self {
        Self::new(RevmapResult::Usage, text)
    }
}

impl From<revmap::Error> for Fault {
    fn from(error: revmap::Error) -> Self {
        let result = match error.kind {
            ErrorKind::Usage => RevmapResult::Usage,
            ErrorKind::Content => RevmapResult::Content,
            ErrorKind::File => RevmapResult::File,
            ErrorKind::Unsupported => RevmapResult::Unsupported,
            ErrorKind::TooLarge => RevmapResult::TooLarge,
            ErrorKind::OutOfHostMemory => RevmapResult::OutOfHostMemory,
            ErrorKind::OutOfDeviceMemory => RevmapResult::OutOfDeviceMemory,
            ErrorKind::DeviceLost => RevmapResult::DeviceLost,
            ErrorKind::Other => RevmapResult::Other,
        };
        Self::new(result, error.to_string())
    }
}

pub(crate) type Outcome<T> = std::result::Result<T, Fault>;

thread_local! {
    static LAST: RefCell<(RevmapResult, Option<CString>)> = const { RefCell::new((RevmapResult::Ok, None)) };
}

/// Runs the body of an entry point: keeps its failure for this thread, and makes one of a panic.
pub(crate) fn enter(body: impl FnOnce() -> Outcome<()>) -> RevmapResult {
    let fault = match catch_unwind(AssertUnwindSafe(body)) {
        Ok(Ok(())) => return RevmapResult::Ok,
        Ok(Err(fault)) => fault,
        Err(panic) => Fault::new(RevmapResult::Internal, panic_text(panic.as_ref())),
    };
    let text = CString::new(fault.text.replace('\0', " ")).ok();
    // A thread that is ending has no last failure.
    let _ = LAST.try_with(|last| last.replace((fault.result, text)));
    fault.result
}

fn panic_text(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let said = text.or_else(|| panic.downcast_ref::<&str>().copied());
    let said = said.unwrap_or("it says no more");
    format!("a fault of the library: {said}")
}

/// The kind of this thread's last failure; REVMAP_RESULT_OK if there was none.
#[unsafe(no_mangle)]
pub extern "C" fn revmap_last_error() -> RevmapResult {
    LAST.try_with(|last| last.borrow().0)
        .unwrap_or(RevmapResult::Ok)
}

/// The reason of this thread's last failure: one line of UTF-8 with the cause and the remedy. Empty
/// if none has failed. The text lasts until the next failure on this thread, or the thread's end.
#[unsafe(no_mangle)]
pub extern "C" fn revmap_last_error_text() -> *const c_char {
    const NONE: &CStr = c"";
    LAST.try_with(|last| last.borrow().1.as_ref().map(|text| text.as_ptr()))
        .ok()
        .flatten()
        .unwrap_or(NONE.as_ptr())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::panic)]
    use super::*;

    fn last() -> (RevmapResult, String) {
        // SAFETY: the text lasts until the next failure of this thread.
        let text = unsafe { CStr::from_ptr(revmap_last_error_text()) };
        (revmap_last_error(), text.to_string_lossy().into_owned())
    }

    #[test]
    fn a_panic_stays_within_and_each_thread_has_its_own_failure() {
        assert_eq!(last(), (RevmapResult::Ok, String::new()));
        assert_eq!(enter(|| panic!("planted")), RevmapResult::Internal);
        let (result, text) = last();
        assert_eq!(result, RevmapResult::Internal);
        assert!(text.ends_with("planted"), "{text}");
        std::thread::spawn(|| {
            assert_eq!(last(), (RevmapResult::Ok, String::new()));
            assert_eq!(enter(|| Err(Fault::usage("a\0b"))), RevmapResult::Usage);
            assert_eq!(last(), (RevmapResult::Usage, "a b".into()));
        })
        .join()
        .unwrap();
        assert_eq!(last().0, RevmapResult::Internal);
        // A successful call leaves the last failure unchanged.
        assert_eq!(enter(|| Ok(())), RevmapResult::Ok);
        assert_eq!(last().0, RevmapResult::Internal);
    }
}
