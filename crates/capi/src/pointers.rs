//! Pointers from the caller, checked before use.

use crate::fault::{Fault, Outcome, RevmapResult, enter};
use std::ffi::{CStr, c_char, c_void};

pub(crate) fn null(what: &str) -> Fault {
    Fault::usage(format!("the pointer to {what} is null"))
}

/// The body of an entry point that returns a value without a size of its own.
pub(crate) unsafe fn put<T>(
    to: *mut T,
    what: &str,
    value: impl FnOnce() -> Outcome<T>,
) -> RevmapResult {
    enter(|| {
        if to.is_null() {
            return Err(null(what));
        }
        let value = value()?;
        // SAFETY: the caller's, for one value.
        unsafe { to.write(value) };
        Ok(())
    })
}

/// A value from the caller without a size of its own.
pub(crate) unsafe fn take<T: Copy>(from: *const T, what: &str) -> Outcome<T> {
    // SAFETY: null or the caller's.
    unsafe { from.as_ref() }.copied().ok_or_else(|| null(what))
}

/// The body of an entry point that returns bytes, or with a null pointer their number alone. `count`
/// is the room, and becomes the number.
pub(crate) unsafe fn put_bytes(
    to: *mut c_void,
    count: *mut usize,
    data: impl FnOnce() -> Outcome<Vec<u8>>,
) -> RevmapResult {
    // SAFETY: the caller's pointers; the room is as large as it says.
    enter(|| unsafe {
        let room = take(count, "count")?;
        let data = data()?;
        if !to.is_null() {
            if room < data.len() {
                let message = format!("{} bytes do not fit into {room}", data.len());
                return Err(Fault::usage(message));
            }
            to.cast::<u8>()
                .copy_from_nonoverlapping(data.as_ptr(), data.len());
        }
        count.write(data.len());
        Ok(())
    })
}

/// An array from the caller; null if it is empty.
pub(crate) unsafe fn list<'a, T>(from: *const T, count: usize, what: &str) -> Outcome<&'a [T]> {
    if count == 0 {
        return Ok(&[]);
    }
    check_room(from, count, what)?;
    // SAFETY: the caller's, of so many elements, unchanged during the call.
    Ok(unsafe { std::slice::from_raw_parts(from, count) })
}

/// Fails for a null pointer, and for more elements than memory holds.
pub(crate) fn check_room<T>(at: *const T, count: usize, what: &str) -> Outcome<()> {
    if at.is_null() {
        return Err(null(what));
    }
    let bytes = count.checked_mul(size_of::<T>());
    if bytes.is_none_or(|bytes| bytes > isize::MAX as usize) {
        let message = format!("{count} {what} are more than memory holds");
        return Err(Fault::usage(message));
    }
    Ok(())
}

/// A text from the caller.
pub(crate) unsafe fn text<'a>(from: *const c_char, what: &str) -> Outcome<&'a str> {
    optional_text(from, what)?.ok_or_else(|| null(what))
}

/// A text from the caller; `None` for null.
pub(crate) unsafe fn optional_text<'a>(
    from: *const c_char,
    what: &str,
) -> Outcome<Option<&'a str>> {
    if from.is_null() {
        return Ok(None);
    }
    // SAFETY: the caller's, ended by 0, unchanged during the call.
    let text = unsafe { CStr::from_ptr(from) }.to_str();
    text.map(Some)
        .map_err(|_| Fault::usage(format!("the {what} is not UTF-8")))
}
